#include "plastic/hardening.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "base/error.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

namespace {

constexpr double kLeastStrain = 0x1p-1000;

[[noreturn]] void refuse(const std::string& argument, double value, std::string_view allowed) {
  fail(Status::invalid_argument, argument + " is " + text(value) + "; it must be " + std::string(allowed));
}

void check_positive(const char* argument, double value, std::string_view unit = "") {
  if (!(value > 0) || !std::isfinite(value)) refuse(argument, value, "positive and finite" + std::string(unit));
}

void check_not_negative(const char* argument, double value, std::string_view unit = "") {
  if (!(value >= 0) || !std::isfinite(value)) refuse(argument, value, "at least 0 and finite" + std::string(unit));
}

constexpr std::string_view kPascal = " [Pa]";

void check_law(const Swift& law) {
  check_positive("B", law.B, kPascal);
  check_not_negative("C", law.C);
  if (!(law.n >= 0 && law.n <= 1)) refuse("n", law.n, "from 0 (no hardening) to 1 (linear hardening)");
  check_positive("strain_scale", law.strain_scale);
}

void check_law(const LinearHardening& law) {
  check_positive("yield_stress", law.yield_stress, kPascal);
  check_not_negative("hardening_modulus", law.hardening_modulus, " [Pa]: laws that soften are not solved");
}

void check_law(const PerfectPlasticity& law) {
  check_positive("yield_stress", law.yield_stress, kPascal);
}

void check_law(const Voce& law) {
  check_positive("yield_stress", law.yield_stress, kPascal);
  if (!(law.saturation_stress >= law.yield_stress) || !std::isfinite(law.saturation_stress)) {
    refuse("saturation_stress", law.saturation_stress,
           "finite and at least yield_stress = " + text(law.yield_stress) + " [Pa]: laws that soften are not solved");
  }
  check_positive("rate", law.rate);
}

void check_law(const RambergOsgood& law) {
  check_positive("K", law.K, kPascal);
  if (!(law.m >= 1) || !std::isfinite(law.m)) refuse("m", law.m, "at least 1 and finite");
  check_not_negative("yield_stress", law.yield_stress, " [Pa] (0: flow from zero stress)");
}

void check_law(const HardeningTable& law) {
  const std::size_t count = law.plastic_strain.size();
  if (count == 0 || law.stress.size() != count) {
    fail(Status::invalid_argument, "plastic_strain has " + std::to_string(count) + " values and stress " +
                                       std::to_string(law.stress.size()) +
                                       "; a table needs as many of each, and at least one");
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::string at = "[" + std::to_string(k) + "]";
    const double strain = law.plastic_strain[k], stress = law.stress[k];
    if (k == 0 && strain != 0) refuse("plastic_strain" + at, strain, "0: the table begins at first yield");
    if (!std::isfinite(strain) || (k > 0 && !(strain > law.plastic_strain[k - 1]))) {
      refuse("plastic_strain" + at, strain, "finite and larger than the one before");
    }
    if (!(stress > 0) || !std::isfinite(stress)) refuse("stress" + at, stress, "positive and finite [Pa]");
    if (k > 0 && stress < law.stress[k - 1]) {
      refuse("stress" + at, stress,
             "at least the one before, " + text(law.stress[k - 1]) + " [Pa]: laws that soften are not solved");
    }
  }
}

/// Slopes of the monotone interpolation: zero beside a flat or at an end of monotony, else the weighted harmonic
/// mean of the chords; at the ends a one-sided parabola, held so that the cubic stays monotone.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t count = x.size();
  std::vector<double> slope(count, 0.0);
  if (count < 2) return slope;
  const auto width = [&x](std::size_t k) { return x[k + 1] - x[k]; };
  const auto chord = [&](std::size_t k) { return (y[k + 1] - y[k]) / width(k); };
  if (count == 2) return {chord(0), chord(0)};
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double before = chord(k - 1), behind = chord(k);
    if (before <= 0 || behind <= 0) continue;
    const double a = 2 * width(k) + width(k - 1), b = width(k) + 2 * width(k - 1);
    slope[k] = (a + b) / (a / before + b / behind);
  }
  const auto at_end = [](double near_width, double far_width, double near_chord, double far_chord) {
    const double parabola =
        ((2 * near_width + far_width) * near_chord - near_width * far_chord) / (near_width + far_width);
    return std::clamp(parabola, 0.0, 3 * near_chord);
  };
  slope[0] = at_end(width(0), width(1), chord(0), chord(1));
  slope[count - 1] = at_end(width(count - 2), width(count - 3), chord(count - 2), chord(count - 3));
  return slope;
}

}  // namespace

