/* Runs of bodies that harden: loaded and unloaded, their fields, saved and resumed, and scenes that cannot be run. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { n = 24, nodes = n * n, layers = 14, cuboids = nodes * layers, increments = 5 };

static const double tolerance = 1e-7;

static brn_scene *plastic_scene(double yield_stress) {
  static const int32_t fields[] = {BRN_FIELD_STRESS, BRN_FIELD_VON_MISES, BRN_FIELD_PLASTIC_STRAIN,
                                   BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN, BRN_FIELD_RESIDUAL_STRESS};
  brn_scene *scene = sphere_scene(n, increments - 2); /* 1 N: contact radius about 15 um */
  const brn_hardening hardening = linear_hardening(yield_stress);
  const brn_step unload = force_step(0.0, 2);
  brn_solver solver;
  brn_subsurface wanted;
  brn_solver_init(&solver);
  solver.tolerance = tolerance;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = 2.5e-6;
  wanted.fields = fields;
  wanted.field_count = sizeof fields / sizeof fields[0];
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, &hardening));
  CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, layers, 2.5e-6));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &unload));
  return scene;
}

static void a_sphere_leaves_an_imprint(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = plastic_scene(800e6);
  brn_run *run = NULL;
  brn_increment loaded, apart;
  double *stress, *residual, *strain, *equivalent, *displacement, *layer, trace = 0;
  size_t count = 0, k;
  int32_t step;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK(strcmp(brn_run_stage_name(run, 2), "stress") == 0 && strcmp(brn_run_stage_name(run, 3), "plastic") == 0);
  CHECK(brn_run_stage_name(run, 4) == NULL);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  for (step = 0; step < increments; ++step) {
    const brn_increment one = increment_of(run, step);
    CHECK(one.converged == 1 && one.yield <= tolerance && one.yield >= 0 && one.substeps == 1);
    CHECK(one.increment_error >= 0 &&
          (one.increment_error > 0) == (step < increments - 2)); /* unloading is elastic */
  }
  loaded = increment_of(run, increments - 3);
  apart = increment_of(run, increments - 1);
  /* Less than the yield stress of the largest plastic strain; the largest of all is between nodes. */
  CHECK(loaded.max_von_mises < 1.02 * (800e6 + 5e9 * loaded.max_equivalent_plastic_strain));
  CHECK(loaded.plastic_nodes > 100 && loaded.max_equivalent_plastic_strain > 1e-4);
  CHECK(loaded.max_equivalent_plastic_strain_at[2] > 0);
  CHECK(loaded.upper_max_equivalent_plastic_strain != loaded.upper_max_equivalent_plastic_strain);
  CHECK(apart.max_equivalent_plastic_strain >= loaded.max_equivalent_plastic_strain);
  CHECK(apart.normal_force == 0 && apart.contact_nodes == 0 && apart.approach > 0);

  /* Without pressure the total stress is the residual one. */
  stress = field_of(run, BRN_FIELD_STRESS, 6 * cuboids);
  residual = field_of(run, BRN_FIELD_RESIDUAL_STRESS, 6 * cuboids);
  strain = field_of(run, BRN_FIELD_PLASTIC_STRAIN, 6 * cuboids);
  equivalent = field_of(run, BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN, cuboids);
  displacement = field_of(run, BRN_FIELD_RESIDUAL_DISPLACEMENT, nodes);
  CHECK(memcmp(stress, residual, 6 * cuboids * sizeof *stress) == 0);
  CHECK(largest(stress, 6 * cuboids) > 1e7);
  CHECK(largest(equivalent, cuboids) == apart.max_equivalent_plastic_strain);
  CHECK(largest(displacement, nodes) > 0.1 * apart.approach);
  for (k = 0; k < cuboids; ++k) {
    const double sum = strain[6 * k] + strain[6 * k + 1] + strain[6 * k + 2];
    trace = fabs(sum) > trace ? fabs(sum) : trace;
  }
  CHECK(trace <= 1e-14 * largest(strain, 6 * cuboids));
  layer = malloc(6 * nodes * sizeof *layer);
  CHECK_STATUS(BRN_OK, brn_run_get_layer(run, BRN_FIELD_RESIDUAL_STRESS, 3, layer, 6 * nodes, &count));
  CHECK(memcmp(layer, residual + 3 * 6 * nodes, 6 * nodes * sizeof *layer) == 0);
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_field(run, BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT, layer, nodes, &count));
  CHECK_SAYS(brn_run_message(run), "upper_residual_displacement|harden");
  free(layer);
  free(displacement);
  free(equivalent);
  free(strain);
  free(residual);
  free(stress);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void increments_are_divided_where_that_is_asked_for(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = plastic_scene(800e6);
  brn_run *run = start(engine, scene);
  brn_solver solver;
  double as_is, allowed;
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  as_is = increment_of(run, 1).increment_error;
  allowed = 0.2 * as_is;
  brn_run_destroy(run);
  brn_solver_init(&solver);
  solver.tolerance = tolerance;
  solver.increment_tolerance = allowed;
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK(increment_of(run, 1).substeps > 1);
  CHECK(increment_of(run, 1).increment_error > 0 && increment_of(run, 1).increment_error <= allowed);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void below_yield_it_is_the_elastic_run(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *hard = plastic_scene(1e12), *elastic = plastic_scene(1e12);
  brn_run *runs[2] = {NULL, NULL};
  brn_subsurface wanted;
  int k;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = 2.5e-6;
  wanted.max_von_mises = 1;
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(elastic, BRN_LOWER, NULL));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(elastic, &wanted));
  CHECK_STATUS(BRN_OK, brn_run_create(engine, hard, &runs[0]));
  CHECK_STATUS(BRN_OK, brn_run_create(engine, elastic, &runs[1]));
  for (k = 0; k < 2; ++k) CHECK_STATUS(BRN_OK, brn_run_execute(runs[k], NULL, NULL));
  for (k = 0; k < increments; ++k) {
    const brn_increment a = increment_of(runs[0], k), b = increment_of(runs[1], k);
    CHECK(fabs(a.approach - b.approach) <= tolerance * fabs(b.approach));
    CHECK(fabs(a.max_pressure - b.max_pressure) <= 1e-4 * b.max_pressure);
    /* Interpolated alike from the same pressure but for the tolerance. */
    CHECK(fabs(a.max_von_mises - b.max_von_mises) <= 1e-5 * b.max_von_mises);
    CHECK(a.yield == 0 && a.plastic_nodes == 0 && a.max_equivalent_plastic_strain == 0);
    CHECK(b.yield != b.yield && b.plastic_nodes == 0);
    CHECK(b.max_equivalent_plastic_strain != b.max_equivalent_plastic_strain);
  }
  for (k = 0; k < 2; ++k) brn_run_destroy(runs[k]);
  brn_scene_destroy(elastic);
  brn_scene_destroy(hard);
  brn_engine_destroy(engine);
}

