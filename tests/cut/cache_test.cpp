#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "picture_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

class Cache : public testing::Test {
 protected:
  Cache() { write_png(options_.images.front(), noise(512, 256)); }

  /// True if the call had to cut.
  bool cuts(const CutOptions& options) {
    bool cut_now = false;
    CutOptions watched = options;
    watched.progress = [&](auto, auto) { return cut_now = true; };
    const auto path = cut_into_cache(watched, folder_ / "cache");
    EXPECT_TRUE(path) << path.error().message;
    EXPECT_TRUE(path && open_tile_set(*path));
    return cut_now;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / "cache"), {}));
  }

  ScratchFolder folder_;
  CutOptions options_{.images = {folder_ / "in.png"}, .output = {}, .tile_px = 32};
};

TEST_F(Cache, SecondCallFindsWhatTheFirstMade) {
  EXPECT_TRUE(cuts(options_));
  EXPECT_FALSE(cuts(options_));
  EXPECT_EQ(files(), 1U);
}

TEST_F(Cache, SamePictureByAnotherPathIsTheSame) {
  fs::create_symlink(folder_ / "in.png", folder_ / "link.png");
  fs::create_directory(folder_ / "sub");
  EXPECT_TRUE(cuts(options_));
  CutOptions other = options_;
  other.images = {folder_ / "sub/../in.png"};
  EXPECT_FALSE(cuts(other));
}

TEST_F(Cache, ChangedPicturesAndOptionsAreCutAnew) {
  EXPECT_TRUE(cuts(options_));
  CutOptions other = options_;
  other.quality = 50;
  EXPECT_TRUE(cuts(other));
  other = options_;
  other.projection = Projection::equal_area;
  EXPECT_TRUE(cuts(other));
  fs::last_write_time(folder_ / "in.png", fs::last_write_time(folder_ / "in.png") + std::chrono::seconds(1));
  EXPECT_TRUE(cuts(options_));
  EXPECT_EQ(files(), 4U);
}

TEST_F(Cache, FailuresLeaveNothing) {
  fs::resize_file(folder_ / "in.png", fs::file_size(folder_ / "in.png") / 2);
  EXPECT_FALSE(cut_into_cache(options_, folder_ / "cache"));
  EXPECT_EQ(files(), 0U);
}

TEST_F(Cache, FolderThatCannotBeMadeIsNamed) {
  const auto path = cut_into_cache(options_, folder_ / "in.png");
  ASSERT_FALSE(path);
  EXPECT_NE(path.error().message.find("in.png"), std::string::npos);
}

TEST_F(Cache, ProcessesThatCutAtTheSameTimeDoNotDisturbEachOther) {
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(cut_into_cache(options_, folder_ / "cache") ? 0 : 1);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(files(), 1U);
  EXPECT_FALSE(cuts(options_));
}

TEST_F(Cache, ThreadsNeither) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] { EXPECT_TRUE(cut_into_cache(options_, folder_ / "cache")); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(files(), 1U);
}

}  // namespace
}  // namespace terrella::test
