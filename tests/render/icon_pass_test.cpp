// Icons alone, judged by where trigonometry and GeographicLib put their parts.
#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "object_canvas.h"

namespace terrella::test {
namespace {

// A part of an icon lies where geometry says, to this, and covers as many pixels. A turned edge is blended by its
// distance from a pixel's middle, which is not quite the covered area.
constexpr double kPlace_px = 0.1, kOfTheArea = 0.03;
constexpr std::array<ObjectColor, 4> kParts{{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {0, 0, 0}}};

/// A picture of four parts: red and green above, blue and black below.
std::shared_ptr<const IconImage> four_parts(int width_px, int height_px, std::uint8_t alpha = 255) {
  IconImage icon{width_px, height_px, {}};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const ObjectColor& c = kParts[(y < height_px / 2 ? 0U : 2U) + (x < width_px / 2 ? 0U : 1U)];
      icon.rgba.insert(icon.rgba.end(), {c.red, c.green, c.blue, alpha});
    }
  }
  return std::make_shared<const IconImage>(std::move(icon));
}

struct Seen {
  double weight = 0.0;  ///< covered pixels
  glm::dvec2 middle{0.0};
};

/// The pixels of a part. Red, green and blue count by their channel, black by the rest of alpha, so mixed pixels count
/// for each part by its share. The picture is premultiplied.
Seen find(const ObjectPicture& picture, std::size_t part) {
  Seen seen;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      const ObjectColor c = picture.at(x, y);
      const std::array<int, 4> shares{c.red, c.green, c.blue, c.alpha - c.red - c.green - c.blue};
      const double share = shares[part] / 255.0;
      seen.weight += share;
      seen.middle += share * glm::dvec2(x + 0.5, y + 0.5);
    }
  }
  seen.middle /= std::max(seen.weight, 1e-9);
  return seen;
}

/// `turn`: clockwise on the screen. Offsets in the icon are counted from its place, right and down.
glm::dvec2 turned(const glm::dvec2& offset, double turn) {
  return {std::cos(turn) * offset.x - std::sin(turn) * offset.y, std::sin(turn) * offset.x + std::cos(turn) * offset.y};
}

class IconPassTest : public ObjectCanvas {
 protected:
  /// Checks all parts of the icon: their places and sizes.
  void check(const PointObject& point, const Camera& camera, double turn) {
    const ObjectPicture picture = draw({.points = {point}}, camera);
    const glm::dvec2 place = *project(view(camera), ellipsoid().to_ecef(point.place));
    const glm::dvec2 shape(point.icon.image->width_px, point.icon.image->height_px);
    const glm::dvec2 sides = shape * (double(point.size_px) / std::max(shape.x, shape.y));
    for (std::size_t k = 0; k < kParts.size(); ++k) {
      const glm::dvec2 part(k % 2 == 0 ? 0.25 : 0.75, k < 2 ? 0.25 : 0.75);
      const glm::dvec2 ought = place + turned((part - glm::dvec2(point.icon.anchor)) * sides, turn);
      const Seen seen = find(picture, k);
      EXPECT_NEAR(seen.weight, 0.25 * sides.x * sides.y, kOfTheArea * sides.x * sides.y)
          << "part " << k << " turn " << turn;
      EXPECT_LT(glm::distance(seen.middle, ought), kPlace_px)
          << "part " << k << " turn " << turn << " is at " << seen.middle.x << ',' << seen.middle.y << ", not at "
          << ought.x << ',' << ought.y;
    }
  }
};

TEST_F(IconPassTest, AnIconHasItsPlaceSizeAnchorAndTurnInEveryDepthMode) {
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 150});
    for (const double turn_deg : {0.0, 30.0, 90.0, -135.0}) {
      for (const glm::vec2 anchor : {glm::vec2(0.5F, 0.5F), glm::vec2(0.5F, 1.0F), glm::vec2(0.0F, 0.25F)}) {
        PointObject point{.place = at(47.3, 8.2, 5.0e3), .size_px = 40.0F};
        point.icon = {four_parts(16, 8), anchor, Angle::degrees(turn_deg)};
        check(point, over(47.0, 8.0, 2.0e6, -80.0, 20.0), Angle::degrees(turn_deg).rad());
      }
    }
  }
}

TEST_F(IconPassTest, AHeadingFromNorthFollowsTheGround) {
  const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
  use(DepthMode::reversed, {300, 300});
  for (const Camera& camera :
       {over(60.0, 20.0, 3.0e6), over(50.0, 12.0, 2.0e6, -50.0, 35.0), over(-80.0, 20.0, 3.0e6)}) {
    for (const double heading_deg : {0.0, 45.0, 200.0}) {
      const double off_deg = camera.pitch == Angle::degrees(-90.0) ? 2.0 : 9.0;
      PointObject point{.place = at(camera.eye.lat.deg() + off_deg, camera.eye.lon.deg() + off_deg), .size_px = 48.0F};
      point.icon = {four_parts(24, 24), {0.5F, 0.5F}, Angle::degrees(heading_deg), true};
      double lat_deg = 0.0, lon_deg = 0.0;
      earth.Direct(point.place.lat.deg(), point.place.lon.deg(), heading_deg, 100.0, lat_deg, lon_deg);
      const View eye = view(camera);
      const glm::dvec2 way =
          *project(eye, ellipsoid().to_ecef(at(lat_deg, lon_deg))) - *project(eye, ellipsoid().to_ecef(point.place));
      check(point, camera, std::atan2(way.x, -way.y));
    }
  }
}

