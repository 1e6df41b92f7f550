#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "cut_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

constexpr int kHeight_px = 512;  // four bands of 128 rows: 16 pixels a tile, 3 levels

class Resume : public testing::TestWithParam<const char*> {
 protected:
  Resume() {
    write_png(options_.images.front(), noise(2 * kHeight_px, kHeight_px));
    if (options_.output.extension() == ".pmtiles") options_.grid = CutGrid::web_mercator;
  }

  /// Cuts in another process, which kills itself when that many rows are read.
  void killed_at(std::int64_t rows) const {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      CutOptions options = options_;
      options.progress = [rows](std::int64_t done, auto) {
        if (done >= rows) kill(getpid(), SIGKILL);
        return true;
      };
      static_cast<void>(cut(options));
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  }

  /// The first row that is read when it is cut again.
  std::int64_t first_row_of_next() {
    std::int64_t first = -1;
    CutOptions options = options_;
    options.progress = [&](std::int64_t done, auto) {
      if (first < 0) first = done;
      return true;
    };
    must_cut(options);
    return first;
  }

  std::vector<std::byte> uninterrupted() {
    CutOptions options = options_;
    options.output = folder_ / (std::string("whole-") + GetParam());
    options.name = "in";
    must_cut(options);
    return fs::is_directory(options.output) ? std::vector<std::byte>{} : read_bytes(options.output);
  }

  ScratchFolder folder_;
  CutOptions options_{.images = {folder_ / "in.png"}, .output = folder_ / GetParam(), .tile_px = 16};
};

TEST_P(Resume, KilledAnywhereItGoesOnToTheSameBytes) {
  for (const std::int64_t rows : {16, 250, 512}) {
    fs::remove_all(options_.output);
    killed_at(rows);
    EXPECT_FALSE(fs::exists(options_.output));
    EXPECT_EQ(folder_.names().size(), rows == 16 ? 2U : 3U) << "what it has left";
    EXPECT_GT(first_row_of_next(), rows / 128 * 128 - (rows == 512 ? 128 : 0)) << "bands that are done";
    const auto whole = uninterrupted();
    EXPECT_TRUE(all_tiles(options_.output) == all_tiles(folder_ / (std::string("whole-") + GetParam())));
    if (!whole.empty()) {
      EXPECT_TRUE(read_bytes(options_.output) == whole) << "after " << rows << " rows";
    }
    EXPECT_EQ(folder_.names(), (std::vector<std::string>{"in.png", GetParam(), std::string("whole-") + GetParam()}));
  }
}

TEST_P(Resume, KilledAgainAndAgain) {
  for (std::int64_t rows = 100; rows < kHeight_px; rows += 150) killed_at(rows);
  EXPECT_GT(first_row_of_next(), 300);
  uninterrupted();
  EXPECT_TRUE(all_tiles(options_.output) == all_tiles(folder_ / (std::string("whole-") + GetParam())));
}

TEST_P(Resume, ChangedPicturesAndOptionsAreBegunAnewAndLeftoversRemoved) {
  killed_at(250);
  fs::last_write_time(folder_ / "in.png", fs::last_write_time(folder_ / "in.png") + std::chrono::seconds(1));
  EXPECT_EQ(first_row_of_next(), 16);
  killed_at(250);
  options_.quality = 50;
  options_.force = true;
  EXPECT_EQ(first_row_of_next(), 16);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"in.png", GetParam()}));
}

TEST_P(Resume, LeftoversOfOtherOutputsStay) {
  killed_at(250);
  const auto before = folder_.names();
  CutOptions other = options_;
  other.output = folder_ / (std::string(GetParam()) + ".1-1.gpkg");
  must_cut(other);
  EXPECT_EQ(folder_.names().size(), before.size() + 1);
  EXPECT_GT(first_row_of_next(), 128);
}

fs::path left_over(const ScratchFolder& folder) {
  for (const std::string& name : folder.names()) {
    if (name.ends_with(".part")) return folder / name;
  }
  return {};
}

TEST_P(Resume, TornLastRecordsAreWrittenAgain) {
  killed_at(250);
  int torn = 0;
  for (const auto& entry : fs::directory_iterator(left_over(folder_))) {
    if (entry.path().extension() != ".part" || entry.file_size() < 100) continue;
    fs::resize_file(entry.path(), entry.file_size() - 10);
    std::ofstream(entry.path(), std::ios::app) << "0123456789";
    ++torn;
  }
  EXPECT_GT(torn, 0);
  must_cut(options_);
  uninterrupted();
  EXPECT_TRUE(all_tiles(options_.output) == all_tiles(folder_ / (std::string("whole-") + GetParam())));
}

TEST_P(Resume, DamagedBandsAreAnErrorAndThenCutAnew) {
  killed_at(250);
  const fs::path band = left_over(folder_) / "band-0000.tiles";
  auto bytes = read_bytes(band);
  bytes[bytes.size() / 2] ^= std::byte{1};
  write_bytes(band, bytes);
  expect_refused(options_, {"band-0000", "damaged"});
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.png"});
  must_cut(options_);
}

INSTANTIATE_TEST_SUITE_P(Outputs, Resume, testing::Values("out.gpkg", "tiles", "web.pmtiles"),
                         [](const auto& output) { return std::string(output.param).substr(0, 3); });

}  // namespace
}  // namespace terrella::test
