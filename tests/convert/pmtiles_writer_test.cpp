#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

#include "base/hash_mix.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/file_bytes.h"
#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/pmtiles/tile_number.h"
#include "streaming/tile_lister.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

using Bytes = std::vector<std::byte>;
using Tiles = std::map<TileId, Bytes>;

TileSetInfo web_set(int max_level) {
  TileSetInfo info;
  info.name = "A set";
  info.attribution = "nobody";
  info.format = ImageFormat::png;
  info.grid.projection = Projection::web_mercator;
  info.grid.root_span_deg = 360.0;
  info.grid.max_level = max_level;
  return info;
}

/// A picture at the root, which tells a reader the tiles' size. Other tiles need not be pictures.
Bytes picture() {
  Image image{.width_px = 64, .height_px = 64, .rgba = std::vector<std::uint8_t>(64 * 64 * 4, 255)};
  auto bytes = encode_png(image);
  EXPECT_TRUE(bytes);
  return *std::move(bytes);
}

/// All tiles of a pyramid, whose bytes a function of the tile's number makes.
template <class Make>
Tiles pyramid(int max_level, const Make& make) {
  Tiles tiles;
  for (std::uint64_t number = 1; number < first_number(max_level + 1); ++number) {
    tiles[tile_of_number(number)] = make(number);
  }
  tiles[TileId{}] = picture();
  return tiles;
}

Bytes different_bytes(std::uint64_t number) {
  Bytes bytes(1 + mix_bits(number) % 300, std::byte{7});
  bytes.resize(bytes.size() + sizeof number);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

class PmtilesWriterTest : public testing::Test {
 protected:
  /// Writes the tiles in the order of `ids`.
  void write(const Tiles& tiles, const std::vector<TileId>& ids, const TileSetInfo& info) {
    auto writer = make_tile_writer(setup(info));
    ASSERT_TRUE(writer) << writer.error().message;
    for (const TileId& id : ids) ASSERT_TRUE((*writer)->put(id, tiles.at(id)));
    const Status finished = (*writer)->finish();
    ASSERT_TRUE(finished) << finished.error().message;
  }
  void write(const Tiles& tiles, const TileSetInfo& info) { write(tiles, ids_of(tiles), info); }

  [[nodiscard]] WriterSetup setup(const TileSetInfo& info) const {
    return {.output = output_,
            .part = folder_ / "part",
            .info = info,
            .last_change = {},
            .mark = "of the test",
            .may_replace = [](const std::filesystem::path&) { return Done{}; }};
  }

  /// In the order of tile numbers.
  static std::vector<TileId> ids_of(const Tiles& tiles) {
    std::vector<TileId> ids;
    ids.reserve(tiles.size());
    for (const auto& [id, bytes] : tiles) ids.push_back(id);
    std::ranges::sort(ids, {}, tile_number);
    return ids;
  }

  [[nodiscard]] Bytes file() const { return *read_file(output_, 1UL << 30); }
  [[nodiscard]] PmtilesHeader header() const { return *parse_pmtiles_header(file(), std::nullopt); }

  /// The library's reader finds each tile, and lists these and no others.
  void expect_read_back(const Tiles& tiles) const {
    const auto source = open_pmtiles(output_);
    ASSERT_TRUE(source) << source.error().message;
    for (const auto& [id, bytes] : tiles) {
      const auto tile = (*source)->read(id);
      ASSERT_TRUE(tile) << id.level << "/" << id.x << "/" << id.y << ": " << tile.error().why;
      ASSERT_EQ(tile->bytes, bytes);
    }
    std::size_t listed = 0;
    const Status walked = dynamic_cast<TileLister&>(**source).for_each_tile([&](const TileId& id) {
      listed += tiles.count(id);
      return true;
    });
    ASSERT_TRUE(walked) << walked.error().message;
    EXPECT_EQ(listed, tiles.size());
    const PmtilesHeader head = header();
    EXPECT_EQ(head.addressed_tiles, tiles.size());
    EXPECT_EQ(head.tiles.offset, kPmtilesHeadBytes);
    EXPECT_EQ(kPmtilesHeadBytes + head.tiles.length + head.metadata.length + head.leaves.length, file().size());
  }

  test::ScratchFolder folder_;
  const std::filesystem::path output_ = folder_ / "set.pmtiles";
};

TEST_F(PmtilesWriterTest, ManyTilesNeedLeafDirectories) {
  const Tiles tiles = pyramid(7, different_bytes);
  ASSERT_GT(tiles.size(), 20'000U);
  write(tiles, web_set(7));
  const PmtilesHeader head = header();
  EXPECT_LE(head.root.offset + head.root.length, kPmtilesHeadBytes);
  EXPECT_GT(head.leaves.length, 0U);
  EXPECT_EQ(head.tile_contents, tiles.size());
  EXPECT_EQ(head.tile_entries, tiles.size());
  expect_read_back(tiles);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"set.pmtiles"});
}

