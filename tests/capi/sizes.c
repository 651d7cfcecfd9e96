/* Clients of other releases: a shorter struct_size hides the members beyond it, a longer one is accepted and what it
 * adds is ignored. */
#include <stddef.h>

#include "check.h"

static void an_older_client_gets_defaults(void) {
  brn_engine *engine = NULL;
  brn_engine_options options;
  memset(&options, 0x7f, sizeof options); /* every member is out of range */
  options.struct_size = offsetof(brn_engine_options, isa);
  options.threads = 2;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &engine));
  CHECK(brn_engine_threads(engine) == 2);
  brn_engine_destroy(engine);

  memset(&options, 0x7f, sizeof options);
  options.struct_size = sizeof options.struct_size;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &engine));
  brn_engine_destroy(engine);

  memset(&options, 0x7f, sizeof options); /* half of a member is none of it */
  options.struct_size = offsetof(brn_engine_options, memory_limit) + 3;
  options.threads = 1;
  options.isa = BRN_ISA_BASELINE;
  options.wisdom = NULL;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &engine));
  CHECK(brn_engine_isa(engine) == BRN_ISA_BASELINE);
  brn_engine_destroy(engine);
}

static void an_unset_size_is_refused(void) {
  brn_engine *engine = NULL;
  brn_engine_options options;
  brn_scene *scene = NULL;
  brn_grid grid = square_grid(8, 1e-6);
  brn_engine_options_init(&options);
  options.struct_size = 0;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_engine_create(&options, &engine));
  CHECK_SAYS(brn_last_message(), "struct_size|0");
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  grid.struct_size = 0;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_grid(scene, &grid));
  CHECK_SAYS(brn_scene_message(scene), "struct_size|0");
  brn_scene_destroy(scene);
}

static void members_beyond_an_older_grid_are_not_read(void) {
  brn_scene *scene = NULL;
  brn_grid grid = square_grid(8, 1e-6);
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  grid.boundary = 77;
  grid.struct_size = offsetof(brn_grid, boundary);
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  grid.struct_size = offsetof(brn_grid, ny); /* without ny: its default is no size */
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_grid(scene, &grid));
  CHECK_SAYS(brn_scene_message(scene), "ny");
  brn_scene_destroy(scene);
}

typedef struct {
  brn_step known;
  double added[4];
} newer_step;

static void a_newer_client_is_accepted(void) {
  brn_scene *scene = sphere_scene(8, 1);
  newer_step step;
  memset(&step, 0x7f, sizeof step);
  step.known = force_step(1.0, 2);
  step.known.struct_size = sizeof step;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step.known));
  brn_scene_destroy(scene);
}

typedef struct {
  brn_increment known;
  unsigned char added[64];
} newer_increment;

static int untouched(const void *bytes, size_t begin, size_t end) {
  const unsigned char *byte = bytes;
  while (begin < end && byte[begin] == 0x5a) ++begin;
  return begin == end;
}

static void results_stay_within_the_size(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(16, 1);
  brn_run *run = NULL;
  brn_increment whole, older;
  newer_increment newer;
  const size_t cut = offsetof(brn_increment, first_touch);
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));

  brn_increment_init(&whole);
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, 0, &whole));

  memset(&older, 0x5a, sizeof older);
  older.struct_size = cut;
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, 0, &older));
  CHECK(older.struct_size == cut);
  CHECK(older.normal_force == whole.normal_force && older.contact_nodes == whole.contact_nodes);
  CHECK(untouched(&older, cut, sizeof older));

  memset(&newer, 0x5a, sizeof newer);
  newer.known.struct_size = sizeof newer;
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, 0, &newer.known));
  CHECK(newer.known.struct_size == sizeof newer);
  CHECK(newer.known.max_pressure == whole.max_pressure && newer.known.wall_seconds == whole.wall_seconds);
  CHECK(untouched(newer.added, 0, sizeof newer.added));

  memset(&older, 0x5a, sizeof older);
  older.struct_size = 0;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_increment(run, 0, &older));
  CHECK_SAYS(brn_run_message(run), "struct_size|0");
  CHECK(untouched(&older, sizeof older.struct_size, sizeof older));

  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static int32_t look_at_the_size(const brn_progress *progress, void *user) {
  *(size_t *)user = progress->struct_size;
  return 0;
}

static void progress_states_its_size(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(16, 1);
  brn_run *run = NULL;
  size_t size = 0;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, look_at_the_size, &size));
  CHECK(size == sizeof(brn_progress));
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* Without strain_scale and what follows, and with members that are not known yet. */
static void laws_of_other_releases_are_read(void) {
  brn_engine *engine = plain_engine(1);
  brn_hardening steel;
  struct {
    brn_return_result known;
    double added[4];
  } result;
  brn_return_points points;
  double numbers[20] = {4e9};
  size_t k;
  int64_t yielded = 0;
  memset(&steel, 0x7f, sizeof steel);
  steel.struct_size = offsetof(brn_hardening, strain_scale);
  steel.law = BRN_HARDENING_SWIFT;
  steel.B = 1240e6;
  steel.C = 30.0;
  steel.n = 0.085;
  brn_return_points_init(&points);
  points.count = 1;
  points.shear_modulus = 80e9;
  points.plastic_strain = &numbers[6];
  memset(&result, 0x5a, sizeof result);
  brn_return_result_init(&result.known);
  result.known.struct_size = sizeof result;
  result.known.capacity = 1;
  result.known.plastic_strain = &numbers[13];
  for (k = 0; k < 6; ++k) {
    points.trial[k] = &numbers[k];
    result.known.increment[k] = &numbers[7 + k];
  }
  points.struct_size = offsetof(brn_return_points, layer_depths);
  CHECK_STATUS(BRN_OK, brn_return_map_batch(engine, &steel, &points, &result.known, &yielded));
  CHECK(yielded == 1 && numbers[7] == numbers[13] && numbers[13] > 0.005 && numbers[13] < 0.01);
  CHECK(untouched((unsigned char *)&result, sizeof result.known, sizeof result));
  steel.struct_size = 0;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, &steel, &points, &result.known, &yielded));
  CHECK_SAYS(brn_engine_message(engine), "hardening|struct_size|0");
  brn_engine_destroy(engine);
}

int main(void) {
  an_older_client_gets_defaults();
  an_unset_size_is_refused();
  members_beyond_an_older_grid_are_not_read();
  a_newer_client_is_accepted();
  results_stay_within_the_size();
  progress_states_its_size();
  laws_of_other_releases_are_read();
  return check_report();
}
