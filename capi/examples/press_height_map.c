/* Heights from memory: a rigid plane is pressed on a surface that lies in an array, as an instrument delivers it.
 * Prints the surface's statistics and the real contact area at three loads, and checks that the pressure field
 * carries the load. */
#include <brinell.h>
#include <math.h>
#include <stdio.h>

enum { nx = 96, ny = 64 };

static double heights[nx * ny], pressure[nx * ny];

static int failed(brn_status status, const char *message) {
  if (status != BRN_OK) fprintf(stderr, "%s: %s\n", brn_status_name(status), message);
  return status != BRN_OK;
}

int main(void) {
  const double spacing = 0.5e-6, forces[3] = {0.01, 0.02, 0.04};
  brn_engine *engine = NULL;
  brn_scene *scene = NULL;
  brn_run *run = NULL;
  int good = 0;

  for (int j = 0; j < ny; ++j) { /* a turned surface with some waviness, lying askew */
    for (int i = 0; i < nx; ++i) {
      heights[j * nx + i] = 40e-9 * cos(0.55 * i + 0.1 * sin(0.3 * j)) + 20e-9 * sin(0.17 * j) + 1e-9 * i;
    }
  }
  brn_heights map;
  brn_heights_init(&map);
  map.values = heights;
  map.nx = nx;
  map.ny = ny;
  map.detrend = BRN_DETREND_PLANE;
  brn_statistics statistics;
  brn_statistics_init(&statistics);
  if (failed(brn_height_statistics(&map, spacing, spacing, &statistics), brn_last_message())) goto end;
  printf("Sa %.1f nm, Sq %.1f nm, Sdq %.3f\n", 1e9 * statistics.sa, 1e9 * statistics.sq, statistics.sdq);

  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = nx;
  grid.ny = ny;
  grid.dx = grid.dy = spacing;
  brn_body bronze;
  brn_body_init(&bronze);
  bronze.rigid = 0;
  bronze.youngs_modulus = 110e9;
  bronze.poissons_ratio = 0.34;
  if (failed(brn_engine_create(NULL, &engine), brn_last_message()) ||
      failed(brn_scene_create(&scene), brn_last_message()) ||
      failed(brn_scene_set_grid(scene, &grid), brn_scene_message(scene)) ||
      failed(brn_scene_set_body(scene, BRN_LOWER, &bronze), brn_scene_message(scene)) ||
      failed(brn_scene_add_heights(scene, &map), brn_scene_message(scene))) {
    goto end;
  }
  for (int k = 0; k < 3; ++k) {
    brn_step step;
    brn_step_init(&step);
    step.drive = BRN_DRIVE_FORCE;
    step.target = forces[k];
    if (failed(brn_scene_add_step(scene, &step), brn_scene_message(scene))) goto end;
  }
  if (failed(brn_run_create(engine, scene, &run), brn_last_message())) goto end;

  good = 1;
  for (int k = 0; k < 3; ++k) {
    brn_increment result;
    size_t count = 0;
    double carried = 0.0;
    brn_increment_init(&result);
    if (failed(brn_run_advance(run, NULL, NULL), brn_run_message(run)) ||
        failed(brn_run_get_increment(run, k, &result), brn_run_message(run)) ||
        failed(brn_run_get_field(run, BRN_FIELD_PRESSURE, pressure, nx * ny, &count), brn_run_message(run))) {
      good = 0;
      goto end;
    }
    for (size_t n = 0; n < count; ++n) carried += pressure[n] * spacing * spacing;
    printf("force %.2f N: contact area %.2f %%, peak pressure %.2f GPa, the field carries %.9f N\n", forces[k],
           100.0 * result.contact_area / (nx * ny * spacing * spacing), 1e-9 * result.max_pressure, carried);
    good &= result.contact_nodes > 0 && fabs(carried / forces[k] - 1.0) < 1e-7;
  }

end:
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
  return good ? 0 : 1;
}
