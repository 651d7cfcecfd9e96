#include "surface/roughness.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "surface/ordered_sum.h"
#include "surface/portable_math.h"
#include "surface/portable_transform.h"
#include "surface/surface_checks.h"

namespace brinell::surface {

namespace {

constexpr double kSlack = 1e-9;  // relative, on the cutoffs
constexpr double kTwoPi = 6.283185307179586476925;

std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// Uniform in [0, 1).
double random_turns(std::uint64_t seed, std::int64_t kx, std::int64_t ky) {
  const std::uint64_t bits = mix(mix(mix(seed) ^ static_cast<std::uint64_t>(kx)) ^ static_cast<std::uint64_t>(ky));
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

// The waves of one direction: |k| <= limit are on the grid, below its Nyquist wave number, and may be in the band.
struct Direction {
  std::int64_t nodes;
  double length;  // [m]
  double centre;  // in lengths
  std::int64_t limit;

  Direction(std::int64_t n, double spacing, double offset, double short_cutoff)
      : nodes(n), length(static_cast<double>(n) * spacing), centre(offset / length) {
    const std::int64_t highest = (n - 1) / 2;
    const double in_band = std::min(length / short_cutoff * (1.0 + kSlack), static_cast<double>(highest));
    limit = static_cast<std::int64_t>(in_band);
  }

  double frequency(std::int64_t k) const { return static_cast<double>(k) / length; }

  // Phase of wave k at node 0, in turns: x there is −(nodes − 1)/2 spacings from the grid's centre.
  double turns_at_first_node(std::int64_t k) const {
    const std::int64_t period = 2 * nodes;
    const auto shift = static_cast<double>((k * (nodes - 1)) % period) / static_cast<double>(period);
    return -shift - static_cast<double>(k) * centre;
  }
};

struct Band {
  double lowest;  // f² limits
  double highest;
  double rolloff;  // f²
  double exponent;

  explicit Band(const Roughness& roughness) {
    const double low = (1.0 - kSlack) / roughness.long_cutoff;
    const double high = (1.0 + kSlack) / roughness.short_cutoff;
    const double bend = 1.0 / roughness.rolloff;
    lowest = low * low;
    highest = high * high;
    rolloff = bend * bend;
    exponent = -0.5 * (1.0 + roughness.hurst);
  }

  bool holds(double f2) const { return f2 >= lowest && f2 <= highest; }
  double amplitude(double f2) const { return f2 <= rolloff ? 1.0 : portable::power(f2 / rolloff, exponent); }
};

// One of each pair ±(kx, ky): ky > 0, or ky = 0 and kx > 0.
std::int64_t first_kx(std::int64_t ky, const Direction& along_x) {
  return ky == 0 ? 1 : -along_x.limit;
}

bool has_wave(const Band& band, const Direction& along_x, const Direction& along_y) {
  for (std::int64_t ky = 0; ky <= along_y.limit; ++ky) {
    const double fy = along_y.frequency(ky);
    for (std::int64_t kx = first_kx(ky, along_x); kx <= along_x.limit; ++kx) {
      const double fx = along_x.frequency(kx);
      if (band.holds(fx * fx + fy * fy)) return true;
    }
  }
  return false;
}

// Spectrum and heights in the making.
class Synthesis {
 public:
  Synthesis(const Roughness& roughness, Centre centre, const Grid& grid)
      : roughness_(roughness),
        band_(roughness),
        along_x_(grid.nx, grid.dx, centre.x, roughness.short_cutoff),
        along_y_(grid.ny, grid.dy, centre.y, roughness.short_cutoff),
        transform_x_(grid.nx),
        transform_y_(grid.ny),
        rows_(Buffer<Complex>(static_cast<std::size_t>(along_y_.limit + 1) * static_cast<std::size_t>(grid.nx))) {}

  // field += factor · heights.
  void add(double factor, double* field, const parallel::Arena& arena) {
    const double scale = factor * transform_rows(arena);
    transform_columns(scale, field, arena);
  }

 private:
  // Fills rows_ with the unscaled waves of each ky >= 0, transformed along x. Returns the factor that they lack.
  double transform_rows(const parallel::Arena& arena) {
    const std::int64_t nx = along_x_.nodes;
    const std::int64_t rows = along_y_.limit + 1;
    std::vector<double> squares(static_cast<std::size_t>(rows));
    const std::size_t scratch_size = transform_x_.scratch_size();
    Buffer<Complex> scratch(scratch_size * static_cast<std::size_t>(arena.threads()));
    arena.for_chunks(rows, rows_per_chunk(nx), [&](std::int64_t begin, std::int64_t end, int slot) {
      for (std::int64_t ky = begin; ky < end; ++ky) {
        Complex* row = rows_.data() + ky * nx;
        squares[static_cast<std::size_t>(ky)] = fill_row(ky, row);
        transform_x_(row, scratch.data() + static_cast<std::size_t>(slot) * scratch_size);
      }
    });
    double sum = 0;
    for (const double square : squares) sum += square;
    return (roughness_.rms_height > 0 ? roughness_.rms_height : roughness_.rms_slope) / std::sqrt(sum);
  }

  // Returns the row's part of the mean square of heights or slopes.
  double fill_row(std::int64_t ky, Complex* row) const {
    const double fy = along_y_.frequency(ky);
    const double turns_y = along_y_.turns_at_first_node(ky);
    const bool of_height = roughness_.rms_height > 0;
    double sum = 0;
    for (std::int64_t kx = first_kx(ky, along_x_); kx <= along_x_.limit; ++kx) {
      const double fx = along_x_.frequency(kx);
      const double f2 = fx * fx + fy * fy;
      if (!band_.holds(f2)) continue;
      const double amplitude = band_.amplitude(f2);
      const double turns = random_turns(roughness_.seed, kx, ky) + (along_x_.turns_at_first_node(kx) + turns_y);
      const portable::SinCos phase = portable::sin_cos_of_turns(turns);
      row[kx < 0 ? kx + along_x_.nodes : kx] = {amplitude * phase.cos, amplitude * phase.sin};
      const double half_square = 0.5 * amplitude * amplitude;
      sum += of_height ? half_square : half_square * (kTwoPi * kTwoPi * f2);
    }
    return sum;
  }

  // The height of a column is the real part of sum over ky >= 0 of its spectrum G: the transform of the Hermitian
  // extension G(0).re, G(ky)/2, conj(G(ky))/2. Two such columns, being real, go through as one complex one.
  void transform_columns(double scale, double* field, const parallel::Arena& arena) const {
    constexpr std::int64_t kColumns = 8;  // a cache line of the field
    constexpr std::int64_t kPairs = kColumns / 2;
    const std::int64_t nx = along_x_.nodes;
    const std::int64_t ny = along_y_.nodes;
    const std::size_t per_slot = static_cast<std::size_t>(kPairs * ny) + transform_y_.scratch_size();
    Buffer<Complex> memory(per_slot * static_cast<std::size_t>(arena.threads()));
    arena.for_chunks(nx, kColumns, [&](std::int64_t begin, std::int64_t end, int slot) {
      Complex* columns = memory.data() + static_cast<std::size_t>(slot) * per_slot;
      Complex* scratch = columns + kPairs * ny;
      std::fill(columns, scratch, Complex{0, 0});
      for (std::int64_t ky = 0; ky <= along_y_.limit; ++ky) {
        const Complex* row = rows_.data() + ky * nx;
        for (std::int64_t i = begin; i < end; i += 2) {
          const Complex a = row[i];
          const Complex b = i + 1 < end ? row[i + 1] : Complex{0, 0};
          Complex* column = columns + (i - begin) / 2 * ny;
          if (ky == 0) {
            column[0] = {a.re, b.re};
          } else {
            column[ky] = {0.5 * (a.re - b.im), 0.5 * (a.im + b.re)};
            column[ny - ky] = {0.5 * (a.re + b.im), 0.5 * (b.re - a.im)};
          }
        }
      }
      for (std::int64_t i = begin; i < end; i += 2) transform_y_(columns + (i - begin) / 2 * ny, scratch);
      for (std::int64_t j = 0; j < ny; ++j) {
        double* row = field + j * nx;
        for (std::int64_t i = begin; i < end; ++i) {
          const Complex pair = columns[(i - begin) / 2 * ny + j];
          row[i] += scale * ((i - begin) % 2 == 0 ? pair.re : pair.im);
        }
      }
    });
  }

  Roughness roughness_;
  Band band_;
  Direction along_x_;
  Direction along_y_;
  PortableTransform transform_x_;
  PortableTransform transform_y_;
  Buffer<Complex> rows_;  // (along_y_.limit + 1) × nx, row ky >= 0
};

void check_centre(Centre centre) {
  if (!std::isfinite(centre.x)) refuse("centre x of a rough surface", centre.x, "finite [m]");
  if (!std::isfinite(centre.y)) refuse("centre y of a rough surface", centre.y, "finite [m]");
}

void check_wavelength(std::string_view argument, double value) {
  if (!(value >= 0) || !std::isfinite(value)) {
    refuse(argument, value, "a positive, finite wavelength [m], or 0 for the default");
  }
}

}  // namespace

Roughness checked(const Roughness& roughness, const Grid& grid) {
  check_grid(grid);
  Roughness result = roughness;
  if (!(result.hurst > 0 && result.hurst <= 1)) refuse("rough: hurst", result.hurst, "above 0 and at most 1");
  for (const auto& [name, value] :
       {std::pair{"rough: rms_slope", result.rms_slope}, std::pair{"rough: rms_height", result.rms_height}}) {
    if (!(value >= 0) || !std::isfinite(value)) refuse(name, value, "finite and not negative");
  }
  if ((result.rms_slope > 0) == (result.rms_height > 0)) {
    fail(Status::invalid_argument, "rough: rms_slope is " + text(result.rms_slope) + " and rms_height is " +
                                       text(result.rms_height) + "; exactly one of them must be positive");
  }
  check_wavelength("rough: long_cutoff", result.long_cutoff);
  check_wavelength("rough: rolloff", result.rolloff);
  check_wavelength("rough: short_cutoff", result.short_cutoff);

  const double shortest = 2.0 * std::max(grid.dx, grid.dy);
  const double longest = std::max(static_cast<double>(grid.nx) * grid.dx, static_cast<double>(grid.ny) * grid.dy);
  if (result.long_cutoff == 0) result.long_cutoff = std::max({longest, result.rolloff, shortest});
  if (result.rolloff == 0) result.rolloff = result.long_cutoff;
  if (result.short_cutoff == 0) result.short_cutoff = shortest;
  if (result.short_cutoff < shortest * (1.0 - kSlack)) {
    refuse("rough: short_cutoff", result.short_cutoff, "at least twice the larger spacing, " + text(shortest) + " m");
  }
  if (result.rolloff < result.short_cutoff) {
    refuse("rough: rolloff", result.rolloff, "at least short_cutoff, " + text(result.short_cutoff) + " m");
  }
  if (result.long_cutoff < result.rolloff) {
    refuse("rough: long_cutoff", result.long_cutoff, "at least rolloff, " + text(result.rolloff) + " m");
  }
  if (!has_wave(Band(result), {grid.nx, grid.dx, 0, result.short_cutoff},
                {grid.ny, grid.dy, 0, result.short_cutoff})) {
    fail(Status::invalid_argument, "rough: no wave that fits the grid has a length between long_cutoff, " +
                                       text(result.long_cutoff) + " m, and short_cutoff, " +
                                       text(result.short_cutoff) +
                                       " m, and is sampled more than twice; widen the band or refine the grid");
  }
  return result;
}

Buffer<double> rough_heights(const Roughness& roughness, Centre centre, const Grid& grid,
                             const parallel::Arena& arena) {
  check_centre(centre);
  const Roughness complete = checked(roughness, grid);
  Buffer<double> heights(grid.nodes());
  Synthesis(complete, centre, grid).add(1.0, heights.data(), arena);
  return heights;
}

void add_to_gap(const Roughness& roughness, Centre centre, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena) {
  check_gap(grid, gap);
  check_centre(centre);
  const Roughness complete = checked(roughness, grid);
  Synthesis(complete, centre, grid).add(-1.0, gap.data(), arena);
}

}  // namespace brinell::surface