void check(const Hardening& hardening) {
  std::visit([](const auto& law) { check_law(law); }, hardening.law);
  const std::vector<DepthFactor>& points = hardening.depth_factor;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string at = "depth_factor[" + std::to_string(k) + "]";
    const auto& [depth, factor] = points[k];
    if (!(depth >= 0) || !std::isfinite(depth)) refuse(at + ": depth", depth, "at least 0 and finite [m]");
    if (k > 0 && !(depth > points[k - 1].depth)) refuse(at + ": depth", depth, "larger than the one before [m]");
    if (!(factor > 0) || !std::isfinite(factor)) refuse(at + ": factor", factor, "positive and finite");
  }
}

YieldCurve::YieldCurve(const Hardening& hardening) : depth_factor_(hardening.depth_factor) {
  check(hardening);
  std::visit([this](const auto& law) { use(law); }, hardening.law);
}

void YieldCurve::use(const Swift& law) {
  use_power(law.B, law.C, law.strain_scale, law.n, 0);
}

void YieldCurve::use(const RambergOsgood& law) {
  use_power(law.K, 0, 1, 1 / law.m, law.yield_stress);
}

void YieldCurve::use_power(double coefficient, double offset, double scale, double exponent, double onset) {
  if (exponent == 0) return use(PerfectPlasticity{coefficient});
  if (exponent == 1 && onset == 0) return use(LinearHardening{coefficient * offset, coefficient * scale});
  curve_.form = simd::HardeningForm::power;
  curve_.coefficient = coefficient;
  curve_.offset = std::max(offset, kLeastStrain);
  curve_.scale = scale;
  curve_.exponent = exponent;
  curve_.onset = onset;
  curve_.initial = std::max(onset, coefficient * std::pow(curve_.offset, exponent));
}

void YieldCurve::use(const PerfectPlasticity& law) {
  use(LinearHardening{law.yield_stress, 0});
}

void YieldCurve::use(const LinearHardening& law) {
  curve_.form = simd::HardeningForm::linear;
  curve_.initial = law.yield_stress;
  curve_.modulus = law.hardening_modulus;
}

void YieldCurve::use(const Voce& law) {
  curve_.form = simd::HardeningForm::voce;
  curve_.initial = law.yield_stress;
  curve_.amplitude = law.saturation_stress - law.yield_stress;
  curve_.rate = law.rate;
}

void YieldCurve::use(const HardeningTable& law) {
  strain_ = law.plastic_strain;
  stress_ = law.stress;
  slope_ = monotone_slopes(strain_, stress_);
  curve_.form = simd::HardeningForm::table;
  curve_.initial = stress_.front();
  curve_.count = strain_.size();
  curve_.strain = strain_.data();
  curve_.stress = stress_.data();
  curve_.slope = slope_.data();
}

double YieldCurve::yield_stress(double p) const {
  double result = 0;
  simd::kernels(simd::Isa::baseline).return_mapping.yield_stress(1, curve_, &p, nullptr, &result);
  return result;
}

double YieldCurve::factor_at(double depth) const {
  if (depth_factor_.empty()) return 1;
  const auto behind = std::upper_bound(depth_factor_.begin(), depth_factor_.end(), depth,
                                       [](double at, const DepthFactor& point) { return at < point.depth; });
  if (behind == depth_factor_.begin()) return behind->factor;
  const DepthFactor& before = *(behind - 1);
  if (behind == depth_factor_.end()) return before.factor;
  const double share = (depth - before.depth) / (behind->depth - before.depth);
  return before.factor + share * (behind->factor - before.factor);
}

std::vector<double> YieldCurve::factors_at(std::span<const double> depths) const {
  std::vector<double> factors;
  factors.reserve(depths.size());
  for (std::size_t k = 0; k < depths.size(); ++k) {
    if (!(depths[k] >= 0)) refuse("depth[" + std::to_string(k) + "]", depths[k], "at least 0 [m]");
    factors.push_back(factor_at(depths[k]));
  }
  return factors;
}

}  // namespace brinell::plastic
