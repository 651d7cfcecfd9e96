/* NULL handles and pointers everywhere, unknown constants, engine options out of range; the values of the statuses.
 */
#include <stdlib.h>

#include "check.h"

/* Values never change: programs have them compiled in. */
static void statuses_are_pinned(void) {
  static const struct {
    brn_status value;
    int32_t pinned;
    const char *name;
  } table[] = {
      {BRN_OK, 0, "BRN_OK"},
      {BRN_INVALID_ARGUMENT, 10, "BRN_INVALID_ARGUMENT"},
      {BRN_INVALID_SCENE, 20, "BRN_INVALID_SCENE"},
      {BRN_WRONG_STATE, 30, "BRN_WRONG_STATE"},
      {BRN_SHORT_BUFFER, 40, "BRN_SHORT_BUFFER"},
      {BRN_UNSUPPORTED, 50, "BRN_UNSUPPORTED"},
      {BRN_OUT_OF_MEMORY, 60, "BRN_OUT_OF_MEMORY"},
      {BRN_TOO_LARGE, 70, "BRN_TOO_LARGE"},
      {BRN_NOT_CONVERGED, 80, "BRN_NOT_CONVERGED"},
      {BRN_NO_EQUILIBRIUM, 85, "BRN_NO_EQUILIBRIUM"},
      {BRN_CANCELLED, 90, "BRN_CANCELLED"},
      {BRN_DAMAGED_DATA, 100, "BRN_DAMAGED_DATA"},
      {BRN_INTERNAL, 1000, "BRN_INTERNAL"},
  };
  size_t k;
  for (k = 0; k < sizeof table / sizeof *table; ++k) {
    CHECK(table[k].value == table[k].pinned);
    CHECK(strcmp(brn_status_name(table[k].pinned), table[k].name) == 0);
  }
  CHECK(strcmp(brn_status_name(-1), "unknown status") == 0);
  CHECK(strcmp(brn_status_name(11), "unknown status") == 0);
  CHECK(strcmp(brn_status_name(INT32_MAX), "unknown status") == 0);
}

static void constants_are_pinned(void) {
  CHECK(BRN_ISA_BEST == 0 && BRN_ISA_BASELINE == 1 && BRN_ISA_AVX2 == 2 && BRN_ISA_AVX512 == 3);
  CHECK(BRN_BOUNDARY_FREE == 0 && BRN_BOUNDARY_PERIODIC == 1);
  CHECK(BRN_LOWER == 0 && BRN_UPPER == 1);
  CHECK(BRN_SHAPE_PLANE == 0 && BRN_SHAPE_SPHERE == 1 && BRN_SHAPE_ELLIPSOID == 2 && BRN_SHAPE_CONE == 3);
  CHECK(BRN_SHAPE_FLAT_PUNCH == 4 && BRN_SHAPE_ROLLER == 5 && BRN_SHAPE_SINUSOID == 6);
  CHECK(BRN_PROFILE_PARABOLIC == 0 && BRN_PROFILE_EXACT == 1);
  CHECK(BRN_DETREND_NONE == 0 && BRN_DETREND_MEAN == 1 && BRN_DETREND_PLANE == 2);
  CHECK(BRN_DRIVE_FORCE == 1 && BRN_DRIVE_APPROACH == 2 && BRN_DRIVE_MEAN_PRESSURE == 3);
  CHECK(BRN_PRECISION_DOUBLE == 0 && BRN_PRECISION_MIXED == 1);
  CHECK(BRN_FIELD_PRESSURE == 1 && BRN_FIELD_GAP == 2 && BRN_FIELD_DISPLACEMENT == 3);
  CHECK(BRN_FIELD_UNDEFORMED_GAP == 4);
}

static void version_is_three_numbers(void) {
  int major, minor, patch;
  char rest;
  CHECK(sscanf(brn_version(), "%d.%d.%d%c", &major, &minor, &patch, &rest) == 3);
}

static void destroying_null_does_nothing(void) {
  brn_engine_destroy(NULL);
  brn_scene_destroy(NULL);
  brn_run_destroy(NULL);
}

