// Blocks of a TIFF on a real server equal those of the file on disk.

#include "streaming/remote_tiff/remote_tiff.h"

#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "raster_files.h"
#include "served_folder.h"

namespace terrella::test {
namespace {

/// Waits for blocks that have to be fetched.
class Waiting : public RasterSource {
 public:
  explicit Waiting(RemoteTiff& raster) : raster_(raster) {}
  [[nodiscard]] const RasterInfo& info() const override { return raster_.info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    auto there = raster_.read(block);
    if (there || there.error().kind != MissingKind::remote) return there;
    std::promise<Result<EncodedTile, TileFailure>> answer;
    raster_.remote()->fetch(block, 0.0, [&](auto came) { answer.set_value(std::move(came)); });
    return answer.get_future().get();
  }

 private:
  RemoteTiff& raster_;
};

struct RemoteCase {
  const char* name;
  int bands;
  const char* type;
  const char* options;
  const char* overview_options = "";
  friend void PrintTo(const RemoteCase& one, std::ostream* out) { *out << one.name; }
};

class RemoteTiffMatrix : public testing::TestWithParam<RemoteCase> {
 protected:
  static void SetUpTestSuite() { served = std::make_unique<ServedFolder>(); }
  static void TearDownTestSuite() { served.reset(); }
  static std::unique_ptr<ServedFolder> served;
};
std::unique_ptr<ServedFolder> RemoteTiffMatrix::served;

TEST_P(RemoteTiffMatrix, EqualsTheFile) {
  const RemoteCase& test = GetParam();
  const ScratchFolder folder;
  const bool is_picture = std::string(test.type) == "Byte";
  write_raw(folder / "in.raw", test.type, 301, 173, test.bands,
            [](int x, int y, int band) { return std::floor(250.0 * noise_at(x / 3, y / 2, band)); });
  const std::string name = std::string(test.name) + ".tif";
  ASSERT_TRUE(translate(test.options, folder / "in.raw", *served / name));
  if (std::string(test.options).find("-of COG") == std::string::npos) {
    ASSERT_TRUE(add_overviews(std::string("-r average ") + test.overview_options, *served / name, "2 4"));
  }
  const RasterOptions options{.heights = !is_picture};
  const auto truth = open_raster(*served / name, some_place(), options);
  ASSERT_TRUE(truth) << truth.error().message;

  const auto file = RemoteFile::open({.url = served->url(name), .http = quick_options()});
  ASSERT_TRUE(file) << file.error().message;
  auto pyramid = open_remote_raster(**file);
  ASSERT_TRUE(pyramid) << pyramid.error().message;
  const auto remote = RemoteTiff::make(*file, *std::move(pyramid), some_place(), options);
  ASSERT_TRUE(remote) << remote.error().message;
  ASSERT_EQ((*remote)->info().levels.size(), (*truth)->info().levels.size());
  Waiting waiting(**remote);
  for (std::size_t level = 0; level < waiting.info().levels.size(); ++level) {
    if (is_picture) {
      EXPECT_TRUE(whole_picture(waiting, level).rgba == whole_picture(**truth, level).rgba) << level;
    } else {
      const Numbers got = whole_numbers(waiting, level), expected = whole_numbers(**truth, level);
      ASSERT_EQ(got.values.size(), expected.values.size());
      EXPECT_EQ(std::memcmp(got.values.data(), expected.values.data(), got.values.size() * sizeof(float)), 0) << level;
    }
  }
}

constexpr const char* kPlain = "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32";

INSTANTIATE_TEST_SUITE_P(
    Layouts, RemoteTiffMatrix,
    testing::Values(
        RemoteCase{"plain", 3, "Byte", kPlain}, RemoteCase{"cog", 3, "Byte", "-of COG -co BLOCKSIZE=64"},
        RemoteCase{"cog_jpeg_mask", 3, "Byte",
                   "-of COG -co BLOCKSIZE=64 -co COMPRESS=JPEG -co ADD_ALPHA=YES -a_nodata 0"},
        RemoteCase{"cog_webp", 4, "Byte",
                   "-of COG -co BLOCKSIZE=64 -co COMPRESS=WEBP -colorinterp red,green,blue,alpha"},
        RemoteCase{"ycbcr", 3, "Byte", "-co TILED=YES -co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR",
                   "--config COMPRESS_OVERVIEW JPEG --config PHOTOMETRIC_OVERVIEW YCBCR"},
        RemoteCase{"bands", 3, "Byte", "-co TILED=YES -co INTERLEAVE=BAND -co COMPRESS=DEFLATE"},
        RemoteCase{"big", 1, "Byte", "-co TILED=YES -co BIGTIFF=YES -co COMPRESS=LZW -co PREDICTOR=2"},
        RemoteCase{"big_endian", 1, "UInt16", "-co TILED=YES -co ENDIANNESS=BIG -co COMPRESS=ZSTD"},
        RemoteCase{"signed16", 1, "Int16", "-co TILED=YES -co COMPRESS=DEFLATE -co PREDICTOR=2 -a_nodata 0"},
        RemoteCase{"float32", 1, "Float32",
                   "-of COG -co BLOCKSIZE=64 -co COMPRESS=DEFLATE -co PREDICTOR=YES -a_nodata 7"},
        RemoteCase{"lerc", 1, "Float64", "-co TILED=YES -co COMPRESS=LERC"},
        RemoteCase{"sparse", 1, "Byte", "-co TILED=YES -co SPARSE_OK=TRUE -a_nodata 3"},
        // 173 rows: two blocks, of which the last ends with a shorter strip.
        RemoteCase{"strips", 3, "Byte", "-co BLOCKYSIZE=3"},
        RemoteCase{"strips_ycbcr", 3, "Byte", "-co BLOCKYSIZE=16 -co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR",
                   "--config COMPRESS_OVERVIEW JPEG --config PHOTOMETRIC_OVERVIEW YCBCR"},
        RemoteCase{"strips_bands", 3, "Byte", "-co BLOCKYSIZE=8 -co INTERLEAVE=BAND -co COMPRESS=LZW -co PREDICTOR=2"},
        RemoteCase{"strips_float", 1, "Float32", "-co BLOCKYSIZE=3 -co COMPRESS=DEFLATE -co PREDICTOR=3 -a_nodata 7"},
        RemoteCase{"one_strip", 1, "Int16", "-co BLOCKYSIZE=173 -co COMPRESS=ZSTD"},
        RemoteCase{"strips_sparse", 1, "Int16", "-co BLOCKYSIZE=8 -co SPARSE_OK=TRUE -co COMPRESS=LZW -a_nodata 0"}),
    [](const auto& test) { return test.param.name; });

class RemoteTiffCacheTest : public testing::Test {
 protected:
  RemoteTiffCacheTest() {
    write_raw(folder_ / "in.raw", "Byte", 300, 300, 1, [](int x, int y, int) { return (x + y) % 256; });
    EXPECT_TRUE(translate("-of COG -co BLOCKSIZE=64", folder_ / "in.raw", served_ / "a.tif"));
  }
  RemoteFileOptions options(const std::string& held_key, bool offline = false) {
    RemoteFileOptions options{.url = served_.url("a.tif"), .http = quick_options(), .offline = offline};
    options.held_key = held_key;
    options.open_cache = [this](const std::string& key) -> Result<std::shared_ptr<TileCache>> {
      opened_.push_back(key);
      auto cache =
          TileCache::open(folder_ / (std::to_string(std::hash<std::string>()(key)) + ".gpkg"), range_cache_info(), key);
      if (!cache) return Error{cache.error().message};
      return *std::move(cache);
    };
    return options;
  }
  /// The whole picture; the cache is closed afterwards.
  Image look(const RemoteFileOptions& options) {
    const auto file = RemoteFile::open(options);
    EXPECT_TRUE(file) << file.error().message;
    if (!file) return {};
    auto pyramid = open_remote_raster(**file);
    EXPECT_TRUE(pyramid) << pyramid.error().message;
    const auto remote = RemoteTiff::make(*file, *std::move(pyramid), some_place(), {});
    EXPECT_TRUE(remote) << remote.error().message;
    key_ = (*file)->cache_key();
    Waiting waiting(**remote);
    return whole_picture(waiting, waiting.info().levels.size() - 1);
  }

