// Whole contact solves side by side. Each candidate has a process of its own, warm and with a peak memory of its
// own; all take turns, round after round, so that whatever else the machine does falls on all of them alike.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "measure/statistics.h"
#include "measure/worker.h"
#include "solve/candidate.h"

namespace {

using namespace brinell;
using bench::SolveMethod;
using bench::SolveSample;

struct Options {
  std::vector<std::string> scenes{"rough_5", "rough_20", "sphere", "periodic_5"};
  std::vector<std::int64_t> sizes{1024};
  std::vector<double> tolerances{1e-6};
  std::vector<SolveMethod> methods{SolveMethod::textbook, SolveMethod::in_double, SolveMethod::mixed};
  std::vector<int> threads{1};
  simd::Isa isa = simd::supported().back();
  int repeats = 6;
  std::int64_t textbook_largest = 1024;
  double seconds = 10;
  std::string csv;
};

struct Row {
  bench::SolveCase which;
  SolveSample solution{};
  double cold_seconds = 0;  // of the first solve, which fills the spectra
  std::vector<double> seconds{};
  std::size_t peak_bytes = 0;
  double ratio = 0;                // first candidate's time / this one's; NaN without one
  double approach_difference = 0;  // relative, to the first candidate's

  double time() const { return bench::median(seconds); }
};

/// All candidates of one scene, size and tolerance.
std::vector<Row> compare(const Options& options, const bench::SolveScene& scene, std::int64_t nodes, double tolerance,
                         bench::SolveInputs& inputs) {
  const bench::SolveInput input = inputs.make(scene, nodes);
  const bool wall = *std::max_element(options.threads.begin(), options.threads.end()) > 1;
  std::vector<Row> rows;
  std::vector<bench::Worker<SolveSample>> workers;
  for (const SolveMethod method : options.methods) {
    const bool textbook = method == SolveMethod::textbook;
    if (textbook && nodes > options.textbook_largest) continue;
    for (const int threads : options.threads) {
      if (textbook && threads != options.threads.front()) continue;
      const bench::SolveCase which{&scene, nodes, method, options.isa, textbook ? 1 : threads, tolerance};
      rows.push_back({which});
      workers.emplace_back(
          [=] { return bench::prepare(which, input, wall ? bench::Clock::wall : bench::Clock::cpu); });
    }
  }
  for (int round = 0; round <= options.repeats; ++round) {  // the first turn fills the caches
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Row& row = rows[k];
      const bool textbook = row.which.method == SolveMethod::textbook;
      if (textbook && round == 0) continue;  // its set-up has filled everything
      // Long turns vary less: a few tell as much.
      if (round > 1 && row.seconds.front() * round > options.seconds) continue;
      row.solution = workers[k].run();
      if (round == 0) {
        row.cold_seconds = row.solution.seconds;
      } else {
        row.seconds.push_back(row.solution.seconds);
      }
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].peak_bytes = workers[k].peak_bytes();
    rows[k].ratio = rows[0].time() / rows[k].time();
    rows[k].approach_difference = std::fabs(rows[k].solution.approach / rows[0].solution.approach - 1);
  }
  return rows;
}