static void queries_of_null_are_empty(void) {
  CHECK(brn_engine_message(NULL) != NULL);
  CHECK(brn_scene_message(NULL) != NULL);
  CHECK(brn_run_message(NULL) != NULL);
  CHECK(brn_engine_isa(NULL) == 0);
  CHECK(strcmp(brn_engine_isa_name(NULL), "") == 0);
  CHECK(brn_engine_threads(NULL) == 0);
  CHECK(brn_run_plan_count(NULL) == 0);
  CHECK(brn_run_memory_bytes(NULL) == 0);
  CHECK(brn_run_total_increments(NULL) == 0);
  CHECK(brn_run_solved_increments(NULL) == 0);
  CHECK(brn_run_trace_count(NULL) == 0);
  CHECK(brn_run_stage_name(NULL, 0) == NULL);
  CHECK(brn_run_stage_seconds(NULL, 0) == 0.0);
}

/* The call is refused as an invalid argument, and the message names the argument. */
#define REFUSED(call, words)                  \
  do {                                        \
    CHECK_STATUS(BRN_INVALID_ARGUMENT, call); \
    CHECK_SAYS(brn_last_message(), words);    \
  } while (0)

static void null_handles_are_refused(void) {
  const brn_grid grid = square_grid(4, 1e-6);
  const brn_body body = steel_body();
  const brn_shape shape = sphere_shape(1e-3);
  const brn_step step = force_step(1.0, 1);
  brn_roughness roughness;
  brn_heights heights;
  brn_solver solver;
  brn_plan_item item;
  brn_increment increment;
  brn_trace_point point;
  size_t size = 0;
  double value = 0.0;
  char byte = 0;
  brn_roughness_init(&roughness);
  brn_heights_init(&heights);
  brn_solver_init(&solver);
  brn_plan_item_init(&item);
  brn_increment_init(&increment);
  brn_trace_point_init(&point);

  REFUSED(brn_engine_export_wisdom(NULL, &byte, 1, &size), "engine|NULL");
  REFUSED(brn_scene_set_grid(NULL, &grid), "scene|NULL");
  REFUSED(brn_scene_set_body(NULL, BRN_LOWER, &body), "scene|NULL");
  REFUSED(brn_scene_add_shape(NULL, &shape), "scene|NULL");
  REFUSED(brn_scene_add_roughness(NULL, &roughness), "scene|NULL");
  REFUSED(brn_scene_add_heights(NULL, &heights), "scene|NULL");
  REFUSED(brn_scene_add_step(NULL, &step), "scene|NULL");
  REFUSED(brn_scene_set_solver(NULL, &solver), "scene|NULL");
  REFUSED(brn_run_get_plan_item(NULL, 0, &item), "run|NULL");
  REFUSED(brn_run_advance(NULL, NULL, NULL), "run|NULL");
  REFUSED(brn_run_execute(NULL, NULL, NULL), "run|NULL");
  REFUSED(brn_run_get_increment(NULL, 0, &increment), "run|NULL");
  REFUSED(brn_run_get_trace_point(NULL, 0, &point), "run|NULL");
  REFUSED(brn_run_get_field(NULL, BRN_FIELD_PRESSURE, &value, 1, &size), "run|NULL");
  REFUSED(brn_run_save(NULL, &byte, 1, &size), "run|NULL");
}

