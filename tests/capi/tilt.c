/* Bodies that tilt: under a force with its place, and by prescribed slopes. The pressed body is a flat punch of 10 um
 * radius with a rounded edge, on n x n nodes of steel 0.8 um apart. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "check.h"

enum { n = 40, nodes = n * n };

static const double spacing = 0.8e-6, force = 0.02;

/* The certificate bounds the moments by 1e-8 times force and half the grid. */
static const double place_tolerance = 1e-8 * 0.5 * n * 0.8e-6;

static brn_scene *punch_scene(int32_t boundary) {
  brn_scene *scene = NULL;
  brn_grid grid = square_grid(n, spacing);
  const brn_body body = steel_body();
  brn_shape shape;
  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_FLAT_PUNCH;
  shape.radius = 10e-6;
  shape.edge_radius = 1e-3;
  grid.boundary = boundary;
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  return scene;
}

static brn_step beside(double x, double y) {
  brn_step step = force_step(force, 1);
  step.rotation = BRN_ROTATION_FREE;
  step.eccentricity[0] = x;
  step.eccentricity[1] = y;
  return step;
}

static brn_step tilted(double sx, double sy) {
  brn_step step = force_step(force, 1);
  step.tilt[0] = sx;
  step.tilt[1] = sy;
  return step;
}

static void rotation_is_fixed_unless_asked_for(void) {
  brn_step step;
  CHECK(BRN_ROTATION_FIXED == 0 && BRN_ROTATION_FREE == 1);
  brn_step_init(&step);
  CHECK(step.struct_size == sizeof step && step.rotation == BRN_ROTATION_FIXED);
  CHECK(step.eccentricity[0] == 0.0 && step.eccentricity[1] == 0.0 && step.tilt[0] == 0.0 && step.tilt[1] == 0.0);
}

