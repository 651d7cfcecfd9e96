// bench: what scenes and kernels cost, as ratios to calibrations measured in turn and as counted instructions, and
// whether that is more than in their baselines. Scenes are solved without writing anything.
#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/baseline.h"
#include "bench/instructions.h"
#include "bench/timing.h"
#include "commands.h"
#include "errors.h"
#include "scene_builder.h"

namespace brinell::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKernels = "kernels";
constexpr std::int64_t kSmallNodes = 256 * 256;  // of elastic bodies: up to here valgrind takes seconds
constexpr int kKernelTurns = 3;                  // of each kernel in a round: they are short
constexpr int kSecondLooks = 2;  // at a figure that fails: a burst of other work passes, a cause stays

/// One cost of a profile or kernel, beside that of its baseline.
struct Figure {
  std::string name;
  Json now;            // as baseline.json holds it
  double seconds = 0;  // 0: counted, not timed
  Band against{};      // now / baseline; all 0 without one
  double allowed = 0;
  std::string not_compared{};  // why, if it was not

  bool fails() const { return not_compared.empty() && against.low > allowed; }
};

/// What shares a baseline.json: a profile, or all kernels.
struct Group {
  std::string name;
  std::filesystem::path baseline;
  std::filesystem::path scene_path;  // empty: kernels
  Scene scene{};
  bool small = false;
  std::vector<std::string> names{};  // of the figures that are timed
  std::vector<Timing> timings{};
  Json facts{};  // of the last solution
  std::vector<Figure> figures{};
};

/// "kernels", and the folders in profiles/ that hold scenes, in the order of their names.
std::vector<std::filesystem::path> known_profiles() {
  std::vector<std::filesystem::path> scenes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("profiles", error)) {
    if (std::filesystem::exists(entry.path() / "scene.toml")) scenes.push_back(entry.path());
  }
  if (scenes.empty()) throw FileError("there is no folder profiles/ with scenes here; name the scenes to time");
  std::sort(scenes.begin(), scenes.end());
  scenes.insert(scenes.begin(), kKernels);
  return scenes;
}

double solve_once(brn_engine* engine, const brn_scene* scene, Json& facts) {
  const double start = seconds_now(engine);
  const Run run = make_run(engine, scene);
  check(brn_run_execute(run.get(), nullptr, nullptr), run.get());
  const double seconds = seconds_now(engine) - start;
  int iterations = 0;
  double certificate = 0;
  const int increments = brn_run_solved_increments(run.get());
  for (int k = 0; k < increments; ++k) {
    const brn_increment increment = increment_of(run.get(), k);
    iterations += increment.iterations;
    certificate = std::max(
        {certificate, increment.penetration, increment.complementarity, increment.tension, increment.balance});
    if (increment.yield > certificate) certificate = increment.yield;
  }
  facts = {{"increments", increments}, {"iterations", iterations}, {"certificate", certificate}};
  return seconds;
}

double run_kernel(brn_engine* engine, int index) {
  double seconds = 0;
  const brn_status status = brn_benchmark_run(engine, index, &seconds);
  if (status != BRN_OK) throw EngineError(status, brn_engine_message(engine));
  return seconds;
}

Group kernels_group(const BenchOptions& options, brn_engine* engine) {
  const std::filesystem::path folder = options.baselines.empty() ? "profiles" : options.baselines;
  Group group{kKernels, folder / kKernels / "baseline.json", {}};
  for (int k = 0; k < brn_benchmark_count(); ++k) {
    if (brn_benchmark_calibration(k) == k) continue;
    group.names.emplace_back(brn_benchmark_name(k));
    group.timings.emplace_back(engine, brn_benchmark_calibration(k), [=] { return run_kernel(engine, k); });
  }
  return group;
}

Group scene_group(const BenchOptions& options, const std::filesystem::path& path) {
  const std::string name = scene_name(path);
  const auto folder = options.baselines.empty() ? scene_path(path).parent_path() : options.baselines / name;
  Group group{name, folder / "baseline.json", path};
  const SceneFile scene = read_scene(path);
  BuiltScene built = build_scene(scene);
  const bool hardens = scene.lower.hardening.has_value() || scene.upper.hardening.has_value();
  group.small = !hardens && built.grid.nx * built.grid.ny <= kSmallNodes;
  group.scene = std::move(built.scene);
  group.names = {"time"};
  return group;
}

