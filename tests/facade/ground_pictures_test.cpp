// Lines and areas that lie on the ground, beside rays that are cast at the ground in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "caller_scene.h"
#include "objects/object_picker.h"

namespace terrella::test {
namespace {

constexpr Viewport kView{120, 90}, kWide{640, 480};
constexpr int kRays = 4;  // a side of a pixel
const Color kGround{0, 160, 0};
constexpr ObjectColor kInk{240, 0, 0};

Geodetic on_map(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = 0.0};
}

std::vector<Geodetic> ring_of(std::initializer_list<std::pair<double, double>> lon_lat) {
  std::vector<Geodetic> places;
  for (const auto& [lon, lat] : lon_lat) places.push_back(on_map(lat, lon));
  return places;
}

const PolygonObject kEurope{.rings = {ring_of({{-40, 10}, {60, 10}, {60, 80}, {-40, 80}})}, .fill = kInk};

class GroundPicturesTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto made = Globe::create(unlit_options(), one_colour({.tile_px = 16, .max_level = 1}, kGround));
    ASSERT_TRUE(made) << made.error().message;
    globe_ = *std::move(made);
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  void look(double lat_deg, double lon_deg, double height_m, double pitch_deg = -90.0) {
    globe_->set_camera(camera_at(lat_deg, lon_deg, height_m, 0.0, pitch_deg));
    settle(*globe_, kView);
  }
  void set_bytes(std::size_t bytes) {
    globe_->set_budget({.gpu_bytes = bytes,
                        .upload_bytes_per_frame = 8U << 20,
                        .upload_time_per_frame = {},
                        .relief_meshes_per_frame = 1});
  }
  /// All ground of a wide picture, a quarter of it at least, has ink.
  static void expect_all_ink(const Picture& shot) {
    int bare = 0, inked = 0;
    for (int y = 0; y < kWide.height_px; ++y) {
      for (int x = 0; x < kWide.width_px; ++x) {
        bare += shot.at(x, y)[1] > kGround[1] / 2 ? 1 : 0;
        inked += ink(shot, x, y) > 0.5 ? 1 : 0;
      }
    }
    EXPECT_EQ(bare, 0);
    EXPECT_GT(inked, kWide.width_px * kWide.height_px / 4);
  }
  /// Part of the ink in a pixel.
  [[nodiscard]] static double ink(const Picture& shot, int x, int y) { return shot.at(x, y)[0] / double(kInk.red); }

  std::unique_ptr<Globe> globe_;
};

/// Part of a pixel whose rays meet an area; less than 0 at the limb.
double rays_in(const View& view, const Ground& ground, const std::vector<MapRing>& rings, int x, int y) {
  int in = 0;
  for (const int dx : {-1, 2}) {
    if (!pick(view, ground, {x + dx, y + 0.5})) return -1.0;
  }
  for (int k = 0; k < kRays * kRays; ++k) {
    const auto place = pick(view, ground, {x + (k % kRays + 0.5) / kRays, y + (k / kRays + 0.5) / kRays});
    if (!place) return -1.0;
    bool odd = false;
    for (const MapRing& ring : rings) odd = odd != crosses_odd(ring, {place->lon.deg(), place->lat.deg()});
    in += odd ? 1 : 0;
  }
  return in / double(kRays * kRays);
}

