#include "influence/spectrum_cache.h"

#include <type_traits>
#include <utility>

namespace brinell::influence {

template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> SpectrumCache::get(SpectrumKey key,
                                                              FunctionRef<fft::Spectrum<Real>()> build) {
  key.single_precision = std::is_same_v<Real, float>;
  return std::static_pointer_cast<const fft::Spectrum<Real>>(get_any(key, [&] {
    auto spectrum = std::make_shared<const fft::Spectrum<Real>>(build());
    const std::size_t bytes = spectrum->values.bytes();
    return Built{std::move(spectrum), bytes};
  }));
}

template std::shared_ptr<const fft::Spectrum<double>> SpectrumCache::get(SpectrumKey,
                                                                         FunctionRef<fft::Spectrum<double>()>);
template std::shared_ptr<const fft::Spectrum<float>> SpectrumCache::get(SpectrumKey,
                                                                        FunctionRef<fft::Spectrum<float>()>);

std::shared_ptr<const void> SpectrumCache::get_any(const SpectrumKey& key, FunctionRef<Built()> build) {
  std::unique_lock lock(mutex_);
  for (auto found = entries_.find(key); found != entries_.end(); found = entries_.find(key)) {
    if (found->second.spectrum != nullptr) {
      uses_.splice(uses_.begin(), uses_, found->second.use);
      return found->second.spectrum;
    }
    built_.wait(lock);
  }
  entries_.try_emplace(key);
  lock.unlock();

  Built result;
  try {
    result = build();
    lock.lock();
    uses_.push_front(key);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    entries_.erase(key);
    built_.notify_all();
    throw;
  }
  entries_[key] = {result.spectrum, result.bytes, uses_.begin()};
  bytes_ += result.bytes;
  drop_beyond_limit();
  built_.notify_all();
  return result.spectrum;
}

void SpectrumCache::drop_beyond_limit() {
  while (bytes_ > byte_limit_ && !uses_.empty()) {
    const auto oldest = entries_.find(uses_.back());
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
    uses_.pop_back();
  }
}

std::size_t SpectrumCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace brinell::influence