// A large picture drawn small shows the means of its pixels, and nothing of its neighbours in the atlas.
TEST_F(IconPassTest, AReducedIconShowsMeans) {
  IconImage board{256, 256, {}};
  for (int k = 0; k < 256 * 256; ++k) {
    const auto value = static_cast<std::uint8_t>((k % 256 + k / 256) % 2 == 0 ? 255 : 0);
    board.rgba.insert(board.rgba.end(), {value, value, value, 255});
  }
  IconImage black{256, 256, std::vector<std::uint8_t>(4UL * 256 * 256, 0)};
  for (std::size_t k = 3; k < black.rgba.size(); k += 4) black.rgba[k] = 255;
  ObjectScene scene;
  const auto shared_black = std::make_shared<const IconImage>(black);
  for (const double lon : {-20.0, 20.0}) {
    scene.points.push_back({.place = at(0, lon), .size_px = 12.0F, .icon = {.image = shared_black}});
  }
  scene.points.push_back(
      {.place = at(0, 0), .size_px = 12.0F, .icon = {.image = std::make_shared<const IconImage>(board)}});
  const ObjectPicture picture = draw(scene, over(0.0, 0.0, 8.0e6));
  for (int y = 95; y < 105; ++y) {
    for (int x = 95; x < 105; ++x) {
      EXPECT_NEAR(picture.at(x, y).red, 128, 3) << x << ',' << y;
      EXPECT_EQ(picture.at(x, y).alpha, 255) << x << ',' << y;
    }
  }
}

TEST_F(IconPassTest, TransparentPixelsOfAPictureHaveNoColourAndTintIsAFactor) {
  IconImage half{2, 1, {255, 0, 0, 255, 0, 255, 0, 0}};  // the right half is transparent, and green
  PointObject point{.place = at(0, 0), .size_px = 40.0F, .icon = {.image = std::make_shared<const IconImage>(half)}};
  const ObjectPicture picture = draw({.points = {point}}, over(0.0, 0.0, 8.0e6));
  EXPECT_EQ(picture.at(85, 100), (ObjectColor{255, 0, 0}));
  EXPECT_EQ(picture.at(115, 100).alpha, 0);
  for (int x = 70; x < 130; ++x) EXPECT_EQ(picture.at(x, 100).green, 0) << x;
  point.icon.image = four_parts(8, 8);
  point.icon.tint = {100, 255, 255, 128};
  const ObjectPicture tinted = draw({.points = {point}}, over(0.0, 0.0, 8.0e6));
  EXPECT_NEAR(tinted.at(90, 90).red, 50, 1) << "premultiplied in the picture";
  EXPECT_NEAR(tinted.at(90, 90).alpha, 128, 1);
}

TEST_F(IconPassTest, TheNearerIconIsOnTopAndTheEdgeOfItShowsTheFarther) {
  const auto parts = four_parts(16, 16);
  const auto other = std::make_shared<const IconImage>(IconImage{1, 1, {255, 255, 255, 255}});
  const PointObject near_icon{.place = at(0, 0, 1.0e5), .size_px = 20.5F, .icon = {.image = parts}};
  const PointObject far_icon{.place = at(0, 0, 10.0), .size_px = 60.0F, .icon = {.image = other}};
  for (const bool near_first : {true, false}) {
    const auto points = near_first ? std::vector{near_icon, far_icon} : std::vector{far_icon, near_icon};
    const ObjectPicture picture = draw({.points = points}, over(0.0, 0.0, 4.0e6));
    EXPECT_EQ(picture.at(95, 95), kParts[0]) << near_first;
    EXPECT_EQ(picture.at(80, 100), (ObjectColor{255, 255, 255})) << near_first;
    for (int x = 72; x < 128; ++x) EXPECT_EQ(picture.at(x, 95).alpha, 255) << x << ' ' << near_first;
  }
}

TEST_F(IconPassTest, TenThousandIconsOfManyPicturesAreTwoDraws) {
  std::vector<std::shared_ptr<const IconImage>> images;
  for (int k = 0; k < 40; ++k) images.push_back(four_parts(8 + k, 40 - k));
  ObjectScene scene;
  for (int k = 0; k < 10'000; ++k) {
    scene.points.push_back({.place = at(k % 120 - 60.0, k % 359), .icon = {.image = images[std::size_t(k % 40)]}});
  }
  static_cast<void>(draw(scene, over(0.0, 0.0, 1.0e7)));
  EXPECT_EQ(draw_calls_, 2);
}

}  // namespace
}  // namespace terrella::test