struct AreaCase {
  const char* name;
  std::vector<std::vector<Geodetic>> rings;
  double lat, lon, height_m, pitch = -90.0;
};
const AreaCase kAreas[] = {
    {"over a pole", {ring_of({{0, 70}, {100, 65}, {-120, 72}})}, 80.0, 30.0, 6.0e6},
    {"over a pole with a hole at it",
     {ring_of({{0, 60}, {90, 60}, {180, 60}, {-90, 60}}), ring_of({{0, 80}, {120, 80}, {-120, 80}})},
     90.0,
     0.0,
     6.0e6},
    {"over the antimeridian", {ring_of({{160, -20}, {-160, -25}, {-150, 10}, {175, 20}})}, 0.0, 180.0, 8.0e6},
    {"Fiji, with an edge of no length at the antimeridian",
     {ring_of({{-180, -16.067},
               {-179.795, -16.021},
               {-179.917, -16.502},
               {-180, -16.556},
               {179.363, -16.801},
               {178.726, -17.011},
               {178.596, -16.639},
               {179.096, -16.434},
               {179.413, -16.378},
               {180, -16.067}})},
     -16.6,
     179.3,
     3.0e5},
    {"around the south pole as maps draw it",
     {ring_of({{-180, -90}, {-180, -70}, {-60, -75}, {60, -65}, {180, -70}, {180, -90}})},
     -85.0,
     100.0,
     6.0e6},
    {"over a corner of three faces", {ring_of({{20, 20}, {70, 25}, {65, 55}, {30, 50}})}, 35.0, 45.0, 9.0e6},
    {"half the planet", {ring_of({{-180, 0}, {-180, 90}, {180, 90}, {180, 0}})}, 10.0, 40.0, 9.0e6},
    {"small, with a hole",
     {ring_of({{8, 47}, {9, 47}, {9, 48}, {8, 48}}), ring_of({{8.3, 47.3}, {8.7, 47.4}, {8.5, 47.8}})},
     47.5,
     8.5,
     2.0e5},
    {"a field", {ring_of({{8.5, 47.5}, {8.503, 47.5003}, {8.5025, 47.502}})}, 47.501, 8.5015, 400.0},
    {"tilted to 80 degrees", {ring_of({{8.49, 47.5}, {8.51, 47.501}, {8.505, 47.53}})}, 47.495, 8.5, 500.0, -10.0},
};

// 32 MiB have room for nine pictures, and a view to the horizon wants hundreds.
TEST_F(GroundPicturesTest, WithLittleRoomTheyAreCoarserAndWhole) {
  set_bytes(32U << 20);
  ASSERT_TRUE(globe_->add_objects({.polygons = {kEurope}}));
  for (const auto& [height_m, pitch_deg] : {std::pair{1.0e6, -90.0}, {2.0e5, -10.0}, {3.0e3, -10.0}}) {
    globe_->set_camera(camera_at(47.0, 8.5, height_m, 0.0, pitch_deg));
    settle(*globe_, kWide);
    expect_all_ink(picture());
  }
}

// 8 MiB have room for one picture. A disc needs the pictures of a cube's faces.
TEST_F(GroundPicturesTest, WhatHasNoRoomIsCounted) {
  set_bytes(8U << 20);
  ASSERT_TRUE(globe_->add_objects(
      {.polygons = {{.rings = {ring_of({{-180, -90}, {180, -90}, {180, 90}, {-180, 90}})}, .fill = kInk}}}));
  globe_->set_camera(camera_at(47.0, 8.5, 1.0e7));
  EXPECT_GT(settle(*globe_, kView).ground_left_out, 0);
  set_bytes(512U << 20);
  EXPECT_EQ(settle(*globe_, kView).ground_left_out, 0);
  EXPECT_EQ(picture().at(60, 45)[0], 240);
}

// A small map beside a large view takes a hundredth of the room, so that the large view stays as fine as it is.
TEST_F(GroundPicturesTest, ViewsShareTheRoomByTheirPixels) {
  std::vector<Geodetic> comb;
  for (int k = 0; k < 400; ++k) comb.push_back(on_map(k % 2 == 0 ? 40.0 : 55.0, 7.0 + 0.01 * k));
  ASSERT_TRUE(globe_->add_objects({.polygons = {{.rings = {comb}, .fill = kInk}}}));
  globe_->set_camera(camera_at(47.0, 8.5, 2.0e5, 0.0, -30.0));
  set_bytes(320U << 20);  // 60 pictures; the large view needs 39
  settle(*globe_, kWide);
  const Picture alone = picture();
  const auto map = *GlobeView::create(*globe_);
  map->set_camera(camera_at(47.0, 8.5, 1.0e6));
  const OffscreenTarget small({64, 48});
  for (int k = 0; k < 3; ++k) {
    const auto soon = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    ASSERT_TRUE(map->render_until_settled(small.framebuffer(), {64, 48}, soon));
    settle(*globe_, kWide);
  }
  EXPECT_EQ(picture().rgba, alone.rgba);
}