TEST_F(PmtilesWriterTest, FewTilesLieInTheRoot) {
  const Tiles tiles = pyramid(3, different_bytes);
  write(tiles, web_set(3));
  EXPECT_EQ(header().leaves.length, 0U);
  expect_read_back(tiles);
}

TEST_F(PmtilesWriterTest, ContentsAreStoredOnceAndNeighboursAreARun) {
  // Two contents of equal length, each in many places, and a run that goes on into the next level.
  const Tiles tiles =
      pyramid(5, [](std::uint64_t number) { return Bytes(40, number % 100 < 90 ? std::byte{1} : std::byte{2}); });
  write(tiles, web_set(5));
  EXPECT_EQ(header().tile_contents, 3U);
  EXPECT_LT(header().tile_entries, 40U);
  EXPECT_EQ(header().tiles.length, picture().size() + 80);
  expect_read_back(tiles);
}

TEST_F(PmtilesWriterTest, ARunEndsAtAGap) {
  Tiles tiles = pyramid(3, [](std::uint64_t) { return Bytes(40, std::byte{1}); });
  const TileId gap = tile_of_number(30);
  tiles.erase(gap);
  write(tiles, web_set(3));
  expect_read_back(tiles);
  EXPECT_EQ((*open_pmtiles(output_))->read(gap).error().kind, MissingKind::absent);
}

TEST_F(PmtilesWriterTest, TheOrderOfArrivalDoesNotMatter) {
  const Tiles tiles = pyramid(5, [](std::uint64_t number) { return different_bytes(mix_bits(number) % 500); });
  write(tiles, web_set(5));
  const Bytes sorted = file();
  std::vector<TileId> ids = ids_of(tiles);
  std::ranges::shuffle(ids, std::mt19937(35));
  write(tiles, ids, web_set(5));
  EXPECT_EQ(file(), sorted);
  EXPECT_TRUE(header().clustered);
  expect_read_back(tiles);
}

TEST_F(PmtilesWriterTest, LevelsAreThoseWithTilesAndBoundsAreRoundedOutwards) {
  TileSetInfo info = web_set(6);
  info.grid.bounds = {.west = Angle::degrees(5.123456789),
                      .south = Angle::degrees(-90.0),
                      .east = Angle::degrees(17.5),
                      .north = Angle::degrees(49.1)};
  write({{{.level = 3, .x = 4, .y = 3}, picture()}, {{.level = 4, .x = 8, .y = 6}, picture()}}, info);
  EXPECT_EQ(header().min_level, 3);
  EXPECT_EQ(header().max_level, 4);
  const GeoRect bounds = header().bounds;
  EXPECT_NEAR(bounds.west.deg(), 5.1234567, 1e-12);
  EXPECT_NEAR(bounds.south.deg(), -85.0511288, 1e-12);
  EXPECT_NEAR(bounds.east.deg(), 17.5, 1e-12);
  EXPECT_NEAR(bounds.north.deg(), 49.1, 1e-12);
}

TEST_F(PmtilesWriterTest, TilesOfASetWithSmallerRootsKeepTheirZoom) {
  TileSetInfo info = web_set(1);
  info.grid.root_span_deg = 90.0;
  write({{{.level = 1, .x = 3, .y = 5}, picture()}}, info);
  const auto source = open_pmtiles(output_);
  ASSERT_TRUE(source);
  EXPECT_TRUE((*source)->read({.level = 3, .x = 3, .y = 5}));
}

