// The saved state of a run: "BRNRUN", version, byte order, fingerprint of the scene, increments, trace, pressure, and
// a checksum of all that at the end.
#include <cstring>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/fingerprint.h"
#include "scene/run.h"

namespace brinell::scene {

namespace {

constexpr char kMagic[8] = {'B', 'R', 'N', 'R', 'U', 'N', '\0', '\0'};
constexpr std::uint32_t kVersion = 6;  // of the layout below
constexpr std::uint32_t kByteOrder = 0x01020304;

[[noreturn]] void damaged(const std::string& why) {
  fail(Status::damaged_data, "saved run: " + why);
}

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    put_bytes(&value, sizeof value);
  }
  void put_bytes(const void* data, std::size_t size) {
    if (size == 0) return;  // nothing may be at no address
    const std::size_t before = bytes.size();
    bytes.resize(before + size);
    std::memcpy(bytes.data() + before, data, size);
  }
  std::vector<std::byte> bytes;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
  template <class T>
  void get(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    get_bytes(&value, sizeof value);
  }
  void get_bytes(void* data, std::size_t size) {
    if (size > left_.size()) damaged("it is truncated");
    if (size == 0) return;
    std::memcpy(data, left_.data(), size);
    left_ = left_.subspan(size);
  }
  std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::byte> left_;
};

/// Calls visit with every member, for writing and for reading alike.
template <class I, class Visit>
void members(I& increment, const Visit& visit) {
  visit(increment.position.step);
  visit(increment.position.increment);
  visit(increment.converged);
  visit(increment.iterations);
  visit(increment.convolutions);
  visit(increment.contact_nodes);
  visit(increment.normal_force);
  visit(increment.approach);
  for (auto& value : increment.tilt) visit(value);
  for (auto& value : increment.centre_of_force) visit(value);
  visit(increment.first_touch);
  visit(increment.contact_area);
  visit(increment.max_pressure);
  for (auto& value : increment.max_pressure_at) visit(value);
  visit(increment.mean_gap);
  for (auto& largest : increment.max_von_mises) {
    visit(largest.value);
    for (auto& value : largest.at) visit(value);
  }
  visit(increment.stress_missing);
  visit(increment.certificate.penetration);
  visit(increment.certificate.complementarity);
  visit(increment.certificate.tension);
  visit(increment.certificate.balance);
  visit(increment.yield);
  visit(increment.substeps);
  visit(increment.increment_error);
  for (auto& body : increment.plastic) {
    visit(body.largest);
    for (auto& value : body.at) visit(value);
    visit(body.cuboids);
  }
  visit(increment.wall_seconds);
}

template <class P, class Visit>
void trace_members(P& point, const Visit& visit) {
  visit(point.position.step);
  visit(point.position.increment);
  visit(point.iteration);
  visit(point.certified);
  visit(point.nx);
  visit(point.ny);
  visit(point.seconds);
  visit(point.certificate);
}

template <class S, class Visit>
void plastic_members(S& state, const Visit& visit) {
  visit(state.last_was_force);
  visit(state.last_change);
  visit(state.last_error);
  visit(state.total);
  visit(state.approach);
}

template <class S, class Visit>
void body_members(S& state, const Visit& visit) {
  visit(state.region.i0);
  visit(state.region.j0);
  visit(state.region.box.nx);
  visit(state.region.box.ny);
  visit(state.region.box.nz);
}

void put_plastic(Writer& out, const plastic::ElasticPlastic::State& state) {
  const auto put = [&](const auto& value) { out.put(value); };
  plastic_members(state, put);
  for (const auto& body : state.bodies) {
    if (!body) continue;
    body_members(*body, put);
    for (const Buffer<double>* field : {&body->strain, &body->increment, &body->stress, &body->equivalent}) {
      put(static_cast<std::uint64_t>(field->size()));
      out.put_bytes(field->data(), field->size() * sizeof(double));
    }
  }
}

plastic::ElasticPlastic::State get_plastic(Reader& in, const Scene& scene) {
  plastic::ElasticPlastic::State state;
  const auto get = [&](auto& value) { in.get(value); };
  plastic_members(state, get);
  for (const Which which : {Which::lower, Which::upper}) {
    if (!scene.hardens(which) || (which == Which::upper && scene.identical())) continue;
    plastic::PlasticBody::State& body = state.bodies[static_cast<std::size_t>(which)].emplace();
    body_members(body, get);
    plastic::Box& box = body.region.box;
    const Grid& grid = scene.grid();
    const bool fits = body.region.i0 >= 0 && body.region.j0 >= 0 && box.nx >= 0 && box.ny >= 0 && box.nz >= 0 &&
                      box.nx <= grid.nx - body.region.i0 && box.ny <= grid.ny - body.region.j0 &&
                      box.nz <= scene.layers().count;
    if (!fits) damaged("its plastic strain lies outside the scene");
    if (!body.region.empty()) {
      box.dx = grid.dx;
      box.dy = grid.dy;
      box.dz = scene.layers().thickness;
    }
    const std::size_t stride = plastic::PlasticBody::stride_of(box);
    for (auto [field, size] : {std::pair{&body.strain, 6 * stride}, std::pair{&body.increment, 6 * stride},
                               std::pair{&body.stress, 6 * stride}, std::pair{&body.equivalent, stride}}) {
      std::uint64_t count = 0;
      in.get(count);
      if (count != size || count > in.left() / sizeof(double)) damaged("its plastic strain is not that of its box");
      *field = Buffer<double>::uninitialised(count);
      in.get_bytes(field->data(), count * sizeof(double));
    }
  }
  return state;
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
  Fingerprint sum;
  sum.add_bytes(bytes.data(), bytes.size());
  return sum.value();
}

}  // namespace

