// Stress below a uniformly loaded rectangle: closed form by corner sums, quadrature of point forces further away.
// Formulas, signs and where each is used: engine/influence/stress.h. Everything here is 2π times the stress.
#pragma once

#include "simd/influence_kernels.h"
#include "simd/kernels/influence_row.inl"

namespace brinell::simd {
namespace {

enum Stress { kXx, kYy, kZz, kYz, kXz, kXy };

template <class Arch>
struct SixStresses {
  xsimd::batch<double, Arch> component[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
};

/// Which components a caller wants.
struct Wanted {
  bool component[6];
  bool operator[](Stress c) const { return component[c]; }
};

/// A corner of the cell seen from the field point.
template <class Arch>
struct Corner {
  using Batch = xsimd::batch<double, Arch>;
  Batch x, y, z, rho, x2z2, y2z2;
  Corner(Batch x_, Batch y_, Batch z_) : x(x_), y(y_), z(z_), x2z2(x * x + z * z), y2z2(y * y + z * z) {
    rho = xsimd::sqrt(x2z2 + y * y);
  }
  /// ln's argument o + ρ, where ρ² − o² = rest; for o < 0 the sum would cancel.
  Batch sum(Batch o, Batch rest) const {
    const Batch larger = rho + xsimd::abs(o);
    return xsimd::select(o < Batch(0.0), rest / larger, larger);
  }
};

/// Products of the corners' arguments of a logarithm: one logarithm serves all four.
template <class Arch>
struct CornerLog {
  using Batch = xsimd::batch<double, Arch>;
  Batch numerator = Batch(1.0), denominator = Batch(1.0);  // braces would read a list of lanes
  void take(bool positive, Batch argument) {
    if (positive) {
      numerator = numerator * argument;
    } else {
      denominator = denominator * argument;
    }
  }
  Batch value() const { return xsimd::log(numerator / denominator); }
};

/// Unit pressure.
template <class Arch>
class PressureStress {
  using Batch = xsimd::batch<double, Arch>;

 public:
  PressureStress(const StressCell& cell, const Wanted& wanted)
      : wanted_(wanted), z_(cell.z), m_(cell.compressibility), twice_nu_(1 - cell.compressibility) {}

  void corner(const Corner<Arch>& at, bool positive) {
    const Batch sign(positive ? 1.0 : -1.0), xy = at.x * at.y, z_rho = z_ * at.rho;
    const Batch inverse = Batch(1.0) / at.rho;
    const Batch solid = wanted_[kXx] || wanted_[kYy] || wanted_[kZz] ? xsimd::atan2(xy, z_rho) : Batch(0.0);
    const Batch lever = z_ * xy * inverse;
    if (wanted_[kXx]) {
      add(kXx, sign * (lever / at.x2z2 - twice_nu_ * solid - m_ * xsimd::atan2(xy, at.x2z2 + z_rho)));
    }
    if (wanted_[kYy]) {
      add(kYy, sign * (lever / at.y2z2 - twice_nu_ * solid - m_ * xsimd::atan2(xy, at.y2z2 + z_rho)));
    }
    if (wanted_[kZz]) add(kZz, -sign * (solid + lever / at.x2z2 + lever / at.y2z2));
    if (wanted_[kYz]) add(kYz, sign * z_ * z_ * at.x * inverse / at.y2z2);
    if (wanted_[kXz]) add(kXz, sign * z_ * z_ * at.y * inverse / at.x2z2);
    if (wanted_[kXy]) {
      add(kXy, -sign * z_ * inverse);
      log_.take(positive, z_ + at.rho);
    }
  }