TEST_F(GroundPicturesTest, ASmallerBudgetFreesThem) {
  ASSERT_TRUE(globe_->add_objects({.polygons = {kEurope}}));
  globe_->set_camera(camera_at(47.0, 8.5, 2.0e5, 0.0, -10.0));
  const std::size_t before = settle(*globe_, kWide).gpu_bytes;
  set_bytes(32U << 20);
  EXPECT_LT(settle(*globe_, kWide).gpu_bytes, before / 2);
  expect_all_ink(picture());
  set_bytes(512U << 20);
  EXPECT_GE(settle(*globe_, kWide).gpu_bytes, before) << "as fine as before";
}

// A border that is off by half a pixel changes the covered part of a pixel by a half; at a slant by a pixel.
TEST_F(GroundPicturesTest, AreasCoverThePartOfAPixelWhoseRaysMeetThem) {
  const LayerId layer = *globe_->add_objects({});
  for (const AreaCase& c : kAreas) {
    SCOPED_TRACE(c.name);
    const PolygonObject area{.rings = c.rings, .fill = kInk, .stroke = {0, 0, 0, 0}};
    ASSERT_TRUE(globe_->set_objects(layer, {.polygons = {area}}));
    look(c.lat, c.lon, c.height_m, c.pitch);
    const auto rings = map_rings_of(area);
    ASSERT_TRUE(rings);
    const View view = globe_->view(kView);
    const Picture shot = picture();
    const double most = c.pitch == -90.0 ? 0.5 : 0.95;
    int inside = 0, outside = 0, wrong = 0;
    std::string where;
    for (int y = 0; y < kView.height_px; ++y) {
      for (int x = 0; x < kView.width_px; ++x) {
        const double truth = rays_in(view, globe_->ground(), *rings, x, y);
        if (truth < 0.0) continue;
        ++(truth > 0.5 ? inside : outside);
        if (std::abs(ink(shot, x, y) - truth) <= most) continue;
        ++wrong;
        where += " " + std::to_string(x) + "," + std::to_string(y);
      }
    }
    EXPECT_GT(inside, 200);
    EXPECT_GT(outside, 200);
    EXPECT_EQ(wrong, 0) << where;
  }
}

// Two translucent areas in one colour are one: a gap would be greener there, a double pixel redder. Colours are
// rounded twice.
TEST_F(GroundPicturesTest, AreasThatShareABorderLeaveNoGapAndNoDoublePixel) {
  constexpr ObjectColor kTint{220, 20, 20, 128};
  const int once = (220 * 128 + 127 * kGround[0]) / 255;
  for (const double span_deg : {30.0, 0.01}) {
    std::vector<Geodetic> border, west, east;
    for (int k = 0; k <= 300; ++k) {
      const double t = k / 300.0 - 0.5;
      border.push_back(on_map(40.0 + span_deg * t, 10.0 + 0.1 * span_deg * std::sin(40.0 * t)));
    }
    west = east = border;
    for (const double side : {-1.0, 1.0}) {
      std::vector<Geodetic>& area = side < 0.0 ? west : east;
      for (const double end : {0.5, -0.5}) area.push_back(on_map(40.0 + span_deg * end, 10.0 + side * span_deg));
    }
    std::ranges::reverse(east);
    const auto area = [&](const std::vector<Geodetic>& ring) {
      return PolygonObject{.rings = {ring}, .fill = kTint, .stroke = {0, 0, 0, 0}};
    };
    const LayerId layer = *globe_->add_objects({.polygons = {area(west), area(east)}});
    for (const double zoom : {1.0, 0.3, 4.0}) {
      look(40.0, 10.0, zoom * span_deg * 111e3);
      const View view = globe_->view(kView);
      const Picture shot = picture();
      for (const Geodetic& place : border) {
        const auto px = project(view, globe_->options().body.ellipsoid.to_ecef(place));
        const double end_deg = std::abs(place.lat.deg() - 40.0);
        if (!px || end_deg > 0.45 * span_deg || px->x < 1 || px->y < 1 || px->x > 118 || px->y > 88) continue;
        EXPECT_NEAR(shot.at(int(px->x), int(px->y))[0], once, 2) << span_deg << " " << zoom;
      }
    }
    ASSERT_TRUE(globe_->remove(layer));
  }
}

