#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "errors.h"
#include "output/fields_file.h"
#include "output/staged_file.h"
#include "scratch_folder.h"
#include "surface_file.h"

namespace brinell::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Files cannot grow past a number of bytes while this lives, which is how a full disk looks to a program.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

std::vector<double> ramp(std::size_t size) {
  std::vector<double> values(size);
  for (std::size_t k = 0; k < size; ++k) values[k] = 1e-9 * static_cast<double>(k * k % 1009);
  return values;
}

TEST(WriteFile, leaves_a_whole_file_and_nothing_else) {
  const ScratchFolder folder;
  folder.write("a.json", "before");
  write_file(folder.path() / "a.json", "after");
  EXPECT_EQ(ScratchFolder::read(folder.path() / "a.json"), "after");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(WriteFile, keeps_what_was_there_when_the_disk_is_full) {
  const ScratchFolder folder;
  const auto path = folder.write("a.json", "before");
  std::string message;
  {
    const SmallFiles limit(100);
    message = message_of<FileError>([&] { write_file(path, std::string(1000, 'x')); });
  }
  EXPECT_THAT(message, AllOf(HasSubstr("a.json"), HasSubstr("cannot be written")));
  EXPECT_EQ(ScratchFolder::read(path), "before");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(MakeOutputFolder, names_a_folder_that_cannot_be) {
  const ScratchFolder folder;
  make_output_folder(folder.path() / "a" / "b");
  make_output_folder(folder.path() / "a" / "b");
  const auto file = folder.write("file", "");
  for (const auto& path : {file, file / "below"}) {
    EXPECT_THAT(message_of<FileError>([&] { make_output_folder(path); }), HasSubstr(path.string()));
  }
}

TEST(FieldsFile, holds_what_was_added_with_unit_and_spacing) {
  const ScratchFolder folder;
  const auto values = ramp(300 * 700);  // more than one chunk
  {
    FieldsFile file(folder.path(), {700, 300, 1e-6, 2e-6, {}});
    file.begin_increment(0, 3);
    file.add({"gap"}, "m", values);
    file.publish();
  }
  EXPECT_EQ(folder.entries(), 2);
  const HeightMap map = read_surface(folder.path() / "fields.h5:/step_0/increment_3/gap");
  EXPECT_EQ(map.nx, 700);
  EXPECT_EQ(map.ny, 300);
  EXPECT_EQ(map.dx, 1e-6);
  EXPECT_EQ(map.dy, 2e-6);
  EXPECT_EQ(map.heights, values);
  EXPECT_THAT(message_of<SceneError>([&] {
                read_surface(folder.path() / "fields.h5:/step_0/increment_3/gap", {"nm", "", false});
              }),
              HasSubstr("'m'"));
}

TEST(FieldsFile, goes_on_after_what_is_there) {
  const ScratchFolder folder;
  const auto values = ramp(6);
  for (const int increment : {2, 10}) {
    FieldsFile file(folder.path(), {3, 2, 1, 1, {}}, true);
    file.begin_increment(0, increment);
    file.add({"gap"}, "m", values);
    file.publish();
  }
  for (const char* place : {"fields.h5:/step_0/increment_2/gap", "fields.h5:/step_0/increment_10/gap"}) {
    EXPECT_EQ(read_surface(folder.path() / place).heights, values);
  }
  const std::string xdmf = ScratchFolder::read(folder.path() / "fields.xdmf");
  EXPECT_LT(xdmf.find("increment_2/gap"), xdmf.find("increment_10/gap"));
}

TEST(FieldsFile, leaves_nothing_unless_published) {
  const ScratchFolder folder;
  {
    FieldsFile file(folder.path(), {3, 2, 1, 1, {}});
    file.begin_increment(0, 0);
    file.add({"gap"}, "m", ramp(6));
  }
  EXPECT_EQ(folder.entries(), 0);
}

TEST(FieldsFile, leaves_nothing_when_the_disk_is_full) {
  const ScratchFolder folder;
  std::vector<double> noise(512 * 512);
  std::uint64_t state = 1;
  for (double& value : noise) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    value = static_cast<double>(state >> 11);
  }
  // From a limit that stops the first byte to one that stops only the last ones.
  for (const rlim_t limit : {1U, 1000U, 100'000U, 1'000'000U}) {
    std::string message;
    {
      const SmallFiles small(limit);
      message = message_of<FileError>([&] {
        FieldsFile file(folder.path(), {512, 512, 1, 1, {}});
        file.begin_increment(0, 0);
        file.add({"gap"}, "m", noise);
        file.publish();
      });
    }
    EXPECT_THAT(message, AllOf(HasSubstr("fields.h5"), HasSubstr("cannot be written"))) << limit;
    EXPECT_EQ(folder.entries(), 0) << limit;
  }
}

TEST(Xdmf, places_fields_and_names_its_neighbour) {
  const std::vector<StoredIncrement> increments{{0,
                                                 0,
                                                 {{"pressure"},
                                                  {"von_mises", FieldKind::scalar},
                                                  {"stress", FieldKind::tensor},
                                                  {"principal_directions", FieldKind::directions}}}};
  const std::string even = xdmf_text("fields.h5", {4, 3, 2.0, 1.0, {0.5, 1.5}}, increments);
  EXPECT_THAT(even, AllOf(HasSubstr("fields.h5:/step_0/increment_0/pressure"), HasSubstr("Dimensions=\"1 3 4\""),
                          HasSubstr("Dimensions=\"2 3 4\""), HasSubstr(">0 -1 -3<"), HasSubstr(">0.5 -1 -3<"),
                          HasSubstr(">1 1 2<"), HasSubstr("stress_yz"), HasSubstr("0 0 0 5 1 1 1 1 2 3 4 1"),
                          HasSubstr("principal_directions_3"), HasSubstr("Vector"),
                          HasSubstr("0 0 0 6 1 1 1 1 2 3 4 3"), HasSubstr("Dimensions=\"2 3 4 9\"")));
  const std::string uneven = xdmf_text("fields.h5", {4, 3, 2.0, 1.0, {0, 1, 3}}, increments);
  EXPECT_THAT(uneven,
              AllOf(HasSubstr("VXVYVZ"), HasSubstr(">0 1 3<"), HasSubstr(">-3 -1 1 3<"), HasSubstr(">-1 0 1<")));
}

}  // namespace
}  // namespace brinell::cli
