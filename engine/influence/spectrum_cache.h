// Spectra of influence coefficients, shared by all that runs on one engine: whoever comes second to the same grid
// pays nothing. Spectra do not depend on elastic moduli. The least recently used ones go when the bytes pass a limit;
// those still in use live on with their users.
#pragma once

#include <compare>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>

#include "base/function_ref.h"
#include "base/grid.h"
#include "fft/convolution.h"

namespace brinell::influence {

/// What a spectrum responds to.
enum class Response : std::int32_t {
  displacement = 0,  // normal surface displacement of a pressure
  conductance = 1,   // its approximate inverse
};

struct SpectrumKey {
  Response response = Response::displacement;
  Boundary boundary = Boundary::free;
  fft::Method method = fft::Method::automatic;
  std::int64_t nx = 0, ny = 0;
  double dx = 0, dy = 0;
  bool single_precision = false;  // set by the cache

  friend auto operator<=>(const SpectrumKey&, const SpectrumKey&) = default;
};

class SpectrumCache {
 public:
  /// byte_limit = 0 keeps nothing.
  explicit SpectrumCache(std::size_t byte_limit) : byte_limit_(byte_limit) {}

  /// The spectrum of this key; built by the first who asks while others who ask for the same wait. If build throws,
  /// its caller gets the exception and one of those who wait builds. Not to be called from within a body of
  /// Arena::for_chunks: build uses the arena.
  template <class Real>
  std::shared_ptr<const fft::Spectrum<Real>> get(SpectrumKey key, FunctionRef<fft::Spectrum<Real>()> build);

  std::size_t bytes() const;  // of the spectra kept
  std::size_t byte_limit() const { return byte_limit_; }

 private:
  struct Entry {
    std::shared_ptr<const void> spectrum;  // null while it is being built
    std::size_t bytes = 0;
    std::list<SpectrumKey>::iterator use;
  };
  struct Built {
    std::shared_ptr<const void> spectrum;
    std::size_t bytes;
  };
  std::shared_ptr<const void> get_any(const SpectrumKey& key, FunctionRef<Built()> build);
  void drop_beyond_limit();

  const std::size_t byte_limit_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable built_;
  std::map<SpectrumKey, Entry> entries_;
  std::list<SpectrumKey> uses_;  // of finished entries, most recent first
  std::size_t bytes_ = 0;
};

}  // namespace brinell::influence