void measure(std::vector<Group>& groups, const BenchOptions& options, brn_engine* engine) {
  for (Group& group : groups) {  // here the groups stay where they are
    if (group.scene_path.empty()) continue;
    group.timings.emplace_back(engine, 0,
                               [&group, engine] { return solve_once(engine, group.scene.get(), group.facts); });
    if (options.rounds > 0) solve_once(engine, group.scene.get(), group.facts);  // fills the engine's caches
  }
  // Rounds are interleaved, so that a disturbance of the machine meets all alike.
  const int rounds = options.rounds + options.rounds % 2;
  for (int round = 0; round < rounds; ++round) {
    for (Group& group : groups) {
      const int turns = group.scene_path.empty() ? kKernelTurns : 1;
      for (Timing& timing : group.timings) {
        for (int turn = 0; turn < turns; ++turn) timing.measure();
      }
    }
  }
}

Figure timed_figure(const std::string& name, const Timing& timing, double allowed) {
  const Band ratio = timing.ratio();
  Figure figure{name, {{"ratio", ratio.middle}, {"calibration", timing.calibration()}}};
  figure.seconds = timing.seconds();
  figure.against = ratio;
  figure.allowed = allowed;
  return figure;
}

/// Turns figure.against from what was measured into its ratio to the baseline.
void compare(Figure& figure, const std::optional<Baseline>& baseline, const Circumstances& now) {
  const Band measured = figure.against;
  figure.against = {};
  const bool counted = figure.now.contains("count");
  if (!baseline) {
    figure.not_compared = "no baseline";
  } else if (!baseline->figures.contains(figure.name)) {
    figure.not_compared = "not in the baseline";
  } else {
    const Circumstances& then = baseline->recorded;
    const Json& before = baseline->figures.at(figure.name);
    const auto differs = [&](const std::string& what, const std::string& was) {
      figure.not_compared = "recorded " + what + " " + was;
    };
    if (then.compiler != now.compiler) return differs("with", then.compiler);
    if (counted) {
      if (before.at("isa") != figure.now.at("isa")) return differs("with", before.at("isa"));
    } else {
      if (then.machine != now.machine) return differs("on", then.machine);
      if (then.isa != now.isa) return differs("with", then.isa);
      if (then.threads != now.threads) return differs("with threads:", std::to_string(then.threads));
    }
    const double base = before.at(counted ? "count" : "ratio").get<double>();
    figure.against = {measured.low / base, measured.middle / base, measured.high / base};
  }
}

void evaluate(Group& group, const BenchOptions& options, const Circumstances& now) {
  const std::optional<Baseline> baseline = read_baseline(group.baseline);
  for (std::size_t k = 0; k < group.timings.size(); ++k) {
    if (options.rounds == 0) break;
    Timing& timing = group.timings[k];
    Figure figure = timed_figure(group.names[k], timing, options.allowed);
    compare(figure, baseline, now);
    for (int look = 0; look < kSecondLooks && figure.fails() && !options.update; ++look) {
      timing.forget();
      const int turns = 2 * options.rounds * (group.scene_path.empty() ? kKernelTurns : 1);
      for (int turn = 0; turn < turns; ++turn) timing.measure();
      figure = timed_figure(group.names[k], timing, options.allowed);
      compare(figure, baseline, now);
    }
    group.figures.push_back(figure);
  }
  if (group.small && options.instructions) {
    if (const auto counted = count_instructions(group.scene_path)) {
      const auto count = static_cast<double>(counted->count);
      Figure figure{"instructions", {{"count", counted->count}, {"isa", counted->isa}}};
      figure.against = {count, count, count};
      figure.allowed = options.allowed_instructions;
      compare(figure, baseline, now);
      group.figures.push_back(figure);
    } else {
      std::cerr << "brinell: valgrind is not installed: instructions of " << group.name << " are not counted\n";
    }
  }
  for (const Figure& figure : group.figures) {
    if (!figure.fails() || options.update) continue;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  " costs %.3f times (%.3f to %.3f) what it did, %.3f is allowed; baseline of ",
                  figure.against.middle, figure.against.low, figure.against.high, figure.allowed);
    std::cerr << "brinell: " << group.name << ": " << figure.name << text.data() << baseline->recorded.in_words()
              << "\n";
  }
  if (!options.update) return;
  // What was not measured this time stays, if it was recorded under the same circumstances.
  Baseline updated{now, Json::object()};
  const bool same = baseline && baseline->recorded.compiler == now.compiler &&
                    baseline->recorded.machine == now.machine && baseline->recorded.isa == now.isa &&
                    baseline->recorded.threads == now.threads;
  if (same) updated.figures = baseline->figures;
  for (const Figure& figure : group.figures) updated.figures[figure.name] = figure.now;
  write_baseline(group.baseline, updated);
}

