/* Values out of range in every description: each is refused, with a message that names the member and its value, and
 * leaves the scene as it was. */
#include <math.h>

#include "check.h"

#define REFUSED(scene, call, words)              \
  do {                                           \
    CHECK_STATUS(BRN_INVALID_ARGUMENT, call);    \
    CHECK_SAYS(brn_scene_message(scene), words); \
  } while (0)

static brn_scene *empty_scene(void) {
  brn_scene *scene = NULL;
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  return scene;
}

static void grids(void) {
  brn_scene *scene = empty_scene();
  brn_grid grid = square_grid(8, 1e-6);
  grid.nx = 0;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "nx|0");
  grid.nx = 8;
  grid.ny = -3;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "ny|-3");
  grid.ny = 8;
  grid.dx = 0.0;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "dx|0");
  grid.dx = -2.5;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "dx|-2.5");
  grid.dx = 1e-6;
  grid.dy = NAN;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "dy|nan");
  grid.dy = INFINITY;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "dy|inf");
  grid.dy = 1e-6;
  grid.boundary = 2;
  REFUSED(scene, brn_scene_set_grid(scene, &grid), "boundary|2");
  grid.boundary = BRN_BOUNDARY_PERIODIC;
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  brn_scene_destroy(scene);
}

static void bodies(void) {
  static const double bad_ratios[] = {0.5, 0.7, -1.0, -1.5, NAN, INFINITY};
  static const double bad_moduli[] = {0.0, -210e9, NAN, INFINITY};
  brn_scene *scene = empty_scene();
  brn_body body = steel_body();
  size_t k;
  for (k = 0; k < sizeof bad_ratios / sizeof *bad_ratios; ++k) {
    body.poissons_ratio = bad_ratios[k];
    REFUSED(scene, brn_scene_set_body(scene, BRN_LOWER, &body), "poissons_ratio|0.5");
  }
  body.poissons_ratio = 0.3;
  for (k = 0; k < sizeof bad_moduli / sizeof *bad_moduli; ++k) {
    body.youngs_modulus = bad_moduli[k];
    REFUSED(scene, brn_scene_set_body(scene, BRN_UPPER, &body), "youngs_modulus");
  }
  body.rigid = 1; /* the constants of a rigid body are ignored */
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &body));
  body.rigid = 2;
  REFUSED(scene, brn_scene_set_body(scene, BRN_UPPER, &body), "rigid|2");
  body = steel_body();
  REFUSED(scene, brn_scene_set_body(scene, 2, &body), "which|2");
  REFUSED(scene, brn_scene_set_body(scene, -1, &body), "which|-1");
  brn_scene_destroy(scene);
}

static void shapes(void) {
  brn_scene *scene = empty_scene();
  const brn_grid grid = square_grid(8, 1e-6);
  brn_shape shape = sphere_shape(1e-3);
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));

  shape.kind = 7;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "kind|7");
  shape.kind = -1;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "kind|-1");
  shape = sphere_shape(0.0);
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius|0");
  shape = sphere_shape(-1e-3);
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius|-0.001");
  shape = sphere_shape(NAN);
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius|nan");
  shape = sphere_shape(1e-3);
  shape.profile = 2;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "profile|2");

  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_ELLIPSOID;
  shape.radius_x = 1e-3;
  shape.radius_y = 0.0;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius_y|0");
  shape.radius_x = -1.0;
  shape.radius_y = 1e-3;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius_x|-1");

  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_CONE;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "half_angle|0");
  shape.half_angle = 1.6; /* beyond a right angle */
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "half_angle|1.6");
  shape.half_angle = 1.2;
  shape.tip_radius = -1e-6;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "tip_radius|-1e-06");

  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_FLAT_PUNCH;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius|0");
  shape.radius = 1e-3;
  shape.edge_radius = -1e-4;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "edge_radius|-1e-04");

  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_ROLLER;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "radius|0");
  shape.radius = 1e-3;
  shape.straight_length = -1.0;
  shape.crown_radius = 1.0;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "straight_length|-1");
  shape.straight_length = 1e-6;
  shape.crown_radius = -1.0;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "crown_radius|-1");

  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_SINUSOID;
  shape.amplitude = INFINITY;
  shape.wavelength_x = 8e-6;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "amplitude|inf");
  shape.amplitude = 1e-9;
  shape.wavelength_x = -8e-6;
  REFUSED(scene, brn_scene_add_shape(scene, &shape), "wavelength_x|-8e-06");
  brn_scene_destroy(scene);
}

