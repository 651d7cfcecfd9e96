#include "subsurface/stress_field.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "simd/kernel_table.h"

namespace brinell::subsurface {

namespace {

constexpr std::int64_t kNodesOfChunk = 4096;  // six components of a chunk stay in the nearest caches

constexpr const char* kComponentNames[] = {"xx", "yy", "zz", "yz", "xz", "xy"};
constexpr const char* kInvariantNames[] = {"von_mises",   "tresca",      "hydrostatic",
                                           "principal_1", "principal_2", "principal_3"};
constexpr const char* kTractionNames[] = {"pressure", "shear_x", "shear_y"};

/// Layers of one array: the caller's, or those of the batch and, where maxima are looked for, the one before them.
class LayerArray {
 public:
  LayerArray() = default;
  LayerArray(double* whole, std::size_t nodes) : whole_(whole), nodes_(nodes) {}
  LayerArray(std::int64_t batch, bool and_before, std::size_t nodes)
      : own_(Buffer<double>::uninitialised(static_cast<std::size_t>(batch + (and_before ? 1 : 0)) * nodes)),
        nodes_(nodes),
        before_(and_before ? 1 : 0) {}

  bool empty() const { return nodes_ == 0; }

  /// Layers from `first` on come next.
  void begin_batch(std::int64_t first) {
    if (before_ != 0 && first > first_) std::copy_n(at(first - 1), nodes_, own_.data());
    first_ = first;
  }
  double* at(std::int64_t layer) {
    if (whole_ != nullptr) return whole_ + static_cast<std::size_t>(layer) * nodes_;
    return own_.data() + static_cast<std::size_t>(layer - first_ + before_) * nodes_;
  }

 private:
  double* whole_ = nullptr;
  Buffer<double> own_;
  std::size_t nodes_ = 0;
  std::int64_t before_ = 0;  // layers of own_ before the batch
  std::int64_t first_ = 0;
};

void require(const void* array, bool needed, const std::string& what) {
  if (needed && array == nullptr) fail(Status::invalid_argument, what + ": the array is missing");
}

}  // namespace

/// State of one call.
struct StressField::Work {
  std::int64_t first = 0, last = 0;  // layers of the batch
  std::array<fft::SourceTransform<double>, kTractions> sources;
  std::vector<LayerSpectra> streamed;  // of the batch
  std::array<LayerArray, kComponents> component;
  std::array<LayerArray, kInvariants> invariant;
  std::array<LayerArray, 9> direction;
  std::array<std::vector<double>, kInvariants> chunk_largest;  // [layer of the batch][chunk]
  std::vector<MaximumSearch> search;                           // by Invariant
};

StressField::StressField(const fft::Backend& backend, StressRequest request, std::size_t spectra_limit)
    : backend_(backend),
      request_(std::move(request)),
      plan_(plan_stress(backend, request_, spectra_limit)),
      index_(request_.sources, plan_.needed),
      one_thread_(std::make_unique<parallel::Arena>(1)),
      serial_backend_{*one_thread_, backend.kernels, backend.plans},
      convolution_(inner_backend(), request_.grid.nx, request_.grid.ny, request_.boundary),
      kept_(static_cast<std::size_t>(plan_.kept_layers)) {
  workers_.resize(plan_.threads_inside ? 1 : static_cast<std::size_t>(backend.arena.threads()));
}

void StressField::for_tasks(std::int64_t count, FunctionRef<void(std::int64_t task, Worker& worker)> body) {
  const auto ready = [this](int slot) -> Worker& {
    Worker& worker = workers_[static_cast<std::size_t>(slot)];
    if (worker.workspace == nullptr) worker.workspace = convolution_.workspace();
    return worker;
  };
  if (plan_.threads_inside) {
    for (std::int64_t task = 0; task < count; ++task) body(task, ready(0));
    return;
  }
  backend_.arena.for_chunks(count, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    for (std::int64_t task = begin; task < end; ++task) body(task, ready(slot));
  });
}

const LayerSpectra& StressField::spectra_of(const Work& work, std::int64_t layer) const {
  return layer < plan_.kept_layers ? kept_[static_cast<std::size_t>(layer)]
                                   : work.streamed[static_cast<std::size_t>(layer - work.first)];
}

Maxima StressField::compute(const Tractions& tractions, const StressFields& fields) {
  for (std::size_t c = 0; c < kComponents; ++c) {
    require(fields.component[c], request_.components.has(static_cast<int>(c)),
            std::string("field of stress ") + kComponentNames[c]);
  }
  for (std::size_t k = 0; k < kInvariants; ++k) {
    require(fields.invariant[k], request_.invariants.has(static_cast<int>(k)),
            std::string("field of ") + kInvariantNames[k]);
  }
  for (std::size_t k = 0; k < 9; ++k) {
    require(fields.direction[k], request_.directions, "field " + std::to_string(k) + " of the principal directions");
  }
  return run(tractions, fields, nullptr);
}

