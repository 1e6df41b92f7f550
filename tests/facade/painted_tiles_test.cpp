// Tiles that an application paints itself, from raw pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"
#include "tiles/painted_tiles.h"

namespace terrella::test {
namespace {

constexpr Viewport kPainted{64, 64};
const TileGrid kPaintedGrid{.tile_px = 64, .max_level = 2};

/// Red grows to the east of a tile, green to the south.
Image slope_of_colors() {
  Image image{64, 64, {}};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (const int part : {4 * x, 4 * y, 0, 255}) image.rgba.push_back(static_cast<std::uint8_t>(part));
    }
  }
  return image;
}

class PaintedTiles : public GlTest {
 protected:
  static std::unique_ptr<Globe> globe_of(const TilePainter& paint) {
    auto globe = make_globe(unlit_options(), painted_tiles(kPaintedGrid, paint));
    globe->set_camera(camera_at(-20, 20, 2.0e6));
    return globe;
  }
};

TEST_F(PaintedTiles, ShowTheirPixelsFromTheNorthWestCorner) {
  const auto globe = globe_of([](const TileId&) { return slope_of_colors(); });
  settle(*globe, kPainted);
  const Picture shot = picture();
  const Color north_west = shot.at(20, 20), south_east = shot.at(30, 30);
  EXPECT_GT(south_east[0], north_west[0]);
  EXPECT_GT(south_east[1], north_west[1]);
  EXPECT_EQ(north_west[2], 0);
  EXPECT_TRUE(globe->missing_tiles().empty());
}

// Snow beside rock has no dark rim and no light one: a magnified picture has no value outside of those of its texels.
TEST_F(PaintedTiles, MagnifiedHaveNoValueOutsideOfTheirTexels) {
  constexpr int kLeast = 60, kMost = 200;
  const auto snow_and_rock = [](const TileId&) {
    Image image{64, 64, {}};
    std::minstd_rand random(7);
    for (int k = 0; k < 64 * 64; ++k) {
      const auto value = static_cast<std::uint8_t>(random() % 2 == 0 ? kLeast : kMost);
      image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    return image;
  };
  GlobeOptions options = unlit_options();
  options.surface.sharpness = Sharpness::bicubic;
  const auto globe = make_globe(options, painted_tiles(kPaintedGrid, snow_and_rock));
  globe->set_camera(camera_at(-20, 20, 1.0e6));
  settle(*globe, kPainted);
  const Picture shot = picture();
  int least = 255, most = 0;
  for (int y = 0; y < kPainted.height_px; ++y) {
    for (int x = 0; x < kPainted.width_px; ++x) {
      least = std::min<int>(least, shot.at(x, y)[0]);
      most = std::max<int>(most, shot.at(x, y)[0]);
    }
  }
  EXPECT_GE(least, kLeast - 1) << "1 level: rounding";
  EXPECT_LE(most, kMost + 1);
  EXPECT_LT(least, kLeast + 20) << "texels are magnified, not averaged";
  EXPECT_GT(most, kMost - 20);
}

// Whatever goes wrong in the application's function, the tile is missing, and the message says why.
TEST_F(PaintedTiles, ThatFailAreMissing) {
  const std::pair<TilePainter, const char*> cases[] = {
      {[](const TileId&) -> Result<Image, TileFailure> { throw 7; }, "exception"},
      {[](const TileId&) -> Result<Image, TileFailure> { throw std::runtime_error("out of paint"); }, "out of paint"},
      {[](const TileId&) {
         return Image{2, 2, std::vector<std::uint8_t>(16, 9)};
       },
       "2×2"},
      {[](const TileId&) {
         return TileFailure{MissingKind::blank, "nothing here"};
       },
       "nothing here"}};
  for (const auto& [paint, says] : cases) {
    const auto globe = globe_of(paint);
    settle(*globe, kPainted);
    ASSERT_FALSE(globe->missing_tiles().empty()) << says;
    EXPECT_NE(globe->missing_tiles().front().failure.why.find(says), std::string::npos)
        << globe->missing_tiles().front().failure.why;
  }
}

}  // namespace
}  // namespace terrella::test
