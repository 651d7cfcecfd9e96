/* A run is cancelled in its fourth increment, saved to memory, loaded again and finished. Its pressure is, bit for
 * bit, that of a run that was left alone. */
#include <brinell.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { n = 64, increments = 6 };

static double straight[n * n], resumed[n * n];

static int failed(brn_status status, const char *message) {
  if (status != BRN_OK) fprintf(stderr, "%s: %s\n", brn_status_name(status), message);
  return status != BRN_OK;
}

static int32_t stop_in_the_fourth(const brn_progress *progress, void *user) {
  (void)user;
  return progress->solved == 3;
}

static int describe(brn_scene *scene) {
  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = grid.ny = n;
  grid.dx = grid.dy = 4e-6;
  brn_body glass;
  brn_body_init(&glass);
  glass.rigid = 0;
  glass.youngs_modulus = 70e9;
  glass.poissons_ratio = 0.22;
  brn_shape ball;
  brn_shape_init(&ball);
  ball.kind = BRN_SHAPE_SPHERE;
  ball.radius = 5e-3;
  brn_step press;
  brn_step_init(&press);
  press.drive = BRN_DRIVE_FORCE;
  press.target = 5.0;
  press.increments = increments;
  return !failed(brn_scene_set_grid(scene, &grid), brn_scene_message(scene)) &&
         !failed(brn_scene_set_body(scene, BRN_LOWER, &glass), brn_scene_message(scene)) &&
         !failed(brn_scene_add_shape(scene, &ball), brn_scene_message(scene)) &&
         !failed(brn_scene_add_step(scene, &press), brn_scene_message(scene));
}

int main(void) {
  brn_engine *engine = NULL;
  brn_scene *scene = NULL;
  brn_run *run = NULL;
  void *saved = NULL;
  size_t size = 0, count = 0;
  int good = 0;

  if (failed(brn_engine_create(NULL, &engine), brn_last_message()) ||
      failed(brn_scene_create(&scene), brn_last_message()) || !describe(scene) ||
      failed(brn_run_create(engine, scene, &run), brn_last_message()) ||
      failed(brn_run_execute(run, NULL, NULL), brn_run_message(run)) ||
      failed(brn_run_get_field(run, BRN_FIELD_PRESSURE, straight, n * n, &count), brn_run_message(run))) {
    goto end;
  }
  brn_run_destroy(run);
  run = NULL;

  if (failed(brn_run_create(engine, scene, &run), brn_last_message())) goto end;
  const brn_status status = brn_run_execute(run, stop_in_the_fourth, NULL);
  printf("%s after %d of %d increments\n", brn_status_name(status), (int)brn_run_solved_increments(run),
         (int)brn_run_total_increments(run));
  if (status != BRN_CANCELLED || failed(brn_run_save(run, NULL, 0, &size), brn_run_message(run))) goto end;
  saved = malloc(size);
  if (saved == NULL || failed(brn_run_save(run, saved, size, &size), brn_run_message(run))) goto end;
  brn_run_destroy(run);
  run = NULL;

  if (failed(brn_run_load(engine, scene, saved, size, &run), brn_last_message()) ||
      failed(brn_run_execute(run, NULL, NULL), brn_run_message(run)) ||
      failed(brn_run_get_field(run, BRN_FIELD_PRESSURE, resumed, n * n, &count), brn_run_message(run))) {
    goto end;
  }
  good = count == n * n && memcmp(straight, resumed, sizeof straight) == 0;
  printf("resumed from %zu bytes: %s\n", size, good ? "the same bits" : "the results differ");

end:
  free(saved);
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
  return good ? 0 : 1;
}
