#include "bench/baseline.h"

#include <brinell.h>

#include <array>
#include <ctime>
#include <fstream>

#include "errors.h"
#include "output/staged_file.h"

namespace brinell::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Model name, family and model of the processor: hypervisors often shorten the name.
std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  std::string name = "unknown processor", family, model;
  for (std::string line; std::getline(file, line) && !line.empty();) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon + 2 > line.size()) continue;
    const std::string key = line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
    const std::string value = line.substr(colon + 2);
    if (key == "model name") name = value;
    if (key == "cpu family") family = value;
    if (key == "model") model = value;
  }
  return family.empty() ? name : name + ", family " + family + " model " + model;
}

std::string compiler() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#elif defined(__GNUC__)
  return std::string("gcc ") + __VERSION__;
#else
  return "unknown compiler";
#endif
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm day{};
  gmtime_r(&now, &day);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &day);
  return text.data();
}

}  // namespace

std::string Circumstances::in_words() const {
  return date + " (brinell " + version + ", " + compiler + ", " + machine + ", " + isa + ", " +
         std::to_string(threads) + (threads == 1 ? " thread)" : " threads)");
}

Circumstances present_circumstances(const std::string& isa, int threads) {
  return {today(), brn_version(), compiler(), machine(), isa, threads};
}

std::optional<Baseline> read_baseline(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  try {
    const Json json = Json::parse(file);
    const Json& recorded = json.at("recorded");
    return Baseline{{recorded.at("date"), recorded.at("version"), recorded.at("compiler"), recorded.at("machine"),
                     recorded.at("isa"), recorded.at("threads")},
                    json.at("figures")};
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path.string() + " is no baseline: " + error.what());
  }
}

void write_baseline(const std::filesystem::path& path, const Baseline& baseline) {
  const Circumstances& on = baseline.recorded;
  const Json json{{"recorded",
                   {{"date", on.date},
                    {"version", on.version},
                    {"compiler", on.compiler},
                    {"machine", on.machine},
                    {"isa", on.isa},
                    {"threads", on.threads}}},
                  {"figures", baseline.figures}};
  make_output_folder(path.parent_path());
  write_file(path, json.dump(2) + "\n");
}

}  // namespace brinell::cli
