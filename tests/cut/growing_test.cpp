// A picture shows before it is cut: coarse pictures, and tiles that arrive while the cut goes on.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <future>
#include <numbers>
#include <thread>

#include "cut_files.h"
#include "streaming/cut/growing/coarse_canvas.h"
#include "streaming/cut/growing/coarse_raster.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/sets/open_tile_set.h"
#include "tests/support/end_by_answer.h"
#include "tiles/height_decoder.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// Waves of a third of the picture, different in each channel.
Image waves(int width_px, int height_px) {
  const auto wave = [](int size_px, double turned) {
    std::vector<double> values;
    for (int i = 0; i < size_px; ++i) {
      values.push_back(60.0 * std::sin(6.0 * std::numbers::pi * (i + 0.5) / size_px + turned));
    }
    return values;
  };
  std::array<std::vector<double>, 3> across, down;
  for (std::size_t c = 0; c < 3; ++c) {
    across[c] = wave(width_px, static_cast<double>(c));
    down[c] = wave(height_px, 2.0 - static_cast<double>(c));
  }
  return painted(width_px, height_px, [&](int x, int y, int c) {
    if (c == 3) return 255;
    const auto k = static_cast<std::size_t>(c);
    return static_cast<int>(
        std::lround(127.0 + across[k][static_cast<std::size_t>(x)] + down[k][static_cast<std::size_t>(y)]));
  });
}

/// RMS difference of two pictures as they show. Transparent pixels count as equal, whatever colour they store.
double rms(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
    const std::size_t alpha = i | 3U;
    const auto shown = [&](const Image& of) { return i == alpha ? of.rgba[i] : of.rgba[i] * of.rgba[alpha] / 255.0; };
    sum += std::pow(shown(a) - shown(b), 2);
  }
  return std::sqrt(sum / static_cast<double>(a.rgba.size()));
}

std::vector<std::byte> bytes_of(const Result<EncodedTile, TileFailure>& tile) {
  return tile ? tile->bytes : std::vector<std::byte>{};
}

