// One elastic-plastic body of a contact: plastic strain in the box of cuboids below it, and one pass of the fixed
// point that an increment of load asks for. With the plastic strain before, plus the increment d,
//
//   total = sigma_el(pressure) + sigma_res(before + d),   trial = total + 2 mu d,   mapped = radial return of trial,
//
// d is the solution if mapped = d; the total stress then lies within the yield surface and, where there is flow, on
// it. The equivalent plastic strain is p = p_before + √(2/3 d:d). z points into the body, whichever it is.
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

/// How far a state is from a solution, relative to the yield stress of each cuboid.
struct YieldError {
  double yield = 0;  // excess of the von Mises stress; where there is flow, its distance from the yield stress
  double flow = 0;   // von Mises norm of 2 mu (mapped − d)

  double worst() const { return yield > flow ? yield : flow; }
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
  bool make_room_below(const contact::Box& contact, const double* pressure, double unit);

  /// Flow in the last layer of all, or below the grid's side: what lies beyond it is unknown.
  bool flow_is_cut_off() const;

  /// d = factor · (increment of the last solution).
  void guess(double factor);
  bool has_increment() const;

  /// Adds `weight` times the displacement of before + d to the nodes of the grid [m], positive into the body.
  void add_displacement(double weight, double* displacement);

  /// Total stress, trial and return for the pressure of the grid, in units of `unit` [Pa].
  YieldError evaluate(const double* pressure, double unit);

  /// For the acceleration, after evaluate(): d and what it was mapped to.
  AndersonPart unknowns();
  /// After the acceleration: what does not flow has no increment.
  void confine();

  /// d becomes history; what is returned is the plastic work that it dissipated [J].
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
    Buffer<double> strain, increment;  // 6·stride
    Buffer<double> equivalent;         // stride
  };
  State state() const;
  void restore(const State& state);

  /// Bytes of one whose box takes all layers below so many nodes.
  static std::size_t bytes(const fft::Backend& backend, const Grid& grid, const Layers& layers,
                           std::size_t spectra_limit);

 private:
  static constexpr std::size_t kBlock = Anderson::kBlock;
  static constexpr std::size_t kAll = 6;  // components

  TensorView view(const Buffer<double>& field) const;
  TensorArrays arrays(Buffer<double>& field) const;
  void move_to(const Region& region);
  std::int64_t layers_for(std::int64_t count) const;
  bool take_pressure(const double* pressure, double unit);
  void combine();
  double try_stress();
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
  Buffer<double> p_old_, p_, p_mapped_, von_mises_, yield_;              // one value a cuboid
  Buffer<double> factor_;                                                // on the yield stress; empty: 1
  std::vector<double> layer_factor_;
  Buffer<double> pressure_, displacement_;  // below the box [Pa]; on the grid [m]
  bool accepted_ = false;                   // before + d has become before, and nothing has happened since
  bool residual_is_current_ = false;        // residual_ is that of the present strain
  bool displacement_is_current_ = false;
  std::vector<std::uint8_t> moved_;   // by the return: see MappedState
  std::vector<std::uint8_t> active_;  // blocks that moved or hold an increment
  std::vector<std::int64_t> blocks_;  // active ones of all components
};

}  // namespace brinell::plastic