static void the_pressure_is_centred_where_the_force_acts(void) {
  static const double places[][2] = {{0.0, 0.0}, {3e-6, 0.0}, {0.0, -3e-6}, {2e-6, 1e-6}};
  static double gap[nodes], undeformed[nodes], displacement[nodes], pressure[nodes];
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = punch_scene(BRN_BOUNDARY_FREE);
  brn_run *run;
  size_t k;
  for (k = 0; k < 4; ++k) add(scene, beside(places[k][0], places[k][1]));
  run = start(engine, scene);
  for (k = 0; k < 4; ++k) {
    brn_increment result;
    double largest = 0.0;
    size_t m;
    CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
    result = increment_of(run, (int32_t)k);
    CHECK(fabs(result.centre_of_force[0] - places[k][0]) <= place_tolerance);
    CHECK(fabs(result.centre_of_force[1] - places[k][1]) <= place_tolerance);
    CHECK(fabs(result.normal_force / force - 1.0) <= 1e-8 && result.balance <= 1e-8);
    /* towards the force the bodies come closer: the plane falls there */
    CHECK(result.tilt[0] * places[k][0] <= 0.0 && result.tilt[1] * places[k][1] <= 0.0);
    CHECK((result.tilt[0] < -1e-6) == (places[k][0] > 0.0));

    read_field(run, BRN_FIELD_GAP, gap, nodes);
    read_field(run, BRN_FIELD_UNDEFORMED_GAP, undeformed, nodes);
    read_field(run, BRN_FIELD_DISPLACEMENT, displacement, nodes);
    read_field(run, BRN_FIELD_PRESSURE, pressure, nodes);
    for (m = 0; m < nodes; ++m) largest = fmax(largest, displacement[m]);
    for (m = 0; m < nodes; ++m) {
      const double x = ((double)(m % n) - 0.5 * (n - 1)) * spacing, y = ((double)(m / n) - 0.5 * (n - 1)) * spacing;
      const double plane = result.tilt[0] * x + result.tilt[1] * y;
      /* a few roundings of gaps up to a tenth of a micrometre */
      CHECK(fabs(undeformed[m] + displacement[m] - result.approach + plane - gap[m]) < 1e-21);
      CHECK(gap[m] > -1e-8 * largest);
    }
  }
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void slopes_give_back_the_state_that_they_came_from(void) {
  static double by_place[nodes], by_slopes[nodes];
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = punch_scene(BRN_BOUNDARY_FREE), *again = punch_scene(BRN_BOUNDARY_FREE);
  brn_increment free_one, fixed_one;
  brn_run *run;
  size_t k;
  add(scene, beside(2e-6, -1e-6));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  free_one = increment_of(run, 0);
  read_field(run, BRN_FIELD_PRESSURE, by_place, nodes);
  brn_run_destroy(run);

  add(again, tilted(free_one.tilt[0], free_one.tilt[1]));
  run = start(engine, again);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  fixed_one = increment_of(run, 0);
  read_field(run, BRN_FIELD_PRESSURE, by_slopes, nodes);
  CHECK(fixed_one.tilt[0] == free_one.tilt[0] && fixed_one.tilt[1] == free_one.tilt[1]);
  CHECK(fabs(fixed_one.approach / free_one.approach - 1.0) < 1e-7);
  CHECK(fabs(fixed_one.centre_of_force[0] - 2e-6) < 10.0 * place_tolerance);
  CHECK(fabs(fixed_one.centre_of_force[1] + 1e-6) < 10.0 * place_tolerance);
  /* A pressure is uncertain by the certificate times about 30 pi, that of the stiffest mode, in both runs. */
  for (k = 0; k < nodes; ++k) CHECK(fabs(by_slopes[k] - by_place[k]) < 2e-6 * free_one.max_pressure);
  brn_run_destroy(run);
  brn_scene_destroy(again);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static brn_increment only_increment(brn_engine *engine, brn_step step) {
  brn_scene *scene = punch_scene(BRN_BOUNDARY_FREE);
  brn_increment result;
  brn_run *run;
  add(scene, step);
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = increment_of(run, 0);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  return result;
}

/* Members that a client's struct_size leaves out are not read, however wild. */
static void an_older_step_does_not_tilt(void) {
  brn_engine *engine = plain_engine(1);
  const brn_increment parallel = only_increment(engine, force_step(force, 1));
  brn_increment result;
  brn_step step = force_step(force, 1);
  step.rotation = 77;
  step.eccentricity[0] = NAN;
  step.tilt[0] = NAN;
  step.struct_size = offsetof(brn_step, rotation);
  result = only_increment(engine, step);
  CHECK(result.tilt[0] == 0.0 && result.tilt[1] == 0.0 && result.max_pressure == parallel.max_pressure);

  step.rotation = BRN_ROTATION_FREE; /* known without a place: the centre */
  step.struct_size = offsetof(brn_step, eccentricity);
  result = only_increment(engine, step);
  CHECK(fabs(result.centre_of_force[0]) <= place_tolerance && fabs(result.tilt[0]) < 1e-9);
  brn_engine_destroy(engine);
}

/* The history goes through a turn of the place, slopes, and an approach with a place. */
static brn_scene *history(void) {
  brn_scene *scene = punch_scene(BRN_BOUNDARY_FREE);
  brn_step step = beside(2e-6, 1e-6);
  step.increments = 2;
  add(scene, step);
  add(scene, beside(-1e-6, 2e-6));
  add(scene, tilted(1e-5, -2e-5));
  step = beside(1e-6, 0.0);
  step.drive = BRN_DRIVE_APPROACH;
  step.target = 2e-9;
  add(scene, step);
  return scene;
}

enum { increments = 5 };

static void a_run_resumes_within_its_history(void) {
  static double expected[nodes], pressure[nodes];
  brn_engine *engine = plain_engine(2), *other = plain_engine(1);
  brn_scene *scene = history(), *different = history();
  brn_increment whole, resumed;
  brn_run *run = start(engine, scene);
  int done, k;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  whole = increment_of(run, increments - 1);
  read_field(run, BRN_FIELD_PRESSURE, expected, nodes);
  brn_run_destroy(run);
  add(different, beside(0.0, 0.0));
  for (done = 1; done < increments; ++done) {
    size_t size = 0;
    unsigned char *data;
    run = start(engine, scene);
    for (k = 0; k < done; ++k) CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
    CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
    data = malloc(size);
    CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));
    brn_run_destroy(run);
    CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(other, different, data, size, &run));
    CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
    free(data);
    CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
    resumed = increment_of(run, increments - 1);
    read_field(run, BRN_FIELD_PRESSURE, pressure, nodes);
    CHECK(memcmp(expected, pressure, sizeof expected) == 0);
    CHECK(memcmp(whole.tilt, resumed.tilt, sizeof whole.tilt) == 0);
    CHECK(whole.approach == resumed.approach && whole.normal_force == resumed.normal_force);
    CHECK(whole.balance == resumed.balance && whole.iterations == resumed.iterations);
    brn_run_destroy(run);
  }
  CHECK(fabs(whole.centre_of_force[0] - 1e-6) <= place_tolerance);
  /* met to the certificate's part of the depth under the force, which is less than twice that at the centre */
  CHECK(fabs(whole.approach - 2e-9) <= 2e-8 * 2e-9);
  brn_scene_destroy(different);
  brn_scene_destroy(scene);
  brn_engine_destroy(other);
  brn_engine_destroy(engine);
}

static void refused(brn_engine *engine, int32_t boundary, brn_step step, const char *words) {
  brn_scene *scene = punch_scene(boundary);
  brn_run *run = NULL;
  add(scene, step);
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_create(engine, scene, &run));
  CHECK_SAYS(brn_engine_message(engine), words);
  brn_scene_destroy(scene);
}

static void bad_steps_are_refused(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = punch_scene(BRN_BOUNDARY_FREE);
  brn_step step = beside(0.0, 0.0);
  step.rotation = 2;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "rotation = 2");
  step.rotation = -1;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "rotation = -1");
  step = beside(0.0, NAN);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "eccentricity = nan|finite");
  step = tilted(INFINITY, 0.0);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "tilt = inf|finite");
  brn_scene_destroy(scene);

  refused(engine, BRN_BOUNDARY_FREE, beside(16e-6, 0.0), "step 0|eccentricity|outside the grid|1.56e-05");
  refused(engine, BRN_BOUNDARY_FREE, beside(0.0, -17e-6), "eccentricity|-1.7e-05|outside the grid");
  refused(engine, BRN_BOUNDARY_PERIODIC, beside(0.0, 0.0), "eccentricity|free boundary");
  refused(engine, BRN_BOUNDARY_PERIODIC, tilted(0.0, 1e-6), "tilt|free boundary");
  brn_engine_destroy(engine);
}

int main(void) {
  rotation_is_fixed_unless_asked_for();
  the_pressure_is_centred_where_the_force_acts();
  slopes_give_back_the_state_that_they_came_from();
  an_older_step_does_not_tilt();
  a_run_resumes_within_its_history();
  bad_steps_are_refused();
  return check_report();
}
