/* The stress below the surface: of a scene, by field, by layer and by its largest value; and of tractions that the
 * caller has. The pressed sphere is that of sphere_scene: contact radius 14.8 um. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "check.h"

enum { n = 48, nodes = n * n, layers = 12, cells = nodes * layers };

static const double thickness = 1.2e-6;

static const int32_t stress_and_von_mises[] = {BRN_FIELD_STRESS, BRN_FIELD_VON_MISES};

static brn_subsurface equal_layers(const int32_t *fields, size_t count) {
  brn_subsurface wanted;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = thickness;
  wanted.fields = fields;
  wanted.field_count = count;
  return wanted;
}

static brn_increment last_of(brn_run *run) {
  brn_increment result;
  brn_increment_init(&result);
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, brn_run_solved_increments(run) - 1, &result));
  return result;
}

static int has_stress_stage(brn_run *run) {
  brn_plan_item item;
  int32_t k;
  for (k = 0; k < brn_run_plan_count(run); ++k) {
    brn_plan_item_init(&item);
    CHECK_STATUS(BRN_OK, brn_run_get_plan_item(run, k, &item));
    if (strcmp(item.stage, "stress") == 0) return 1;
  }
  return 0;
}

/* Hertz: 0.620041 p0 at 0.48086 a for nu = 0.3. 15 cells to the contact radius are good for a percent. */
static void below_a_sphere_is_what_hertz_says(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  const brn_subsurface wanted = equal_layers(stress_and_von_mises, 2);
  const double a = cbrt(0.75 * 1.0 * 1e-3 * (1.0 - 0.09) / 210e9), p0 = 1.5 / (3.14159265358979 * a * a);
  double *stress, *von_mises, depths[layers];
  brn_increment result;
  brn_run *run;
  size_t count = 0, k;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK(has_stress_stage(run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = last_of(run);
  CHECK(fabs(result.max_von_mises / (0.620041 * p0) - 1.0) < 0.01);
  CHECK(fabs(result.max_von_mises_at[2] / (0.48086 * a) - 1.0) < 0.02);
  CHECK(fabs(result.max_von_mises_at[0]) < 0.01 * a && fabs(result.max_von_mises_at[1]) < 0.01 * a);
  CHECK(isnan(result.upper_max_von_mises) && isnan(result.upper_max_von_mises_at[2]));
  CHECK(result.stress_missing == 0);

  CHECK_STATUS(BRN_OK, brn_run_get_depths(run, NULL, 0, &count));
  CHECK(count == layers);
  CHECK_STATUS(BRN_OK, brn_run_get_depths(run, depths, layers, &count));
  CHECK(depths[0] == 0.5 * thickness && depths[layers - 1] == (layers - 0.5) * thickness);

  stress = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  von_mises = field_of(run, BRN_FIELD_VON_MISES, cells);
  for (k = 0; k < cells; ++k) {
    const double *s = stress + 6 * k;
    const double square =
        0.5 * ((s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) + (s[2] - s[0]) * (s[2] - s[0])) +
        3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    CHECK(fabs(sqrt(square) - von_mises[k]) < 1e-12 * p0); /* a few roundings of the largest stress */
  }
  free(von_mises);
  free(stress);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void a_layer_is_a_part_of_its_field(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 1);
  const brn_subsurface wanted = equal_layers(stress_and_von_mises, 2);
  static double layer[6 * nodes + 1];
  double *whole;
  brn_run *run;
  size_t count = 0;
  int64_t k;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_layer(run, BRN_FIELD_STRESS, 0, layer, 6 * nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  whole = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  for (k = 0; k < layers; ++k) {
    CHECK_STATUS(BRN_OK, brn_run_get_layer(run, BRN_FIELD_STRESS, k, layer, 6 * nodes, &count));
    CHECK(count == 6 * nodes && memcmp(layer, whole + 6 * nodes * k, 6 * nodes * sizeof *layer) == 0);
  }
  CHECK_STATUS(BRN_OK, brn_run_get_layer(run, BRN_FIELD_VON_MISES, 0, NULL, 0, &count));
  CHECK(count == nodes);
  layer[0] = -7.0;
  CHECK_STATUS(BRN_SHORT_BUFFER, brn_run_get_layer(run, BRN_FIELD_VON_MISES, 0, layer, nodes - 1, &count));
  CHECK_SAYS(brn_run_message(run), "2303|2304");
  CHECK(count == nodes && layer[0] == -7.0);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_layer(run, BRN_FIELD_STRESS, layers, layer, 6 * nodes, &count));
  CHECK_SAYS(brn_run_message(run), "layer = 12|11");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_layer(run, BRN_FIELD_STRESS, -1, layer, 6 * nodes, &count));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_layer(run, BRN_FIELD_PRESSURE, 0, layer, nodes, &count));
  CHECK_SAYS(brn_run_message(run), "pressure|surface");
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_layer(run, BRN_FIELD_TRESCA, 0, layer, nodes, &count));
  CHECK_SAYS(brn_run_message(run), "tresca");
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_field(run, BRN_FIELD_UPPER_STRESS, NULL, 0, &count));
  CHECK_SAYS(brn_run_message(run), "upper_stress");
  free(whole);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void what_is_not_asked_for_is_not_there(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 1);
  brn_subsurface wanted = equal_layers(NULL, 0);
  brn_increment result, alone;
  brn_run *run = start(engine, scene);
  uint64_t bytes;
  int32_t k;
  size_t count = 7;
  CHECK(!has_stress_stage(run));
  bytes = brn_run_memory_bytes(run);
  for (k = 0; brn_run_stage_name(run, k) != NULL; ++k) CHECK(strcmp(brn_run_stage_name(run, k), "stress") != 0);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = last_of(run);
  CHECK(isnan(result.max_von_mises) && isnan(result.max_von_mises_at[0]) && result.stress_missing == 0);
  CHECK_STATUS(BRN_OK, brn_run_get_depths(run, NULL, 0, &count));
  CHECK(count == 0);
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_field(run, BRN_FIELD_STRESS, NULL, 0, &count));
  brn_run_destroy(run);

  /* the largest value alone: no field, which would take 2.5 MiB of 48 x 48 x 12 tensors */
  wanted.max_von_mises = 1;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK(has_stress_stage(run));
  CHECK(brn_run_memory_bytes(run) > bytes);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  alone = last_of(run);
  CHECK(alone.max_von_mises > 0.0 && alone.max_pressure == result.max_pressure);
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_field(run, BRN_FIELD_VON_MISES, NULL, 0, &count));
  bytes = brn_run_memory_bytes(run);
  brn_run_destroy(run);
  wanted.fields = stress_and_von_mises;
  wanted.field_count = 2;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK(brn_run_memory_bytes(run) >= bytes + 7 * sizeof(double) * cells);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* Bodies of one material: under pressure alone both hold the same stress in their own frames; under sliding the upper
 * one gets the opposite shear, which mirrors the place of the largest. */