static brn_roughness good_roughness(void) {
  brn_roughness roughness;
  brn_roughness_init(&roughness);
  roughness.hurst = 0.8;
  roughness.rms_slope = 0.1;
  return roughness;
}

static void roughness(void) {
  brn_scene *scene = empty_scene();
  const brn_grid grid = square_grid(16, 1e-6);
  brn_roughness rough = good_roughness();
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  rough.hurst = 0.0;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "hurst|0");
  rough.hurst = 1.5;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "hurst|1.5");
  rough = good_roughness();
  rough.rms_height = 1e-9;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "rms_slope|rms_height");
  rough.rms_slope = rough.rms_height = 0.0;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "rms_slope|rms_height");
  rough = good_roughness();
  rough.rms_slope = -0.1;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "rms_slope|-0.1");
  rough = good_roughness();
  rough.short_cutoff = NAN;
  REFUSED(scene, brn_scene_add_roughness(scene, &rough), "short_cutoff|nan");
  rough = good_roughness();
  CHECK_STATUS(BRN_OK, brn_scene_add_roughness(scene, &rough));
  brn_scene_destroy(scene);
}

static void heights(void) {
  brn_scene *scene = empty_scene();
  const brn_grid grid = square_grid(4, 1e-6);
  double values[16] = {0.0};
  brn_heights map;
  brn_statistics statistics;
  brn_heights_init(&map);
  map.values = values;
  map.nx = map.ny = 4;
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));

  map.nx = 5;
  REFUSED(scene, brn_scene_add_heights(scene, &map), "5|4");
  map.nx = 4;
  values[6] = NAN; /* node (2, 1) */
  REFUSED(scene, brn_scene_add_heights(scene, &map), "nan|2|1");
  values[6] = -INFINITY;
  REFUSED(scene, brn_scene_add_heights(scene, &map), "inf|2|1");
  values[6] = 0.0;
  map.detrend = 3;
  REFUSED(scene, brn_scene_add_heights(scene, &map), "detrend|3");
  map.detrend = BRN_DETREND_NONE;
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));

  brn_statistics_init(&statistics);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_height_statistics(&map, 0.0, 1e-6, &statistics));
  CHECK_SAYS(brn_last_message(), "dx|0");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_height_statistics(&map, 1e-6, -1e-6, &statistics));
  CHECK_SAYS(brn_last_message(), "dy|-1e-06");
  map.nx = 0;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_height_statistics(&map, 1e-6, 1e-6, &statistics));
  CHECK_SAYS(brn_last_message(), "nx|0");
  brn_scene_destroy(scene);
}

/* Heights lie on the grid: it comes first and stays. */
static void grid_and_heights_out_of_order(void) {
  brn_scene *scene = empty_scene();
  const brn_grid grid = square_grid(4, 1e-6), other = square_grid(5, 1e-6);
  const double values[16] = {0.0};
  brn_heights map;
  brn_heights_init(&map);
  map.values = values;
  map.nx = map.ny = 4;
  CHECK_STATUS(BRN_WRONG_STATE, brn_scene_add_heights(scene, &map));
  CHECK_SAYS(brn_scene_message(scene), "grid");
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_add_heights(scene, &map));
  CHECK_STATUS(BRN_WRONG_STATE, brn_scene_set_grid(scene, &other));
  CHECK_SAYS(brn_scene_message(scene), "grid");
  brn_scene_destroy(scene);
}