Json json_of(const std::vector<Group>& groups) {
  Json list = Json::array();
  for (const Group& group : groups) {
    Json figures = Json::array();
    for (const Figure& figure : group.figures) {
      Json one{{"name", figure.name}};
      one.update(figure.now);
      if (figure.seconds > 0) one["median_seconds"] = figure.seconds;
      if (figure.not_compared.empty()) {
        one["against_baseline"] = figure.against.middle;
        one["band"] = {figure.against.low, figure.against.high};
        one["allowed"] = figure.allowed;
        one["passed"] = !figure.fails();
      } else {
        one["not_compared"] = figure.not_compared;
      }
      figures.push_back(one);
    }
    Json one{{"name", group.name}};
    if (group.facts.is_object()) one.update(group.facts);
    one["figures"] = figures;
    list.push_back(one);
  }
  return list;
}

void print_table(const std::vector<Group>& groups) {
  std::cout << "seconds     to calibration  instructions    against baseline          figure\n";
  for (const Group& group : groups) {
    for (const Figure& figure : group.figures) {
      std::array<char, 200> line{};
      std::string columns;
      if (figure.seconds > 0) {
        std::snprintf(line.data(), line.size(), "%-10.4g  %-14.4g  %-14s  ", figure.seconds,
                      figure.now["ratio"].get<double>(), "");
      } else {
        std::snprintf(line.data(), line.size(), "%-10s  %-14s  %-14lld  ", "", "",
                      static_cast<long long>(figure.now["count"].get<std::int64_t>()));
      }
      columns = line.data();
      if (figure.not_compared.empty()) {
        std::snprintf(line.data(), line.size(), "%.3f (%.3f to %.3f)    ", figure.against.middle, figure.against.low,
                      figure.against.high);
      } else {
        std::snprintf(line.data(), line.size(), "%-24s  ", figure.not_compared.c_str());
      }
      std::cout << columns << line.data() << group.name << ": " << figure.name << (figure.fails() ? "  FAILS" : "")
                << "\n";
    }
  }
}

}  // namespace

int bench_command(const BenchOptions& options) {
  const Engine engine = make_engine(options.threads);
  if (options.once) {
    for (const auto& path : options.scenes) {
      Json facts;
      solve_once(engine.get(), build_scene(read_scene(path)).scene.get(), facts);
    }
    std::cout << brn_engine_isa_name(engine.get()) << "\n";
    return kSolved;
  }
  std::vector<Group> groups;
  for (const auto& path : options.scenes.empty() ? known_profiles() : options.scenes) {
    groups.push_back(path == kKernels ? kernels_group(options, engine.get()) : scene_group(options, path));
  }
  const Circumstances now =
      present_circumstances(brn_engine_isa_name(engine.get()), brn_engine_threads(engine.get()));
  measure(groups, options, engine.get());
  for (Group& group : groups) evaluate(group, options, now);
  const bool failed = std::any_of(groups.begin(), groups.end(), [](const Group& group) {
    return std::any_of(group.figures.begin(), group.figures.end(), [](const Figure& f) { return f.fails(); });
  });
  if (options.json) {
    std::cout << Json{{"version", now.version},
                      {"compiler", now.compiler},
                      {"machine", now.machine},
                      {"isa", now.isa},
                      {"threads", now.threads},
                      {"rounds", options.rounds},
                      {"passed", options.update || !failed},
                      {"scenes", json_of(groups)}}
                     .dump(2)
              << "\n";
  } else {
    print_table(groups);
  }
  return failed && !options.update ? kTooSlow : kSolved;
}

}  // namespace brinell::cli
