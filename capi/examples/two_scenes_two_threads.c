/* One engine, two threads of the caller, a scene on each: a ball on a free grid and a wavy surface on a periodic one.
 * Each gives the bits that it gives alone. */
#include <brinell.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { n = 96 };

typedef struct {
  brn_engine *engine;
  int periodic;
  double pressure[n * n];
  int solved;
} job;

static int failed(brn_status status, const char *message) {
  if (status != BRN_OK) fprintf(stderr, "%s: %s\n", brn_status_name(status), message);
  return status != BRN_OK;
}

static void *solve(void *argument) {
  job *work = argument;
  brn_scene *scene = NULL;
  brn_run *run = NULL;
  size_t count = 0;

  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = grid.ny = n;
  grid.dx = grid.dy = 1e-6;
  grid.boundary = work->periodic ? BRN_BOUNDARY_PERIODIC : BRN_BOUNDARY_FREE;
  brn_body steel;
  brn_body_init(&steel);
  steel.rigid = 0;
  steel.youngs_modulus = 210e9;
  steel.poissons_ratio = 0.3;
  brn_shape shape;
  brn_shape_init(&shape);
  shape.kind = work->periodic ? BRN_SHAPE_SINUSOID : BRN_SHAPE_SPHERE;
  shape.radius = 1e-3;
  shape.amplitude = 20e-9;
  shape.wavelength_x = shape.wavelength_y = n * 1e-6;
  brn_step press;
  brn_step_init(&press);
  press.drive = work->periodic ? BRN_DRIVE_MEAN_PRESSURE : BRN_DRIVE_FORCE;
  press.target = work->periodic ? 20e6 : 1.0;
  press.increments = 3;

  if (failed(brn_scene_create(&scene), brn_last_message()) ||
      failed(brn_scene_set_grid(scene, &grid), brn_scene_message(scene)) ||
      failed(brn_scene_set_body(scene, BRN_LOWER, &steel), brn_scene_message(scene)) ||
      failed(brn_scene_add_shape(scene, &shape), brn_scene_message(scene)) ||
      failed(brn_scene_add_step(scene, &press), brn_scene_message(scene)) ||
      failed(brn_run_create(work->engine, scene, &run), brn_last_message()) ||
      failed(brn_run_execute(run, NULL, NULL), brn_run_message(run)) ||
      failed(brn_run_get_field(run, BRN_FIELD_PRESSURE, work->pressure, n * n, &count), brn_run_message(run))) {
    work->solved = 0;
  } else {
    work->solved = count == n * n;
  }
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  return NULL;
}

static job alone[2], together[2];

int main(void) {
  brn_engine *engine = NULL;
  pthread_t threads[2];
  int good = 1;

  if (failed(brn_engine_create(NULL, &engine), brn_last_message())) return 1;
  for (int k = 0; k < 2; ++k) {
    alone[k].engine = together[k].engine = engine;
    alone[k].periodic = together[k].periodic = k;
    solve(&alone[k]);
  }
  for (int k = 0; k < 2; ++k) {
    if (pthread_create(&threads[k], NULL, solve, &together[k]) != 0) return 1;
  }
  for (int k = 0; k < 2; ++k) {
    pthread_join(threads[k], NULL);
    const int same = alone[k].solved && together[k].solved &&
                     memcmp(alone[k].pressure, together[k].pressure, sizeof alone[k].pressure) == 0;
    printf("%s grid: %s\n", k ? "periodic" : "free", same ? "the same bits as alone" : "wrong");
    good &= same;
  }
  brn_engine_destroy(engine);
  return good ? 0 : 1;
}
