// What a request for stresses will hold in memory, known before any of it is allocated, and the order of its work.
//
// Work goes in batches of layers: spectra that are not kept are generated for a batch, the components of its layers
// follow, then their invariants. The batch depends on sizes alone, so that results do not depend on the threads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fft/convolution.h"
#include "subsurface/stress_request.h"

namespace brinell::subsurface {

struct StressPlan {
  std::int64_t layers = 0;
  std::int64_t batch = 0;        // layers computed together
  std::int64_t kept_layers = 0;  // the first ones, whose spectra stay for the next call
  bool threads_inside = false;   // threads share each transform, not the layers and components
  Components needed;             // components that must be computed
  std::size_t field_bytes = 0;   // the caller's fields, if it stores all that the request names
  std::size_t kept_bytes = 0;    // spectra that stay
  std::size_t work_bytes = 0;    // all else
  std::size_t total_bytes() const { return field_bytes + kept_bytes + work_bytes; }
};

/// Spectra of whole layers are kept as far as spectra_limit bytes allow. Throws as check() does.
StressPlan plan_stress(const fft::Backend& backend, const StressRequest& request, std::size_t spectra_limit);

}  // namespace brinell::subsurface
