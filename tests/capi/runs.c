/* A run from plan to result: order of calls, buffers, cancellation, a solve that fails, an empty contact. */
#include <fenv.h>
#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { n = 32, nodes = n * n };

static void the_plan_is_known_before_the_run(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 2);
  brn_run *run = start(engine, scene);
  const int32_t count = brn_run_plan_count(run);
  uint64_t bytes = 0;
  brn_plan_item item;
  int32_t k;
  brn_scene_destroy(scene); /* the run has copied what it needs */
  CHECK(count >= 1);
  for (k = 0; k < count; ++k) {
    brn_plan_item_init(&item);
    CHECK_STATUS(BRN_OK, brn_run_get_plan_item(run, k, &item));
    CHECK(item.stage != NULL && strlen(item.stage) > 0);
    CHECK(item.what != NULL && strlen(item.what) > 0);
    bytes += item.bytes;
  }
  CHECK(bytes == brn_run_memory_bytes(run));
  CHECK(bytes >= nodes * sizeof(double));
  brn_plan_item_init(&item);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_plan_item(run, count, &item));
  CHECK_SAYS(brn_run_message(run), "index");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_plan_item(run, -1, &item));
  CHECK_SAYS(brn_run_message(run), "index|-1");
  CHECK(brn_run_total_increments(run) == 2);
  CHECK(brn_run_solved_increments(run) == 0);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  brn_run_destroy(run);
  brn_engine_destroy(engine);
}

static void calls_out_of_order_are_refused(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 2);
  brn_run *run = start(engine, scene);
  static double field[nodes];
  brn_increment result;
  brn_trace_point point;
  size_t count = 0;

  brn_increment_init(&result);
  CHECK(brn_run_get_increment(run, 0, &result) != BRN_OK);
  CHECK_SAYS(brn_run_message(run), "0");
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_get_field(run, BRN_FIELD_PRESSURE, field, nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_UNDEFORMED_GAP, field, nodes, &count));
  CHECK(count == nodes && field[0] > 0.0);

  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK(brn_run_solved_increments(run) == 1);
  CHECK(brn_run_get_increment(run, 1, &result) != BRN_OK);
  CHECK_SAYS(brn_run_message(run), "1");
  CHECK(brn_run_get_increment(run, -1, &result) == BRN_INVALID_ARGUMENT);
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  CHECK_STATUS(BRN_WRONG_STATE, brn_run_advance(run, NULL, NULL));
  CHECK(strlen(brn_run_message(run)) > 0);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL)); /* nothing remains */

  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_field(run, 0, field, nodes, &count));
  CHECK_SAYS(brn_run_message(run), "field|0");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_field(run, 5, field, nodes, &count));
  CHECK_SAYS(brn_run_message(run), "field|5");
  brn_trace_point_init(&point);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_trace_point(run, brn_run_trace_count(run), &point));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_run_get_trace_point(run, -1, &point));
  CHECK_SAYS(brn_run_message(run), "index|-1");

  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void short_buffers_are_refused_untouched(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 1);
  brn_run *run = start(engine, scene);
  static double field[nodes + 1];
  size_t count = 0, k;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  for (k = 0; k <= nodes; ++k) field[k] = -7.0;
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_GAP, NULL, 0, &count));
  CHECK(count == nodes);
  count = 0;
  CHECK_STATUS(BRN_SHORT_BUFFER, brn_run_get_field(run, BRN_FIELD_GAP, field, nodes - 1, &count));
  CHECK_SAYS(brn_run_message(run), "1023|1024");
  CHECK(count == nodes);
  for (k = 0; k <= nodes; ++k) CHECK(field[k] == -7.0);
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_GAP, field, nodes + 1, &count));
  CHECK(count == nodes && field[nodes] == -7.0 && field[0] > 0.0);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* The fields of the last increment are what its summary says, and belong together. */