Maxima StressField::compute_by_layer(const Tractions& tractions, FunctionRef<void(const StressLayer&)> take) {
  return run(tractions, {}, &take);
}

Maxima StressField::run(const Tractions& tractions, const StressFields& fields,
                        const FunctionRef<void(const StressLayer&)>* take) {
  for (int t = 0; t < kTractions; ++t) {
    require(tractions[static_cast<std::size_t>(t)], request_.sources.has(t), kTractionNames[t]);
  }
  const std::size_t nodes = request_.grid.nodes();
  const auto array = [&](double* whole, bool stored, bool computed, bool and_before = false) {
    if (stored && whole != nullptr) return LayerArray(whole, nodes);
    return computed ? LayerArray(plan_.batch, and_before, nodes) : LayerArray();
  };
  Work work;
  for (int c = 0; c < kComponents; ++c) {
    const auto at = static_cast<std::size_t>(c);
    work.component[at] = array(fields.component[at], request_.components.has(c), plan_.needed.has(c));
  }
  const Invariants wanted = request_.invariants | request_.maxima;
  for (int k = 0; k < kInvariants; ++k) {
    const auto at = static_cast<std::size_t>(k);
    work.invariant[at] =
        array(fields.invariant[at], request_.invariants.has(k), wanted.has(k), request_.maxima.has(k));
    work.search.emplace_back(request_.grid, request_.boundary, request_.depths);
  }
  for (std::size_t k = 0; k < 9; ++k) {
    work.direction[k] = array(fields.direction[k], request_.directions, request_.directions);
  }

  transform_sources(tractions, work);
  for (work.first = 0; work.first < plan_.layers; work.first = work.last) {
    work.last = std::min(work.first + plan_.batch, plan_.layers);
    for (LayerArray& one : work.invariant) one.begin_batch(work.first);
    for (LayerArray& one : work.component) one.begin_batch(work.first);
    for (LayerArray& one : work.direction) one.begin_batch(work.first);
    generate(work);
    convolve(work);
    evaluate_invariants(work);
    finish_layers(work, take);
  }
  Maxima maxima{};
  for (int k = 0; k < kInvariants; ++k) {
    if (request_.maxima.has(k))
      maxima[static_cast<std::size_t>(k)] = work.search[static_cast<std::size_t>(k)].result();
  }
  return maxima;
}

void StressField::transform_sources(const Tractions& tractions, Work& work) {
  const std::size_t nodes = request_.grid.nodes();
  for_tasks(kTractions, [&](std::int64_t t, Worker& worker) {
    if (!request_.sources.has(static_cast<int>(t))) return;
    const double* source = tractions[static_cast<std::size_t>(t)];
    Buffer<double> reaction;
    if (request_.body == Body::upper && static_cast<Traction>(t) != Traction::pressure) {
      reaction = Buffer<double>::uninitialised(nodes);
      std::transform(source, source + nodes, reaction.data(), [](double shear) { return -shear; });
      source = reaction.data();
    }
    work.sources[static_cast<std::size_t>(t)] = convolution_.transform(source, *worker.workspace);
  });
}

void StressField::generate(Work& work) {
  const auto count = static_cast<std::size_t>(index_.count());
  std::vector<std::pair<std::int64_t, Traction>> tasks;
  work.streamed.resize(static_cast<std::size_t>(plan_.batch));
  std::vector<LayerSpectra*> target;
  for (std::int64_t layer = work.first; layer < work.last; ++layer) {
    const bool keep = layer < plan_.kept_layers;
    LayerSpectra& spectra =
        keep ? kept_[static_cast<std::size_t>(layer)] : work.streamed[static_cast<std::size_t>(layer - work.first)];
    target.push_back(&spectra);
    if (keep && !spectra.empty()) continue;
    spectra.resize(count);
    for (int t = 0; t < kTractions; ++t) {
      if (index_.generates(t)) tasks.emplace_back(layer, static_cast<Traction>(t));
    }
  }
  const auto forget = [&] {
    for (const auto& [layer, traction] : tasks) target[static_cast<std::size_t>(layer - work.first)]->clear();
  };
  const auto one = [&](std::int64_t task, Worker& worker) {
    const auto& [layer, traction] = tasks[static_cast<std::size_t>(task)];
    if (worker.coefficients.empty() && request_.boundary == Boundary::free) {
      worker.coefficients = Buffer<double>::uninitialised(kComponents * request_.grid.nodes());
    }
    generate_spectra(inner_backend(), convolution_, request_, request_.depths[static_cast<std::size_t>(layer)],
                     traction, index_, worker.coefficients, *worker.workspace,
                     *target[static_cast<std::size_t>(layer - work.first)]);
  };
  try {
    for_tasks(static_cast<std::int64_t>(tasks.size()), one);
  } catch (...) {  // spectra that are there are taken for complete
    forget();
    throw;
  }
}

