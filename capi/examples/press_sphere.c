/* A rigid sphere of 10 mm radius is pressed into steel with 10 N. Compares approach, peak pressure and contact
 * radius with Hertz (1881); the grid has 40 nodes across the contact radius, which is good for 1 %. */
#include <brinell.h>
#include <math.h>
#include <stdio.h>

static int failed(brn_status status, const char *message) {
  if (status != BRN_OK) fprintf(stderr, "%s: %s\n", brn_status_name(status), message);
  return status != BRN_OK;
}

static int near_theory(const char *name, double value, double theory) {
  const double error = fabs(value / theory - 1.0);
  printf("%-15s %12.5e   Hertz %12.5e   error %.2f %%\n", name, value, theory, 100.0 * error);
  return error < 0.01;
}

int main(void) {
  const double pi = 3.14159265358979323846;
  const double radius = 10e-3, force = 10.0, youngs_modulus = 210e9, poissons_ratio = 0.3;
  const double contact_modulus = youngs_modulus / (1.0 - poissons_ratio * poissons_ratio);
  const double a = cbrt(0.75 * force * radius / contact_modulus);

  brn_engine *engine = NULL;
  brn_scene *scene = NULL;
  brn_run *run = NULL;
  int good = 0;

  if (failed(brn_engine_create(NULL, &engine), brn_last_message())) goto end;
  if (failed(brn_scene_create(&scene), brn_last_message())) goto end;

  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = grid.ny = 128;
  grid.dx = grid.dy = a / 40.0;
  brn_body steel; /* the upper body stays rigid, the default */
  brn_body_init(&steel);
  steel.rigid = 0;
  steel.youngs_modulus = youngs_modulus;
  steel.poissons_ratio = poissons_ratio;
  brn_shape sphere;
  brn_shape_init(&sphere);
  sphere.kind = BRN_SHAPE_SPHERE;
  sphere.radius = radius;
  brn_step press;
  brn_step_init(&press);
  press.drive = BRN_DRIVE_FORCE;
  press.target = force;

  if (failed(brn_scene_set_grid(scene, &grid), brn_scene_message(scene)) ||
      failed(brn_scene_set_body(scene, BRN_LOWER, &steel), brn_scene_message(scene)) ||
      failed(brn_scene_add_shape(scene, &sphere), brn_scene_message(scene)) ||
      failed(brn_scene_add_step(scene, &press), brn_scene_message(scene)) ||
      failed(brn_run_create(engine, scene, &run), brn_last_message()) ||
      failed(brn_run_execute(run, NULL, NULL), brn_run_message(run))) {
    goto end;
  }

  brn_increment result;
  brn_increment_init(&result);
  if (failed(brn_run_get_increment(run, 0, &result), brn_run_message(run))) goto end;
  good = near_theory("approach", result.approach, a * a / radius);
  good &= near_theory("peak pressure", result.max_pressure, 1.5 * force / (pi * a * a));
  good &= near_theory("contact radius", sqrt(result.contact_area / pi), a);
  printf("certificate     penetration %.1e, complementarity %.1e, balance %.1e\n", result.penetration,
         result.complementarity, result.balance);

end:
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
  return good ? 0 : 1;
}