static void fields_agree_with_the_summary(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  brn_run *run = start(engine, scene);
  static double pressure[nodes], gap[nodes], displacement[nodes], undeformed[nodes];
  const double cell = (48e-6 / n) * (48e-6 / n);
  double force = 0.0, largest = 0.0;
  int64_t touching = 0;
  size_t count = 0, k;
  brn_increment result;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = increment_of(run, 0);
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_PRESSURE, pressure, nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_GAP, gap, nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_DISPLACEMENT, displacement, nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_UNDEFORMED_GAP, undeformed, nodes, &count));
  for (k = 0; k < nodes; ++k) {
    force += pressure[k] * cell;
    largest = fmax(largest, pressure[k]);
    touching += pressure[k] > 0.0;
    /* rounding of a sum of three terms of the displacement's size */
    CHECK(fabs(undeformed[k] + displacement[k] - result.approach - gap[k]) < 1e-14 * fabs(result.approach));
  }
  CHECK(result.converged == 1 && result.step == 0 && result.increment == 0);
  CHECK(fabs(force - 1.0) < 1e-8);
  CHECK(fabs(result.normal_force - force) < 1e-12);
  CHECK(largest == result.max_pressure);
  CHECK(touching == result.contact_nodes);
  CHECK(fabs(result.contact_area / ((double)touching * cell) - 1.0) < 1e-12);
  CHECK(result.penetration <= 1e-8 && result.complementarity <= 1e-8);
  CHECK(result.tension <= 1e-8 && result.balance <= 1e-8);
  CHECK(fabs(result.centre_of_force[0]) < 1e-9 && fabs(result.centre_of_force[1]) < 1e-9);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void the_trace_ends_certified(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, 2);
  brn_run *run = start(engine, scene);
  brn_trace_point point;
  double seconds = 0.0;
  int64_t k, count;
  int32_t stage = 0;
  CHECK(brn_run_trace_count(run) == 0);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  count = brn_run_trace_count(run);
  CHECK(count >= 2);
  for (k = 0; k < count; ++k) {
    brn_trace_point_init(&point);
    CHECK_STATUS(BRN_OK, brn_run_get_trace_point(run, k, &point));
    CHECK(point.seconds >= seconds && point.nx >= 1 && point.ny >= 1);
    seconds = point.seconds;
  }
  CHECK(point.certified == 1 && point.increment == 1 && point.nx == n && point.certificate <= 1e-8);
  while (stage < 100 && brn_run_stage_name(run, stage) != NULL) {
    CHECK(brn_run_stage_seconds(run, stage) >= 0.0);
    ++stage;
  }
  CHECK(stage >= 1 && stage < 100);
  CHECK(brn_run_stage_name(run, -1) == NULL);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static int32_t cancel_from(const brn_progress *progress, void *user) {
  return progress->solved >= *(const int32_t *)user;
}

static void a_cancelled_run_goes_on_to_the_same_bits(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 3);
  brn_run *straight = start(engine, scene), *stopped = start(engine, scene);
  static double expected[nodes], pressure[nodes];
  int32_t from = 1, never = 99;
  size_t count = 0;
  CHECK_STATUS(BRN_OK, brn_run_execute(straight, NULL, NULL));
  CHECK_STATUS(BRN_CANCELLED, brn_run_execute(stopped, cancel_from, &from));
  CHECK(brn_run_solved_increments(stopped) == 1);
  CHECK_STATUS(BRN_OK, brn_run_get_field(stopped, BRN_FIELD_PRESSURE, pressure, nodes, &count));
  CHECK_STATUS(BRN_CANCELLED, brn_run_advance(stopped, cancel_from, &from));
  CHECK_STATUS(BRN_OK, brn_run_execute(stopped, cancel_from, &never));
  CHECK_STATUS(BRN_OK, brn_run_get_field(straight, BRN_FIELD_PRESSURE, expected, nodes, &count));
  CHECK_STATUS(BRN_OK, brn_run_get_field(stopped, BRN_FIELD_PRESSURE, pressure, nodes, &count));
  CHECK(memcmp(expected, pressure, sizeof expected) == 0);
  brn_run_destroy(stopped);
  brn_run_destroy(straight);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void a_solve_that_fails_says_so(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(64, 1);
  brn_solver solver;
  brn_run *run;
  brn_increment result;
  brn_solver_init(&solver);
  solver.max_iterations = 1;
  solver.tolerance = 1e-13;
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  run = start(engine, scene);
  CHECK_STATUS(BRN_NOT_CONVERGED, brn_run_execute(run, NULL, NULL));
  CHECK_SAYS(brn_run_message(run), "1e-13");
  CHECK(brn_run_solved_increments(run) == 1); /* kept and marked */
  result = increment_of(run, 0);
  CHECK(result.converged == 0);
  CHECK(fmax(fmax(result.penetration, result.complementarity), fmax(result.tension, result.balance)) > 1e-13);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void bodies_apart_carry_nothing(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = NULL;
  const brn_grid grid = square_grid(n, 1e-6);
  const brn_body body = steel_body();
  const brn_shape shape = sphere_shape(1e-3);
  brn_step step;
  brn_run *run;
  brn_increment result;
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  brn_step_init(&step);
  step.drive = BRN_DRIVE_APPROACH;
  step.target = -1e-6;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));
  run = start(engine, scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  result = increment_of(run, 0);
  CHECK(result.converged == 1 && result.normal_force == 0.0 && result.contact_nodes == 0);
  CHECK(result.max_pressure == 0.0 && result.contact_area == 0.0);
  CHECK(isnan(result.centre_of_force[0]) && isnan(result.centre_of_force[1]));
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

/* Rounding direction and denormals of the calling thread are its own. */
static void floating_point_state_is_left_alone(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 1);
  brn_run *run = start(engine, scene);
  volatile double denormal = 5e-324;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  CHECK(fegetround() == FE_TONEAREST);
  CHECK(denormal * 2.0 > denormal);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

int main(void) {
  the_plan_is_known_before_the_run();
  calls_out_of_order_are_refused();
  short_buffers_are_refused_untouched();
  fields_agree_with_the_summary();
  the_trace_ends_certified();
  a_cancelled_run_goes_on_to_the_same_bits();
  a_solve_that_fails_says_so();
  bodies_apart_carry_nothing();
  floating_point_state_is_left_alone();
  return check_report();
}