static void the_upper_body_mirrors_the_lower_one(void) {
  static const int32_t fields[] = {BRN_FIELD_STRESS, BRN_FIELD_UPPER_STRESS, BRN_FIELD_UPPER_HYDROSTATIC};
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  const brn_body body = steel_body();
  brn_subsurface wanted = equal_layers(fields, 3);
  brn_step slide = force_step(1.0, 1);
  double *lower, *upper, *hydrostatic;
  brn_increment pressed, sliding;
  brn_run *run;
  size_t k;
  wanted.upper_max_von_mises = 1;
  slide.traction_ratio[0] = 0.4;
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &slide));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  pressed = last_of(run);
  CHECK(pressed.max_von_mises == pressed.upper_max_von_mises);
  lower = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  upper = field_of(run, BRN_FIELD_UPPER_STRESS, 6 * (size_t)cells);
  hydrostatic = field_of(run, BRN_FIELD_UPPER_HYDROSTATIC, cells);
  CHECK(memcmp(lower, upper, 6 * cells * sizeof *lower) == 0);
  for (k = 0; k < cells; ++k) {
    CHECK(fabs((upper[6 * k] + upper[6 * k + 1] + upper[6 * k + 2]) / 3.0 - hydrostatic[k]) <
          1e-14 * pressed.max_pressure);
  }
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  sliding = last_of(run);
  CHECK(sliding.max_von_mises > 1.05 * pressed.max_von_mises);
  CHECK(sliding.max_von_mises_at[2] < 0.5 * pressed.max_von_mises_at[2]);
  CHECK(fabs(sliding.upper_max_von_mises / sliding.max_von_mises - 1.0) < 1e-9);
  CHECK(fabs(sliding.max_von_mises_at[0]) > 1e-6);
  CHECK(fabs(sliding.upper_max_von_mises_at[0] + sliding.max_von_mises_at[0]) < 1e-9);
  free(hydrostatic);
  free(upper);
  free(lower);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* Each direction turns the stress into its principal one, and directions alone bring no largest value along. */