static void null_outputs_are_refused(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(8, 1);
  REFUSED(brn_engine_create(NULL, NULL), "out|NULL");
  REFUSED(brn_scene_create(NULL), "out|NULL");
  REFUSED(brn_run_create(engine, scene, NULL), "out|NULL");
  REFUSED(brn_run_load(engine, scene, "x", 1, NULL), "out|NULL");
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void create_clears_its_output_on_failure(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(8, 1);
  int target = 0;
  brn_run *run = (brn_run *)(void *)&target;
  brn_engine *other = (brn_engine *)(void *)&target;
  brn_engine_options options;

  REFUSED(brn_run_create(NULL, scene, &run), "engine|NULL");
  CHECK(run == NULL);
  run = (brn_run *)(void *)&target;
  REFUSED(brn_run_create(engine, NULL, &run), "scene|NULL");
  CHECK(run == NULL);
  run = (brn_run *)(void *)&target;
  REFUSED(brn_run_load(engine, scene, NULL, 16, &run), "data|NULL");
  CHECK(run == NULL);
  brn_engine_options_init(&options);
  options.threads = -1;
  REFUSED(brn_engine_create(&options, &other), "threads|-1");
  CHECK(other == NULL);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void null_pointers_on_good_handles_are_refused(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(8, 1);
  brn_run *run = NULL;
  brn_statistics statistics;
  brn_heights heights;
  size_t size = 0;
  brn_statistics_init(&statistics);
  brn_heights_init(&heights);
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));

  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_grid(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "grid|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_body(scene, BRN_LOWER, NULL));
  CHECK_SAYS(brn_scene_message(scene), "body|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_shape(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "shape|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_roughness(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "roughness|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_heights(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "heights|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "step|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_solver(scene, NULL));
  CHECK_SAYS(brn_scene_message(scene), "solver|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_plan_item(run, 0, NULL));
  CHECK_SAYS(brn_run_message(run), "out|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_field(run, BRN_FIELD_UNDEFORMED_GAP, NULL, 64, &size));
  CHECK_SAYS(brn_run_message(run), "values|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_field(run, BRN_FIELD_UNDEFORMED_GAP, NULL, 0, NULL));
  CHECK_SAYS(brn_run_message(run), "count|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_save(run, NULL, 64, &size));
  CHECK_SAYS(brn_run_message(run), "buffer|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_save(run, NULL, 0, NULL));
  CHECK_SAYS(brn_run_message(run), "size|NULL");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_engine_export_wisdom(engine, NULL, 64, &size));
  CHECK_SAYS(brn_engine_message(engine), "buffer|NULL");
  REFUSED(brn_height_statistics(NULL, 1.0, 1.0, &statistics), "heights|NULL");
  heights.nx = heights.ny = 2;
  REFUSED(brn_height_statistics(&heights, 1.0, 1.0, &statistics), "values|NULL");

  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void engine_options_out_of_range_are_refused(void) {
  brn_engine *engine = NULL;
  brn_engine_options options;
  brn_engine_options_init(&options);
  options.threads = 1025;
  REFUSED(brn_engine_create(&options, &engine), "threads|1025|1024");
  brn_engine_options_init(&options);
  options.isa = 4;
  REFUSED(brn_engine_create(&options, &engine), "isa|4");
  options.isa = -1;
  REFUSED(brn_engine_create(&options, &engine), "isa|-1");
  brn_engine_options_init(&options);
  options.wisdom = "this is no wisdom";
  REFUSED(brn_engine_create(&options, &engine), "wisdom");
  CHECK(engine == NULL);
}

static void every_instruction_set_is_used_or_refused(void) {
  int32_t isa;
  for (isa = BRN_ISA_BASELINE; isa <= BRN_ISA_AVX512; ++isa) {
    brn_engine *engine = NULL;
    brn_engine_options options;
    brn_status status;
    brn_engine_options_init(&options);
    options.isa = isa;
    status = brn_engine_create(&options, &engine);
    if (status == BRN_OK) {
      CHECK(brn_engine_isa(engine) == isa);
      CHECK(strlen(brn_engine_isa_name(engine)) > 0);
    } else {
      CHECK(status == BRN_UNSUPPORTED && isa != BRN_ISA_BASELINE);
      CHECK(engine == NULL && strlen(brn_last_message()) > 0);
    }
    brn_engine_destroy(engine);
  }
}

static void engine_uses_the_threads_it_is_given(void) {
  brn_engine *engine = plain_engine(3);
  CHECK(brn_engine_threads(engine) == 3);
  brn_engine_destroy(engine);
  engine = plain_engine(0);
  CHECK(brn_engine_threads(engine) >= 1);
  brn_engine_destroy(engine);
}

static void wisdom_goes_round(void) {
  brn_engine *engine = plain_engine(1), *wiser = NULL;
  brn_engine_options options;
  size_t size = 0, again = 0;
  char *text;
  CHECK_STATUS(BRN_OK, brn_engine_export_wisdom(engine, NULL, 0, &size));
  CHECK(size > 0);
  text = malloc(size + 1);
  memset(text, '#', size + 1);
  CHECK_STATUS(BRN_SHORT_BUFFER, brn_engine_export_wisdom(engine, text, size - 1, &again));
  CHECK(again == size);
  CHECK_STATUS(BRN_OK, brn_engine_export_wisdom(engine, text, size, &again));
  CHECK(again == size && strlen(text) == size - 1 && text[size] == '#');
  brn_engine_options_init(&options);
  options.wisdom = text;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &wiser));
  brn_engine_destroy(wiser);
  brn_engine_destroy(engine);
  free(text);
}

int main(void) {
  statuses_are_pinned();
  constants_are_pinned();
  version_is_three_numbers();
  destroying_null_does_nothing();
  queries_of_null_are_empty();
  null_handles_are_refused();
  null_outputs_are_refused();
  create_clears_its_output_on_failure();
  null_pointers_on_good_handles_are_refused();
  engine_options_out_of_range_are_refused();
  every_instruction_set_is_used_or_refused();
  engine_uses_the_threads_it_is_given();
  wisdom_goes_round();
  return check_report();
}