/* A transposed map, read through its strides, is the map. */
static void strides_are_followed(void) {
  double map[2 * 3], transposed[3 * 2];
  brn_heights plain, strided;
  brn_statistics one, two;
  int i, j;
  for (j = 0; j < 2; ++j) {
    for (i = 0; i < 3; ++i) map[j * 3 + i] = transposed[i * 2 + j] = i * i - 0.3 * j * i;
  }
  brn_heights_init(&plain);
  plain.values = map;
  plain.nx = 3;
  plain.ny = 2;
  strided = plain;
  strided.values = transposed;
  strided.stride_x = 2;
  strided.stride_y = 1;
  brn_statistics_init(&one);
  brn_statistics_init(&two);
  CHECK_STATUS(BRN_OK, brn_height_statistics(&plain, 1.0, 2.0, &one));
  CHECK_STATUS(BRN_OK, brn_height_statistics(&strided, 1.0, 2.0, &two));
  CHECK(memcmp(&one, &two, sizeof one) == 0);
  CHECK(one.sq > 0.0 && one.sz == one.sp + one.sv);
  strided.stride_x = INT64_MAX;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_height_statistics(&strided, 1.0, 2.0, &two));
  CHECK(strstr(brn_last_message(), "stride_x = 9223372036854775807") != NULL);
  strided.stride_x = 0;
  strided.stride_y = INT64_MIN;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_height_statistics(&strided, 1.0, 2.0, &two));
}

static void steps(void) {
  brn_scene *scene = empty_scene();
  brn_step step = force_step(1.0, 1);
  step.drive = 0;
  REFUSED(scene, brn_scene_add_step(scene, &step), "drive|0");
  step.drive = 4;
  REFUSED(scene, brn_scene_add_step(scene, &step), "drive|4");
  step = force_step(1.0, 0);
  REFUSED(scene, brn_scene_add_step(scene, &step), "increments|0");
  step = force_step(1.0, -5);
  REFUSED(scene, brn_scene_add_step(scene, &step), "increments|-5");
  step = force_step(-1.5, 1);
  REFUSED(scene, brn_scene_add_step(scene, &step), "target|-1.5");
  step = force_step(NAN, 1);
  REFUSED(scene, brn_scene_add_step(scene, &step), "target|nan");
  step.drive = BRN_DRIVE_APPROACH;
  step.target = INFINITY;
  REFUSED(scene, brn_scene_add_step(scene, &step), "target|inf");
  step.drive = BRN_DRIVE_MEAN_PRESSURE;
  step.target = -1e6;
  REFUSED(scene, brn_scene_add_step(scene, &step), "target|-1");
  step.drive = BRN_DRIVE_APPROACH; /* away from the surface is allowed */
  step.target = -1e-6;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));
  brn_scene_destroy(scene);
}

static void solvers(void) {
  static const double bad_tolerances[] = {0.0, -1e-8, 1e-15, 0.2, NAN, INFINITY};
  static const double bad_increments[] = {-1e-3, 9e-7, 1.1, NAN};
  brn_scene *scene = empty_scene();
  brn_solver solver;
  size_t k;
  brn_solver_init(&solver);
  for (k = 0; k < sizeof bad_tolerances / sizeof *bad_tolerances; ++k) {
    solver.tolerance = bad_tolerances[k];
    REFUSED(scene, brn_scene_set_solver(scene, &solver), "tolerance|1e-14|0.1");
  }
  brn_solver_init(&solver);
  solver.max_iterations = 0;
  REFUSED(scene, brn_scene_set_solver(scene, &solver), "max_iterations|0");
  for (k = 0; k < sizeof bad_increments / sizeof *bad_increments; ++k) {
    brn_solver_init(&solver);
    solver.increment_tolerance = bad_increments[k];
    REFUSED(scene, brn_scene_set_solver(scene, &solver), "increment_tolerance|0|1e-06");
  }
  brn_solver_init(&solver);
  solver.precision = 2;
  REFUSED(scene, brn_scene_set_solver(scene, &solver), "precision|2");
  brn_solver_init(&solver);
  CHECK_STATUS(BRN_OK, brn_scene_set_solver(scene, &solver));
  brn_scene_destroy(scene);
}

