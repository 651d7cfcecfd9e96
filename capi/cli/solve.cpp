#include "solve.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <vector>

#include "interrupt.h"
#include "output/fields_file.h"
#include "output/staged_file.h"
#include "output/summary.h"
#include "progress.h"

namespace brinell::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kCheckpointInterval = std::chrono::seconds(30);

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Solve {
 public:
  Solve(const RunParts& parts, const RunOptions& options)
      : parts_(parts),
        options_(options),
        earlier_seconds_(parts.resumed ? parts.folder.earlier_seconds() : 0.0),
        progress_(options.quiet) {
    const auto& output = parts.file.output;
    if (output.fields.empty()) return;
    const bool keeps_earlier = parts.resumed && output.increments != StoredIncrements::last;
    fields_.emplace(parts.folder.path(),
                    FieldsGrid{parts.grid.nx, parts.grid.ny, parts.grid.dx, parts.grid.dy, depths_of(parts.run)},
                    keeps_earlier);
  }

  int solve() {
    const brn_status status = advance_to_end();
    progress_.clear();
    const bool is_failure = status != BRN_OK && status != BRN_NOT_CONVERGED && status != BRN_CANCELLED;
    const std::string message = status == BRN_OK ? "" : brn_run_message(parts_.run);
    if (!is_failure || solved() > 0) write_results(status);
    if (is_failure) throw EngineError(status, message);
    return report(status, message);
  }

 private:
  int solved() const { return brn_run_solved_increments(parts_.run); }
  int total() const { return brn_run_total_increments(parts_.run); }

  bool is_finished() const {
    return solved() == total() && increment_of(parts_.run, solved() - 1).stress_missing == 0;
  }

  brn_status advance_to_end() {
    while (!is_finished()) {
      if (interrupted()) return BRN_CANCELLED;
      const brn_status status = brn_run_advance(parts_.run, follow_progress, &progress_);
      if (status != BRN_OK && status != BRN_NOT_CONVERGED) return status;
      store_if_wanted();
      warn_if_cut_off();
      if (status != BRN_OK) return status;
      if (Clock::now() - saved_at_ > kCheckpointInterval && solved() < total()) save_checkpoint();
    }
    return BRN_OK;
  }

  void store_if_wanted() {
    const auto wanted = parts_.file.output.increments;
    const brn_increment increment = increment_of(parts_.run, solved() - 1);
    const bool ends_step = increment.increment + 1 == parts_.file.steps[increment.step].increments;
    if (wanted == StoredIncrements::all || (wanted == StoredIncrements::steps && ends_step)) store(increment);
  }

  void store(const brn_increment& increment) {
    if (!fields_) return;
    fields_->begin_increment(increment.step, increment.increment);
    std::vector<double> values;
    for (const auto& name : parts_.file.output.fields) {
      const FieldInfo info = field_info(name);
      if (info.is_below_surface() && increment.stress_missing != 0) continue;
      std::size_t count = 0;
      check(brn_run_get_field(parts_.run, info.id, nullptr, 0, &count), parts_.run);
      values.resize(count);
      check(brn_run_get_field(parts_.run, info.id, values.data(), values.size(), &count), parts_.run);
      const FieldKind kind = info.is_tensor()          ? FieldKind::tensor
                             : info.is_directions()    ? FieldKind::directions
                             : info.is_below_surface() ? FieldKind::scalar
                                                       : FieldKind::surface;
      fields_->add({name, kind}, info.unit, values);
    }
  }

  /// Contact beyond the grid is left out. A rough surface is cut off here and there on purpose; but where nearly all
  /// of the edge is in contact the grid is too small, or a modulus or force is not in Pa or N. Said once.
  void warn_if_cut_off() {
    const std::int64_t nx = parts_.grid.nx;
    const std::int64_t ny = parts_.grid.ny;
    if (warned_ || parts_.file.grid.periodic || nx < 3 || ny < 3) return;
    const std::int64_t edge = 2 * (nx + ny) - 4;
    const brn_increment increment = increment_of(parts_.run, solved() - 1);
    if (10 * increment.contact_nodes < 9 * edge) return;
    std::vector<double> pressure(static_cast<std::size_t>(nx * ny));
    std::size_t count = 0;
    check(brn_run_get_field(parts_.run, BRN_FIELD_PRESSURE, pressure.data(), pressure.size(), &count), parts_.run);
    std::int64_t touching = 0;
    for (std::int64_t j = 0; j < ny; ++j) {
      const bool is_end = j == 0 || j == ny - 1;
      for (std::int64_t i = 0; i < nx; i += is_end ? 1 : nx - 1) {
        if (pressure[static_cast<std::size_t>(j * nx + i)] > 0) ++touching;
      }
    }
    if (10 * touching < 9 * edge) return;
    warned_ = true;
    progress_.clear();
    std::cerr << "brinell: warning: step " << increment.step << ", increment " << increment.increment << ": "
              << touching << " of " << edge << " nodes on the edge of the grid are in contact, and contact beyond it "
              << "is left out; enlarge the grid, or check the units: moduli in Pa, forces in N, lengths in m\n";
  }

  void save_checkpoint() {
    write_file(parts_.folder.checkpoint(), save_run(parts_.run));
    saved_at_ = Clock::now();
  }

  void write_results(brn_status status) {
    if (fields_) {
      if (parts_.file.output.increments == StoredIncrements::last && solved() > 0) {
        store(increment_of(parts_.run, solved() - 1));
      }
      fields_->publish();
    }
    write_file(parts_.folder.trace(), trace_csv(parts_.run));
    save_checkpoint();
    summary_ = summary_json(parts_.file, parts_.engine, parts_.run, status == BRN_CANCELLED,
                            earlier_seconds_ + seconds_since(started_))
                   .dump(2) +
               "\n";
    write_file(parts_.folder.summary(), summary_);
  }

  int report(brn_status status, const std::string& message) const {
    if (options_.json) {
      std::cout << summary_;
    } else if (!options_.quiet) {
      std::cout << summary_table(parts_.run) << "results in " << parts_.folder.path().string() << "\n";
    }
    const std::string count = std::to_string(solved()) + " of " + std::to_string(total()) + " increments solved";
    if (status == BRN_CANCELLED) {
      std::cerr << "brinell: interrupted, " << count << "; go on with: brinell resume "
                << parts_.folder.path().string() << "\n";
      return kInterrupted;
    }
    if (status == BRN_NOT_CONVERGED) {
      std::cerr << "brinell: not converged, " << count << ": " << message << "\n";
      return kNotConverged;
    }
    return all_converged() ? kSolved : kNotConverged;
  }

  /// A resumed run may hold an increment that did not converge before.
  bool all_converged() const {
    for (int k = 0; k < solved(); ++k) {
      if (increment_of(parts_.run, k).converged == 0) return false;
    }
    return true;
  }

  const RunParts& parts_;
  const RunOptions& options_;
  double earlier_seconds_;
  ProgressLine progress_;
  std::optional<FieldsFile> fields_;
  std::string summary_;
  bool warned_ = false;
  Clock::time_point started_ = Clock::now();
  Clock::time_point saved_at_ = started_;
};

}  // namespace

int solve(const RunParts& parts, const RunOptions& options) {
  return Solve(parts, options).solve();
}

}  // namespace brinell::cli
