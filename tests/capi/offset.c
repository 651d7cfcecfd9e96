/* The upper body moves sideways between steps: bodies of surfaces, the place in the results, runs that are saved,
 * cancelled and resumed around a move, older clients, and what cannot move. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "check.h"

enum { n = 24, nodes = n * n, layers = 12 };

static const double spacing = 2e-6;

static brn_step moving(double force, double i, double j) {
  brn_step step = force_step(force, 1);
  step.offset[0] = i * spacing;
  step.offset[1] = j * spacing;
  return step;
}

enum { ELASTIC = -1 };

/* The sphere and 1 N at the centre to begin with; one body may harden, BRN_LOWER or BRN_UPPER. */
static brn_scene *history(int32_t hardens) {
  brn_scene *scene = sphere_scene(n, 2);
  brn_solver solver;
  brn_solver_init(&solver);
  solver.tolerance = 1e-7;
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  if (hardens != ELASTIC) {
    const brn_hardening hardening = linear_hardening(600e6);
    const brn_body body = steel_body();
    CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &body));
    CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, hardens, &hardening));
    CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, layers, 3e-6));
  }
  add(scene, moving(0.1, 2, -1)); /* in contact */
  add(scene, moving(0, 0, 3));
  add(scene, moving(0.6, -2, -2));
  return scene;
}

enum { increments = 5 };

static void results_tell_where_the_upper_body_stands(void) {
  static const int at[increments][2] = {{0, 0}, {0, 0}, {2, -1}, {2, 2}, {0, 0}};
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = history(ELASTIC);
  brn_run *run = start(engine, scene);
  int k;
  brn_step step;
  brn_step_init(&step);
  CHECK(step.offset[0] == 0.0 && step.offset[1] == 0.0);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  for (k = 0; k < increments; ++k) {
    const brn_increment one = increment_of(run, k);
    CHECK(one.offset[0] == at[k][0] * spacing && one.offset[1] == at[k][1] * spacing);
    if (one.contact_nodes == 0) continue;
    /* Off the centre as the sphere: the certificate, 1e-7 of the displacement, allows 1e-5 of the contact's size. */
    CHECK(fabs(one.centre_of_force[0] - one.offset[0]) < 1e-5 * 15e-6);
    CHECK(fabs(one.centre_of_force[1] - one.offset[1]) < 1e-5 * 15e-6);
  }
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static int32_t stop(const brn_progress *progress, void *user) {
  (void)progress;
  (void)user;
  return 1;
}

/* Saved after each increment, also where the next one, which moves, was begun and cancelled. */
static void a_run_resumes_around_its_moves(int32_t hardens) {
  static double expected[2][nodes], found[2][nodes], before[2][nodes];
  brn_engine *engine = plain_engine(2), *other = plain_engine(1);
  brn_scene *scene = history(hardens), *different = history(hardens);
  brn_run *run = start(engine, scene);
  brn_increment whole, resumed;
  int done, k, cancels;
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  whole = increment_of(run, increments - 1);
  read_field(run, BRN_FIELD_PRESSURE, expected[0], nodes);
  read_field(run, BRN_FIELD_GAP, expected[1], nodes);
  brn_run_destroy(run);
  add(different, moving(0, 1, 0));
  for (done = 1; done < increments; ++done) {
    for (cancels = 0; cancels < 2; ++cancels) {
      size_t size = 0;
      unsigned char *data;
      run = start(engine, scene);
      for (k = 0; k < done; ++k) CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
      read_field(run, BRN_FIELD_PRESSURE, before[0], nodes);
      read_field(run, BRN_FIELD_GAP, before[1], nodes);
      if (cancels && done != 3) { /* the one without force asks nobody */
        CHECK_STATUS(BRN_CANCELLED, brn_run_advance(run, stop, NULL));
        read_field(run, BRN_FIELD_PRESSURE, found[0], nodes);
        read_field(run, BRN_FIELD_GAP, found[1], nodes);
        CHECK(memcmp(before, found, sizeof before) == 0);
      }
      CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, &size));
      data = malloc(size);
      CHECK_STATUS(BRN_OK, brn_run_save(run, data, size, &size));
      if (cancels) CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
      if (!cancels) {
        brn_run_destroy(run);
        CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(other, different, data, size, &run));
        CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
        read_field(run, BRN_FIELD_GAP, found[1], nodes);
        CHECK(memcmp(before[1], found[1], sizeof found[1]) == 0);
        CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
      }
      free(data);
      resumed = increment_of(run, increments - 1);
      read_field(run, BRN_FIELD_PRESSURE, found[0], nodes);
      read_field(run, BRN_FIELD_GAP, found[1], nodes);
      CHECK(memcmp(expected, found, sizeof expected) == 0);
      CHECK(whole.approach == resumed.approach && whole.first_touch == resumed.first_touch);
      CHECK(whole.plastic_nodes == resumed.plastic_nodes && whole.iterations == resumed.iterations);
      CHECK(whole.upper_plastic_nodes == resumed.upper_plastic_nodes);
      CHECK((whole.plastic_nodes > 0) == (hardens == BRN_LOWER));
      CHECK((whole.upper_plastic_nodes > 0) == (hardens == BRN_UPPER));
      brn_run_destroy(run);
    }
  }
  brn_scene_destroy(different);
  brn_scene_destroy(scene);
  brn_engine_destroy(other);
  brn_engine_destroy(engine);
}