  void point(Batch x, Batch y, Batch weight) {
    const Batch z2 = z_ * z_, rho2 = x * x + y * y + z2;
    const Batch inverse = inverse_root(rho2), inverse2 = inverse * inverse, inverse3 = inverse * inverse2;
    const Batch t = inverse / (rho2 * inverse + z_);  // 1/(ρ(ρ + z))
    const Batch axial = Batch(3.0) * z_ * inverse3 * inverse2 * weight;
    const Batch even = m_ * (z_ * inverse3 - t) * weight;
    const Batch planar = m_ * t * (inverse2 + t) * weight - axial;
    if (wanted_[kXx]) add(kXx, even + x * x * planar);
    if (wanted_[kYy]) add(kYy, even + y * y * planar);
    if (wanted_[kZz]) add(kZz, -z2 * axial);
    if (wanted_[kYz]) add(kYz, -y * z_ * axial);
    if (wanted_[kXz]) add(kXz, -x * z_ * axial);
    if (wanted_[kXy]) add(kXy, x * y * planar);
  }

  SixStresses<Arch> corners() const {
    SixStresses<Arch> all = sum_;
    if (wanted_[kXy]) all.component[kXy] = all.component[kXy] - m_ * log_.value();
    return all;
  }
  SixStresses<Arch> points() const { return sum_; }

 private:
  void add(Stress c, Batch value) { sum_.component[c] = sum_.component[c] + value; }

  Wanted wanted_;
  Batch z_, m_, twice_nu_;
  SixStresses<Arch> sum_;
  CornerLog<Arch> log_;
};

/// Unit shear along x.
template <class Arch>
class ShearStress {
  using Batch = xsimd::batch<double, Arch>;

 public:
  ShearStress(const StressCell& cell, const Wanted& wanted)
      : wanted_(wanted), z_(cell.z), m_(cell.compressibility), twice_nu_(1 - cell.compressibility) {}

  void corner(const Corner<Arch>& at, bool positive) {
    const Batch sign(positive ? 1.0 : -1.0), inverse = Batch(1.0) / at.rho;
    const Batch edge = at.y * inverse / at.x2z2, far = Batch(1.0) / (at.rho + z_);
    if (wanted_[kXx]) add(kXx, sign * (at.x * at.x * edge - m_ * at.y * far));
    if (wanted_[kYy]) add(kYy, sign * at.y * (m_ * far - inverse));
    if (wanted_[kXx] || wanted_[kYy]) log_y_.take(positive, at.sum(at.y, at.x2z2));
    if (wanted_[kZz]) add(kZz, sign * z_ * z_ * edge);
    if (wanted_[kYz]) add(kYz, -sign * z_ * inverse);
    if (wanted_[kXz]) add(kXz, sign * (z_ * at.x * edge - xsimd::atan2(at.x * at.y, z_ * at.rho)));
    if (wanted_[kXy]) {
      add(kXy, sign * at.x * (m_ * far - inverse));
      log_x_.take(positive, at.sum(at.x, at.y2z2));
    }
  }

  void point(Batch x, Batch y, Batch weight) {
    const Batch rho2 = x * x + y * y + z_ * z_;
    const Batch inverse = inverse_root(rho2), inverse2 = inverse * inverse, inverse3 = inverse * inverse2;
    const Batch s = Batch(1.0) / (rho2 * inverse + z_);  // 1/(ρ + z)
    const Batch t = inverse * s, ts = t * s;
    const Batch axial = Batch(3.0) * inverse3 * inverse2 * weight;
    const Batch planar = m_ * ts * (inverse2 + t + t) * weight - axial;
    const Batch m = m_ * weight;
    if (wanted_[kXx]) add(kXx, x * (m * (inverse3 - Batch(3.0) * ts) + x * x * planar));
    if (wanted_[kYy]) add(kYy, x * (m * (inverse3 - ts) + y * y * planar));
    if (wanted_[kZz]) add(kZz, -x * z_ * z_ * axial);
    if (wanted_[kYz]) add(kYz, -x * y * z_ * axial);
    if (wanted_[kXz]) add(kXz, -x * x * z_ * axial);
    if (wanted_[kXy]) add(kXy, y * (x * x * planar - m * ts));
  }

