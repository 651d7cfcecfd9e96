#include "scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "errors.h"
#include "scratch_folder.h"

namespace brinell::cli {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kWhole = R"(title = "Nano-indentation"
[grid]
nodes = [128, 96]
spacing = [0.2e-6, 1]
layers = 64
layer_thickness = 0.1e-6
boundary = "free"
[lower]
youngs_modulus = 210e9
poissons_ratio = 0.3
[lower.hardening]
law = "swift"
B = 1240e6
C = 30
n = 0.085
depth_factor = [[0, 1.2], [1e-6, 1]]
[upper]
rigid = true
[[surface]]
shape = "sphere"
radius = 105e-6
profile = "exact"
[[surface]]
shape = "file"
path = "disk.gsf"
units = "um"
detrend = "plane"
[[step]]
normal_force = 0.65
increments = 25
eccentricity = [0.0, 1e-6]
[[step]]
approach = 0
increments = 10
traction_ratio = [0.3, 0]
[solver]
tolerance = 1e-9
max_iterations = 100
precision = "mixed"
increment_tolerance = 1e-3
threads = 2
[output]
fields = ["pressure", "stress"]
increments = "all"
)";

/// A valid scene with one line exchanged.
std::string with(const std::string& line, const std::string& replacement) {
  std::string text = kWhole;
  const auto at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size(), replacement);
}

std::string refusal(const std::string& text) {
  return message_of<SceneError>([&] { parse_scene("folder/scene.toml", text); });
}

TEST(SceneFile, reads_the_keys_of_the_contract) {
  const SceneFile scene = parse_scene("folder/scene.toml", kWhole);
  EXPECT_EQ(scene.title, "Nano-indentation");
  EXPECT_THAT(scene.grid.nodes.value(), ElementsAre(128, 96));
  EXPECT_THAT(scene.grid.spacing.value(), ElementsAre(0.2e-6, 1.0));
  EXPECT_EQ(scene.grid.layers, 64);
  EXPECT_EQ(scene.grid.layer_thickness, 0.1e-6);
  EXPECT_FALSE(scene.grid.periodic);
  EXPECT_EQ(scene.lower.youngs_modulus, 210e9);
  EXPECT_EQ(scene.lower.poissons_ratio, 0.3);
  ASSERT_TRUE(scene.lower.hardening);
  EXPECT_EQ(scene.lower.hardening->law, "swift");
  EXPECT_EQ(scene.lower.hardening->numbers.at("C"), 30);
  EXPECT_EQ(scene.lower.hardening->depth_factor[1][0], 1e-6);
  EXPECT_TRUE(scene.upper.rigid);
  ASSERT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.surfaces[0].numbers.at("radius"), 105e-6);
  EXPECT_TRUE(scene.surfaces[0].exact);
  EXPECT_EQ(scene.surfaces[1].path, "folder/disk.gsf");
  EXPECT_EQ(scene.surfaces[1].units, "um");
  EXPECT_EQ(scene.surfaces[1].detrend, "plane");
  ASSERT_EQ(scene.steps.size(), 2U);
  EXPECT_EQ(scene.steps[0].normal_force.value(), 0.65);
  EXPECT_EQ(scene.steps[0].increments, 25);
  EXPECT_THAT(scene.steps[0].eccentricity.value(), ElementsAre(0, 1e-6));
  EXPECT_EQ(scene.steps[1].approach.value(), 0);
  EXPECT_THAT(scene.steps[1].traction_ratio.value(), ElementsAre(0.3, 0));
  EXPECT_EQ(scene.solver.tolerance, 1e-9);
  EXPECT_EQ(scene.solver.max_iterations, 100);
  EXPECT_TRUE(scene.solver.mixed);
  EXPECT_EQ(scene.solver.increment_tolerance, 1e-3);
  EXPECT_EQ(scene.solver.threads, 2);
  EXPECT_THAT(scene.output.fields, ElementsAre("pressure", "stress"));
  EXPECT_EQ(scene.output.increments, StoredIncrements::all);
}

TEST(SceneFile, fills_in_defaults) {
  const SceneFile scene = parse_scene("scene.toml", R"(
[lower]
youngs_modulus = 1
poissons_ratio = 0
[[surface]]
shape = "plane"
[[step]]
approach = 1e-6)");
  EXPECT_FALSE(scene.grid.nodes);
  EXPECT_TRUE(scene.upper.rigid);
  EXPECT_EQ(scene.steps[0].increments, 1);
  EXPECT_EQ(scene.solver.tolerance, 1e-8);
  EXPECT_EQ(scene.solver.max_iterations, 2000);
  EXPECT_EQ(scene.solver.increment_tolerance, 0);
  EXPECT_EQ(scene.solver.threads, 0);
  EXPECT_EQ(scene.output.increments, StoredIncrements::last);
}