TEST_F(PmtilesWriterTest, ASetWithoutTilesIsRefused) {
  for (const char* name : {"set.pmtiles", "set.mbtiles"}) {
    WriterSetup empty = setup(web_set(3));
    empty.output = folder_ / name;
    {
      auto writer = make_tile_writer(empty);
      ASSERT_TRUE(writer);
      const Status finished = (*writer)->finish();
      ASSERT_FALSE(finished);
      EXPECT_NE(finished.error().message.find("no tiles"), std::string::npos);
    }
    EXPECT_EQ(folder_.names(), std::vector<std::string>{});
  }
}

TEST(PmtilesFormatTest, ADirectoryIsReadBack) {
  const PmtilesDirectory directory = {
      {.tile = 0, .offset = 0, .length = 127, .run = 1},
      {.tile = 1, .offset = 127, .length = 128, .run = 300},
      {.tile = 400, .offset = 0, .length = 127, .run = 1},
      {.tile = std::uint64_t{1} << 50, .offset = std::uint64_t{1} << 40, .length = 1U << 31, .run = 0}};
  const auto packed = pack(pmtiles_directory_bytes(directory));
  ASSERT_TRUE(packed);
  const auto unpacked = unpack(*packed, PmtilesCompression::gzip);
  ASSERT_TRUE(unpacked);
  const auto read = parse_pmtiles_directory(*unpacked);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, directory);
}

TEST(PmtilesFormatTest, AHeaderIsReadBack) {
  const PmtilesHeader header{.root = {127, 5},
                             .metadata = {132, 6},
                             .leaves = {138, 7},
                             .tiles = {145, std::uint64_t{1} << 40},
                             .directory_compression = PmtilesCompression::gzip,
                             .tile_compression = PmtilesCompression::none,
                             .min_level = 2,
                             .max_level = 24,
                             .bounds = {.west = Angle::degrees(-10.5),
                                        .south = Angle::degrees(-1.25),
                                        .east = Angle::degrees(170.0),
                                        .north = Angle::degrees(3.0)},
                             .tile_type = PmtilesTileType::webp,
                             .clustered = true,
                             .addressed_tiles = 9,
                             .tile_entries = 8,
                             .tile_contents = 7};
  const auto read = parse_pmtiles_header(pmtiles_header_bytes(header), std::nullopt);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->root, header.root);
  EXPECT_EQ(read->metadata, header.metadata);
  EXPECT_EQ(read->leaves, header.leaves);
  EXPECT_EQ(read->tiles, header.tiles);
  EXPECT_EQ(read->directory_compression, header.directory_compression);
  EXPECT_EQ(read->tile_compression, header.tile_compression);
  EXPECT_EQ(read->min_level, 2);
  EXPECT_EQ(read->max_level, 24);
  EXPECT_EQ(read->bounds, header.bounds);
  EXPECT_EQ(read->tile_type, header.tile_type);
  EXPECT_TRUE(read->clustered);
  EXPECT_EQ(read->addressed_tiles, 9U);
  EXPECT_EQ(read->tile_entries, 8U);
  EXPECT_EQ(read->tile_contents, 7U);
}

TEST(CheckOutputTest, WebFormatsTakePicturesInWebMercatorAlone) {
  TileSetInfo geodetic = web_set(3);
  geodetic.grid.projection = Projection::equirectangular;
  TileSetInfo heights = web_set(3);
  heights.numbers = NumberInfo{};
  for (const TileSetInfo& info : {geodetic, heights}) {
    for (const char* name : {"a.pmtiles", "a.mbtiles"}) {
      const Status fits = check_output(name, info);
      ASSERT_FALSE(fits);
      EXPECT_NE(fits.error().message.find(".gpkg"), std::string::npos) << "the cure is named";
    }
    EXPECT_TRUE(check_output("a.gpkg", info));
    EXPECT_TRUE(check_output("a", info));
  }
  EXPECT_TRUE(check_output("a.pmtiles", web_set(3)));
}

}  // namespace
}  // namespace terrella
