// bm_convolution/<method>/<instruction set>/<precision>/<boundary>/<N>/<threads>: one convolution of N × N nodes.
#include <benchmark/benchmark.h>

#include <string>

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

}  // namespace

int main(int argc, char** argv) {
  for (const std::int64_t n : {256, 512, 1024, 2048}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      register_size<double>("double", n, boundary);
      register_size<float>("float", n, boundary);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
