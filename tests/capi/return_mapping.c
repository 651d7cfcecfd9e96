/* brn_return_map_batch: every law against its formula, the tangent's scalars, what it refuses, and older clients. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "check.h"

enum { count = 300 };
static const double mu = 80e9;

typedef struct {
  double trial[6][count], before[count];
  double increment[6][count], after[count], von_mises[count], stress[6][count], theta[count], theta_bar[count];
  brn_return_points points;
  brn_return_result result;
} batch;

/* Uniaxial and shear stresses up to ten times q. */
static void fill(batch *b, double q) {
  int i, c;
  memset(b, 0, sizeof *b);
  brn_return_points_init(&b->points);
  brn_return_result_init(&b->result);
  for (i = 0; i < count; ++i) {
    const double reach = 10.0 * q * i / (count - 1);
    b->trial[i % 6][i] = i % 6 < 3 ? reach : reach / sqrt(3.0);
    b->before[i] = 1e-5 * (i % 7);
  }
  b->points.count = count;
  b->points.shear_modulus = mu;
  b->points.plastic_strain = b->before;
  b->result.capacity = count;
  b->result.plastic_strain = b->after;
  b->result.von_mises = b->von_mises;
  b->result.theta = b->theta;
  b->result.theta_bar = b->theta_bar;
  for (c = 0; c < 6; ++c) {
    b->points.trial[c] = b->trial[c];
    b->result.increment[c] = b->increment[c];
    b->result.stress[c] = b->stress[c];
  }
}

static double yield_of(const brn_hardening *h, double p) {
  switch (h->law) {
    case BRN_HARDENING_SWIFT: return h->B * pow(h->C + h->strain_scale * p, h->n);
    case BRN_HARDENING_LINEAR: return h->yield_stress + h->hardening_modulus * p;
    case BRN_HARDENING_PERFECT: return h->yield_stress;
    case BRN_HARDENING_VOCE:
      return h->saturation_stress - (h->saturation_stress - h->yield_stress) * exp(-h->rate * p);
    case BRN_HARDENING_RAMBERG_OSGOOD: return fmax(h->yield_stress, h->K * pow(p, 1.0 / h->m));
    default: return h->stress[0] + (h->stress[1] - h->stress[0]) * fmin(p / h->plastic_strain[1], 1.0);
  }
}

static brn_hardening law_of(int32_t law) {
  static const double strain[] = {0.0, 0.02}, stress[] = {300e6, 600e6};
  brn_hardening h;
  brn_hardening_init(&h);
  h.law = law;
  h.B = 1240e6;
  h.C = 30.0;
  h.n = 0.085;
  h.yield_stress = 400e6;
  h.hardening_modulus = 5e9;
  h.saturation_stress = 700e6;
  h.rate = 20.0;
  h.K = 4320e6;
  h.m = 12.6;
  h.plastic_strain = strain;
  h.stress = stress;
  h.point_count = 2;
  return h;
}

static void every_law_is_met(void) {
  brn_engine *engine = plain_engine(2);
  batch *b = malloc(sizeof *b);
  int32_t law;
  int i, c;
  for (law = BRN_HARDENING_SWIFT; law <= BRN_HARDENING_TABLE; ++law) {
    const brn_hardening h = law_of(law);
    int64_t yielded = -1, expected = 0;
    fill(b, yield_of(&h, 0.0) / 3.0);
    CHECK_STATUS(BRN_OK, brn_return_map_batch(engine, &h, &b->points, &b->result, &yielded));
    for (i = 0; i < count; ++i) {
      const double q = i % 6 < 3 ? b->trial[i % 6][i] : sqrt(3.0) * b->trial[i % 6][i];
      const double flow = b->after[i] - b->before[i];
      const double after = yield_of(&h, b->after[i]);
      CHECK(flow >= 0.0);
      if (flow == 0.0) {
        CHECK(q <= yield_of(&h, b->before[i]) * (1.0 + 1e-13) && b->theta[i] == 1.0 && b->theta_bar[i] == 0.0);
        continue;
      }
      ++expected;
      CHECK(fabs(b->von_mises[i] - after) <= 1e-12 * after);
      CHECK(fabs(b->von_mises[i] + 3.0 * mu * flow - q) <= 1e-12 * q);
      CHECK(fabs(b->theta[i] - b->von_mises[i] / q) <= 1e-14);
      CHECK(b->theta_bar[i] >= 0.0 && b->theta_bar[i] <= b->theta[i] + 1e-15);
      CHECK(fabs(b->increment[0][i] + b->increment[1][i] + b->increment[2][i]) <= 1e-15 * flow);
      for (c = 0; c < 6; ++c) {
        CHECK(fabs(b->stress[c][i] - (b->trial[c][i] - 2.0 * mu * b->increment[c][i])) <= 1e-14 * q);
      }
    }
    CHECK(yielded == expected && expected >= count / 10);
  }
  free(b);
  brn_engine_destroy(engine);
}