static void directions_are_those_of_the_principal_stresses(void) {
  static const int32_t all[] = {BRN_FIELD_STRESS, BRN_FIELD_PRINCIPAL_DIRECTIONS, BRN_FIELD_PRINCIPAL_1,
                                BRN_FIELD_PRINCIPAL_2, BRN_FIELD_PRINCIPAL_3};
  static const int32_t alone[] = {BRN_FIELD_PRINCIPAL_DIRECTIONS};
  static double layer[9 * nodes];
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  brn_subsurface wanted = equal_layers(all, 5);
  double *stress, *directions, *principal[3], *lonely;
  brn_increment result;
  brn_run *run;
  size_t count = 0, k, m, a, b;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = last_of(run);
  stress = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  directions = field_of(run, BRN_FIELD_PRINCIPAL_DIRECTIONS, 9 * (size_t)cells);
  for (m = 0; m < 3; ++m) principal[m] = field_of(run, BRN_FIELD_PRINCIPAL_1 + (int32_t)m, cells);
  for (k = 0; k < cells; ++k) {
    const double *s = stress + 6 * k;
    const double tensor[3][3] = {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
    for (m = 0; m < 3; ++m) {
      const double *d = directions + 9 * k + 3 * m;
      for (b = 0; b < 3; ++b) {
        double turned = 0.0, product = 0.0;
        for (a = 0; a < 3; ++a) {
          turned += tensor[b][a] * d[a];
          product += d[a] * directions[9 * k + 3 * b + a];
        }
        CHECK(fabs(turned - principal[m][k] * d[b]) < 1e-13 * result.max_pressure); /* some hundred roundings */
        CHECK(fabs(product - (b == m ? 1.0 : 0.0)) < 1e-13);
      }
    }
  }
  CHECK_STATUS(BRN_OK, brn_run_get_layer(run, BRN_FIELD_PRINCIPAL_DIRECTIONS, 3, layer, 9 * nodes, &count));
  CHECK(count == 9 * nodes && memcmp(layer, directions + 3 * 9 * nodes, sizeof layer) == 0);
  brn_run_destroy(run);

  wanted = equal_layers(alone, 1);
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  CHECK(isnan(last_of(run).max_von_mises));
  lonely = field_of(run, BRN_FIELD_PRINCIPAL_DIRECTIONS, 9 * (size_t)cells);
  CHECK(memcmp(lonely, directions, 9 * cells * sizeof *lonely) == 0);
  free(lonely);
  for (m = 0; m < 3; ++m) free(principal[m]);
  free(directions);
  free(stress);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void threads_do_not_change_a_bit(void) {
  static const int32_t threads[] = {1, 2, 8};
  double *expected = NULL;
  brn_increment first;
  size_t k;
  for (k = 0; k < 3; ++k) {
    brn_engine *engine = plain_engine(threads[k]);
    brn_scene *scene = sphere_scene(n, 1);
    const brn_subsurface wanted = equal_layers(stress_and_von_mises, 2);
    brn_run *run;
    CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
    run = start(engine, scene);
    CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
    if (expected == NULL) {
      expected = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
      first = last_of(run);
    } else {
      double *values = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
      const brn_increment result = last_of(run);
      CHECK(memcmp(expected, values, 6 * cells * sizeof *values) == 0);
      CHECK(result.max_von_mises == first.max_von_mises);
      CHECK(memcmp(result.max_von_mises_at, first.max_von_mises_at, sizeof first.max_von_mises_at) == 0);
      free(values);
    }
    brn_run_destroy(run);
    brn_scene_destroy(scene);
    brn_engine_destroy(engine);
  }
  free(expected);
}

typedef struct {
  int calls, cancel_at;
} counter;

static int32_t count_calls(const brn_progress *progress, void *user) {
  counter *c = user;
  (void)progress;
  return ++c->calls == c->cancel_at;
}

/* What is cancelled while the stress is computed loses no contact, and goes on from a saved state too. */
static void a_cancelled_stress_keeps_the_contact(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 2);
  const brn_subsurface wanted = equal_layers(stress_and_von_mises, 2);
  counter contact = {0, -1}, stop = {0, 0};
  brn_increment whole, marked, resumed;
  double *expected, *values;
  brn_run *run = start(engine, scene), *loaded = NULL;
  unsigned char *data;
  size_t size = 0;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, count_calls, &contact)); /* without stress */
  brn_run_destroy(run);
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  whole = last_of(run);
  expected = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  brn_run_destroy(run);

  run = start(engine, scene);
  stop.cancel_at = contact.calls + layers + 2; /* in the second layer of the second increment's stress */
  CHECK_STATUS(BRN_CANCELLED, brn_run_execute(run, count_calls, &stop));
  CHECK(brn_run_solved_increments(run) == 2);
  marked = last_of(run);
  CHECK(marked.stress_missing == 1 && isnan(marked.max_von_mises) && marked.converged == 1);
  CHECK(marked.approach == whole.approach && marked.max_pressure == whole.max_pressure);
  CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
  data = malloc(size);
  CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));

  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  resumed = last_of(run);
  CHECK(resumed.stress_missing == 0 && resumed.max_von_mises == whole.max_von_mises);
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_advance(run, NULL, NULL));
  brn_run_destroy(run);

  CHECK_STATUS(BRN_OK, brn_run_load(engine, scene, data, size, &loaded));
  CHECK(last_of(loaded).stress_missing == 1);
  values = field_of(loaded, BRN_FIELD_STRESS, 6 * (size_t)cells);
  CHECK(memcmp(expected, values, 6 * cells * sizeof *values) == 0);
  resumed = last_of(loaded);
  CHECK(resumed.stress_missing == 0 && resumed.max_von_mises == whole.max_von_mises);
  brn_run_destroy(loaded);
  free(values);
  free(data);
  free(expected);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void saved_runs_keep_the_largest_and_make_fields_anew(void) {
  brn_engine *engine = plain_engine(2), *other = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 2), *deeper = sphere_scene(n, 2);
  brn_subsurface wanted = equal_layers(stress_and_von_mises, 2);
  brn_increment whole, loaded;
  double *expected, *values;
  unsigned char *data;
  brn_run *run;
  size_t size = 0;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  wanted.layer_thickness *= 2.0;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(deeper, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  whole = last_of(run);
  expected = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
  data = malloc(size);
  CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));
  brn_run_destroy(run);

  CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(other, deeper, data, size, &run));
  CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
  loaded = last_of(run);
  CHECK(memcmp(&whole, &loaded, sizeof whole) == 0);
  values = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  CHECK(memcmp(expected, values, 6 * cells * sizeof *values) == 0);
  loaded = last_of(run);
  CHECK(memcmp(&whole, &loaded, sizeof whole) == 0);
  brn_run_destroy(run);
  free(values);
  free(data);
  free(expected);
  brn_scene_destroy(deeper);
  brn_scene_destroy(scene);
  brn_engine_destroy(other);
  brn_engine_destroy(engine);
}