std::vector<std::byte> Run::save() const {
  Writer out;
  out.bytes.reserve(scene_.grid().nodes() * sizeof(double) +
                    (trace_.size() + increments_.size() + 8) * sizeof(Increment));
  out.put_bytes(kMagic, sizeof kMagic);
  out.put(kVersion);
  out.put(kByteOrder);
  out.put(scene_.fingerprint());
  out.put(static_cast<std::uint64_t>(increments_.size()));
  const auto put = [&](const auto& value) { out.put(value); };
  for (const Increment& increment : increments_) members(increment, put);
  out.put(static_cast<std::uint64_t>(trace_.size()));
  for (const TracePoint& point : trace_) trace_members(point, put);
  put(step_origin_.force);
  put(step_origin_.approach);
  put(solving_seconds_);
  for (const double seconds : stage_seconds_) put(seconds);
  if (!increments_.empty()) {
    if (plastic_ != nullptr) put_plastic(out, plastic_->state());
    const contact::Solver::State state = solver_->state();
    put(state.total);
    put(state.approach);
    put(state.slope_x);
    put(state.slope_y);
    out.put(static_cast<std::uint64_t>(state.pressure.size()));
    out.put_bytes(state.pressure.data(), state.pressure.size() * sizeof(double));
  }
  out.put(checksum(out.bytes));
  return std::move(out.bytes);
}

std::unique_ptr<Run> Run::load(Engine& engine, const Scene& scene, std::span<const std::byte> bytes) {
  Reader in(bytes);
  char magic[sizeof kMagic];
  in.get_bytes(magic, sizeof magic);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0) damaged("the data are not of a saved run");
  std::uint32_t version = 0;
  std::uint32_t byte_order = 0;
  in.get(version);
  in.get(byte_order);
  if (byte_order != kByteOrder) damaged("it was saved on a machine of another byte order");
  if (version != kVersion) {
    damaged("its layout has version " + std::to_string(version) + "; this release reads version " +
            std::to_string(kVersion));
  }
  if (bytes.size() < sizeof(std::uint64_t)) damaged("it is truncated");
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  if (sum != checksum(bytes.first(bytes.size() - sizeof sum)))
    damaged("its checksum does not match: it is truncated or altered");

  auto run = std::make_unique<Run>(engine, scene);
  std::uint64_t fingerprint = 0;
  in.get(fingerprint);
  if (fingerprint != scene.fingerprint()) damaged("it belongs to another scene");
  std::uint64_t count = 0;
  in.get(count);
  if (count > static_cast<std::uint64_t>(run->total())) damaged("it holds more increments than the scene has");
  const auto get = [&](auto& value) { in.get(value); };
  run->increments_.resize(count);
  for (Increment& increment : run->increments_) members(increment, get);
  in.get(count);
  if (count > in.left() / sizeof(double)) damaged("it is truncated");
  run->trace_.resize(count);
  for (TracePoint& point : run->trace_) trace_members(point, get);
  get(run->step_origin_.force);
  get(run->step_origin_.approach);
  get(run->solving_seconds_);
  for (double& seconds : run->stage_seconds_) get(seconds);
  if (run->increments_.empty()) return run;

  run->prepare();
  plastic::ElasticPlastic::State plastic;
  if (run->plastic_ != nullptr) plastic = get_plastic(in, scene);
  contact::Solver::State state;
  get(state.total);
  get(state.approach);
  get(state.slope_x);
  get(state.slope_y);
  in.get(count);
  if (count != (state.total > 0 ? scene.grid().nodes() : 0)) damaged("its grid is not the scene's");
  state.pressure = Buffer<double>::uninitialised(count);
  in.get_bytes(state.pressure.data(), count * sizeof(double));
  if (run->plastic_ == nullptr) {
    run->solver_->restore(state);
  } else {
    plastic.contact = std::move(state);
    run->plastic_->restore(plastic);
  }
  return run;
}

}  // namespace brinell::scene
