// One elastic-plastic body of a contact: plastic strain in the box of cuboids below it, and one pass of the fixed
// point that an increment of load asks for. With the plastic strain before, plus the increment d,
//
//   total = sigma_el(pressure) + sigma_res(before + d),   trial = total + 2 mu (d − early(d)),
//   mapped = early(d) + radial return of trial,
//
// where early(d) is the part of the flow in the direction that it begins with (flow_path.h), d is the solution if
// mapped = d; the total stress then lies within the yield surface and, where there is flow, on it. The equivalent
// plastic strain is p = p_before + |early| + |d − early|. z points into the body, whichever it is.
//
// The box begins at the surface and lies below part of the grid. It holds every node that is in contact, so that the
// stress under the contact needs no others, and all flow, with a margin of a few cuboids: the time of a pass goes
// with its size. It grows as either comes near a side, and downwards where a solution's stress would let what lies
// below it yield. What it holds stays. Fields are [k][j][i] in the box; the six components are `stride` values apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "base/grid.h"
#include "contact/nested_grids.h"
#include "fft/convolution.h"
#include "plastic/anderson.h"
#include "plastic/eigenstrain_displacement.h"
#include "plastic/eigenstrain_response.h"
#include "plastic/hardening.h"
#include "subsurface/stress_field.h"

namespace brinell::plastic {

struct PlasticMaterial {
  double youngs_modulus = 0;  // [Pa]
  double poissons_ratio = 0;
  Hardening hardening;
};

/// Layers of cuboids below the nodes of a grid.
struct Layers {
  std::int64_t count = 0;
  double thickness = 0;  // [m]
};

/// A box of cuboids, the first of them below the node (i0, j0).
struct Region {
  std::int64_t i0 = 0, j0 = 0;
  Box box;  // no cuboids: none yet

  bool empty() const { return box.nz == 0; }
  friend bool operator==(const Region&, const Region&) = default;
};

/// A field of `before` in the box `next`: where they overlap, zero elsewhere.
Buffer<double> placed_in(const Region& next, const Region& before, const Buffer<double>& field,
                         std::size_t components);

/// How far a state is from a solution, relative to the yield stress of each cuboid.
struct YieldError {
  double yield = 0;  // excess of the von Mises stress; where there is flow, its distance from the yield stress
  double flow = 0;   // von Mises norm of 2 mu (mapped − d)

  double worst() const { return yield > flow ? yield : flow; }
};

/// Shear along x and y, as multiples of the pressure.
using TractionRatio = std::array<double, 2>;

/// The pressure, and the shears that are not zero.
subsurface::Sources sources_of(const TractionRatio& shear);

/// Estimated error of an increment: its root mean square over all that has flowed is √(squares/cuboids).
struct IncrementError {
  double squares = 0;        // of flow_error()
  std::int64_t cuboids = 0;  // that have flowed, in this increment or before
};

struct LargestPlasticStrain {
  double value = 0;            // equivalent
  std::array<double, 3> at{};  // [m], z into the body; meaningless where the value is 0
  std::int64_t cuboids = 0;    // that have flowed
};

class PlasticBody {
 public:
  /// The grid is that of the contact; layers are those that the box may take. spectra_limit: bytes that the
  /// coefficients of the stress under the contact may keep. Throws Status::invalid_argument for the material.
  PlasticBody(const fft::Backend& backend, const Grid& grid, const Layers& layers, const PlasticMaterial& material,
              std::size_t spectra_limit);

  const Region& region() const { return region_; }
  std::size_t stride() const { return stride_; }
  static std::size_t stride_of(const Box& box);
  const YieldCurve& law() const { return law_; }
  double shear_modulus() const { return shear_modulus_; }

  /// Lets the box grow so that it holds the contact with a margin; true if it grew.
  bool cover(const contact::Box& contact);

  /// Lets it grow once flow has come near a side that is not the grid's; true if it grew.
  bool make_room_for_flow();

  /// Lets it grow where a solution's stress, after evaluate(), would let cuboids below it yield; true if it grew.
  bool make_room_below(const contact::Box& contact, const double* pressure, double unit, const TractionRatio& shear);

  /// Flow in the last layer of all, or below the grid's side: what lies beyond it is unknown.
  bool flow_is_cut_off() const;

  /// d = factor · (increment of the last solution).
  void guess(double factor);
  bool has_increment() const;