TEST(SceneFile, names_unknown_keys_with_line_and_nearest_key) {
  EXPECT_THAT(refusal(with("spacing", "spaceing")), AllOf(HasSubstr("scene.toml:4:"), HasSubstr("[grid]"),
                                                          HasSubstr("'spaceing'"), HasSubstr("'spacing'")));
  EXPECT_THAT(refusal(with("normal_force", "force")),
              AllOf(HasSubstr("scene.toml:29:"), HasSubstr("unknown key 'force'")));
  EXPECT_THAT(refusal(with("increments = 25", "increment = 25")),
              AllOf(HasSubstr("scene.toml:30:"), HasSubstr("[[step]] 1"), HasSubstr("'increments'")));
  EXPECT_THAT(refusal(with("[solver]", "[slover]")), AllOf(HasSubstr(":36:"), HasSubstr("'solver'")));
  EXPECT_THAT(refusal(with("C = 30", "D = 30\nC = 30")), AllOf(HasSubstr(":14:"), HasSubstr("[lower.hardening]")));
  // A key of another shape is unknown here.
  EXPECT_THAT(refusal(with("radius = 105e-6", "radius = 105e-6\ntip_radius = 1")),
              AllOf(HasSubstr("'tip_radius'"), HasSubstr("'radius'")));
}

TEST(SceneFile, names_wrong_types_with_what_was_found_and_wanted) {
  EXPECT_THAT(refusal(with("radius = 105e-6", "radius = \"big\"")),
              AllOf(HasSubstr("scene.toml:21: [[surface]] 1"), HasSubstr("\"big\""), HasSubstr("expected a number"),
                    HasSubstr("found a text")));
  EXPECT_THAT(refusal(with("[128, 96]", "[128.0, 96]")),
              AllOf(HasSubstr(":3:"), HasSubstr("whole number"), HasSubstr("found a number")));
  EXPECT_THAT(refusal(with("[128, 96]", "128")), AllOf(HasSubstr("nodes = 128"), HasSubstr("[x, y]")));
  EXPECT_THAT(refusal(with("[128, 96]", "[1, 2, 3]")), HasSubstr("found 3 values"));
  EXPECT_THAT(refusal(with("rigid = true", "rigid = 1")), HasSubstr("expected true or false"));
  EXPECT_THAT(refusal(with("[upper]\nrigid = true", "[[upper]]\nrigid = true")), HasSubstr("a table [upper]"));
  EXPECT_THAT(refusal(with("\"pressure\"", "3")), HasSubstr("an array of texts"));
  EXPECT_THAT(refusal(with("title = \"Nano-indentation\"", "title = 1979-05-27")), HasSubstr("a date"));
}

TEST(SceneFile, names_values_out_of_range) {
  EXPECT_THAT(refusal(with("[128, 96]", "[128, 0]")), AllOf(HasSubstr("nodes = [128, 0]"), HasSubstr("from 1")));
  EXPECT_THAT(refusal(with("[0.2e-6, 1]", "[0.2e-6, 0]")), HasSubstr("above 0"));
  EXPECT_THAT(refusal(with("[0.2e-6, 1]", "[-1, 1]")), HasSubstr("above 0"));
  EXPECT_THAT(refusal(with("[0.2e-6, 1]", "[nan, 1]")), HasSubstr("finite"));
  EXPECT_THAT(refusal(with("= 0.3\n", "= 0.5\n")),
              AllOf(HasSubstr("poissons_ratio = 0.5"), HasSubstr("above -1 and below 0.5")));
  EXPECT_THAT(refusal(with("= 0.3\n", "= -1\n")), HasSubstr("above -1"));
  EXPECT_THAT(refusal(with("210e9", "-210e9")), HasSubstr("above 0"));
  EXPECT_THAT(refusal(with("0.65", "-0.65")), AllOf(HasSubstr("normal_force = -0.65"), HasSubstr("at least 0")));
  EXPECT_THAT(refusal(with("0.65", "inf")), HasSubstr("finite"));
  EXPECT_THAT(refusal(with("increments = 25", "increments = 0")), HasSubstr("from 1"));
  EXPECT_THAT(refusal(with("1e-9", "1")), HasSubstr("1e-14 to 0.1"));
  EXPECT_THAT(refusal(with("\"mixed\"", "\"singel\"")), HasSubstr("double, mixed"));
  EXPECT_THAT(refusal(with("\"sphere\"", "\"spere\"")),
              AllOf(HasSubstr("nearest is 'sphere'"), HasSubstr("flat_punch")));
  EXPECT_THAT(refusal(with("\"stress\"]", "\"mises\"]")), AllOf(HasSubstr("'mises'"), HasSubstr("von_mises")));
  EXPECT_THAT(refusal(with("\"um\"", "\"inch\"")), AllOf(HasSubstr("units = \"inch\""), HasSubstr("unit of length")));
}

TEST(SceneFile, wants_exactly_one_drive) {
  EXPECT_THAT(refusal(with("normal_force = 0.65", "")), AllOf(HasSubstr(":28: [[step]] 1"), HasSubstr("found none")));
  EXPECT_THAT(refusal(with("normal_force = 0.65", "normal_force = 1\napproach = 0")), HasSubstr("found 2"));
  EXPECT_THAT(refusal(with("normal_force = 0.65", "mean_pressure = 1")), HasSubstr("periodic"));
  EXPECT_THAT(refusal(with("eccentricity = [0.0, 1e-6]", "eccentricity = [0, 0]\ntilt = [0, 0]")), HasSubstr("both"));
}