void StressField::convolve(Work& work) {
  for_tasks((work.last - work.first) * kComponents, [&](std::int64_t task, Worker& worker) {
    const std::int64_t layer = work.first + task / kComponents;
    const int component = static_cast<int>(task % kComponents);
    if (!plan_.needed.has(component)) return;
    const LayerSpectra& spectra = spectra_of(work, layer);
    std::array<fft::Term<double>, kTractions> terms{};
    std::size_t count = 0;
    for (int t = 0; t < kTractions; ++t) {
      if (!request_.sources.has(t)) continue;
      terms[count++] = {&work.sources[static_cast<std::size_t>(t)],
                        &spectra[static_cast<std::size_t>(index_.of(t, component))]};
    }
    convolution_.apply(std::span<const fft::Term<double>>(terms.data(), count),
                       work.component[static_cast<std::size_t>(component)].at(layer), *worker.workspace);
  });
}

void StressField::evaluate_invariants(Work& work) {
  const Invariants wanted = request_.invariants | request_.maxima;
  if (wanted.empty() && !request_.directions) return;
  const auto nodes = static_cast<std::int64_t>(request_.grid.nodes());
  const std::int64_t chunks = (nodes + kNodesOfChunk - 1) / kNodesOfChunk;
  const std::int64_t tasks = chunks * (work.last - work.first);
  for (std::vector<double>& largest : work.chunk_largest) largest.resize(static_cast<std::size_t>(tasks));
  backend_.arena.for_chunks(tasks, 1, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t task = begin; task < end; ++task) {
      const std::int64_t layer = work.first + task / chunks, from = task % chunks * kNodesOfChunk;
      const auto n = static_cast<std::size_t>(std::min(kNodesOfChunk, nodes - from));
      const auto place = [&](LayerArray& array) { return array.empty() ? nullptr : array.at(layer) + from; };
      simd::StressArrays stress;
      InvariantArrays result;
      for (std::size_t c = 0; c < kComponents; ++c) stress.component[c] = place(work.component[c]);
      for (std::size_t k = 0; k < kInvariants; ++k) result.invariant[k] = place(work.invariant[k]);
      for (std::size_t k = 0; k < 9; ++k) result.direction[k] = place(work.direction[k]);
      fill_invariants(backend_.kernels, n, stress, result);
      for (std::size_t k = 0; k < kInvariants; ++k) {
        if (!request_.maxima.has(static_cast<int>(k))) continue;
        work.chunk_largest[k][static_cast<std::size_t>(task)] =
            backend_.kernels.subsurface.largest(n, result.invariant[k]);
      }
    }
  });
}

void StressField::finish_layers(Work& work, const FunctionRef<void(const StressLayer&)>* take) {
  for (std::int64_t layer = work.first; layer < work.last; ++layer) {
    for (int k = 0; k < kInvariants; ++k) {
      if (!request_.maxima.has(k)) continue;
      const auto at = static_cast<std::size_t>(k);
      const std::vector<double>& all = work.chunk_largest[at];
      const std::size_t chunks = all.size() / static_cast<std::size_t>(work.last - work.first);
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(chunks) * (layer - work.first);
      const double largest = *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(chunks));
      LayerArray& values = work.invariant[at];
      work.search[at].take(values.at(layer), largest, layer > 0 ? values.at(layer - 1) : nullptr);
    }
    if (take == nullptr) continue;
    StressLayer shown{layer, request_.depths[static_cast<std::size_t>(layer)], {}, {}, {}};
    for (int c = 0; c < kComponents; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (request_.components.has(c)) shown.component[at] = work.component[at].at(layer);
    }
    for (int k = 0; k < kInvariants; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (request_.invariants.has(k)) shown.invariant[at] = work.invariant[at].at(layer);
    }
    for (std::size_t k = 0; request_.directions && k < 9; ++k) shown.direction[k] = work.direction[k].at(layer);
    (*take)(shown);
  }
}

}  // namespace brinell::subsurface