  /// Adds `weight` times the displacement of before + d to the nodes of the grid [m], positive into the body.
  void add_displacement(double weight, double* displacement);

  /// Total stress, trial and return for the pressure of the grid, in units of `unit` [Pa], and a shear of so many
  /// times that, which pushes this body along x and y.
  YieldError evaluate(const double* pressure, double unit, const TractionRatio& shear = {});

  /// For the acceleration, after evaluate(): d and what it was mapped to.
  AndersonPart unknowns();
  /// After the acceleration: what does not flow has no increment.
  void confine();

  /// flow_error() of the solved increment.
  IncrementError increment_error() const;

  /// d becomes history; what is returned is the plastic work that it dissipated [J], never negative.
  double accept();

  /// Plastic strain, equivalent plastic strain and the total stress of the last evaluation.
  TensorView strain() const { return view(strain_); }
  TensorView stress() const { return view(total_); }
  const Buffer<double>& equivalent() const { return p_; }
  LargestPlasticStrain largest() const;

  /// Another response of the body's cuboids, in a box of the caller's.
  std::unique_ptr<EigenstrainResponse> response(const Box& box) const;

  /// Residual stress of the present strain.
  void residual_stress(const TensorArrays& result);

  /// What survives between increments.
  struct State {
    Region region;
    Buffer<double> strain, increment, stress;  // 6·stride
    Buffer<double> equivalent;                 // stride
  };
  State state() const;
  void restore(const State& state);
  static std::size_t state_bytes(std::size_t cuboids) { return (3 * 6 + 1) * Buffer<double>::padded_bytes(cuboids); }

  /// Bytes of one whose box takes all layers below so many nodes, under such tractions.
  static std::size_t bytes(const fft::Backend& backend, const Grid& grid, const Layers& layers,
                           std::size_t spectra_limit, subsurface::Sources sources);

 private:
  static constexpr std::size_t kBlock = Anderson::kBlock;
  static constexpr std::size_t kAll = 6;  // components

  TensorView view(const Buffer<double>& field) const;
  TensorArrays arrays(Buffer<double>& field) const;
  void move_to(const Region& region);
  bool take_tractions(const double* pressure, double unit, const TractionRatio& shear);
  subsurface::Tractions tractions() const;
  void contact_stress(const double* pressure, double unit, const TractionRatio& shear);
  std::int64_t layers_for(std::int64_t count) const;
  void combine();
  double try_stress();
  void part_flow(std::size_t begin, std::size_t end);
  void yield_stresses_of_block(std::size_t first, const double* equivalent, double* result) const;
  double plastic_work() const;
  double distance_of_flow() const;
  void list_blocks();
  bool flows(std::size_t n) const { return p_mapped_[n] > p_old_[n] || p_[n] > p_old_[n]; }

  fft::Backend backend_;
  Grid grid_;
  Layers layers_;
  PlasticMaterial material_;
  std::size_t spectra_limit_;
  YieldCurve law_;
  double shear_modulus_;

  Region region_;
  std::size_t stride_ = 0;                           // cuboids rounded up to whole blocks
  std::unique_ptr<EigenstrainResponse> response_;    // of the box; null until needed
  std::unique_ptr<subsurface::StressField> stress_;  // of the box; null until needed
  std::unique_ptr<EigenstrainDisplacement> surface_;
  Buffer<double> old_, strain_, d_, mapped_, residual_, total_, trial_;  // six components each
  Buffer<double> stress_old_, early_;                                    // six: total before; part of d, where active
  Buffer<double> p_old_, p_, p_mapped_, von_mises_, yield_;              // one value a cuboid
  Buffer<double> p_early_;                                               // p_old + |early|
  Buffer<double> factor_;                                                // on the yield stress; empty: 1
  std::vector<double> layer_factor_;
  Buffer<double> pressure_, displacement_;  // above the box [Pa]; on the grid [m]
  std::array<Buffer<double>, 2> shears_;    // above the box [Pa]; empty: none
  bool accepted_ = false;                   // before + d has become before, and nothing has happened since
  bool residual_is_current_ = false;        // residual_ is that of the present strain
  bool displacement_is_current_ = false;
  std::vector<std::uint8_t> moved_;   // by the return: see MappedState
  std::vector<std::uint8_t> active_;  // blocks that moved or hold an increment
  std::vector<std::int64_t> blocks_;  // active ones of all components
};

}  // namespace brinell::plastic