static void a_history_resumes_to_the_same_bits(void) {
  brn_engine *engine = plain_engine(2), *other = plain_engine(1);
  brn_scene *scene = plastic_scene(800e6);
  brn_run *whole = NULL, *run = NULL;
  double *expected[2], *found[2];
  int32_t done;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &whole));
  CHECK_STATUS(BRN_OK, brn_run_execute(whole, NULL, NULL));
  expected[0] = field_of(whole, BRN_FIELD_GAP, nodes);
  expected[1] = field_of(whole, BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN, cuboids);
  for (done = 0; done <= increments; ++done) {
    size_t size = 0;
    unsigned char *data;
    int32_t k;
    CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
    for (k = 0; k < done; ++k) CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
    CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
    data = malloc(size);
    CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));
    brn_run_destroy(run);
    if (done > 0) { /* one bit altered, and truncated */
      data[size / 2] ^= 1;
      CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(other, scene, data, size, &run));
      data[size / 2] ^= 1;
      CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(other, scene, data, size / 2, &run));
    }
    CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
    free(data);
    CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
    found[0] = field_of(run, BRN_FIELD_GAP, nodes);
    found[1] = field_of(run, BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN, cuboids);
    CHECK(memcmp(expected[0], found[0], nodes * sizeof(double)) == 0);
    CHECK(memcmp(expected[1], found[1], cuboids * sizeof(double)) == 0);
    for (k = 0; k < increments; ++k) {
      const brn_increment a = increment_of(whole, k), b = increment_of(run, k);
      CHECK(a.approach == b.approach && a.yield == b.yield && a.plastic_nodes == b.plastic_nodes);
      CHECK(a.max_von_mises == b.max_von_mises);
    }
    free(found[0]);
    free(found[1]);
    brn_run_destroy(run);
  }
  free(expected[0]);
  free(expected[1]);
  brn_run_destroy(whole);
  brn_scene_destroy(scene);
  brn_engine_destroy(other);
  brn_engine_destroy(engine);
}

