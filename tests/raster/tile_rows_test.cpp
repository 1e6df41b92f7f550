#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "streaming/cut/input/tile_rows.h"

namespace terrella::test {
namespace {

/// Colour of a pixel of the finest level, counted from (-180°, 90°).
std::uint8_t colour(std::int64_t x, std::int64_t y, int c) {
  return static_cast<std::uint8_t>(c == 3 ? 200 : x * 3 + y * 5 + c * 50 + (x * y) / 7);
}
float height(std::int64_t x, std::int64_t y) { return static_cast<float>(100 * x - 30 * y) + 0.25F; }

/// Tiles of formulas, made when they are asked for.
class FormulaTiles : public TileSource {
 public:
  explicit FormulaTiles(TileSetInfo info) : info_(std::move(info)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (id == missing) return TileFailure{.kind = kind, .why = "tile of the test"};
    EncodedTile tile;
    const int side = info_.grid.tile_px;
    if (info_.numbers) {
      tile.make_numbers = [id, side]() -> Result<Numbers, TileFailure> {
        Numbers numbers{.width_px = side, .height_px = side, .values = {}};
        for (int y = 0; y < side; ++y) {
          for (int x = 0; x < side; ++x) numbers.values.push_back(height(id.x * side + x, id.y * side + y));
        }
        return numbers;
      };
      return tile;
    }
    tile.make_picture = [id, side]() -> Result<Image, TileFailure> {
      Image image{.width_px = side, .height_px = side, .rgba = {}};
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          for (int c = 0; c < 4; ++c) image.rgba.push_back(colour(id.x * side + x, id.y * side + y, c));
        }
      }
      return image;
    };
    return tile;
  }
  TileId missing{.level = -1};
  MissingKind kind = MissingKind::absent;

 private:
  TileSetInfo info_;
};

GeoRect rect(double west, double south, double east, double north) {
  return {.west = Angle::degrees(west),
          .south = Angle::degrees(south),
          .east = Angle::degrees(east),
          .north = Angle::degrees(north)};
}

/// A level of pixels of 0.5°: 720x360, tiles of 32 px.
TileSetInfo half_degree(const GeoRect& bounds, ImageFormat format = ImageFormat::png) {
  TileSetInfo info;
  info.grid.root_span_deg = 256.0;
  info.grid.tile_px = 32;
  info.grid.max_level = 4;
  info.grid.bounds = bounds;
  info.format = format;
  return info;
}

TEST(TileRowsTest, GiveThePixelsInsideTheBounds) {
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg}) {
    // The bounds are widened to whole pixels: x from 390 to 421, y from 40 to 141.
    auto input = open_tile_rows(std::make_unique<FormulaTiles>(half_degree(rect(15.1, 19.6, 30.4, 70.0), format)), 3,
                                {}, "a.tif");
    ASSERT_TRUE(input) << input.error().message;
    const PictureInfo& info = input->rows->info();
    ASSERT_EQ(info.width_px, 31);
    ASSERT_EQ(info.height_px, 101);
    EXPECT_TRUE(info.has_alpha);
    EXPECT_EQ(info.opaque_inside, format == ImageFormat::jpeg);
    EXPECT_NEAR(input->bounds.west.deg(), 15.0, 1e-12);
    EXPECT_NEAR(input->bounds.east.deg(), 30.5, 1e-12);
    EXPECT_NEAR(input->bounds.north.deg(), 70.0, 1e-12);
    EXPECT_NEAR(input->bounds.south.deg(), 19.5, 1e-12);
    std::vector<std::uint8_t> row(31 * 4);
    for (int y = 0; y < 101; ++y) {
      if (y == 10 || y == 60) {
        ASSERT_TRUE(input->rows->skip_rows(30));
        y += 30;
      }
      const Status read = input->rows->read_row(row);
      ASSERT_TRUE(read) << read.error().message;
      for (int x = 0; x < 31; ++x) {
        for (int c = 0; c < 4; ++c) {
          ASSERT_EQ(row[static_cast<std::size_t>(4 * x + c)], colour(390 + x, 40 + y, c)) << x << " " << y << " " << c;
        }
      }
    }
  }
}

TEST(TileRowsTest, GoOnBeyondTheDateLine) {
  TileSetInfo info = half_degree(rect(175.0, -5.0, -170.0, 5.0));
  info.grid.root_span_deg = 180.0;  // pixels of 0.3515625°, 1024 round the planet
  auto input = open_tile_rows(std::make_unique<FormulaTiles>(info), 1, {}, "a.tif");
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_LT(input->bounds.east.deg(), input->bounds.west.deg());
  const auto width = static_cast<int>(input->rows->info().width_px);
  EXPECT_EQ(width, 1053 - 1009);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(width) * 4);
  ASSERT_TRUE(input->rows->read_row(row));
  for (int x = 0; x < width; ++x) {
    ASSERT_EQ(row[static_cast<std::size_t>(4 * x)], colour((1009 + x) % 1024, 241, 0)) << x;
  }
}

