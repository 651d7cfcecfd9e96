#include "surface/portable_transform.h"

#include <algorithm>
#include <array>
#include <bit>

#include "surface/portable_math.h"

namespace brinell::surface {

namespace {

Complex operator+(Complex a, Complex b) {
  return {a.re + b.re, a.im + b.im};
}
Complex operator-(Complex a, Complex b) {
  return {a.re - b.re, a.im - b.im};
}
Complex operator*(Complex a, Complex b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
Complex conjugate(Complex a) {
  return {a.re, -a.im};
}

Complex unit(std::int64_t numerator, std::int64_t denominator) {
  const portable::SinCos angle =
      portable::sin_cos_of_turns(static_cast<double>(numerator) / static_cast<double>(denominator));
  return {angle.cos, angle.sin};
}

template <int Radix>
struct Butterfly;

template <>
struct Butterfly<2> {
  void operator()(std::array<Complex, 2>& v) const { v = {v[0] + v[1], v[0] - v[1]}; }
};

template <>
struct Butterfly<4> {
  void operator()(std::array<Complex, 4>& v) const {
    const Complex a = v[0] + v[2];
    const Complex b = v[0] - v[2];
    const Complex c = v[1] + v[3];
    const Complex d = v[1] - v[3];
    v = {a + c, {b.re - d.im, b.im + d.re}, a - c, {b.re + d.im, b.im - d.re}};
  }
};

// Odd lengths, by pairs a_t = v_t + v_{R−t}, b_t = v_t − v_{R−t}: V_u and V_{R−u} are
// v_0 + sum a_t·cos(2·pi·u·t/R) ± i·sum b_t·sin(2·pi·u·t/R).
template <int Radix>
struct Butterfly {
  static constexpr int kHalf = Radix / 2;
  std::array<Complex, Radix> root;

  Butterfly() {
    for (int k = 0; k < Radix; ++k) root[k] = unit(k, Radix);
  }

  void operator()(std::array<Complex, Radix>& v) const {
    std::array<Complex, kHalf + 1> sum{};
    std::array<Complex, kHalf + 1> difference{};
    Complex total = v[0];
    for (int t = 1; t <= kHalf; ++t) {
      sum[t] = v[t] + v[Radix - t];
      difference[t] = v[t] - v[Radix - t];
      total = total + sum[t];
    }
    for (int u = 1; u <= kHalf; ++u) {
      Complex even = v[0];
      Complex odd = {0, 0};
      for (int t = 1; t <= kHalf; ++t) {
        const Complex w = root[u * t % Radix];
        even = {even.re + w.re * sum[t].re, even.im + w.re * sum[t].im};
        odd = {odd.re + w.im * difference[t].re, odd.im + w.im * difference[t].im};
      }
      v[u] = {even.re - odd.im, even.im + odd.re};
      v[Radix - u] = {even.re + odd.im, even.im - odd.re};
    }
    v[0] = total;
  }
};

// One decimation-in-frequency pass: `stride` interleaved sequences of length n become Radix·stride sequences of
// length n/Radix. roots has the period stride·n.
template <int Radix>
void pass(std::int64_t n, std::int64_t stride, const Complex* in, Complex* out, const Complex* roots) {
  const Butterfly<Radix> butterfly;
  const std::int64_t part = n / Radix;
  for (std::int64_t p = 0; p < part; ++p) {
    std::array<Complex, Radix> twiddle;
    for (int u = 0; u < Radix; ++u) twiddle[u] = roots[p * u * stride];
    for (std::int64_t q = 0; q < stride; ++q) {
      std::array<Complex, Radix> v;
      for (int t = 0; t < Radix; ++t) v[t] = in[q + stride * (p + part * t)];
      butterfly(v);
      out[q + stride * Radix * p] = v[0];
      for (int u = 1; u < Radix; ++u) out[q + stride * (Radix * p + u)] = v[u] * twiddle[u];
    }
  }
}

void pass(int radix, std::int64_t n, std::int64_t stride, const Complex* in, Complex* out, const Complex* roots) {
  switch (radix) {
    case 2: return pass<2>(n, stride, in, out, roots);
    case 3: return pass<3>(n, stride, in, out, roots);
    case 4: return pass<4>(n, stride, in, out, roots);
    case 5: return pass<5>(n, stride, in, out, roots);
    case 7: return pass<7>(n, stride, in, out, roots);
    case 11: return pass<11>(n, stride, in, out, roots);
    default: return pass<13>(n, stride, in, out, roots);
  }
}

}  // namespace

PortableTransform::PortableTransform(std::int64_t length) : length_(length) {
  std::int64_t rest = length;
  for (const int radix : {4, 2, 3, 5, 7, 11, 13}) {
    for (; rest % radix == 0; rest /= radix) radices_.push_back(radix);
  }
  if (rest == 1) {
    roots_ = Buffer<Complex>::uninitialised(length);
    for (std::int64_t k = 0; k < length; ++k) roots_[k] = unit(k, length);
    return;
  }
  radices_.clear();
  const auto padded = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(2 * length - 1)));
  padded_ = std::make_unique<PortableTransform>(padded);
  chirp_ = Buffer<Complex>::uninitialised(length);
  std::int64_t square = 0;  // k² modulo the period 2·length
  for (std::int64_t k = 0; k < length; ++k) {
    chirp_[k] = unit(square, 2 * length);
    square = (square + 2 * k + 1) % (2 * length);
  }
  chirp_spectrum_ = Buffer<Complex>(padded);
  const double scale = 1.0 / static_cast<double>(padded);  // a power of two: exact
  for (std::int64_t k = 0; k < length; ++k) {
    const Complex value = {chirp_[k].re * scale, -chirp_[k].im * scale};
    chirp_spectrum_[k] = value;
    if (k != 0) chirp_spectrum_[padded - k] = value;
  }
  Buffer<Complex> scratch(padded_->scratch_size());
  (*padded_)(chirp_spectrum_.data(), scratch.data());
}

