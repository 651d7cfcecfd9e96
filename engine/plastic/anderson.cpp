#include "plastic/anderson.h"

#include <algorithm>
#include <cmath>

namespace brinell::plastic {

namespace {

constexpr std::int64_t kBlocksOfChunk = 32;
// Differences that differ from the others by less than this part of their length are left out.
constexpr double kIndependent = 1e-10;

}  // namespace

void Anderson::start(std::size_t size) {
  if (size != size_) history_.resize((2 * depth_ + 2) * size);
  known_.assign(size / kBlock, 0);
  size_ = size;
  steps_ = 0;
  begun_ = false;
  gram_.assign(depth_ * depth_, 0);
  right_.assign(depth_, 0);
}

/// Cholesky factors of the Gram matrix, newest difference first, as far as the differences are independent.
std::vector<double> Anderson::coefficients(std::size_t count) {
  std::vector<double> factor(count * count), gamma(depth_, 0.0), y(count);
  std::vector<std::size_t> order(count);
  for (std::size_t k = 0; k < count; ++k) order[k] = (steps_ - 1 - k) % depth_;
  std::size_t used = 0;
  for (; used < count; ++used) {
    const double whole = gram_[order[used] * depth_ + order[used]];
    double pivot = whole;
    for (std::size_t j = 0; j < used; ++j) {
      double value = gram_[order[used] * depth_ + order[j]];
      for (std::size_t k = 0; k < j; ++k) value -= factor[used * count + k] * factor[j * count + k];
      factor[used * count + j] = value / factor[j * count + j];
      pivot -= factor[used * count + j] * factor[used * count + j];
    }
    if (!(pivot > kIndependent * whole)) break;
    factor[used * count + used] = std::sqrt(pivot);
  }
  for (std::size_t k = 0; k < used; ++k) {
    double value = right_[order[k]];
    for (std::size_t j = 0; j < k; ++j) value -= factor[k * count + j] * y[j];
    y[k] = value / factor[k * count + k];
  }
  for (std::size_t k = used; k-- > 0;) {
    double value = y[k];
    for (std::size_t j = k + 1; j < used; ++j) value -= factor[j * count + k] * gamma[order[j]];
    gamma[order[k]] = value / factor[k * count + k];
  }
  return gamma;
}

void Anderson::advance(std::span<const AndersonPart> parts) {
  std::vector<Place> places;
  std::size_t offset = 0;
  for (const AndersonPart& part : parts) {
    for (const std::int64_t block : part.blocks) {
      const std::size_t at = static_cast<std::size_t>(block) * kBlock;
      places.push_back({part.x + at, part.mapped + at, offset + at});
    }
    offset += part.size;
  }
  const auto n = static_cast<std::int64_t>(places.size());
  double* last_residual = history_.data();
  double* last_mapped = history_.data() + size_;
  const bool differ = begun_;
  begun_ = true;
  const std::size_t newest = steps_ % depth_;
  if (differ) ++steps_;
  const std::size_t count = std::min(steps_, depth_);

  // Differences, and their products with each other and with the residual.
  const auto chunks = static_cast<std::size_t>((n + kBlocksOfChunk - 1) / kBlocksOfChunk);
  std::vector<double> sums(chunks * 2 * depth_);
  arena_.for_chunks(n, kBlocksOfChunk, [&](std::int64_t begin, std::int64_t end, int) {
    double* sum = sums.data() + static_cast<std::size_t>(begin / kBlocksOfChunk) * 2 * depth_;
    for (std::int64_t k = begin; k < end; ++k) {
      const Place& place = places[static_cast<std::size_t>(k)];
      if (std::uint8_t& known = known_[place.at / kBlock]; known == 0) {  // it was zero
        for (std::size_t j = 0; j < 2 * depth_ + 2; ++j)
          std::fill_n(history_.data() + j * size_ + place.at, kBlock, 0.0);
        known = 1;
      }
      double* before = last_residual + place.at;
      double* mapped_before = last_mapped + place.at;
      double* step = residual_step(newest) + place.at;
      double* mapped = mapped_step(newest) + place.at;
      for (std::size_t i = 0; i < kBlock; ++i) {
        const double residual = place.mapped[i] - place.x[i];
        if (differ) {
          step[i] = residual - before[i];
          mapped[i] = place.mapped[i] - mapped_before[i];
        }
        before[i] = residual;
        mapped_before[i] = place.mapped[i];
      }
      for (std::size_t j = 0; j < count; ++j) {
        const double* other = residual_step(j) + place.at;
        double with_newest = 0, with_residual = 0;
        for (std::size_t i = 0; i < kBlock; ++i) {
          with_newest += step[i] * other[i];
          with_residual += before[i] * other[i];
        }
        sum[j] += with_newest;
        sum[depth_ + j] += with_residual;
      }
    }
  });
  for (std::size_t j = 0; j < count; ++j) {
    double with_newest = 0, with_residual = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      with_newest += sums[chunk * 2 * depth_ + j];
      with_residual += sums[(chunk * 2 + 1) * depth_ + j];
    }
    gram_[newest * depth_ + j] = gram_[j * depth_ + newest] = with_newest;
    right_[j] = with_residual;
  }
  const std::vector<double> gamma = count > 0 ? coefficients(count) : std::vector<double>(depth_, 0.0);

  arena_.for_chunks(n, kBlocksOfChunk, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t k = begin; k < end; ++k) {
      const Place& place = places[static_cast<std::size_t>(k)];
      std::copy_n(place.mapped, kBlock, place.x);
      for (std::size_t j = 0; j < count; ++j) {
        if (gamma[j] == 0) continue;
        const double* step = mapped_step(j) + place.at;
        for (std::size_t i = 0; i < kBlock; ++i) place.x[i] -= gamma[j] * step[i];
      }
    }
  });
}

}  // namespace brinell::plastic
