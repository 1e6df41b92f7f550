#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "picture_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"
#include "tiff_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// Cuts to both kinds of output; each must fail with a message that holds all parts, and leave nothing behind.
void expect_picture_refused(const ScratchFolder& folder, const fs::path& picture,
                            const std::vector<std::string>& parts) {
  const auto before = folder.names();
  for (const char* output : {"out.gpkg", "out"}) {
    const auto made = cut({.images = {picture}, .output = folder / output});
    ASSERT_FALSE(made) << output;
    EXPECT_NE(made.error().message.find(picture.string()), std::string::npos) << made.error().message;
    for (const std::string& part : parts) {
      EXPECT_NE(made.error().message.find(part), std::string::npos) << made.error().message;
    }
    EXPECT_EQ(folder.names(), before);
  }
}

void truncate_to(const fs::path& path, double part) {
  fs::resize_file(path, static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(path)) * part));
}

TEST(BadInputTest, NoFileAndNoPicture) {
  const ScratchFolder folder;
  expect_picture_refused(folder, folder / "nowhere.jpg", {"no such file"});
  write_bytes(folder / "empty.jpg", {});
  expect_picture_refused(folder, folder / "empty.jpg", {"empty"});
  const std::string letter(1000, 'a');
  write_bytes(folder / "letter.jpg", std::as_bytes(std::span(letter)));
  expect_picture_refused(folder, folder / "letter.jpg", {"JPEG, PNG or WebP", "GDAL"});
  fs::create_directory(folder / "folder");
  expect_picture_refused(folder, folder / "folder", {"folder"});
}

TEST(BadInputTest, NotTwoToOneSaysWhatToDo) {
  const ScratchFolder folder;
  write_png(folder / "square.png", noise(64, 64));
  expect_picture_refused(folder, folder / "square.png", {"64x64", "‹bounds›"});
}

TEST(BadInputTest, TruncatedPicturesNameTheRow) {
  const ScratchFolder folder;
  const Image picture = noise(256, 128);
  for (const double part : {0.4, 0.7, 0.95}) {
    write_jpeg(folder / "a.jpg", picture);
    write_jpeg(folder / "progressive.jpg", picture, true);
    write_png(folder / "a.png", picture);
    write_interlaced_png(folder / "interlaced.png", picture);
    for (const char* name : {"a.jpg", "progressive.jpg", "a.png", "interlaced.png"}) {
      truncate_to(folder / name, part);
      expect_picture_refused(folder, folder / name, {"row ", "of 128"});
    }
  }
}

TEST(BadInputTest, TruncatedTiffsAreRefused) {
  const ScratchFolder folder;
  const Image picture = noise(256, 128);
  for (const int tile_px : {0, 64}) {
    write_tiff(folder / "a.tif", picture, {.tile_px = tile_px});
    truncate_to(folder / "a.tif", 0.9);
    expect_picture_refused(folder, folder / "a.tif", {});
  }
}

TEST(BadInputTest, ProgressiveJpegWithEndlessScansIsRefused) {
  const ScratchFolder folder;
  write_jpeg(folder / "in.jpg", noise(64, 32), true);
  auto bytes = read_bytes(folder / "in.jpg");
  // The last scan (from its FF DA to before FF D9), two hundred times more.
  std::size_t scan = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    if (bytes[i] == std::byte{0xFF} && bytes[i + 1] == std::byte{0xDA}) scan = i;
  }
  const std::vector<std::byte> last(bytes.begin() + static_cast<std::ptrdiff_t>(scan), bytes.end() - 2);
  bytes.resize(bytes.size() - 2);
  for (int i = 0; i < 200; ++i) bytes.insert(bytes.end(), last.begin(), last.end());
  bytes.insert(bytes.end(), {std::byte{0xFF}, std::byte{0xD9}});
  write_bytes(folder / "in.jpg", bytes);
  expect_picture_refused(folder, folder / "in.jpg", {});
}

class Output : public testing::Test {
 protected:
  Output() { write_png(picture_, noise(512, 256)); }

  void expect_not_written(const fs::path& output, const std::string& part) {
    const auto before = folder_.names();
    const auto made = cut({.images = {picture_}, .output = output, .tile_px = 64});
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find(output.string()), std::string::npos) << made.error().message;
    EXPECT_NE(made.error().message.find(part), std::string::npos) << made.error().message;
    EXPECT_EQ(folder_.names(), before);
  }

  ScratchFolder folder_;
  fs::path picture_ = folder_ / "in.png";
};

TEST_F(Output, FolderIsMissing) {
  expect_not_written(folder_ / "missing/out.gpkg", "No such file");
  expect_not_written(folder_ / "missing/out", "No such file");
}

TEST_F(Output, SomethingElseIsThere) {
  expect_not_written(picture_, "is the input");
  write_bytes(folder_ / "file", {});
  expect_not_written(folder_ / "file", "is a file");
  fs::create_directory(folder_ / "out.gpkg");
  expect_not_written(folder_ / "out.gpkg", "is a folder");
  fs::create_directory(folder_ / "letters");
  write_bytes(folder_ / "letters/mine.txt", {});
  expect_not_written(folder_ / "letters", "other things");
  EXPECT_TRUE(fs::exists(folder_ / "letters/mine.txt"));
}

TEST_F(Output, OldTileSetsAreReplaced) {
  for (const char* output : {"out.gpkg", "out"}) {
    for (const int tile_px : {32, 64}) {
      ASSERT_TRUE(cut({.images = {picture_}, .output = folder_ / output, .tile_px = tile_px, .force = true}));
      const auto tiles = open_tile_set(folder_ / output);
      ASSERT_TRUE(tiles);
      EXPECT_EQ((*tiles)->info().grid.tile_px, tile_px);
    }
  }
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"in.png", "out", "out.gpkg"}));
}

/// A full disk without one: no file may grow over the limit, and the write that would returns an error.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    signal_before_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_before_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*signal_before_)(int);
};

TEST_F(Output, DiskIsFull) {
  const SmallDisk disk(512);
  expect_not_written(folder_ / "out.gpkg", "a limit of 512 bytes");
  expect_not_written(folder_ / "out", "a limit of 512 bytes");
}

TEST_F(Output, DiskFillsUpOnTheWay) {
  const SmallDisk disk(100000);
  expect_not_written(folder_ / "out.gpkg", "a limit of 100000 bytes");
}

TEST_F(Output, StoppingLeavesNothing) {
  const auto before = folder_.names();
  for (const char* output : {"out.gpkg", "out"}) {
    int calls = 0;
    const auto made =
        cut({.images = {picture_}, .output = folder_ / output, .tile_px = 16, .progress = [&](auto, auto) {
               return ++calls < 3;
             }});
    EXPECT_FALSE(made);
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(folder_.names(), before);
  }
}

TEST_F(Output, ProgressGoesFromTheStartToTheEnd) {
  std::int64_t last = 0;
  ASSERT_TRUE(cut(
      {.images = {picture_}, .output = folder_ / "out.gpkg", .progress = [&](std::int64_t done, std::int64_t total) {
         EXPECT_GE(done, last);
         EXPECT_EQ(total, 256);
         last = done;
         return true;
       }}));
  EXPECT_EQ(last, 256);
}

}  // namespace
}  // namespace terrella::test