static void fill(double *heights) {
  int k;
  for (k = 0; k < nodes; ++k) heights[k] = 1e-9 * sin(2.3 * k);
}

/* Steel with a surface, which the caller adds, and one step that moves. */
static brn_scene *moving_scene(int32_t boundary, double i) {
  brn_scene *scene = NULL;
  brn_grid grid = square_grid(n, spacing);
  const brn_body body = steel_body();
  grid.boundary = boundary;
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &body));
  add(scene, moving(0.1, i, 0));
  return scene;
}

static void gap_of(brn_scene *scene, double *gap) {
  brn_engine *engine = plain_engine(1);
  brn_run *run = start(engine, scene);
  read_field(run, BRN_FIELD_UNDEFORMED_GAP, gap, nodes);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void surfaces_belong_to_a_body(void) {
  static double heights[nodes], gap[nodes], other[nodes];
  brn_heights map;
  brn_roughness rough;
  brn_shape shape = sphere_shape(1e-3), wave;
  brn_scene *scene;
  int k, i;
  fill(heights);
  brn_heights_init(&map);
  map.values = heights;
  map.nx = map.ny = n;
  CHECK(map.body == BRN_BODY_DEFAULT && shape.body == BRN_BODY_DEFAULT);

  /* By default heights stay and a sphere goes. */
  scene = moving_scene(BRN_BOUNDARY_PERIODIC, 5);
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));
  gap_of(scene, gap);
  for (k = 0; k < nodes; ++k) CHECK(gap[k] == -heights[k]);
  map.body = BRN_UPPER;
  scene = moving_scene(BRN_BOUNDARY_PERIODIC, 5);
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));
  gap_of(scene, gap);
  for (k = 0; k < n; ++k) {
    for (i = 0; i < n; ++i) CHECK(gap[k * n + (i + 5) % n] == -heights[k * n + i]);
  }
  scene = moving_scene(BRN_BOUNDARY_FREE, 5);
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  gap_of(scene, gap);
  shape.body = BRN_LOWER;
  scene = moving_scene(BRN_BOUNDARY_FREE, 5);
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  gap_of(scene, other);
  for (k = 0; k + 5 < n; ++k) CHECK(fabs(gap[k + 5] - other[k]) <= 1e-15 * other[k]); /* a few roundings */

  brn_shape_init(&wave);
  wave.kind = BRN_SHAPE_SINUSOID;
  wave.amplitude = 1e-9;
  wave.wavelength_x = 8 * spacing;
  brn_roughness_init(&rough);
  rough.hurst = 0.8;
  rough.rms_height = 1e-9;
  CHECK(rough.body == BRN_BODY_DEFAULT);
  for (k = 0; k < 2; ++k) { /* texture stays unless it is the upper body's */
    wave.body = rough.body = k == 0 ? BRN_BODY_DEFAULT : BRN_UPPER;
    scene = moving_scene(BRN_BOUNDARY_PERIODIC, 3);
    CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &wave));
    CHECK_STATUS(BRN_OK, brn_scene_add_roughness(scene, &rough));
    gap_of(scene, gap);
    scene = moving_scene(BRN_BOUNDARY_PERIODIC, 0);
    CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &wave));
    CHECK_STATUS(BRN_OK, brn_scene_add_roughness(scene, &rough));
    gap_of(scene, other);
    CHECK((memcmp(gap, other, sizeof gap) == 0) == (k == 0));
  }
}

/* Members that a client's struct_size leaves out are not read, however wild. */
static void older_clients_move_nothing(void) {
  static double gap[nodes], other[nodes];
  brn_scene *scene = sphere_scene(n, 1);
  brn_shape shape = sphere_shape(1e-3);
  brn_step step = force_step(1.0, 1);
  gap_of(scene, gap);
  scene = moving_scene(BRN_BOUNDARY_FREE, 0);
  shape.body = 99;
  shape.struct_size = offsetof(brn_shape, body);
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  step.offset[0] = NAN;
  step.struct_size = offsetof(brn_step, offset);
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));
  gap_of(scene, other);
  CHECK(memcmp(gap, other, sizeof gap) == 0);
}