class GrowingCutTest : public testing::Test {
 protected:
  /// Five bands of 256 rows, wider than a canvas.
  void write_large() {
    write_png(options_.images.front(), noise(2560, 1280));
    options_.tile_px = 32;
  }
  std::shared_ptr<GrowingCut> start() {
    auto cut = GrowingCut::start(options_, folder_.path());
    EXPECT_TRUE(cut) << cut.error().message;
    return cut ? *std::move(cut) : nullptr;
  }
  static void wait(const GrowingCut& cut) {
    while (!cut.state().ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(cut.state().error) << cut.state().error->message;
  }
  /// The unfinished work of an earlier cut, beside its output.
  [[nodiscard]] fs::path left_over() const {
    for (const std::string& name : folder_.names()) {
      if (name.starts_with(".") && name.ends_with(".part")) return folder_ / name;
    }
    return {};
  }

  ScratchFolder folder_;
  CutOptions options_{.images = {folder_ / "in.png"}, .tile_px = 16, .name = "in"};
};

TEST_F(GrowingCutTest, EveryTileIsThatOfThePlainCutInTheEnd) {
  write_png(options_.images.front(), noise(1024, 512));
  CutOptions plain = options_;
  plain.output = folder_ / "plain.gpkg";
  must_cut(plain);
  const auto expected = all_tiles(plain.output);
  const auto cut = start();
  wait(*cut);
  EXPECT_EQ(cut->info().grid, (*open_tile_set(plain.output))->info().grid);
  for (const auto& [id, bytes] : expected) EXPECT_EQ(bytes_of(cut->read(id)), bytes) << id.level;
  EXPECT_FALSE(cut->read({.level = 0, .x = 7, .y = 0}));
}

TEST_F(GrowingCutTest, FineTilesArriveWhenTheCutHasComeToThem) {
  write_large();
  const auto cut = start();
  const TileId last{.level = cut->info().grid.max_level, .x = 11, .y = 39};
  std::promise<std::vector<std::byte>> arrived;
  ASSERT_FALSE(cut->read(last)) << "the last row is not cut at the start";
  EXPECT_EQ(cut->read(last).error().kind, MissingKind::remote);
  EXPECT_EQ(cut->edition_of(last), 0U);
  EXPECT_GT(cut->edition_of({}), 0U) << "coarse tiles become better";
  EXPECT_TRUE(cut->read({}).value().make_picture) << "the coarsest tile is there at once";
  cut->remote()->fetch(last, 0.0, [&](auto tile) { arrived.set_value(bytes_of(tile)); });
  const TileId given_up{.level = last.level, .x = 12, .y = 39};
  cut->remote()->fetch(given_up, 0.0, [](auto) { ADD_FAILURE() << "it was cancelled"; });
  cut->remote()->cancel(given_up);
  const auto bytes = arrived.get_future().get();
  EXPECT_FALSE(bytes.empty());
  wait(*cut);
  EXPECT_EQ(bytes, bytes_of(cut->read(last)));
}

TEST_F(GrowingCutTest, AnAnswerMayEndTheCut) {
  write_large();
  auto cut = start();
  const TileId last{.level = cut->info().grid.max_level, .x = 11, .y = 39};
  EXPECT_TRUE(end_by_answer(std::move(cut), last));
}

TEST_F(GrowingCutTest, AStoppedCutKeepsWhatIsDoneAndTheNextGoesOnFromThere) {
  write_large();
  for (auto cut = start(); cut->state().share < 0.4;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const fs::path left = left_over();
  ASSERT_FALSE(left.empty());
  ASSERT_TRUE(fs::exists(left / "band-0000.rows"));
  const auto made = fs::last_write_time(left / "band-0000.tiles");
  const auto cut = start();
  const TileId first{.level = cut->info().grid.max_level, .x = 3, .y = 2};
  while (cut->state().share < 0.3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(fs::exists(left) ? fs::last_write_time(left / "band-0000.tiles") : made, made) << "it was made again";
  EXPECT_FALSE(bytes_of(cut->read(first)).empty()) << "tiles of the earlier run are there";
  wait(*cut);
  EXPECT_TRUE(left_over().empty());
}

TEST_F(GrowingCutTest, ADamagedPictureIsToldAndFineTilesThenFail) {
  write_large();
  fs::resize_file(options_.images.front(), fs::file_size(options_.images.front()) / 2);
  const auto cut = start();
  while (!cut->state().ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(cut->state().error);
  EXPECT_NE(cut->state().error->message.find("in.png: row"), std::string::npos) << cut->state().error->message;
  const auto tile = cut->read({.level = cut->info().grid.max_level, .x = 0, .y = 39});
  ASSERT_FALSE(tile);
  EXPECT_EQ(tile.error().kind, MissingKind::broken);
  EXPECT_TRUE(cut->read({}).value().make_picture) << "the coarse picture stays";
  EXPECT_TRUE(left_over().empty()) << "work that failed is not kept";
}

/// The canvas of a picture after all its rows, beside the tiles of the picture's cut.
void expect_canvas_near_cut(const CutOptions& options, const Image& picture) {
  must_cut(options);
  const auto planned = plan_pictures(options);
  ASSERT_TRUE(planned) << planned.error().message;
  CoarseCanvas canvas(planned->plan);
  for (int y = 0; y < picture.height_px; y += static_cast<int>(canvas.row_step())) {
    canvas.add_row(y, std::span(picture.rgba)
                          .subspan(static_cast<std::size_t>(y) * picture.width_px * 4,
                                   static_cast<std::size_t>(picture.width_px) * 4));
  }
  const auto tiles = open_tile_set(options.output);
  for (const auto& [id, bytes] : all_tiles(options.output)) {
    // Coarser pixels are degrees high, where the cut's weights by area count, and edges of a part are wide.
    if (id.level > canvas.grid().max_level || id.level < canvas.grid().max_level - 2) continue;
    EXPECT_LT(rms(canvas.tile(id), *decode_image(bytes)), 5.0)
        << id.level << "/" << id.x << "/" << id.y << " squeezed " << id.squeeze;
  }
}

TEST_F(GrowingCutTest, CoarseTilesAreNearThoseOfTheCut) {
  const Image picture = waves(2560, 1280);
  options_.tile_px = 32;
  options_.output = folder_ / "out.gpkg";
  write_png(options_.images.front(), picture);
  expect_canvas_near_cut(options_, picture);
  // A part that crosses ±180°.
  options_.output = folder_ / "part.gpkg";
  options_.bounds = GeoRect{.west = Angle::degrees(170),
                            .south = Angle::degrees(-10),
                            .east = Angle::degrees(-170),
                            .north = Angle::degrees(0)};
  expect_canvas_near_cut(options_, picture);
}

TEST_F(GrowingCutTest, NumbersShowASmallVersionUntilTheyAreCut) {
  // Rising to the east and to the south; values are (number - 1000) / 10, and the first rows have no data.
  std::vector<float> numbers(1024 * 512);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = i < 64 * 1024 ? -1.0F : static_cast<float>(1000 + i % 1024 + 2 * (i / 1024));
  }
  std::ofstream(folder_ / "raw", std::ios::binary)
      .write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * 4));
  std::ofstream(folder_ / "raw.hdr") << "ENVI\nsamples = 1024\nlines = 512\nbands = 1\ndata type = 4\nbyte order = 0\n";
  const fs::path file = options_.images.front() = folder_ / "in.tif";
  const std::string made = std::string(TERRELLA_GDAL_TRANSLATE) +
                           " -q -ot Int16 -a_nodata -1 -a_scale 0.1 -a_offset -100 " + (folder_ / "raw").string() +
                           " " + file.string();
  ASSERT_EQ(std::system(made.c_str()), 0);
  options_.numbers = CutNumbers{};
  const auto cut = start();
  ASSERT_TRUE(cut);
  const NumberInfo& info = *cut->info().numbers;
  const auto number_of = [&](const Result<EncodedTile, TileFailure>& tile, int x, int y) {
    const auto made_of = decode_numbers(*tile, info, 16);
    EXPECT_TRUE(made_of);
    const double number = made_of->values[static_cast<std::size_t>(y * 16 + x)];
    return (number * tile->number_scale + tile->number_offset) * info.scale + info.offset;
  };
  // The whole planet in 32 by 16 pixels; read before and after the cut.
  const auto small = cut->read({.level = 0, .x = 1, .y = 0});
  ASSERT_TRUE(small && small->make_numbers);
  EXPECT_TRUE(std::isnan(number_of(small, 8, 0)));
  for (int y = 3; y < 16; ++y) {
    for (int x = 1; x < 15; ++x)
      EXPECT_NEAR(number_of(small, x, y), 0.1 * ((16 + x + 0.5) * 32 + 2 * (y + 0.5) * 32), 3.3);
  }
  wait(*cut);
  const auto whole = cut->read({.level = 0, .x = 1, .y = 0});
  ASSERT_TRUE(whole && !whole->bytes.empty());
  for (int y = 3; y < 15; ++y) EXPECT_NEAR(number_of(whole, 8, y), number_of(small, 8, y), 5.0);
}

struct CoarseCase {
  const char* name;
  const char* made_by;  ///< options of gdal_translate; empty: a JPEG
  friend void PrintTo(const CoarseCase& one, std::ostream* out) { *out << one.name; }
};
class CoarseRaster : public testing::TestWithParam<CoarseCase> {};

TEST_P(CoarseRaster, IsASmallVersionOfThePicture) {
  const ScratchFolder folder;
  const Image picture = waves(3000, 1500);
  write_jpeg(folder / "in.jpg", picture);
  fs::path file = folder / "in.jpg";
  if (*GetParam().made_by != '\0') {
    file = folder / "in.tif";
    const std::string command = std::string(TERRELLA_GDAL_TRANSLATE) + " -q " + GetParam().made_by + " " +
                                (folder / "in.jpg").string() + " " + file.string();
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  CrsPlace place{.to_crs = {.x0 = -180.0, .x_per_column = 0.12, .y0 = 90.0, .y_per_row = -0.12}, .crs = "EPSG:4326"};
  const auto raster = open_coarse_raster(file, place);
  ASSERT_TRUE(raster) << raster.error().message;
  ASSERT_TRUE(*raster);
  const RasterLevel& level = (*raster)->info().levels.back();
  EXPECT_LT(level.width_px, 1600);
  EXPECT_NEAR(level.to_crs.x_per_column * static_cast<double>(level.width_px), 360.0, 1e-9);
  EXPECT_NEAR(level.to_crs.y_per_row * static_cast<double>(level.height_px), -180.0, 1e-9);
  const auto block = (*raster)->read({.level = 0, .x = 0, .y = 0});
  ASSERT_TRUE(block);
  const auto image = block->make_picture();
  ASSERT_TRUE(image);
  const double by = 3000.0 / static_cast<double>(level.width_px);
  double worst = 0.0;
  const auto high = std::min<std::int64_t>(level.height_px, image->height_px);
  for (int y = 0; y < high; ++y) {
    for (int x = 0; x < std::min<std::int64_t>(level.width_px, image->width_px); ++x) {
      const auto at = [](const Image& of, int column, int row) {
        return of.rgba[4 * (static_cast<std::size_t>(row) * of.width_px + column)];
      };
      const int true_x = static_cast<int>((x + 0.5) * by), true_y = static_cast<int>((y + 0.5) * by);
      worst = std::max(worst, std::abs(double(at(*image, x, y)) - at(picture, true_x, true_y)));
    }
  }
  // The waves' slope is at most 1.2 levels a pixel, JPEG adds a few levels.
  EXPECT_LT(worst, 1.2 * by + 12.0);
}

INSTANTIATE_TEST_SUITE_P(All, CoarseRaster,
                         testing::Values(CoarseCase{"jpeg", ""}, CoarseCase{"strips", "-co COMPRESS=DEFLATE"},
                                         CoarseCase{"strips_of_eight_rows", "-co BLOCKYSIZE=8"},
                                         CoarseCase{"tiles", "-co TILED=YES -co BLOCKXSIZE=32 -co BLOCKYSIZE=32"},
                                         CoarseCase{"few_tiles",
                                                    "-co TILED=YES -co BLOCKXSIZE=512 -co BLOCKYSIZE=512"}),
                         [](const auto& made) { return made.param.name; });

TEST(CoarseRasterOf, ProgressiveAndInterlacedPicturesOpenWithoutDecoding) {
  const ScratchFolder folder;
  write_jpeg(folder / "p.jpg", waves(512, 256), true);
  write_interlaced_png(folder / "i.png", waves(512, 256));
  EXPECT_TRUE(read_all_rows(folder / "p.jpg"));
  EXPECT_TRUE(read_all_rows(folder / "i.png"));
  EXPECT_FALSE(*open_coarse_raster(folder / "i.png", {}));
}

}  // namespace
}  // namespace terrella::test
