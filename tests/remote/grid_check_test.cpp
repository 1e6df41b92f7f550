#include "streaming/remote/grid_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace terrella {
namespace {

using Verdict = GridCheck::Verdict;
constexpr int kTilePx = 64;

/// A planet without symmetries: waves of a few lengths, on the unit sphere so that it goes round at ±180°.
struct Planet {
  double amplitude = 100.0;  ///< levels of 8 bits
  double detail = 20.0;      ///< amplitude of waves that coarse levels cannot show

  [[nodiscard]] std::array<std::uint8_t, 3> colour(double lat_deg, double lon_deg) const {
    const double lat = lat_deg * std::numbers::pi / 180.0;
    const double lon = lon_deg * std::numbers::pi / 180.0;
    const double x = std::cos(lat) * std::cos(lon), y = std::cos(lat) * std::sin(lon), z = std::sin(lat);
    const double broad = std::sin(3.1 * x + 1.7 * y + 2.3 * z + 0.4) + 0.6 * std::sin(5.3 * y - 4.1 * z + 1.1 * x);
    const double fine = std::sin(90.0 * x + 70.0 * z) * std::sin(110.0 * y);
    const double value = amplitude * (0.5 * broad) + (amplitude > 0 ? detail * fine : 0.0);
    const auto level = [](double v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0, 255.0)); };
    return {level(128 + value), level(110 - 0.7 * value), level(140 + 0.4 * value)};
  }
};

/// A server with a grid and an order of rows of its own, whatever the client believes.
struct Server {
  Planet planet{};
  double root_span_deg = 180.0;
  bool mercator = false;
  bool flipped = false;
  double top_deg = 90.0;  ///< northern edge of row 0
  int jpeg_quality = 0;   ///< 0: not through JPEG
  int asked = 0;

  Result<std::optional<Image>> operator()(const TileId& asked_id) {
    ++asked;
    TileId id = asked_id;
    const double span = std::ldexp(mercator ? 360.0 : root_span_deg, -id.level);
    const auto columns = static_cast<std::int64_t>(std::ceil(360.0 / span - 1e-9));
    const auto rows = static_cast<std::int64_t>(std::ceil((mercator ? 360.0 : 180.0) / span - 1e-9));
    if (flipped) id.y = rows - 1 - id.y;
    if (id.x < 0 || id.x >= columns || id.y < 0 || id.y >= rows) return std::optional<Image>();
    Image image{kTilePx, kTilePx, {}};
    for (int row = 0; row < kTilePx; ++row) {
      for (int column = 0; column < kTilePx; ++column) {
        const double lon = -180.0 + (static_cast<double>(id.x) + (column + 0.5) / kTilePx) * span;
        const double down = (static_cast<double>(id.y) + (row + 0.5) / kTilePx) * span;
        const double lat =
            mercator ? std::atan(std::sinh((180.0 - down) * std::numbers::pi / 180.0)) * 180.0 / std::numbers::pi
                     : top_deg - down;
        const bool outside = lon > 180.0 || lat < -90.0;
        for (const std::uint8_t c : planet.colour(lat, lon)) image.rgba.push_back(outside ? 0 : c);
        image.rgba.push_back(255);
      }
    }
    if (jpeg_quality == 0) return std::optional(std::move(image));
    auto decoded = decode_image(*encode_jpeg(image, jpeg_quality));
    return std::optional(*std::move(decoded));
  }
};

GridCheck check(Server& server, double believed_span_deg = 180.0, int max_level = 5,
                Projection projection = Projection::equirectangular) {
  const TileGrid grid{
      .root_span_deg = believed_span_deg, .tile_px = kTilePx, .max_level = max_level, .projection = projection};
  const auto result = find_mistaken_grid(std::ref(server), grid);
  EXPECT_TRUE(result);
  EXPECT_LE(server.asked, 9);
  EXPECT_EQ(result->advice.empty(), result->verdict == Verdict::fits) << result->advice;
  return *result;
}

GridCheck check(Server&& server, double believed_span_deg = 180.0, int max_level = 5) {
  return check(server, believed_span_deg, max_level);
}

