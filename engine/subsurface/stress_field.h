// Stress below the surface under given tractions, layer by layer: each source is transformed once, each component of
// each layer is one transform back of a sum over the sources, and invariants and maxima follow while the layer is
// near. Only what the request names is computed, and only fields that the caller holds are stored.
//
// Results do not depend on the number of threads, bit for bit, nor on which spectra are kept.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "base/function_ref.h"
#include "fft/convolution.h"
#include "parallel/arena.h"
#include "subsurface/maximum.h"
#include "subsurface/stress_plan.h"
#include "subsurface/stress_request.h"
#include "subsurface/stress_spectra.h"

namespace brinell::subsurface {

/// Largest values by Invariant; those that the request did not name are zero.
using Maxima = std::array<Maximum, kInvariants>;

/// Fields of one layer, nx·ny values each; null: not asked for.
struct StressLayer {
  std::int64_t layer = 0;
  double depth = 0;
  std::array<const double*, kComponents> component{};
  std::array<const double*, kInvariants> invariant{};
  std::array<const double*, 9> direction{};
};

class StressField {
 public:
  /// The backend outlives this. Spectra of the first layers are kept for later calls as far as spectra_limit bytes
  /// allow, those of the others generated anew by each call; the default streams all. Throws as plan_stress does.
  StressField(const fft::Backend& backend, StressRequest request, std::size_t spectra_limit = 0);

  const StressRequest& request() const { return request_; }
  const StressPlan& plan() const { return plan_; }

  /// All layers into the caller's fields. Throws Status::invalid_argument if an array is missing. One call at a time.
  Maxima compute(const Tractions& tractions, const StressFields& fields);

  /// The same without whole fields: `take` is called for each layer from the first to the last, on the calling
  /// thread; what it is shown is valid during the call.
  Maxima compute_by_layer(const Tractions& tractions, FunctionRef<void(const StressLayer&)> take);

 private:
  struct Worker {
    std::unique_ptr<fft::Workspace<double>> workspace;
    Buffer<double> coefficients;
  };
  struct Work;

  void for_tasks(std::int64_t count, FunctionRef<void(std::int64_t task, Worker& worker)> body);
  const fft::Backend& inner_backend() const { return plan_.threads_inside ? backend_ : serial_backend_; }
  const LayerSpectra& spectra_of(const Work& work, std::int64_t layer) const;

  Maxima run(const Tractions& tractions, const StressFields& fields,
             const FunctionRef<void(const StressLayer&)>* take);
  void transform_sources(const Tractions& tractions, Work& work);
  void generate(Work& work);
  void convolve(Work& work);
  void evaluate_invariants(Work& work);
  void finish_layers(Work& work, const FunctionRef<void(const StressLayer&)>* take);

  fft::Backend backend_;
  StressRequest request_;
  StressPlan plan_;
  SpectrumIndex index_;
  std::unique_ptr<parallel::Arena> one_thread_;
  fft::Backend serial_backend_;
  fft::Convolution<double> convolution_;  // of inner_backend()
  std::vector<Worker> workers_;           // by slot
  std::vector<LayerSpectra> kept_;        // of the first layers; empty until generated
};

}  // namespace brinell::subsurface