/* The step that slides yields more, under a stress of whose shear the fields tell too. */
static void sliding_bodies_yield(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *still = sphere_scene(n, 1), *scene = sphere_scene(n, 1);
  const brn_hardening hardening = linear_hardening(900e6);
  brn_scene *scenes[2];
  brn_increment last[2];
  brn_step sliding = force_step(1.0, 1);
  brn_subsurface wanted;
  double *mises, *equivalent;
  int k;
  static const int32_t fields[] = {BRN_FIELD_VON_MISES, BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN};
  brn_solver solver;
  brn_solver_init(&solver);
  solver.tolerance = tolerance;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = 2.5e-6;
  wanted.fields = fields;
  wanted.field_count = 2;
  scenes[0] = still;
  scenes[1] = scene;
  for (k = 0; k < 2; ++k) {
    brn_run *run;
    sliding.traction_ratio[1] = k * 0.3;
    CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scenes[k], BRN_LOWER, &hardening));
    CHECK_STATUS(BRN_OK, brn_scene_set_layers(scenes[k], layers, 2.5e-6));
    CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scenes[k], &wanted));
    CHECK_STATUS(BRN_OK, brn_scene_set_solver(scenes[k], &solver));
    CHECK_STATUS(BRN_OK, brn_scene_add_step(scenes[k], &sliding));
    run = start(engine, scenes[k]);
    CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
    last[k] = increment_of(run, 1);
    CHECK(last[k].yield <= tolerance);
    if (k == 1) { /* no cuboid's stress is above its yield stress */
      size_t at;
      mises = field_of(run, BRN_FIELD_VON_MISES, cuboids);
      equivalent = field_of(run, BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN, cuboids);
      for (at = 0; at < cuboids; ++at) CHECK(mises[at] <= (900e6 + 5e9 * equivalent[at]) * (1 + 2 * tolerance));
      free(equivalent);
      free(mises);
    }
    brn_run_destroy(run);
  }
  CHECK(last[1].plastic_nodes > last[0].plastic_nodes);
  CHECK(last[1].max_equivalent_plastic_strain > 1.1 * last[0].max_equivalent_plastic_strain);
  brn_scene_destroy(scene);
  brn_scene_destroy(still);
  brn_engine_destroy(engine);
}

static void identical_bodies_share_a_field(void) {
  static const int32_t fields[] = {BRN_FIELD_VON_MISES, BRN_FIELD_UPPER_VON_MISES,
                                   BRN_FIELD_UPPER_EQUIVALENT_PLASTIC_STRAIN};
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = plastic_scene(500e6);
  brn_subsurface wanted;
  brn_run *run = NULL;
  brn_increment one;
  double *lower, *upper;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = 2.5e-6;
  wanted.fields = fields;
  wanted.field_count = sizeof fields / sizeof fields[0];
  CHECK_STATUS(BRN_OK, brn_scene_set_identical(scene, 1));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  one = increment_of(run, 0);
  CHECK(one.max_equivalent_plastic_strain > 0);
  CHECK(one.upper_max_equivalent_plastic_strain == one.max_equivalent_plastic_strain);
  lower = field_of(run, BRN_FIELD_VON_MISES, cuboids);
  upper = field_of(run, BRN_FIELD_UPPER_VON_MISES, cuboids);
  CHECK(memcmp(lower, upper, cuboids * sizeof *lower) == 0);
  free(upper);
  free(lower);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void refused(brn_scene *scene, const char *words) {
  brn_engine *engine = plain_engine(1);
  brn_run *run = NULL;
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_create(engine, scene, &run));
  CHECK_SAYS(brn_engine_message(engine), words);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void scenes_that_do_not_fit_together_are_refused(void) {
  const brn_hardening hardening = linear_hardening(8e8), none = linear_hardening(0);
  brn_grid grid = square_grid(n, 2e-6);
  brn_step sliding = force_step(1.0, 1);
  brn_scene *scene = sphere_scene(n, 1);
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, &hardening));
  refused(scene, "layers");
  scene = plastic_scene(8e8);
  CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, layers, 3e-6));
  refused(scene, "depths|layers");
  scene = plastic_scene(8e8);
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_UPPER, &hardening));
  refused(scene, "upper|rigid");
  scene = plastic_scene(8e8);
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, NULL));
  refused(scene, "plastic_strain|harden");
  scene = plastic_scene(8e8);
  grid.boundary = BRN_BOUNDARY_PERIODIC;
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  refused(scene, "free");
  scene = plastic_scene(8e8);
  sliding.traction_ratio[0] = 0.1;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &sliding));
  CHECK_STATUS(BRN_OK, brn_scene_set_identical(scene, 1));
  refused(scene, "traction_ratio|0.1|same_as_lower");

  scene = sphere_scene(n, 1);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_hardening(scene, BRN_LOWER, &none));
  CHECK_SAYS(brn_scene_message(scene), "yield_stress");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_hardening(scene, 2, &hardening));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_layers(scene, 0, 1e-6));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_layers(scene, 4, -1));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_identical(scene, 2));
  brn_scene_destroy(scene);
}

static void plastic_strain_in_the_last_layer_is_told(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 2);
  const brn_hardening hardening = linear_hardening(5e8);
  brn_run *run = NULL;
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, &hardening));
  CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, 4, 2e-6));
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_execute(run, NULL, NULL));
  CHECK_SAYS(brn_run_message(run), "last layer");
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

int main(void) {
  a_sphere_leaves_an_imprint();
  increments_are_divided_where_that_is_asked_for();
  below_yield_it_is_the_elastic_run();
  a_history_resumes_to_the_same_bits();
  sliding_bodies_yield();
  identical_bodies_share_a_field();
  scenes_that_do_not_fit_together_are_refused();
  plastic_strain_in_the_last_layer_is_told();
  return check_report();
}