void print_head() {
  std::printf(
      "| scene | nodes | tolerance | contact %% | method | threads | iterations | convolutions | seconds | first | "
      "times as fast | certificate | approach differs | memory MB |\n"
      "|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
}

void print(const Row& row) {
  const auto& which = row.which;
  const std::string n = std::to_string(which.nodes);
  const auto cold = row.cold_seconds > 0 ? CLI::detail::to_string(std::round(row.cold_seconds * 1e4) / 1e4) : "";
  std::printf("| %s | %s² | %.0e | %.1f | %s | %d | %d | %d | %.4f | %s | %.1f | %.1e%s | %.0e | %.0f |\n",
              which.scene->name.c_str(), n.c_str(), which.tolerance, 100 * row.solution.contact_fraction,
              name(which.method), which.threads, row.solution.iterations, row.solution.convolutions, row.time(),
              cold.c_str(), row.ratio, row.solution.certificate, row.solution.converged != 0 ? "" : " (failed)",
              row.approach_difference, static_cast<double>(row.peak_bytes) / 1e6);
  std::fflush(stdout);
}

/// How cost grows from each size to the next.
void print_growth(const std::vector<Row>& rows) {
  std::printf(
      "\n| scene | tolerance | method | threads | nodes | iterations | ns per node | iterations grow | time per node "
      "grows |\n|---|--:|---|--:|--:|--:|--:|--:|--:|\n");
  const auto same = [](const Row& a, const Row& b) {
    return a.which.scene == b.which.scene && a.which.method == b.which.method && a.which.threads == b.which.threads &&
           a.which.tolerance == b.which.tolerance;
  };
  const auto per_node = [](const Row& row) {
    return 1e9 * row.time() / static_cast<double>(row.which.nodes * row.which.nodes);
  };
  std::vector<bool> shown(rows.size(), false);
  for (std::size_t first = 0; first < rows.size(); ++first) {
    const Row* before = nullptr;
    for (std::size_t k = first; k < rows.size(); ++k) {
      if (shown[k] || !same(rows[first], rows[k])) continue;
      shown[k] = true;
      const Row& row = rows[k];
      std::printf("| %s | %.0e | %s | %d | %lld² | %d | %.0f |", row.which.scene->name.c_str(), row.which.tolerance,
                  name(row.which.method), row.which.threads, static_cast<long long>(row.which.nodes),
                  row.solution.iterations, per_node(row));
      if (before != nullptr) {
        std::printf(" %.2f | %.2f |\n",
                    static_cast<double>(row.solution.iterations) / static_cast<double>(before->solution.iterations),
                    per_node(row) / per_node(*before));
      } else {
        std::printf(" | |\n");
      }
      before = &row;
    }
  }
}

void write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream file(path);
  file << "scene,nodes,tolerance,method,isa,threads,contact_fraction,iterations,convolutions,seconds,first_seconds,"
          "ratio,certificate,approach,peak_bytes\n";
  file.precision(10);
  for (const Row& row : rows) {
    file << row.which.scene->name << ',' << row.which.nodes << ',' << row.which.tolerance << ','
         << name(row.which.method) << ',' << simd::name(row.which.isa) << ',' << row.which.threads << ','
         << row.solution.contact_fraction << ',' << row.solution.iterations << ',' << row.solution.convolutions << ','
         << row.time() << ',' << row.cold_seconds << ',' << row.ratio << ',' << row.solution.certificate << ','
         << row.solution.approach << ',' << row.peak_bytes << '\n';
  }
  if (!file.flush()) throw std::runtime_error(path + " cannot be written");
}

void compare_all(const Options& options) {
  bench::SolveInputs inputs(*std::max_element(options.sizes.begin(), options.sizes.end()));
  std::vector<Row> rows;
  print_head();
  for (const std::string& scene : options.scenes) {
    for (const std::int64_t nodes : options.sizes) {
      for (const double tolerance : options.tolerances) {
        for (Row& row : compare(options, bench::solve_scene(scene), nodes, tolerance, inputs)) {
          print(row);
          rows.push_back(std::move(row));
        }
      }
    }
  }
  if (options.sizes.size() > 1) print_growth(rows);
  if (!options.csv.empty()) write_csv(options.csv, rows);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Whole contact solves, this engine beside the textbook, as Markdown tables.\n"
      "Seconds are medians of process CPU time, or of wall time where a candidate has several threads;\n"
      "'times as fast' is against the first candidate of the same scene, size and tolerance.",
      "compare_solve");
  std::vector<std::string> names;
  for (const auto& scene : bench::solve_scenes()) names.push_back(scene.name);
  const std::map<std::string, SolveMethod> methods{
      {"textbook", SolveMethod::textbook}, {"double", SolveMethod::in_double}, {"mixed", SolveMethod::mixed}};
  std::map<std::string, simd::Isa> isas;
  for (const simd::Isa isa : simd::supported()) isas.emplace(simd::name(isa), isa);
  app.add_option("--scenes", options.scenes, "Scenes")->delimiter(',')->check(CLI::IsMember(names));
  app.add_option("--sizes", options.sizes, "n of n x n nodes (1024)")->delimiter(',')->check(CLI::Range(2, 16384));
  app.add_option("--tolerances", options.tolerances, "On the certificate (1e-6)")
      ->delimiter(',')
      ->check(CLI::Range(1e-14, 0.1));
  app.add_option("--methods", options.methods, "textbook,double,mixed")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(methods));
  app.add_option("--threads", options.threads, "Of this engine's methods (1)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  app.add_option("--isa", options.isa, "Instruction set (the best)")->transform(CLI::CheckedTransformer(isas));
  app.add_option("--repeats", options.repeats, "Timed rounds (6)")->check(CLI::Range(1, 1000));
  app.add_option("--textbook-largest", options.textbook_largest, "Largest n that the textbook solves (1024)");
  app.add_option("--seconds", options.seconds, "After that, a candidate takes no further turns (10)");
  app.add_option("--csv", options.csv, "Writes the rows to this file too");
  CLI11_PARSE(app, argc, argv);
  try {
    compare_all(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_solve: %s\n", error.what());
    return 3;
  }
  return 0;
}
