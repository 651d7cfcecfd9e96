// bm_convolution/<method>/<instruction set>/<precision>/<boundary>/<N>/<threads>: one convolution of N × N nodes.
// bm_spectrum/<made or cached>/<N>: influence coefficients and their spectrum, for a grid that is new or known.
#include <benchmark/benchmark.h>

#include <string>

#include "fft/plan_cache.h"
#include "influence/spectra.h"
#include "kernels/convolution_case.h"
#include "kernels/textbook_convolution.h"

namespace {

using namespace brinell;

template <class Real, class Convolution>
void repeat(benchmark::State& state, Convolution& convolution, std::int64_t n) {
  const auto source = bench::random_source<Real>(n);
  std::vector<Real> result(source.size());
  for (auto _ : state) {
    convolution.apply(source.data(), result.data());
    benchmark::DoNotOptimize(result.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * n * n);
}

template <class Real>
void register_size(const std::string& precision, std::int64_t n, Boundary boundary) {
  const std::string kind = precision + (boundary == Boundary::free ? "/free/" : "/periodic/") + std::to_string(n);
  benchmark::RegisterBenchmark(("bm_convolution/textbook/fftw/" + kind + "/1").c_str(), [n, boundary](
                                                                                            benchmark::State& state) {
    bench::TextbookConvolution<Real> convolution(n, n, boundary);
    repeat<Real>(state, convolution, n);
  })->MeasureProcessCPUTime();
  const auto add = [&](const std::string& method, fft::Method carrier, simd::Isa isa, int threads) {
    const std::string name =
        "bm_convolution/" + method + "/" + std::string(simd::name(isa)) + "/" + kind + "/" + std::to_string(threads);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) {
                                   bench::ConvolutionCase<Real> convolution(n, boundary, carrier, isa, threads);
                                   repeat<Real>(state, convolution, n);
                                 })
        ->MeasureProcessCPUTime()
        ->UseRealTime();
  };
  for (const int threads : {1, 2}) {
    add("fftw", fft::Method::fftw, simd::Isa::baseline, threads);
    for (const simd::Isa isa : simd::supported()) add("lanes", fft::Method::lanes, isa, threads);
  }
}

/// By one thread, with the best instruction set.
void bm_spectrum(benchmark::State& state, std::int64_t n, bool cached) {
  const parallel::Arena arena(1);
  fft::PlanCache plans;
  const fft::Backend backend{arena, simd::kernels(simd::supported().back()), plans};
  const Grid grid{n, n, 1, 1};
  const fft::Convolution<double> convolution(backend, n, n, Boundary::free);
  influence::SpectrumCache kept(std::size_t{1} << 30), none(0);
  for (auto _ : state) {
    const auto spectrum =
        influence::displacement_spectrum(cached ? kept : none, backend, convolution, grid, Boundary::free);
    benchmark::DoNotOptimize(spectrum.get());
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::int64_t n : {256, 512, 1024, 2048}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      register_size<double>("double", n, boundary);
      register_size<float>("float", n, boundary);
    }
    for (const bool cached : {false, true}) {
      benchmark::RegisterBenchmark(
          ("bm_spectrum/" + std::string(cached ? "cached/" : "made/") + std::to_string(n)).c_str(), bm_spectrum, n,
          cached)
          ->MeasureProcessCPUTime();
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
