/* A pressure that the caller already has, here that of Hertz below a sphere, p0 sqrt(1 - r^2/a^2): the stress below
 * it, without a scene. Compares the largest von Mises stress and its depth with 0.620041 p0 and 0.48086 a (nu = 0.3).
 */
#include <brinell.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { nodes = 128, layers = 32 };

static int near_theory(const char *name, double value, double theory, double allowed) {
  const double error = fabs(value / theory - 1.0);
  printf("%-22s %8.5f   theory %8.5f   error %.3f %%\n", name, value, theory, 100.0 * error);
  return error < allowed;
}

int main(void) {
  const double p0 = 1e9, a = 50e-6, dx = 2.6 * a / nodes;
  double *pressure = malloc(sizeof(double) * nodes * nodes);
  double *stress_zz = malloc(sizeof(double) * layers * nodes * nodes);
  double depths[layers];
  brn_engine *engine = NULL;
  brn_stress_request request;
  brn_stress_fields fields;
  brn_stress_maxima maxima;
  int good = 0, i, j, k;

  if (pressure == NULL || stress_zz == NULL) goto end;
  for (j = 0; j < nodes; ++j) {
    for (i = 0; i < nodes; ++i) {
      const double x = (i - 0.5 * (nodes - 1)) * dx, y = (j - 0.5 * (nodes - 1)) * dx;
      const double inside = 1.0 - (x * x + y * y) / (a * a);
      pressure[j * nodes + i] = inside > 0.0 ? p0 * sqrt(inside) : 0.0;
    }
  }
  for (k = 0; k < layers; ++k) depths[k] = k * a / (layers - 1);

  brn_stress_request_init(&request);
  request.nx = request.ny = nodes;
  request.dx = request.dy = dx;
  request.poissons_ratio = 0.3;
  request.depths = depths;
  request.depth_count = layers;
  request.pressure = pressure; /* shear_x and shear_y stay NULL: no friction */

  brn_stress_fields_init(&fields); /* what stays NULL is not computed */
  fields.capacity = (size_t)layers * nodes * nodes;
  fields.component[BRN_ZZ] = stress_zz;
  brn_stress_maxima_init(&maxima);

  if (brn_engine_create(NULL, &engine) != BRN_OK ||
      brn_stress_compute(engine, &request, &fields, &maxima) != BRN_OK) {
    fprintf(stderr, "%s\n", brn_last_message());
    goto end;
  }
  good = near_theory("largest von Mises / p0", maxima.von_mises / p0, 0.620041, 1e-3);
  good &= near_theory("its depth / a", maxima.von_mises_at[2] / a, 0.48086, 5e-3);

  /* at the surface zz is the pressure, and deeper below the centre p0 / (1 + z^2/a^2) */
  for (k = 0; k < layers; k += layers - 1) {
    const size_t centre = ((size_t)k * nodes + nodes / 2) * nodes + nodes / 2;
    const double z = depths[k] / a;
    good &= near_theory(k == 0 ? "-zz / p0 at z = 0" : "-zz / p0 at z = a", -stress_zz[centre] / p0,
                        1.0 / (1.0 + z * z), 2e-3);
  }

end:
  brn_engine_destroy(engine);
  free(stress_zz);
  free(pressure);
  return good ? 0 : 1;
}