TEST(SceneFile, reads_where_the_force_acts_or_the_slopes) {
  const auto steps = [](const std::string& step) {
    const ScratchFolder folder;
    folder.write("scene.toml", with("eccentricity = [0.0, 1e-6]", step));
    return read_scene(folder.path()).steps;
  };
  EXPECT_THAT(steps("eccentricity = [-2e-6, 0]")[0].eccentricity.value(), ElementsAre(-2e-6, 0));
  EXPECT_FALSE(steps("eccentricity = [-2e-6, 0]")[0].tilt);
  EXPECT_THAT(steps("tilt = [1e-5, -3]")[0].tilt.value(), ElementsAre(1e-5, -3));
  EXPECT_FALSE(steps("tilt = [1e-5, -3]")[0].eccentricity);
  EXPECT_FALSE(steps("")[0].eccentricity || steps("")[0].tilt);
  EXPECT_THAT(refusal(with("[0.0, 1e-6]", "0.0")), AllOf(HasSubstr("eccentricity = 0"), HasSubstr("[x, y]")));
  EXPECT_THAT(refusal(with("[0.0, 1e-6]", "[\"a\", 0]")), AllOf(HasSubstr("eccentricity"), HasSubstr("number")));
  EXPECT_THAT(refusal(with("eccentricity = [0.0, 1e-6]", "tilt = [0]")),
              AllOf(HasSubstr("[[step]] 1"), HasSubstr("tilt"), HasSubstr("found 1 value")));
  EXPECT_THAT(refusal(with("eccentricity = [0.0, 1e-6]", "tilt = [nan, 0]")), HasSubstr("finite"));
}

TEST(SceneFile, reads_whose_surfaces_move_and_by_how_much) {
  const SceneFile scene = parse_scene("scene.toml", with("profile = \"exact\"", "body = \"lower\""));
  EXPECT_EQ(scene.surfaces[0].body, "lower");
  EXPECT_EQ(scene.surfaces[1].body, "");
  EXPECT_FALSE(scene.steps[0].offset);
  const SceneFile moved = parse_scene("scene.toml", with("[0.0, 1e-6]", "[0.0, 1e-6]\noffset = [-2e-6, 3]"));
  EXPECT_THAT(moved.steps[0].offset.value(), ElementsAre(-2e-6, 3));
  EXPECT_THAT(refusal(with("profile = \"exact\"", "body = \"uper\"")),
              AllOf(HasSubstr(":22:"), HasSubstr("'upper'")));
  EXPECT_THAT(refusal(with("[0.0, 1e-6]", "[0.0, 1e-6]\noffset = 2e-6")),
              AllOf(HasSubstr("offset = "), HasSubstr("[x, y]")));
  EXPECT_THAT(refusal(with("[0.0, 1e-6]", "[0.0, 1e-6]\noffset = [inf, 0]")), HasSubstr("finite"));
}

TEST(SceneFile, wants_its_parts_to_fit) {
  EXPECT_THAT(refusal(with("radius = 105e-6", "")),
              AllOf(HasSubstr("[[surface]] 1"), HasSubstr("radius is missing")));
  EXPECT_THAT(refusal(with("poissons_ratio = 0.3", "")), HasSubstr("poissons_ratio is missing"));
  EXPECT_THAT(refusal(with("rigid = true", "rigid = true\nyoungs_modulus = 1")), HasSubstr("has no meaning"));
  EXPECT_THAT(refusal(with("layers = 64", "layers = 64\nlayer_depths = [0, 1]")), HasSubstr("either"));
  const std::string rigid = "[lower]\nrigid = true\n[[surface]]\nshape = \"plane\"\n[[step]]\napproach = 0\n";
  EXPECT_THAT(refusal(rigid), AllOf(HasSubstr("scene.toml:1:"), HasSubstr("both bodies are rigid")));
  EXPECT_THAT(refusal("[lower]\nyoungs_modulus = 1\npoissons_ratio = 0\n"), HasSubstr("at least one [[surface]]"));
}

TEST(SceneFile, names_the_line_of_broken_toml) {
  EXPECT_THAT(refusal("a = 1\nb = = 2\n"), HasSubstr("folder/scene.toml:2:"));
  EXPECT_THAT(refusal("a = 1\na = 2\n"), HasSubstr("scene.toml:2:"));
  EXPECT_THAT(refusal("title = \"\xff\""), HasSubstr("scene.toml:1:"));
}

TEST(SceneFile, may_be_a_folder) {
  const ScratchFolder folder;
  EXPECT_THAT(message_of<FileError>([&] { read_scene(folder.path()); }), HasSubstr("scene.toml: no such file"));
  folder.write("scene.toml", kWhole);
  const SceneFile scene = read_scene(folder.path());
  EXPECT_EQ(scene.surfaces[1].path, folder.path() / "disk.gsf");
  EXPECT_EQ(scene.bytes, kWhole);
}

}  // namespace
}  // namespace brinell::cli
