/* Two bodies that harden, each after a law of its own: their fields, what is told of each, and a history that is
 * saved amid it and goes on to the same bits on another number of threads. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { n = 20, nodes = n * n, layers = 13, cuboids = nodes * layers, increments = 4 };

static const int32_t fields[] = {BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN,
                                 BRN_FIELD_UPPER_EQUIVALENT_PLASTIC_STRAIN,
                                 BRN_FIELD_RESIDUAL_STRESS,
                                 BRN_FIELD_UPPER_RESIDUAL_STRESS,
                                 BRN_FIELD_STRESS,
                                 BRN_FIELD_UPPER_STRESS};

static brn_scene *pair_scene(void) {
  brn_scene *scene = sphere_scene(n, increments - 1); /* 1 N: contact radius about 17 um */
  const brn_body upper = steel_body();
  const brn_step unload = force_step(0.0, 1);
  brn_hardening hardening = linear_hardening(500e6);
  brn_solver solver;
  brn_subsurface wanted;
  brn_solver_init(&solver);
  solver.tolerance = 1e-6;
  brn_subsurface_init(&wanted);
  wanted.layers = layers;
  wanted.layer_thickness = 2.8e-6;
  wanted.fields = fields;
  wanted.field_count = sizeof fields / sizeof fields[0];
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &upper));
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, &hardening));
  hardening.law = BRN_HARDENING_PERFECT;
  hardening.yield_stress = 450e6;
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_UPPER, &hardening));
  CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, layers, 2.8e-6));
  CHECK_STATUS(BRN_OK, brn_scene_set_subsurface(scene, &wanted));
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &unload));
  return scene;
}

static double *field(brn_run *run, int32_t which, size_t *count) {
  double *values;
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, which, NULL, 0, count));
  values = malloc((*count + 1) * sizeof *values);
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, which, values, *count, count));
  return values;
}

static void each_body_has_its_own_state(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = pair_scene();
  brn_run *run = start(engine, scene);
  brn_increment last;
  double *values[6], *lower, *upper;
  size_t count[6], k;
  int32_t step;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  for (step = 0; step < increments; ++step) {
    const brn_increment one = increment_of(run, step);
    CHECK(one.converged == 1 && one.yield >= 0 && one.yield <= 1e-6);
  }
  last = increment_of(run, increments - 1);
  for (k = 0; k < 6; ++k) values[k] = field(run, fields[k], &count[k]);
  CHECK(count[0] == cuboids && count[1] == cuboids && count[3] == 6 * cuboids && count[5] == 6 * cuboids);
  CHECK(largest(values[0], cuboids) == last.max_equivalent_plastic_strain);
  CHECK(largest(values[1], cuboids) == last.upper_max_equivalent_plastic_strain);
  CHECK(last.upper_max_equivalent_plastic_strain > last.max_equivalent_plastic_strain);
  CHECK(last.max_equivalent_plastic_strain > 0 && last.plastic_nodes > 0);
  CHECK(last.upper_plastic_nodes > last.plastic_nodes);
  /* Without pressure the total stress of each is its residual one. */
  CHECK(last.normal_force == 0 && last.contact_nodes == 0);
  CHECK(memcmp(values[2], values[4], 6 * cuboids * sizeof(double)) == 0);
  CHECK(memcmp(values[3], values[5], 6 * cuboids * sizeof(double)) == 0);
  CHECK(memcmp(values[2], values[3], 6 * cuboids * sizeof(double)) != 0);
  /* The imprint of the softer body is the deeper one. */
  lower = field(run, BRN_FIELD_RESIDUAL_DISPLACEMENT, &count[0]);
  upper = field(run, BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT, &count[1]);
  CHECK(count[0] == nodes && count[1] == nodes && largest(upper, nodes) > largest(lower, nodes));
  free(upper);
  free(lower);
  for (k = 0; k < 6; ++k) free(values[k]);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void both_survive_a_saved_run(void) {
  brn_engine *engine = plain_engine(1), *other = plain_engine(2);
  brn_scene *scene = pair_scene();
  brn_run *whole = start(engine, scene), *run = start(engine, scene);
  unsigned char *data;
  size_t size = 0, count[2], k;
  CHECK_STATUS(BRN_OK, brn_run_execute(whole, NULL, NULL));
  for (k = 0; k < 2; ++k) CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
  data = malloc(size);
  CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));
  brn_run_destroy(run);
  CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  for (k = 0; k < sizeof fields / sizeof fields[0]; ++k) {
    double *expected = field(whole, fields[k], &count[0]), *found = field(run, fields[k], &count[1]);
    CHECK(count[0] == count[1] && memcmp(expected, found, count[0] * sizeof *found) == 0);
    free(found);
    free(expected);
  }
  free(data);
  brn_run_destroy(run);
  brn_run_destroy(whole);
  brn_scene_destroy(scene);
  brn_engine_destroy(other);
  brn_engine_destroy(engine);
}

int main(void) {
  each_body_has_its_own_state();
  both_survive_a_saved_run();
  return check_report();
}