struct LineCase {
  const char* name;
  Geodetic from, to;
  double lat, lon, height_m, pitch;
  bool upright;  ///< runs up the picture, else across
};

// The ink across a line is its width, and its middle lies on the line.
TEST_F(GroundPicturesTest, LinesHaveTheirPlaceAndWidthInPixelsAtEveryTilt) {
  constexpr float kLine_px = 3.0F;
  const LineCase cases[] = {
      {"from above", on_map(46, 6.9), on_map(46, 7.1), 46.0, 7.0, 5e3, -90.0, false},
      {"over the antimeridian", on_map(10, 179), on_map(10, -179), 10.0, 180.0, 3e5, -90.0, false},
      {"over a pole", on_map(89, 10), on_map(89, -170), 90.0, 0.0, 5e5, -90.0, true},
      {"across, at 80 degrees", on_map(46.025, 6.9), on_map(46.025, 7.1), 46.0, 7.0, 500.0, -10.0, false},
      {"away from the eye, at 80 degrees", on_map(46.0, 7.0), on_map(46.1, 7.0), 46.0, 7.0, 500.0, -10.0, true},
      {"on the far side of a disc", on_map(-40, -10), on_map(-40, 50), 0.0, 20.0, 2e7, -90.0, false},
  };
  const LayerId layer = *globe_->add_objects({});
  for (const LineCase& c : cases) {
    SCOPED_TRACE(c.name);
    ASSERT_TRUE(
        globe_->set_objects(layer, {.lines = {{.places = {c.from, c.to}, .width_px = kLine_px, .color = kInk}}}));
    look(c.lat, c.lon, c.height_m, c.pitch);
    const View view = globe_->view(kView);
    const Picture shot = picture();
    const auto way = normals_along_geodesics({c.from, c.to}, globe_->options().body.ellipsoid, Angle::degrees(1e-4));
    int looked_at = 0;
    for (std::size_t k = 0; k + 1 < way.size(); k += way.size() / 40 + 1) {
      const auto p = project(view, globe_->options().body.ellipsoid.position(way[k]));
      const auto q = project(view, globe_->options().body.ellipsoid.position(way[k + 1]));
      if (!p || !q || p->x < 10 || p->y < 10 || p->x > 110 || p->y > 80) continue;
      if (c.pitch > -90.0 && p->y < 0.5 * kView.height_px) continue;  // beyond 80 degrees lines fade
      const glm::dvec2 along = glm::normalize(*q - *p);
      double sum = 0.0, mean = 0.0;
      for (int off = -8; off <= 8; ++off) {
        const int x = c.upright ? int(p->x) + off : int(p->x), y = c.upright ? int(p->y) : int(p->y) + off;
        const double at = ink(shot, x, y), place = c.upright ? x + 0.5 : y + 0.5;
        sum += at;
        mean += at * place;
      }
      const double slant = std::abs(c.upright ? along.y : along.x);
      if (slant < 0.5 || sum == 0.0) continue;
      ++looked_at;
      // The place of the line in the row or column of the pixel's middle.
      const glm::dvec2 middle(std::floor(p->x) + 0.5, std::floor(p->y) + 0.5);
      const double truth =
          c.upright ? p->x + (middle.y - p->y) * along.x / along.y : p->y + (middle.x - p->x) * along.y / along.x;
      const double most = c.pitch == -90.0 ? 0.5 : 1.0;
      EXPECT_NEAR(mean / sum, truth, most) << p->x << "," << p->y;
      EXPECT_NEAR(sum * slant, double(kLine_px), 0.5) << p->x << "," << p->y;
    }
    EXPECT_GT(looked_at, 3);
  }
}