static void refused(brn_scene *scene, const char *words) {
  brn_engine *engine = plain_engine(1);
  brn_run *run = NULL;
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_create(engine, scene, &run));
  CHECK_SAYS(brn_engine_message(engine), words);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static brn_scene *hardening_scene(double i) {
  brn_scene *scene = moving_scene(BRN_BOUNDARY_FREE, 0);
  const brn_shape shape = sphere_shape(1e-3);
  const brn_body body = steel_body();
  const brn_hardening hardening = linear_hardening(500e6);
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_UPPER, &hardening));
  CHECK_STATUS(BRN_OK, brn_scene_set_layers(scene, layers, 3e-6));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  add(scene, force_step(0.6, 1));
  add(scene, moving(0.0, i, 0));
  return scene;
}

static void what_cannot_move_is_refused(void) {
  static double heights[nodes];
  brn_engine *engine = plain_engine(1);
  brn_heights map;
  brn_roughness rough;
  brn_shape shape = sphere_shape(1e-3);
  brn_step step = moving(1, 0, 0);
  brn_scene *scene = moving_scene(BRN_BOUNDARY_FREE, 0);
  brn_run *run;
  const brn_body body = steel_body();
  const brn_hardening hardening = linear_hardening(500e6);
  step.offset[1] = INFINITY;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_SAYS(brn_scene_message(scene), "offset = inf|finite");
  shape.body = 2;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_shape(scene, &shape));
  CHECK_SAYS(brn_scene_message(scene), "body = 2|-1|lower|upper");
  step.offset[1] = 1e308;
  add(scene, step);
  add(scene, step);
  shape.body = BRN_BODY_DEFAULT;
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  refused(scene, "step 2|offset|1e+308|finite");

  fill(heights);
  brn_heights_init(&map);
  map.values = heights;
  map.nx = map.ny = n;
  map.body = BRN_UPPER;
  scene = moving_scene(BRN_BOUNDARY_FREE, 4);
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));
  refused(scene, "step 0|offset|height map|lower body|periodic");
  scene = moving_scene(BRN_BOUNDARY_PERIODIC, 4.5);
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));
  refused(scene, "step 0|offset|height map|multiples of the spacing|2e-06");
  brn_roughness_init(&rough);
  rough.hurst = 0.8;
  rough.rms_height = 1e-9;
  rough.body = BRN_UPPER;
  scene = moving_scene(BRN_BOUNDARY_FREE, 4.001);
  CHECK_STATUS(BRN_OK, brn_scene_add_roughness(scene, &rough));
  refused(scene, "rough|multiples of the spacing");
  refused(hardening_scene(1.5), "step 2|offset|hardens|multiples of the spacing");
  scene = hardening_scene(2);
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_set_hardening(scene, BRN_LOWER, &hardening));
  CHECK_STATUS(BRN_OK, brn_scene_set_identical(scene, 1));
  refused(scene, "step 2|offset|same_as_lower|upper body its own");

  /* Plastic strain that would leave the grid: the state stays. */
  scene = hardening_scene(11);
  run = start(engine, scene);
  CHECK_STATUS(BRN_INVALID_SCENE, brn_run_execute(run, NULL, NULL));
  CHECK_SAYS(brn_run_message(run), "offset|11 x 0 nodes|beyond|more nodes");
  CHECK(brn_run_solved_increments(run) == 2);
  CHECK(increment_of(run, 1).upper_plastic_nodes > 0);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static int32_t plan_items(brn_engine *engine, brn_scene *scene) {
  brn_run *run = start(engine, scene);
  const int32_t count = brn_run_plan_count(run);
  brn_run_destroy(run);
  return count;
}

static void the_plan_counts_what_a_move_keeps(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *still = sphere_scene(n, 2), *moved = sphere_scene(n, 2);
  int32_t count;
  add(still, moving(0, 0, 0));
  count = plan_items(engine, still);
  CHECK(plan_items(engine, moved) == count);
  add(moved, moving(0, 1, 0));
  CHECK(plan_items(engine, moved) == count + 1);
  brn_scene_destroy(moved);
  brn_scene_destroy(still);
  brn_engine_destroy(engine);
}

int main(void) {
  results_tell_where_the_upper_body_stands();
  a_run_resumes_around_its_moves(ELASTIC);
  a_run_resumes_around_its_moves(BRN_LOWER);
  a_run_resumes_around_its_moves(BRN_UPPER);
  surfaces_belong_to_a_body();
  older_clients_move_nothing();
  what_cannot_move_is_refused();
  the_plan_counts_what_a_move_keeps();
  return check_report();
}