  SixStresses<Arch> corners() const {
    SixStresses<Arch> all = sum_;
    if (wanted_[kXx] || wanted_[kYy]) {
      const Batch log_y = log_y_.value();
      all.component[kXx] = all.component[kXx] + log_y + log_y;
      all.component[kYy] = all.component[kYy] + twice_nu_ * log_y;
    }
    if (wanted_[kXy]) all.component[kXy] = all.component[kXy] + log_x_.value();
    return all;
  }
  SixStresses<Arch> points() const { return sum_; }

 private:
  void add(Stress c, Batch value) { sum_.component[c] = sum_.component[c] + value; }

  Wanted wanted_;
  Batch z_, m_, twice_nu_;
  SixStresses<Arch> sum_;
  CornerLog<Arch> log_x_, log_y_;
};

/// The same with x and y exchanged: shear along y.
constexpr Stress kTurned[6] = {kYy, kXx, kZz, kXz, kYz, kXy};

template <class Arch>
class ShearYStress {
  using Batch = xsimd::batch<double, Arch>;

 public:
  ShearYStress(const StressCell& cell, const Wanted& wanted) : along_x_(cell, turned(wanted)) {}
  void corner(const Corner<Arch>& at, bool positive) { along_x_.corner({at.y, at.x, at.z}, positive); }
  void point(Batch x, Batch y, Batch weight) { along_x_.point(y, x, weight); }
  SixStresses<Arch> corners() const { return turned(along_x_.corners()); }
  SixStresses<Arch> points() const { return turned(along_x_.points()); }

 private:
  template <class Six>
  static Six turned(const Six& six) {
    Six other;
    for (int c = 0; c < 6; ++c) other.component[c] = six.component[kTurned[c]];
    return other;
  }

  ShearStress<Arch> along_x_;
};

inline Wanted wanted_of(const StressRows& rows) {
  Wanted wanted;
  for (int c = 0; c < 6; ++c) wanted.component[c] = rows.component[c] != nullptr;
  return wanted;
}

template <class Arch, class Body>
void fill_stress_rows(const RowSpan& span, const StressRows& rows, double scale, Body body) {
  using Batch = xsimd::batch<double, Arch>;
  for_offsets<Arch>(span, body, [&rows, scale](const SixStresses<Arch>& six, std::int64_t done, std::int64_t count) {
    for (int c = 0; c < 6; ++c) {
      if (rows.component[c] != nullptr) store_lanes(six.component[c] * Batch(scale), rows.component[c] + done, count);
    }
  });
}

constexpr double kInverseTwoPi = 0.15915494309189533577;

template <class Arch, template <class> class Source>
void stress_closed(const StressCell& cell, const RowSpan& span, const StressRows& rows) {
  using Batch = xsimd::batch<double, Arch>;
  const Wanted wanted = wanted_of(rows);
  fill_stress_rows<Arch>(span, rows, kInverseTwoPi, [&](Batch x) {
    const Batch z(cell.z), right = x + Batch(cell.a), left = x - Batch(cell.a);
    const Batch upper(span.y + cell.b), lower(span.y - cell.b);
    Source<Arch> source(cell, wanted);
    source.corner({right, upper, z}, true);
    source.corner({left, upper, z}, false);
    source.corner({right, lower, z}, false);
    source.corner({left, lower, z}, true);
    return source.corners();
  });
}

template <class Arch, template <class> class Source>
void stress_points(const StressCell& cell, const GaussRule& rule_x, const GaussRule& rule_y, const RowSpan& span,
                   const StressRows& rows) {
  using Batch = xsimd::batch<double, Arch>;
  const Wanted wanted = wanted_of(rows);
  fill_stress_rows<Arch>(span, rows, kInverseTwoPi * cell.a * cell.b, [&](Batch x) {
    Source<Arch> source(cell, wanted);
    for (int l = 0; l < rule_y.nodes; ++l) {
      const Batch y(span.y + cell.b * rule_y.node[l]);
      for (int k = 0; k < rule_x.nodes; ++k) {
        source.point(x + Batch(cell.a * rule_x.node[k]), y, Batch(rule_x.weight[k] * rule_y.weight[l]));
      }
    }
    return source.points();
  });
}

}  // namespace
}  // namespace brinell::simd