static void bodies_apart_hold_no_stress(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 1);
  brn_subsurface wanted = equal_layers(NULL, 0);
  brn_step apart;
  brn_increment result;
  brn_run *run;
  brn_step_init(&apart);
  apart.drive = BRN_DRIVE_APPROACH;
  apart.target = -1e-6;
  wanted.max_von_mises = 1;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &apart));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = last_of(run);
  CHECK(result.max_von_mises == 0.0 && isnan(result.max_von_mises_at[2]));
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void refused(brn_scene *scene, const brn_subsurface *wanted, const char *words) {
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_subsurface(scene, wanted));
  CHECK_SAYS(brn_scene_message(scene), words);
}

static void bad_requests_of_scenes_are_refused(void) {
  static const int32_t surface[] = {BRN_FIELD_STRESS, BRN_FIELD_PRESSURE}, unknown[] = {28}, upper[] = {121};
  static const double negative[] = {0.0, -1e-6}, falling[] = {2e-6, 1e-6}, nan_depth[] = {NAN};
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(8, 1);
  brn_subsurface wanted = equal_layers(surface, 2);
  brn_step step = force_step(1.0, 1);
  brn_run *run = NULL;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_subsurface(NULL, &wanted));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_subsurface(scene, NULL));
  refused(scene, &wanted, "fields[1] = 1");
  wanted = equal_layers(unknown, 1);
  refused(scene, &wanted, "fields[0] = 28|27|32|100");
  wanted = equal_layers(NULL, 1);
  refused(scene, &wanted, "fields is NULL");
  wanted = equal_layers(NULL, 0);
  refused(scene, &wanted, "nothing is asked for|max_von_mises");
  wanted.max_von_mises = 2;
  refused(scene, &wanted, "max_von_mises = 2");
  wanted.max_von_mises = 1;
  wanted.layers = -3;
  refused(scene, &wanted, "layers = -3");
  wanted.layers = 3;
  wanted.layer_thickness = 0.0;
  refused(scene, &wanted, "layer_thickness = 0");
  wanted.layer_thickness = 1e-6;
  wanted.depths = falling;
  wanted.depth_count = 2;
  refused(scene, &wanted, "layers = 3|depth_count = 2");
  wanted.layers = 0;
  refused(scene, &wanted, "depths[1] = 1e-06");
  wanted.depths = negative;
  refused(scene, &wanted, "depths[1] = -1e-06|positive");
  wanted.depths = nan_depth;
  wanted.depth_count = 1;
  refused(scene, &wanted, "depths[0] = nan");
  wanted.depths = NULL;
  refused(scene, &wanted, "depths is NULL");
  wanted.depth_count = 0;
  refused(scene, &wanted, "there are no depths");

  step.traction_ratio[1] = INFINITY;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "traction_ratio = inf");
  step.struct_size = offsetof(brn_step, traction_ratio); /* an older client has none */
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));

  wanted = equal_layers(upper, 1);
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_create(engine, scene, &run));
  CHECK_SAYS(brn_engine_message(engine), "upper|rigid");
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* ---- on its own */