TEST(TileRowsTest, HeightsBecomeNumbersOfTiles) {
  TileSetInfo info = half_degree(GeoRect{});
  info.numbers = NumberInfo{.scale = 2.0, .offset = 10.0, .nodata = {}, .floats = true};
  auto tiles = std::make_unique<FormulaTiles>(info);
  tiles->missing = {.level = 4, .x = 1, .y = 0};
  auto input = open_tile_rows(std::move(tiles), 2, NumberInfo{.scale = 0.5, .offset = -100.0}, "a.tif");
  ASSERT_TRUE(input) << input.error().message;
  ASSERT_EQ(input->rows->info().width_px, 720);
  ASSERT_EQ(input->rows->info().height_px, 360);
  std::vector<std::uint8_t> row(720 * 4);
  for (int y = 0; y < 40; ++y) {
    ASSERT_TRUE(input->rows->read_row(row));
    for (int x = 0; x < 720; ++x) {
      float number = 0.0F;
      std::memcpy(&number, row.data() + 4 * x, sizeof(number));
      if (x >= 32 && x < 64 && y < 32) {
        ASSERT_TRUE(std::isnan(number)) << x << " " << y;
      } else {
        ASSERT_EQ(number, static_cast<float>((height(x, y) * 2.0 + 10.0 + 100.0) / 0.5)) << x << " " << y;
      }
    }
  }
}

TEST(TileRowsTest, AbsentTilesAreTransparentAndBrokenOnesEndTheRows) {
  for (const MissingKind kind : {MissingKind::absent, MissingKind::blank, MissingKind::broken, MissingKind::failed}) {
    auto tiles = std::make_unique<FormulaTiles>(half_degree(GeoRect{}));
    tiles->missing = {.level = 4, .x = 2, .y = 1};
    tiles->kind = kind;
    auto input = open_tile_rows(std::move(tiles), 2, {}, "a.tif");
    ASSERT_TRUE(input) << input.error().message;
    std::vector<std::uint8_t> row(720 * 4);
    for (int y = 0; y < 32; ++y) ASSERT_TRUE(input->rows->read_row(row));
    const Status read = input->rows->read_row(row);
    const bool is_hole = kind == MissingKind::absent || kind == MissingKind::blank;
    ASSERT_EQ(read.ok(), is_hole);
    if (is_hole) {
      EXPECT_EQ(row[4 * 64 + 3], 0);
      EXPECT_EQ(row[4 * 63 + 3], 200);
    } else {
      EXPECT_EQ(read.error().message, "a.tif: the rows from 33 of 360 on cannot be made: tile of the test");
    }
  }
}

TEST(TileRowsTest, OtherGridsAreRefused) {
  TileSetInfo info = half_degree(GeoRect{});
  info.grid.projection = Projection::web_mercator;
  const auto input = open_tile_rows(std::make_unique<FormulaTiles>(info), 2, {}, "a.tif");
  ASSERT_FALSE(input);
  EXPECT_EQ(input.error().message.find("a.tif: "), 0U);
}

/// One row of tiles is all that is held, also for 86400 columns.
TEST(WidePictureTest, RowsOfTilesFitIntoTheirPart) {
  constexpr std::int64_t kPlanetWidth = 86400;
  constexpr long kMost_KiB = 64L << 10;
  TileSetInfo info = half_degree(rect(-180.0, 88.0, 180.0, 90.0));
  info.grid.tile_px = tile_side_for_rows(kPlanetWidth);
  EXPECT_EQ(info.grid.tile_px, 64);
  info.grid.max_level = 10;
  info.grid.root_span_deg = 360.0 / kPlanetWidth * info.grid.tile_px * 1024;
  const pid_t child = fork();
  if (child == 0) {
    auto input = open_tile_rows(std::make_unique<FormulaTiles>(info), 2, {}, "a.tif");
    std::vector<std::uint8_t> row(static_cast<std::size_t>(kPlanetWidth) * 4);
    bool good = input.ok() && input->rows->info().width_px == kPlanetWidth;
    for (int y = 0; good && y < 300; ++y) good = input->rows->read_row(row).ok();
    _exit(good ? 0 : 1);
  }
  int status = -1;
  rusage used{};
  ASSERT_EQ(wait4(child, &status, 0, &used), child);
  ASSERT_EQ(status, 0);
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  EXPECT_LT(used.ru_maxrss, own.ru_maxrss + kMost_KiB);
  EXPECT_EQ(tile_side_for_rows(10800), 256);
  EXPECT_EQ(tile_side_for_rows(1 << 20), 8 * 2);
}

}  // namespace
}  // namespace terrella::test