std::size_t PortableTransform::scratch_size() const {
  return padded_ ? 2 * static_cast<std::size_t>(padded_->length_) : static_cast<std::size_t>(length_);
}

void PortableTransform::operator()(Complex* values, Complex* scratch) const {
  if (padded_) {
    bluestein(values, scratch);
  } else {
    stockham(values, scratch);
  }
}

void PortableTransform::stockham(Complex* values, Complex* scratch) const {
  Complex* in = values;
  Complex* out = scratch;
  std::int64_t n = length_;
  std::int64_t stride = 1;
  for (const int radix : radices_) {
    pass(radix, n, stride, in, out, roots_.data());
    std::swap(in, out);
    n /= radix;
    stride *= radix;
  }
  if (in != values) std::copy(in, in + length_, values);
}

// j·k = (j² + k² − (k−j)²)/2, so X = chirp · ((x·chirp) convolved with the conjugate chirp). The inverse transform
// of the convolution is the transform of the conjugate, conjugated.
void PortableTransform::bluestein(Complex* values, Complex* scratch) const {
  const std::int64_t padded = padded_->length_;
  Complex* work = scratch;
  Complex* inner_scratch = scratch + padded;
  for (std::int64_t k = 0; k < length_; ++k) work[k] = values[k] * chirp_[k];
  std::fill(work + length_, work + padded, Complex{0, 0});
  (*padded_)(work, inner_scratch);
  for (std::int64_t k = 0; k < padded; ++k) work[k] = conjugate(work[k] * chirp_spectrum_[k]);
  (*padded_)(work, inner_scratch);
  for (std::int64_t k = 0; k < length_; ++k) values[k] = conjugate(work[k]) * chirp_[k];
}

}  // namespace brinell::surface