static brn_stress_request request_for(const double *pressure, const double *depths, size_t count) {
  brn_stress_request request;
  brn_stress_request_init(&request);
  request.nx = request.ny = n;
  request.dx = request.dy = 48e-6 / n;
  request.poissons_ratio = 0.3;
  request.depths = depths;
  request.depth_count = count;
  request.pressure = pressure;
  return request;
}

/* The pressure of a run gives the stress of that run, to the bit, with and without shear. */
static void alone_it_gives_what_a_run_gives(void) {
  static const int32_t fields[] = {BRN_FIELD_STRESS, BRN_FIELD_TRESCA, BRN_FIELD_PRINCIPAL_1, BRN_FIELD_PRINCIPAL_3};
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  const brn_subsurface wanted = equal_layers(fields, 4);
  double depths[layers], *pressure, *stress, *tresca, *first, *third, *all[9];
  brn_stress_request request;
  brn_stress_fields arrays;
  brn_stress_maxima maxima;
  brn_increment result;
  brn_run *run;
  size_t count = 0, k, c;
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  CHECK_STATUS(BRN_OK, brn_run_get_depths(run, depths, layers, &count));
  result = last_of(run);
  pressure = field_of(run, BRN_FIELD_PRESSURE, nodes);
  stress = field_of(run, BRN_FIELD_STRESS, 6 * (size_t)cells);
  tresca = field_of(run, BRN_FIELD_TRESCA, cells);
  first = field_of(run, BRN_FIELD_PRINCIPAL_1, cells);
  third = field_of(run, BRN_FIELD_PRINCIPAL_3, cells);

  request = request_for(pressure, depths, layers);
  brn_stress_fields_init(&arrays);
  brn_stress_maxima_init(&maxima);
  maxima.wants_tresca = 1;
  arrays.capacity = cells;
  for (k = 0; k < 9; ++k) all[k] = malloc(cells * sizeof(double));
  for (k = 0; k < 6; ++k) arrays.component[k] = all[k];
  arrays.tresca = all[6];
  arrays.principal[0] = all[7];
  arrays.principal[2] = all[8];
  CHECK_STATUS(BRN_OK, brn_stress_compute(engine, &request, &arrays, &maxima));
  for (k = 0; k < cells; ++k) {
    for (c = 0; c < 6; ++c) CHECK(stress[6 * k + c] == all[c][k]);
    CHECK(tresca[k] == all[6][k] && first[k] == all[7][k] && third[k] == all[8][k]);
    /* the same quantity by two ways, each a few roundings of the largest stress */
    CHECK(fabs(first[k] - third[k] - tresca[k]) < 1e-12 * result.max_pressure);
  }
  CHECK(maxima.von_mises == result.max_von_mises);
  CHECK(memcmp(maxima.von_mises_at, result.max_von_mises_at, sizeof maxima.von_mises_at) == 0);
  CHECK(maxima.tresca >= maxima.von_mises && isnan(maxima.principal_1) && isnan(maxima.principal_1_at[1]));

  /* the largest alone */
  maxima.von_mises = 0.0;
  CHECK_STATUS(BRN_OK, brn_stress_compute(engine, &request, NULL, &maxima));
  CHECK(maxima.von_mises == result.max_von_mises);

  /* shear alone, upper body: the opposite of the lower body's */
  request.pressure = NULL;
  request.shear_y = pressure;
  brn_stress_fields_init(&arrays);
  arrays.capacity = cells;
  arrays.component[BRN_YZ] = all[0];
  CHECK_STATUS(BRN_OK, brn_stress_compute(engine, &request, &arrays, NULL));
  request.body = BRN_UPPER;
  arrays.component[BRN_YZ] = all[1];
  CHECK_STATUS(BRN_OK, brn_stress_compute(engine, &request, &arrays, NULL));
  for (k = 0; k < cells; ++k) CHECK(all[0][k] == -all[1][k]);

  for (k = 0; k < 9; ++k) free(all[k]);
  free(third);
  free(first);
  free(tresca);
  free(stress);
  free(pressure);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void bad_requests_alone_are_refused(void) {
  brn_engine_options options;
  brn_engine *engine = plain_engine(1), *small = NULL;
  static double pressure[nodes], field[nodes];
  const double depth = 1e-6, above = -1e-6;
  brn_stress_request request = request_for(pressure, &depth, 1);
  brn_stress_fields arrays;
  brn_stress_maxima maxima;
  brn_stress_fields_init(&arrays);
  brn_stress_maxima_init(&maxima);
  arrays.von_mises = field;
  arrays.capacity = nodes;
  CHECK_STATUS(BRN_OK, brn_stress_compute(engine, &request, &arrays, &maxima));
  CHECK(maxima.von_mises == 0.0 && isnan(maxima.von_mises_at[0]));

#define REFUSED(status, words)                                                  \
  CHECK_STATUS(status, brn_stress_compute(engine, &request, &arrays, &maxima)); \
  CHECK_SAYS(brn_engine_message(engine), words)

  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_stress_compute(NULL, &request, &arrays, NULL));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_stress_compute(engine, NULL, &arrays, NULL));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_stress_compute(engine, &request, NULL, NULL));
  CHECK_SAYS(brn_engine_message(engine), "nothing is asked for");
  arrays.capacity = nodes - 1;
  field[0] = -7.0;
  REFUSED(BRN_SHORT_BUFFER, "2303|2304");
  CHECK(field[0] == -7.0);
  arrays.capacity = nodes;
  arrays.direction[3] = field;
  REFUSED(BRN_INVALID_ARGUMENT, "direction|1 of 9");
  arrays.direction[3] = NULL;
  request.depths = &above;
  REFUSED(BRN_INVALID_ARGUMENT, "depths[0] = -1e-06");
  request.depths = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "depths is NULL");
  request.depth_count = 0;
  REFUSED(BRN_INVALID_ARGUMENT, "depths");
  request = request_for(NULL, &depth, 1);
  REFUSED(BRN_INVALID_ARGUMENT, "sources|pressure");
  request = request_for(pressure, &depth, 1);
  request.nx = 0;
  REFUSED(BRN_INVALID_ARGUMENT, "0 x 48");
  request = request_for(pressure, &depth, 1);
  request.dy = -1.0;
  REFUSED(BRN_INVALID_ARGUMENT, "dy = -1");
  request = request_for(pressure, &depth, 1);
  request.poissons_ratio = 0.5;
  REFUSED(BRN_INVALID_ARGUMENT, "poissons_ratio = 0.5");
  request = request_for(pressure, &depth, 1);
  request.body = 2;
  REFUSED(BRN_INVALID_ARGUMENT, "body = 2");
  request = request_for(pressure, &depth, 1);
  request.boundary = -1;
  REFUSED(BRN_INVALID_ARGUMENT, "boundary = -1");
  request = request_for(pressure, &depth, 1);
  request.struct_size = 0;
  REFUSED(BRN_INVALID_ARGUMENT, "struct_size = 0");
  request = request_for(pressure, &depth, 1);
  maxima.wants_tresca = -1;
  REFUSED(BRN_INVALID_ARGUMENT, "wants_tresca = -1");
  maxima.wants_tresca = 0;
  pressure[17] = NAN;
  REFUSED(BRN_INVALID_ARGUMENT, "pressure[17] = nan");
  pressure[17] = 0.0;

  brn_engine_options_init(&options);
  options.memory_limit = 1000;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &small));
  CHECK_STATUS(BRN_TOO_LARGE, brn_stress_compute(small, &request, &arrays, NULL));
  CHECK_SAYS(brn_engine_message(small), "48 x 48|1000");
  brn_engine_destroy(small);
  brn_engine_destroy(engine);
}

int main(void) {
  below_a_sphere_is_what_hertz_says();
  a_layer_is_a_part_of_its_field();
  what_is_not_asked_for_is_not_there();
  the_upper_body_mirrors_the_lower_one();
  directions_are_those_of_the_principal_stresses();
  threads_do_not_change_a_bit();
  a_cancelled_stress_keeps_the_contact();
  saved_runs_keep_the_largest_and_make_fields_anew();
  bodies_apart_hold_no_stress();
  bad_requests_of_scenes_are_refused();
  alone_it_gives_what_a_run_gives();
  bad_requests_alone_are_refused();
  return check_report();
}
