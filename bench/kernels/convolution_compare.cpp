// Convolutions side by side: all candidates take turns in one process, round after round, so that whatever else the
// machine does falls on all of them alike; process CPU time, medians over the rounds, ratios to the textbook.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/convolution_case.h"
#include "kernels/textbook_convolution.h"

namespace {

using namespace brinell;

constexpr const char* kUsage =
    "convolution_compare: this engine's convolutions against the textbook (FFTW, padded r2c and c2r, by measure)\n"
    "  --sizes N,N…      grids of N x N nodes (256,512,1024,2048)\n"
    "  --rounds R        turns of each candidate (15)\n"
    "  --threads T       threads of this engine's candidates (1); with more, wall time is compared\n"
    "  --periodic        periodic instead of free boundary; the textbook is unpadded then\n"
    "  --precision P     double | float | both (both)\n"
    "Prints a table: median milliseconds, and for each candidate the median of its ratio to the textbook in the\n"
    "same round with the quartiles.\n";

struct Options {
  std::vector<std::int64_t> sizes{256, 512, 1024, 2048};
  int rounds = 15;
  int threads = 1;
  Boundary boundary = Boundary::free;
  bool in_double = true;
  bool in_float = true;
};

double seconds(bool wall) {
  std::timespec now{};
  clock_gettime(wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

template <class Real>
void compare(const Options& options, std::int64_t n) {
  struct Candidate {
    std::string name;
    std::function<void(const Real*, Real*)> apply;
    std::vector<double> times;
  };
  std::vector<Candidate> candidates;
  const auto textbook = std::make_shared<bench::TextbookConvolution<Real>>(n, n, options.boundary);
  candidates.push_back({"textbook", [textbook](const Real* s, Real* r) { textbook->apply(s, r); }, {}});
  const auto add = [&](const std::string& name, fft::Method method, simd::Isa isa) {
    const auto one =
        std::make_shared<bench::ConvolutionCase<Real>>(n, options.boundary, method, isa, options.threads);
    candidates.push_back({name, [one](const Real* s, Real* r) { one->apply(s, r); }, {}});
  };
  add("fftw", fft::Method::fftw, simd::Isa::baseline);
  for (const simd::Isa isa : simd::supported()) {
    add("lanes " + std::string(simd::name(isa)), fft::Method::lanes, isa);
  }

  const auto source = bench::random_source<Real>(n);
  Buffer<Real> result(source.size());  // aligned as the fields of a solve are
  const bool wall = options.threads > 1;
  const int repeats = static_cast<int>(std::max<std::int64_t>(1, 1024 * 1024 / (n * n)));
  for (int round = -1; round < options.rounds; ++round) {  // the first warms up
    for (Candidate& candidate : candidates) {
      const double start = seconds(wall);
      for (int i = 0; i < repeats; ++i) candidate.apply(source.data(), result.data());
      if (round >= 0) candidate.times.push_back((seconds(wall) - start) / repeats);
    }
  }
  const char* precision = sizeof(Real) == sizeof(double) ? "double" : "float";
  for (const Candidate& candidate : candidates) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < candidate.times.size(); ++i) {
      ratios.push_back(candidates.front().times[i] / candidate.times[i]);
    }
    std::printf("| %5lld | %-6s | %-14s | %8.3f | %5.2f (%.2f to %.2f) |\n", static_cast<long long>(n), precision,
                candidate.name.c_str(), 1e3 * quantile(candidate.times, 0.5), quantile(ratios, 0.5),
                quantile(ratios, 0.25), quantile(ratios, 0.75));
  }
  std::fflush(stdout);
}

template <class Number>
bool read(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && number > 0;
}

bool read_sizes(std::string_view text, std::vector<std::int64_t>& sizes) {
  sizes.clear();
  while (true) {
    const std::size_t comma = text.find(',');
    std::int64_t size = 0;
    if (!read(text.substr(0, comma), size)) return false;
    sizes.push_back(size);
    if (comma == std::string_view::npos) return true;
    text.remove_prefix(comma + 1);
  }
}

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view name = argv[i];
    if (name == "--periodic") {
      options.boundary = Boundary::periodic;
      continue;
    }
    if (i + 1 == argc) return false;
    const std::string_view value = argv[++i];
    if (name == "--sizes" && read_sizes(value, options.sizes)) continue;
    if (name == "--rounds" && read(value, options.rounds)) continue;
    if (name == "--threads" && read(value, options.threads)) continue;
    if (name == "--precision" && (value == "double" || value == "float" || value == "both")) {
      options.in_double = value != "float";
      options.in_float = value != "double";
      continue;
    }
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  if (!read_options(argc, argv, options)) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  std::printf("|     N | real   | method         |       ms | times as fast as the textbook |\n");
  std::printf("|------:|--------|----------------|---------:|-------------------------------|\n");
  for (const std::int64_t n : options.sizes) {
    if (options.in_double) compare<double>(options, n);
    if (options.in_float) compare<float>(options, n);
  }
  return 0;
}