TEST(GridCheck, RightSetsFitWhateverJpegDoesToThem) {
  for (const double span : {180.0, 288.0, 360.0, 90.0, 273.07}) {
    for (const int quality : {0, 90, 50, 20}) {
      EXPECT_EQ(check({.root_span_deg = span, .jpeg_quality = quality}, span).verdict, Verdict::fits)
          << span << " " << quality;
    }
  }
}

TEST(GridCheck, FindsRowsThatCountFromTheOtherEnd) {
  for (const int quality : {0, 50}) {
    const GridCheck found = check({.flipped = true, .jpeg_quality = quality});
    EXPECT_EQ(found.verdict, Verdict::flipped_rows);
    EXPECT_NE(found.advice.find("{-y}"), std::string::npos);
  }
}

TEST(GridCheck, TellsOneRootTileFromTwo) {
  EXPECT_EQ(check({.root_span_deg = 360.0}, 180.0).verdict, Verdict::one_root);
  EXPECT_EQ(check({.root_span_deg = 180.0}, 360.0).verdict, Verdict::two_roots);
}

TEST(GridCheck, TellsWebMercator) {
  EXPECT_EQ(check({.mercator = true}, 180.0).verdict, Verdict::web_mercator);
  EXPECT_EQ(check({.mercator = true}, 360.0).verdict, Verdict::web_mercator);
  EXPECT_EQ(check({.mercator = true, .jpeg_quality = 50}, 180.0).verdict, Verdict::web_mercator);
}

TEST(GridCheck, LooksWhetherWhatIsSaidToBeWebMercatorIs) {
  const auto check_square = [](Server server) { return check(server, 360.0, 5, Projection::web_mercator); };
  EXPECT_EQ(check_square({.mercator = true}).verdict, Verdict::fits);
  EXPECT_EQ(check_square({.mercator = true, .flipped = true}).verdict, Verdict::flipped_rows);
  const GridCheck two = check_square({.root_span_deg = 180.0});
  EXPECT_EQ(two.verdict, Verdict::two_roots);
  EXPECT_NE(two.advice.find("leave out ‹projection› web-mercator"), std::string::npos) << two.advice;
  EXPECT_EQ(check_square({.root_span_deg = 360.0}).verdict, Verdict::one_root);
}

TEST(GridCheck, SaysNothingOfFlatSeas) {
  const Planet sea{.amplitude = 0.0};
  for (const bool flipped : {false, true}) {
    EXPECT_EQ(check({.planet = sea, .flipped = flipped}).verdict, Verdict::cannot_tell);
    EXPECT_EQ(check({.planet = sea, .mercator = true, .flipped = flipped}).verdict, Verdict::cannot_tell);
  }
}

TEST(GridCheck, SaysNothingOfAPartOrOfOneLevel) {
  EXPECT_EQ(check(Server{}, 180.0, 0).verdict, Verdict::cannot_tell);
  // The western half alone, as an overlay may be: its missing half is no proof of another grid.
  Server west;
  const auto half = [&](const TileId& id) -> Result<std::optional<Image>> {
    if (id.x >= (1LL << id.level)) return std::optional<Image>();
    return west(id);
  };
  const auto result = find_mistaken_grid(half, {.tile_px = kTilePx, .max_level = 4});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->verdict, Verdict::fits) << result->advice;
}

TEST(GridCheck, TilesOfSomethingElseFitNeitherWay) {
  Server here;
  Server there{.planet = {.amplitude = -100.0}};
  const auto mixed = [&](const TileId& id) { return id.level == 0 ? here(id) : there(id); };
  const auto result = find_mistaken_grid(mixed, {.tile_px = kTilePx, .max_level = 4});
  ASSERT_TRUE(result);
  EXPECT_NE(result->verdict, Verdict::fits);
}

TEST(GridCheck, PassesOnThatItCouldNotAsk) {
  const auto down = [](const TileId&) -> Result<std::optional<Image>> { return Error{"no network"}; };
  EXPECT_FALSE(find_mistaken_grid(down, {.max_level = 3}));
}

}  // namespace
}  // namespace terrella
