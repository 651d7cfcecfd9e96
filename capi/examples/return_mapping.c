/* The constitutive law alone, as another program would embed it: a point of steel (Swift) is stretched step by step
 * with its lateral stress held at zero. At each total strain the trial stress is elastic, the return finds the
 * plastic strain, and Newton's method on the tangent scalar finds the lateral strain. Compares with the curve of the
 * tensile test: the stress is B (C + 1e6 p)^n at the plastic strain p = strain - stress/E.
 */
#include <brinell.h>
#include <math.h>
#include <stdio.h>

enum { steps = 40 };

int main(void) {
  const double E = 210e9, nu = 0.3, mu = E / (2.0 * (1.0 + nu)), bulk = E / (3.0 * (1.0 - 2.0 * nu));
  double plastic[3] = {0.0, 0.0, 0.0}, p = 0.0, worst = 0.0;
  brn_engine *engine = NULL;
  brn_hardening steel;
  int step, k, good = 0;

  brn_hardening_init(&steel);
  steel.law = BRN_HARDENING_SWIFT;
  steel.B = 1240e6;
  steel.C = 30.0;
  steel.n = 0.085;
  if (brn_engine_create(NULL, &engine) != BRN_OK) {
    fprintf(stderr, "%s\n", brn_last_message());
    return 1;
  }
  for (step = 1; step <= steps; ++step) {
    const double strain = 0.03 * step / steps;
    double lateral = -nu * (strain - plastic[0]) + plastic[1], expected;
    double trial[6] = {0}, stress[6], increment[6], after = p, theta = 1.0, theta_bar = 0.0;
    for (k = 0; k < 50; ++k) {
      const double total[3] = {strain, lateral, lateral}, volume = bulk * (strain + 2.0 * lateral);
      double normal, slope;
      brn_return_points points;
      brn_return_result result;
      int c;
      brn_return_points_init(&points);
      brn_return_result_init(&result);
      points.count = result.capacity = 1;
      points.shear_modulus = mu;
      points.plastic_strain = &p;
      result.plastic_strain = &after;
      result.theta = &theta;
      result.theta_bar = &theta_bar;
      for (c = 0; c < 3; ++c) trial[c] = volume + 2.0 * mu * (total[c] - (strain + 2.0 * lateral) / 3.0 - plastic[c]);
      for (c = 0; c < 6; ++c) {
        points.trial[c] = &trial[c];
        result.stress[c] = &stress[c];
        result.increment[c] = &increment[c];
      }
      if (brn_return_map_batch(engine, &steel, &points, &result, NULL) != BRN_OK) {
        fprintf(stderr, "%s\n", brn_engine_message(engine));
        goto end;
      }
      if (fabs(stress[1]) <= 1e-9 * fabs(stress[0])) break;
      /* d stress_yy / d lateral from the tangent: the direction N of a tensile test is (2, -1, -1)/sqrt(6) */
      normal = -1.0 / sqrt(6.0);
      slope = 2.0 * bulk + 2.0 * mu * (theta / 3.0 - theta_bar * normal * 2.0 * normal);
      lateral -= stress[1] / slope;
    }
    for (k = 0; k < 3; ++k) plastic[k] += increment[k];
    p = after;
    expected = p > 0.0 ? steel.B * pow(steel.C + 1e6 * p, steel.n) : E * strain;
    worst = fmax(worst, fabs(stress[0] / expected - 1.0) + fabs(strain - stress[0] / E - plastic[0]) / strain);
    if (step % 8 == 0) {
      printf("strain %.4f  stress %7.2f MPa  plastic strain %.5f\n", strain, 1e-6 * stress[0], p);
    }
  }
  printf("largest error %.1e\n", worst);
  good = worst < 1e-8;

end:
  brn_engine_destroy(engine);
  return good ? 0 : 1;
}