static void expect_no_run(brn_scene *scene, brn_status expected, const char *words) {
  brn_engine *engine = plain_engine(1);
  brn_run *run = NULL;
  CHECK_STATUS(expected, brn_run_create(engine, scene, &run));
  CHECK(run == NULL);
  CHECK_SAYS(brn_last_message(), words);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void incomplete_scenes_do_not_run(void) {
  const brn_grid grid = square_grid(8, 1e-6);
  const brn_body steel = steel_body();
  const brn_shape sphere = sphere_shape(1e-3);
  const brn_step press = force_step(1.0, 1);
  brn_step squeeze;
  brn_body rigid;
  brn_scene *scene;

  expect_no_run(empty_scene(), BRN_INVALID_SCENE, "grid");

  scene = empty_scene();
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &sphere));
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &press));
  expect_no_run(scene, BRN_INVALID_SCENE, "rigid");

  scene = empty_scene();
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &steel));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &sphere));
  expect_no_run(scene, BRN_INVALID_SCENE, "step");

  scene = sphere_scene(8, 1);
  brn_body_init(&rigid);
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &rigid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_UPPER, &rigid));
  expect_no_run(scene, BRN_INVALID_SCENE, "rigid");

  scene = sphere_scene(8, 1); /* on a free grid */
  brn_step_init(&squeeze);
  squeeze.drive = BRN_DRIVE_MEAN_PRESSURE;
  squeeze.target = 1e6;
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &squeeze));
  expect_no_run(scene, BRN_INVALID_SCENE, "periodic");
}

static brn_status plan_of(int64_t nx, int64_t ny, uint64_t memory_limit) {
  brn_engine *engine = NULL;
  brn_engine_options options;
  brn_scene *scene = sphere_scene(8, 1);
  brn_grid grid = square_grid(8, 1e-6);
  brn_run *run = NULL;
  brn_status status;
  brn_engine_options_init(&options);
  options.memory_limit = memory_limit;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &engine));
  grid.nx = nx;
  grid.ny = ny;
  status = brn_scene_set_grid(scene, &grid);
  if (status != BRN_OK) {
    CHECK(strlen(brn_scene_message(scene)) > 0);
  } else {
    status = brn_run_create(engine, scene, &run);
    if (status != BRN_OK) CHECK(strlen(brn_last_message()) > 0);
  }
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
  return status;
}

static void grids_beyond_memory_are_refused(void) {
  CHECK(plan_of(512, 512, 0) == BRN_OK);
  CHECK(plan_of(512, 512, 1 << 20) == BRN_TOO_LARGE); /* one field alone takes 2 MB */
  CHECK_SAYS(brn_last_message(), "1048576");
  CHECK(plan_of(INT64_C(1) << 24, INT64_C(1) << 24, 0) == BRN_TOO_LARGE);
  CHECK(plan_of(INT64_C(1) << 33, INT64_C(1) << 31, 0) == BRN_TOO_LARGE); /* 2^64 nodes */
  CHECK(plan_of(INT64_MAX, 1, 0) == BRN_TOO_LARGE);
  CHECK(plan_of(INT64_MAX, INT64_MAX, 0) == BRN_TOO_LARGE);
}

static void a_refused_value_leaves_the_scene_as_it_was(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(8, 1);
  brn_grid grid = square_grid(-1, 1e-6);
  brn_body body = steel_body();
  brn_run *run = NULL;
  body.poissons_ratio = 0.9;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_set_body(scene, BRN_LOWER, &body));
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

int main(void) {
  grids();
  bodies();
  shapes();
  roughness();
  heights();
  grid_and_heights_out_of_order();
  strides_are_followed();
  steps();
  solvers();
  incomplete_scenes_do_not_run();
  grids_beyond_memory_are_refused();
  a_refused_value_leaves_the_scene_as_it_was();
  return check_report();
}
