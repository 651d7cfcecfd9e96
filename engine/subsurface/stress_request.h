// What a caller wants to know about the stress below the surface.
//
// Tractions are those of design: pressure p > 0 presses, shear q > 0 pushes the lower body along +x or +y; both are
// uniform on the cell around each node. On a periodic boundary they are the trigonometric polynomial through the
// nodes instead, and lateral strain of the mean pressure p̄ is zero: σ_zz = −p̄, σ_xx = σ_yy = −ν/(1 − ν) p̄.
//
// Each body has its own frame: x and y are shared, z points from the surface into the body, so that the upper body's
// frame is the mirror image of the lower one's. The pressure is the same in both; by action and reaction the shear
// on the upper body is −q, which the engine sees to: the caller gives the lower body's. In the upper body's frame
// σ_xz and σ_yz have the opposite sign of what they have in the lower body's axes; the other components do not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "influence/stress.h"
#include "subsurface/invariants.h"

namespace brinell::subsurface {

using influence::StressComponent;
using influence::Traction;

inline constexpr int kComponents = 6;
inline constexpr int kTractions = 3;

enum class Body : std::int32_t { lower = 0, upper = 1 };

/// A choice among an enumeration's values.
template <class Enumeration>
class Choice {
 public:
  constexpr Choice() = default;
  constexpr Choice(std::initializer_list<Enumeration> chosen) {
    for (const Enumeration one : chosen) bits_ |= bit(one);
  }
  static constexpr Choice first(int count) {
    Choice choice;
    choice.bits_ = (std::uint32_t{1} << count) - 1;
    return choice;
  }
  constexpr bool has(Enumeration one) const { return (bits_ & bit(one)) != 0; }
  constexpr bool has(int index) const { return has(static_cast<Enumeration>(index)); }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr void add(Enumeration one) { bits_ |= bit(one); }
  constexpr Choice operator|(Choice other) const {
    other.bits_ |= bits_;
    return other;
  }
  friend constexpr bool operator==(const Choice&, const Choice&) = default;

 private:
  static constexpr std::uint32_t bit(Enumeration one) { return std::uint32_t{1} << static_cast<int>(one); }
  std::uint32_t bits_ = 0;
};

using Components = Choice<StressComponent>;
using Invariants = Choice<Invariant>;
using Sources = Choice<Traction>;

inline constexpr Components kAllComponents = Components::first(kComponents);

struct StressRequest {
  Grid grid;
  Boundary boundary = Boundary::free;
  Body body = Body::lower;
  double poissons_ratio = 0;
  std::vector<double> depths;  // [m], z = 0 at the surface; rising (depths.h)
  Sources sources{Traction::pressure};
  Components components;    // fields wanted
  Invariants invariants;    // fields wanted
  bool directions = false;  // fields of the principal directions wanted
  Invariants maxima;        // of these the largest value and its place; needs no field of them
};

/// nx·ny values [Pa] for each of the request's sources, by Traction; the others are not read.
using Tractions = std::array<const double*, kTractions>;

/// Where the fields go that the request names, each layers·ny·nx values, index = (layer·ny + j)·nx + i; the other
/// pointers are not used.
struct StressFields {
  std::array<double*, kComponents> component{};
  std::array<double*, kInvariants> invariant{};
  std::array<double*, 9> direction{};  // [3·k + axis], the direction of principal stress k
};

/// Throws Status::invalid_argument or Status::too_large, naming what is wrong and what is allowed.
void check(const StressRequest& request);

}  // namespace brinell::subsurface