static void depth_factors_scale_the_yield_stress(void) {
  static const double depths[] = {0.0, 2e-6}, factors[] = {2.0, 1.0},
                      layers[] = {0.0, 1e-6, 5e-6, 6e-6, 7e-6, 8e-6, 9e-6};
  brn_engine *engine = plain_engine(1);
  batch *b = malloc(sizeof *b);
  brn_hardening h = law_of(BRN_HARDENING_PERFECT);
  int i;
  h.depths = depths;
  h.depth_factors = factors;
  h.depth_count = 2;
  fill(b, 1e9);
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, &h, &b->points, &b->result, NULL));
  CHECK_SAYS(brn_engine_message(engine), "layer_depths");
  b->points.layer_depths = layers;
  b->points.layer_count = 3;
  CHECK_STATUS(BRN_OK, brn_return_map_batch(engine, &h, &b->points, &b->result, NULL));
  for (i = 0; i < count; ++i) {
    const double factor = i < count / 3 ? 2.0 : i < 2 * count / 3 ? 1.5 : 1.0;
    CHECK(b->von_mises[i] <= factor * 400e6 * (1.0 + 1e-12));
  }
  CHECK(fabs(b->von_mises[count / 3 - 1] / 800e6 - 1.0) < 1e-12);
  b->points.layer_count = 7;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, &h, &b->points, &b->result, NULL));
  CHECK_SAYS(brn_engine_message(engine), "300|7");
  free(b);
  brn_engine_destroy(engine);
}

static void bad_arguments_are_named(void) {
  brn_engine *engine = plain_engine(1);
  batch *b = malloc(sizeof *b);
  brn_hardening h = law_of(BRN_HARDENING_SWIFT);
  fill(b, 1e9);
#define REFUSED(status, words)                                                            \
  do {                                                                                    \
    CHECK_STATUS(status, brn_return_map_batch(engine, &h, &b->points, &b->result, NULL)); \
    CHECK_SAYS(brn_engine_message(engine), words);                                        \
    h = law_of(BRN_HARDENING_SWIFT);                                                      \
    fill(b, 1e9);                                                                         \
  } while (0)
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(NULL, &h, &b->points, &b->result, NULL));
  CHECK_SAYS(brn_last_message(), "engine");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, NULL, &b->points, &b->result, NULL));
  CHECK_SAYS(brn_engine_message(engine), "hardening");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, &h, NULL, &b->result, NULL));
  CHECK_SAYS(brn_engine_message(engine), "points");
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_return_map_batch(engine, &h, &b->points, NULL, NULL));
  CHECK_SAYS(brn_engine_message(engine), "result");
  h.law = BRN_HARDENING_NONE;
  REFUSED(BRN_INVALID_ARGUMENT, "law = 0|1|6");
  h.law = 7;
  REFUSED(BRN_INVALID_ARGUMENT, "law = 7");
  h.n = 2.0;
  REFUSED(BRN_INVALID_ARGUMENT, "n is 2");
  h.law = BRN_HARDENING_TABLE;
  h.stress = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "stress");
  h.law = BRN_HARDENING_TABLE;
  h.point_count = 0;
  REFUSED(BRN_INVALID_ARGUMENT, "plastic_strain has 0");
  h.depth_count = 1;
  REFUSED(BRN_INVALID_ARGUMENT, "depths");
  b->points.shear_modulus = -1.0;
  REFUSED(BRN_INVALID_ARGUMENT, "shear_modulus is -1");
  b->points.trial[3] = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "trial[3]");
  b->points.plastic_strain = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "plastic_strain");
  b->result.increment[5] = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "increment[5]");
  b->result.stress[1] = NULL;
  REFUSED(BRN_INVALID_ARGUMENT, "stress: 5 of 6");
  b->result.capacity = count - 1;
  REFUSED(BRN_SHORT_BUFFER, "299|300");
  b->trial[2][123] = NAN;
  REFUSED(BRN_INVALID_ARGUMENT, "point 123|zz = nan");
  b->before[299] = -1.0;
  REFUSED(BRN_INVALID_ARGUMENT, "point 299|plastic_strain is -1");
  b->points.count = 0;
  CHECK_STATUS(BRN_OK, brn_return_map_batch(engine, &h, &b->points, &b->result, NULL));
#undef REFUSED
  free(b);
  brn_engine_destroy(engine);
}

int main(void) {
  CHECK(BRN_HARDENING_NONE == 0 && BRN_HARDENING_SWIFT == 1 && BRN_HARDENING_LINEAR == 2);
  CHECK(BRN_HARDENING_PERFECT == 3 && BRN_HARDENING_VOCE == 4 && BRN_HARDENING_RAMBERG_OSGOOD == 5);
  CHECK(BRN_HARDENING_TABLE == 6);
  every_law_is_met();
  depth_factors_scale_the_yield_stress();
  bad_arguments_are_named();
  return check_report();
}