  ScratchFolder folder_;
  ServedFolder served_;
  std::vector<std::string> opened_;
  std::string key_;
};

TEST_F(RemoteTiffCacheTest, TheSecondRunAsksNothing) {
  const Image first = look(options({}));
  // Twenty-five tiles that are read one after the other, and the directories.
  const std::size_t asked = served_.requests(26);
  EXPECT_LE(asked, 27U);
  EXPECT_TRUE(look(options(key_)).rgba == first.rgba);
  EXPECT_TRUE(look(options(key_, true)).rgba == first.rgba);
  EXPECT_EQ(served_.requests(0), asked);
}

TEST_F(RemoteTiffCacheTest, AStoredValueIsExactOnceItsBytesAreThere) {
  write_raw(folder_ / "in.raw", "Float64", 300, 300, 1, [](int x, int y, int) { return x / 3.0 + 1e-9 * y; });
  ASSERT_TRUE(translate("-of COG -co BLOCKSIZE=64", folder_ / "in.raw", served_ / "a.tif"));
  const RasterOptions numbers{.heights = true, .stored = true};
  const auto truth = open_raster(served_ / "a.tif", some_place(), numbers);
  ASSERT_TRUE(truth);
  const auto file = RemoteFile::open(options({}));
  ASSERT_TRUE(file) << file.error().message;
  auto pyramid = open_remote_raster(**file);
  ASSERT_TRUE(pyramid) << pyramid.error().message;
  const auto remote = RemoteTiff::make(*file, *std::move(pyramid), some_place(), numbers);
  ASSERT_TRUE(remote) << remote.error().message;
  EXPECT_EQ((*remote)->value_at(100, 200).error().kind, MissingKind::remote);
  Waiting waiting(**remote);
  static_cast<void>(whole_numbers(waiting, waiting.info().levels.size() - 1));
  for (const auto& [x, y] : {std::pair{0, 0}, {100, 200}, {299, 299}}) {
    const auto value = (*remote)->value_at(x, y);
    ASSERT_TRUE(value) << value.error().why;
    EXPECT_EQ(*value, *(*truth)->value_at(x, y));
    EXPECT_EQ(*value, x / 3.0 + 1e-9 * y);
  }
  for (const auto& [x, y] : {std::pair{-1, 0}, {300, 0}, {0, 300}}) {
    EXPECT_EQ((*remote)->value_at(x, y).error().kind, MissingKind::absent);
  }
}

TEST_F(RemoteTiffCacheTest, AnotherVersionHasAnotherCache) {
  look(options({}));
  const std::string old = key_;
  // The note of the last check expires.
  {
    const auto file = RemoteFile::open(options(old));
    ASSERT_TRUE(file);
    (*file)->doubt_version();
  }
  write_raw(folder_ / "in.raw", "Byte", 300, 300, 1, [](int x, int y, int) { return (2 * x + y) % 256; });
  ASSERT_TRUE(translate("-of COG -co BLOCKSIZE=64 -co COMPRESS=LZW", folder_ / "in.raw", served_ / "a.tif"));
  const auto truth = open_raster(served_ / "a.tif", some_place(), {});
  ASSERT_TRUE(truth);
  const Image now = look(options(old));
  EXPECT_NE(key_, old);
  EXPECT_EQ(opened_.back(), key_);
  EXPECT_TRUE(now.rgba == whole_picture(**truth, (*truth)->info().levels.size() - 1).rgba);
}

TEST(RangeCacheTest, AKeyNamesTheVersionAndNoSecret) {
  const Url url("https://me:pass@host/a.tif?token=abc&id=7");
  const FileVersion version{.etag = "\"x\"", .last_modified = "Mon", .file_bytes = 77};
  const std::string key = range_cache_key(url, version);
  for (const char* secret : {"pass", "abc"}) EXPECT_EQ(key.find(secret), std::string::npos) << key;
  const auto found = version_in_key(key, Url("https://host/a.tif?token=other&id=7"));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->etag, version.etag);
  EXPECT_EQ(found->last_modified, version.last_modified);
  EXPECT_EQ(found->file_bytes, version.file_bytes);
  for (const char* other : {"https://host/b.tif", "https://host/a.tif?id=8"})
    EXPECT_FALSE(version_in_key(key, Url(other)));
  for (const char* text : {"", "{}", "[]", "file:/a", "{\"ranges\":7}"}) EXPECT_FALSE(version_in_key(text, url));
}

TEST(RangeCacheTest, ASpanOfAnotherLengthIsNotThere) {
  const ScratchFolder folder;
  auto cache = TileCache::open(folder / "c.gpkg", range_cache_info(), "{\"ranges\":\"x\"}");
  ASSERT_TRUE(cache) << cache.error().message;
  RangeCache ranges(*std::move(cache));
  const std::uint64_t far = (std::uint64_t{7} << 32) + 5;
  ranges.keep_span({far, 3}, std::vector<std::byte>(3, std::byte{9}));
  ranges.keep({far, 3}, std::vector<std::byte>(2, std::byte{4}));
  EXPECT_EQ(ranges.find_span({far, 3}), std::vector<std::byte>(3, std::byte{9}));
  EXPECT_FALSE(ranges.find_span({far, 4}));
  EXPECT_FALSE(ranges.find_span({5, 3}));
  EXPECT_EQ(ranges.find({far, 3}), std::vector<std::byte>(2, std::byte{4}));
  EXPECT_FALSE(ranges.is_checked(100));
  ranges.set_checked(100, 200);
  EXPECT_TRUE(ranges.is_checked(150));
  EXPECT_FALSE(ranges.is_checked(201));
}

TEST(TiffAddressTest, ByThePath) {
  for (const char* yes : {"https://host/a.tif", "http://host/b/A.TIFF?x=1", "https://h/a.tif#part"}) {
    EXPECT_TRUE(is_tiff_address(Url(yes))) << yes;
  }
  for (const char* no :
       {"https://host/{z}/{x}/{y}.tif", "file:///a.tif", "a.tif", "https://host/a.tif.json", "https://h/?f=a.tif"}) {
    EXPECT_FALSE(is_tiff_address(Url(no))) << no;
  }
}

}  // namespace
}  // namespace terrella::test