// An edit is drawn once it is painted. Elsewhere the picture stays as it is, to the byte.
TEST_F(GroundPicturesTest, AnEditChangesTheGroundUnderItAndNoOther) {
  ObjectScene scene;
  for (int k = 0; k < 2; ++k) {
    const double lon = 10.0 + 20.0 * k;
    scene.polygons.push_back({.rings = {ring_of({{lon, 0}, {lon + 9, 0}, {lon + 9, 9}, {lon, 9}})},
                              .fill = kInk,
                              .of = {.id = ObjectId{std::uint64_t(k) + 1}}});
  }
  const LayerId layer = *globe_->add_objects(scene);
  look(5.0, 25.0, 4e6);
  const Picture before = picture();
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{1}, .fill = ObjectColor{0, 0, 240}}}}));
  draw(*globe_, kView);
  EXPECT_FALSE(globe_->settled());
  settle(*globe_, kView);
  const View view = globe_->view(kView);
  const auto px = [&](double lon) {
    return *project(view, globe_->options().body.ellipsoid.to_ecef(on_map(4.5, lon + 4.5)));
  };
  Picture after = picture();
  EXPECT_EQ(after.at(int(px(10).x), int(px(10).y))[2], 240);
  int changed = 0;
  for (int y = 0; y < kView.height_px; ++y) {
    for (int x = int(px(20).x); x < kView.width_px; ++x) changed += after.at(x, y) == before.at(x, y) ? 0 : 1;
  }
  EXPECT_EQ(changed, 0);
  ASSERT_TRUE(globe_->edit_objects(layer, {.remove = {ObjectId{1}}}));
  settle(*globe_, kView);
  EXPECT_EQ(picture().at(int(px(10).x), int(px(10).y)), kGround);
  ASSERT_TRUE(globe_->remove(layer));
  settle(*globe_, kView);
  EXPECT_EQ(picture().at(int(px(30).x), int(px(30).y)), kGround);
}

// An area at height 0 stays on the ellipsoid when heights raise the ground, unless it is clamped to it.
TEST_F(GroundPicturesTest, AnAreaAtHeightZeroGoesUnderGroundThatHeightsRaise) {
  PolygonObject area{.rings = {ring_of({{6, 45}, {8, 45}, {8, 47}, {6, 47}})}, .fill = kInk};
  ASSERT_TRUE(globe_->add_objects({.polygons = {area}}));
  look(46.0, 7.0, 1e5);
  EXPECT_EQ(picture().at(60, 45)[0], 240);
  auto raised = ElevationSource::open(
      painted_heights({.tile_px = 16, .max_level = 1}, [](double, double) { return 3000.0; }), "a plateau");
  ASSERT_TRUE(raised);
  ASSERT_TRUE(globe_->set_elevation(*raised));
  settle(*globe_, kView);
  EXPECT_EQ(picture().at(60, 45), kGround);
  area.heights = HeightMode::clamp_to_ground;
  ASSERT_TRUE(globe_->add_objects({.polygons = {area}}));
  settle(*globe_, kView);
  EXPECT_EQ(picture().at(60, 45)[0], 240);
}

}  // namespace
}  // namespace terrella::test
