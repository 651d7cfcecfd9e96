// The program `brinell`: arguments, and how every kind of failure becomes a message and an exit status.
#include <brinell.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <functional>
#include <iostream>
#include <new>

#include "commands.h"
#include "errors.h"
#include "handles.h"
#include "words.h"

namespace {

using namespace brinell::cli;

int exit_status(brn_status status) {
  switch (status) {
    case BRN_INVALID_ARGUMENT:
    case BRN_INVALID_SCENE:
    case BRN_UNSUPPORTED:
    case BRN_NO_EQUILIBRIUM: return kBadScene;
    case BRN_NOT_CONVERGED: return kNotConverged;
    case BRN_CANCELLED: return kInterrupted;
    default: return kFileTrouble;
  }
}

int fail(int status, const std::string& message) {
  std::cout.flush();
  std::cerr << "brinell: " << message << "\n";
  return status;
}

int guarded(const std::function<int()>& command) {
  try {
    const int status = command();
    std::cout.flush();
    if (!std::cout) return fail(kFileTrouble, "standard output cannot be written");
    return status;
  } catch (const SceneError& error) {
    return fail(kBadScene, error.what());
  } catch (const FileError& error) {
    return fail(kFileTrouble, error.what());
  } catch (const EngineError& error) {
    return fail(exit_status(error.status()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(kFileTrouble, "there is not enough memory");
  } catch (const std::exception& error) {
    return fail(kFileTrouble, error.what());
  }
}

/// What is wrong with the arguments, in the form of all other messages, and where to read more.
std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  const auto commands = app->get_subcommands();
  if (!commands.empty()) {
    const std::string command = app->get_name() + " " + commands.front()->get_name();
    return command + ": " + error.what() + "\nTry: " + command + " --help\n";
  }
  std::vector<std::string> names;
  for (const auto* command : app->get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  const auto unknown = app->remaining();
  if (unknown.empty()) return app->help();
  return app->get_name() + ": '" + unknown.front() + "' is no command, the nearest is '" +
         nearest(unknown.front(), names) + "'; expected one of: " + joined(names) + "\n";
}

/// An empty path comes from a shell's variable that is not set; it never means the present folder.
CLI::Validator not_empty() {
  return {[](const std::string& path) { return path.empty() ? "the path is empty" : ""; }, ""};
}

class Program {
 public:
  Program() : app_("Semi-analytical contact mechanics of real surfaces", "brinell") {
    app_.set_version_flag("--version", std::string("brinell ") + brn_version());
    app_.require_subcommand(1);
    app_.failure_message(usage_message);
    app_.footer(
        "Exit status: 0 solved and certified, 1 not converged (bench: a figure beyond what is allowed), 2 bad usage "
        "or scene, 3 file or resource trouble,\n"
        "130 interrupted (state saved).");

    auto& run = add("run", "Solve a scene and write its results", [this] { return run_command(options_); });
    add_scene(run);
    run.add_option("--out", options_.out, "Folder of the results (default: out/ and the scene's name)")
        ->check(not_empty());
    add_run_flags(run);

    auto& plan = add("plan", "Print what a scene needs, before anything is solved",
                     [this] { return plan_command(options_.scene, options_.json); });
    add_scene(plan);
    plan.add_flag("--json", options_.json, "Print JSON");

    add_scene(add("check", "Check a scene and the files it names", [this] { return check_command(options_.scene); }));

    auto& resume = add("resume", "Go on with an interrupted run", [this] { return resume_command(options_); });
    resume.add_option("DIR", options_.out, "Folder of the run")->required()->check(not_empty());
    add_run_flags(resume);

    auto& report = add("report", "Draw a run's trace and pressure as SVG and PNG",
                       [this] { return report_command(options_.out); });
    report.add_option("DIR", options_.out, "Folder of the run")->required()->check(not_empty());

    auto& bench = add("bench", "Measure the cost of kernels and scenes against their baselines",
                      [this] { return bench_command(bench_); });
    bench.add_option("PROFILE", bench_.scenes,
                     "Scene files or folders, or the word kernels (default: kernels, and the scenes in profiles/)");
    bench.add_option("--rounds", bench_.rounds, "Runs of each scene; an odd number is rounded up, 0 times nothing")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    bench.add_option("--threads", bench_.threads, "At most so many threads; 0: all that the process may use")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    bench.add_option("--allowed", bench_.allowed, "Ratio to the baseline's time beyond which a figure fails")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    bench
        .add_option("--allowed-instructions", bench_.allowed_instructions,
                    "Ratio to the baseline's instructions beyond which a figure fails")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    bench.add_flag("!--no-instructions", bench_.instructions, "Count no instructions (which takes valgrind)");
    bench.add_option("--baselines", bench_.baselines,
                     "Folder that holds PROFILE/baseline.json (default: beside each scene, kernels in profiles/)");
    bench.add_flag("--update", bench_.update, "Record what is measured as the new baselines");
    bench.add_flag("--json", bench_.json, "Print JSON");
    bench.add_flag("--once", bench_.once)->group("");

    auto& info = add("info", "Print version, instruction set and threads, or the statistics of height maps",
                     [this] { return info_command(paths_, options_.json); });
    info.add_option("SURFACE", paths_, "Height maps");
    info.add_flag("--json", options_.json, "Print JSON");
  }

  int run(int count, char** arguments) {
    try {
      app_.parse(count, arguments);
    } catch (const CLI::ParseError& error) {
      return app_.exit(error, std::cout, std::cerr) == 0 ? kSolved : kBadScene;
    }
    return guarded(command_);
  }

 private:
  CLI::App& add(const std::string& name, const std::string& text, std::function<int()> command) {
    CLI::App& sub = *app_.add_subcommand(name, text);
    sub.set_version_flag("--version", std::string("brinell ") + brn_version());
    sub.callback([this, command = std::move(command)] { command_ = command; });
    return sub;
  }

  void add_scene(CLI::App& sub) {
    sub.add_option("SCENE", options_.scene, "TOML file, or a folder that holds scene.toml")
        ->required()
        ->check(not_empty());
  }

  void add_run_flags(CLI::App& sub) {
    sub.add_flag("--json", options_.json, "Print summary.json");
    add_threads(sub);
    sub.add_flag("--quiet", options_.quiet, "No progress and no table");
  }

  void add_threads(CLI::App& sub) {
    sub.add_option("--threads", options_.threads, "At most so many threads; 0: all that the process may use")
        ->check(CLI::Range(0, 1024));
  }

  CLI::App app_;
  RunOptions options_;
  std::vector<std::filesystem::path> paths_;
  BenchOptions bench_;
  std::function<int()> command_;
};

}  // namespace

int main(int count, char** arguments) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of the write like a full disk
  return Program().run(count, arguments);
}
