#include "run_folder.h"

#include <array>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "formats/formats.h"
#include "output/staged_file.h"

namespace brinell::cli {

void RunFolder::begin(const SceneFile& file) const {
  std::error_code error;
  const bool is_source = std::filesystem::equivalent(scene(), file.path, error);
  const std::array results{summary(), trace(), fields(), path_ / "fields.xdmf", checkpoint()};
  if (!std::filesystem::exists(origin(), error)) {
    const std::string expected = "; expected a new folder or that of an earlier run";
    if (!is_source && std::filesystem::exists(scene(), error)) {
      fail_file(path_, "holds another scene, " + scene().string() + expected);
    }
    for (const auto& result : results) {
      if (std::filesystem::exists(result, error)) {
        fail_file(path_, "holds a " + result.filename().string() + " that no run has written" + expected);
      }
    }
  }
  make_output_folder(path_);
  for (const auto& result : results) {
    std::filesystem::remove(result, error);
    if (error) fail_file(result, "cannot be replaced: " + error.message());
  }
  if (!is_source) write_file(scene(), file.bytes);
  const nlohmann::json source{{"scene", std::filesystem::absolute(file.path).lexically_normal().string()}};
  write_file(origin(), source.dump(2) + "\n");
}

SceneFile RunFolder::read_scene() const {
  if (!std::filesystem::exists(origin())) {
    fail_file(path_, "is not the folder of a run: it holds no run.json; expected what 'brinell run --out' wrote");
  }
  const auto source = nlohmann::json::parse(read_bytes(origin()), nullptr, false);
  if (!source.is_object() || !source.contains("scene") || !source["scene"].is_string()) {
    fail_file(origin(), "is damaged: it does not name the scene");
  }
  return parse_scene(source["scene"].get<std::string>(), read_bytes(scene()));
}

double RunFolder::earlier_seconds() const {
  if (!std::filesystem::exists(summary())) return 0;
  const auto values = nlohmann::json::parse(read_bytes(summary()), nullptr, false);
  if (!values.is_object() || !values.contains("wall_seconds") || !values["wall_seconds"].is_number()) return 0;
  return values["wall_seconds"].get<double>();
}

}  // namespace brinell::cli
