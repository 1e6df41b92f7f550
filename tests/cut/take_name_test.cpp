#include <gtest/gtest.h>

#include "picture_files.h"
#include "streaming/cut/output/part_name.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// A file with a text, or a folder with such a file in it.
class TakeName : public testing::TestWithParam<bool> {
 protected:
  void write(const std::string& name, const std::string& text) const {
    if (GetParam()) fs::create_directory(folder_ / name);
    write_bytes(file(name), std::as_bytes(std::span(text)));
  }
  [[nodiscard]] std::string read(const fs::path& name) const {
    const auto bytes = read_bytes(file(name));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  [[nodiscard]] fs::path file(const fs::path& name) const {
    return GetParam() ? folder_ / name.string() / "text" : folder_ / name.string();
  }

  ScratchFolder folder_;
};

TEST_P(TakeName, TheOldOneIsAskedAboutAndLiesAtThePartThen) {
  write("part", "new");
  write("out", "old");
  std::vector<fs::path> asked;
  const auto taken = take_name(folder_ / "part", folder_ / "out", [&](const fs::path& there) -> Status {
    EXPECT_EQ(read(there.filename()), "old");
    asked.push_back(there.filename());
    return Done{};
  });
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(read("out"), "new");
  EXPECT_EQ(asked, (std::vector<fs::path>{"out", "part"}));
}

TEST_P(TakeName, WhatMustStayStays) {
  write("part", "new");
  write("out", "old");
  EXPECT_FALSE(take_name(folder_ / "part", folder_ / "out", [](const fs::path&) { return Error{"stays"}; }));
  EXPECT_EQ(read("out"), "old");
  EXPECT_EQ(read("part"), "new");
}

TEST_P(TakeName, WhatComesInTheLastMomentGetsItsNameBack) {
  write("part", "new");
  write("out", "old");
  const auto taken = take_name(folder_ / "part", folder_ / "out", [&](const fs::path& there) -> Status {
    if (read(there.filename()) == "foreign") return Error{"stays"};
    fs::rename(folder_ / "out", folder_ / "away");
    write("out", "foreign");
    return Done{};
  });
  EXPECT_FALSE(taken);
  EXPECT_EQ(read("out"), "foreign");
  EXPECT_EQ(read("part"), "new");
}

TEST_P(TakeName, AFreeNameNeedsNoQuestion) {
  write("part", "new");
  EXPECT_TRUE(take_name(folder_ / "part", folder_ / "out", [](const fs::path&) -> Status {
    ADD_FAILURE();
    return Done{};
  }));
  EXPECT_EQ(read("out"), "new");
}

INSTANTIATE_TEST_SUITE_P(FilesAndFolders, TakeName, testing::Bool(),
                         [](const auto& folder) { return folder.param ? "Folder" : "File"; });

}  // namespace
}  // namespace terrella::test
