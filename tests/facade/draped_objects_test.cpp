// Objects on the relief, beside rays that are cast at the ground in double: lines and areas that lie on it, points that
// stand on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>

#include "caller_scene.h"

namespace terrella::test {
namespace {

constexpr Viewport kHills{160, 120};
constexpr double kHillLat = 46.0, kHillLon = 7.0;
constexpr float kWidth_px = 4.0F;
// A pixel, and 0.75 px on the outer side of a bend that is seen at a slant. There the border between two pieces is
// slanted to the line. A border across the line in the picture would let pieces overlap on the inner side.
constexpr double kBeside_px = 1.75;
constexpr double kEnd_px = 6.0;  // an end is cut across the line, and not looked at
constexpr ObjectColor kHillInk{230, 20, 20};
const Color kMeadow{0, 160, 0};
// Ground within this part of the distance may hide a place or not.
constexpr double kHillNearly = 0.05;

Geodetic hill_at(double lat_deg, double lon_deg, double height_m = 0.0) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}

std::unique_ptr<Globe> hilly_globe(double exaggeration, DepthMode depth = DepthMode::reversed) {
  GlobeOptions options = unlit_options();
  options.depth = depth;
  options.exaggeration = exaggeration;
  options.relief_meshes_per_frame = 10000;
  auto heights = ElevationSource::open(painted_heights({.tile_px = 128, .max_level = 5}, waves_m), "hills");
  EXPECT_TRUE(heights) << heights.error().message;
  auto globe = Globe::create(options, one_colour({.tile_px = 16, .max_level = 1}, kMeadow), *heights);
  EXPECT_TRUE(globe) << globe.error().message;
  return *std::move(globe);
}

/// A winding track over hills and through valleys. Its pieces are shorter than the line is wide.
std::vector<Geodetic> winding(double span_deg) {
  std::vector<Geodetic> places;
  for (int k = 0; k < 250; ++k) {
    const double t = (k - 124.5) / 250.0;
    places.push_back(hill_at(kHillLat + span_deg * t, kHillLon + 0.3 * span_deg * std::sin(9.0 * t), 4321.0));
  }
  return places;
}

class DrapedObjects : public GlTest {
 protected:
  /// Looks from a distance at the ground in the middle of the track.
  static void look(Globe& globe, double away_m, double pitch_deg) {
    const double pitch = glm::radians(pitch_deg),
                 ground_m = globe.options().exaggeration * waves_m(glm::radians(kHillLat), glm::radians(kHillLon));
    const double back_deg = glm::degrees(away_m * std::cos(pitch) / globe.options().body.ellipsoid.a_m());
    Camera camera = camera_at(kHillLat - back_deg, kHillLon, 0.0, 0.0, pitch_deg);
    const double here_m = globe.options().exaggeration * waves_m(camera.eye.lat.rad(), camera.eye.lon.rad());
    camera.eye.height_m = std::max(ground_m - away_m * std::sin(pitch), here_m + 0.3 * away_m);
    globe.set_camera(camera);
  }
  static double height_m(const Globe& globe, const Geodetic& place) {
    return globe.ground_height_m(place.lat, place.lon);
  }
  void expect_markers(const Globe& globe, const ObjectScene& scene, double over_m, const std::string& what) const;
  [[nodiscard]] std::vector<bool> inked() const {
    const Picture shot = picture();
    std::vector<bool> is;
    for (int y = 0; y < kHills.height_px; ++y) {
      for (int x = 0; x < kHills.width_px; ++x) is.push_back(shot.at(x, y)[0] > 100);
    }
    return is;
  }
};

/// Sight of a place over the ground before it. A crest is drawn within half a pixel, so a place that a ray a pixel
/// lower misses may be hidden or not.
enum class Sight { open, doubtful, hidden };
Sight sight_of(const Globe& globe, const View& view, const Ecef& place, const glm::dvec2& px) {
  const double away_m = glm::length(place.xyz_m - view.eye.xyz_m);
  const auto part = [&](double lower_px) {
    const auto ground_m = globe.ground().intersect_m(view.eye, pixel_ray(view, {px.x, px.y + lower_px}), 1e-3);
    return ground_m.value_or(HUGE_VAL) / away_m;
  };
  if (part(1.0) > 1.0 - kHillNearly) return Sight::open;
  return part(-1.0) > 1.0 - kHillNearly ? Sight::doubtful : Sight::hidden;
}

/// Places along a line, close to each other, on the ground of the globe.
struct LineTruth {
  std::vector<glm::dvec2> shown_px, perhaps_px, ends_px;
};
LineTruth line_truth(const Globe& globe, const std::vector<Geodetic>& places) {
  const View view = globe.view(kHills);
  LineTruth truth;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    Geodetic place = places[k];
    place.height_m = globe.ground_height_m(place.lat, place.lon);
    const Ecef on_ground = globe.options().body.ellipsoid.to_ecef(place);
    const auto px = project(view, on_ground);
    if (!px || px->x < -9.0 || px->y < -9.0 || px->x > kHills.width_px + 9.0 || px->y > kHills.height_px + 9.0)
      continue;
    const Sight sight = sight_of(globe, view, on_ground, *px);
    if (k == 0 || k + 2 >= places.size()) truth.ends_px.push_back(*px);
    if (sight == Sight::open) truth.shown_px.push_back(*px);
    if (sight != Sight::hidden) truth.perhaps_px.push_back(*px);
  }
  return truth;
}

double nearest_px(const std::vector<glm::dvec2>& all, const glm::dvec2& px) {
  double nearest = HUGE_VAL;
  for (const glm::dvec2& one : all) nearest = std::min(nearest, glm::distance(one, px));
  return nearest;
}

/// Pixels of the line that are missing, and pixels with ink where the line is not within a pixel.
struct LineFaults {
  int gaps = 0, strays = 0, inked = 0;
  std::string where = {};
};
LineFaults faults_of(const std::vector<bool>& inked, const LineTruth& truth) {
  LineFaults faults;
  const int w = kHills.width_px, h = kHills.height_px;
  for (const glm::dvec2& px : truth.shown_px) {
    const int x = static_cast<int>(std::floor(px.x)), y = static_cast<int>(std::floor(px.y));
    if (x < 0 || y < 0 || x >= w || y >= h) continue;
    if (nearest_px(truth.ends_px, px) < kEnd_px) continue;
    if (inked[static_cast<std::size_t>(y * w + x)]) continue;
    ++faults.gaps;
    faults.where += " gap " + std::to_string(x) + "," + std::to_string(y);
  }
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      if (!inked[static_cast<std::size_t>(y * w + x)] || nearest_px(truth.ends_px, {x + 0.5, y + 0.5}) < kEnd_px)
        continue;
      ++faults.inked;
      const double off_px = nearest_px(truth.perhaps_px, {x + 0.5, y + 0.5});
      if (off_px <= 0.5 * double(kWidth_px) + kBeside_px) continue;
      ++faults.strays;
      faults.where += " stray " + std::to_string(x) + "," + std::to_string(y) + " by " + std::to_string(off_px);
    }
  }
  return faults;
}

TEST_F(DrapedObjects, ATrackLiesOnTheGroundFrom100KmTo100M) {
  for (const double exaggeration : {1.0, 20.0}) {
    const auto globe = hilly_globe(exaggeration);
    LayerId layer = *globe->add_objects({});
    for (const double away_m : {100e3, 10e3, 1e3, 100.0}) {
      const auto places = winding(away_m / 111e3 * 1.2);
      ASSERT_TRUE(globe->set_objects(
          layer,
          {.lines = {
               {.places = places, .width_px = kWidth_px, .color = kHillInk, .heights = HeightMode::clamp_to_ground}}}));
      for (const double pitch_deg : {-90.0, -15.0}) {
        look(*globe, away_m, pitch_deg);
        settle(*globe, kHills);
        const LineFaults faults = faults_of(inked(), line_truth(*globe, places));
        const std::string what = std::to_string(exaggeration) + " times, " + std::to_string(away_m) + " m, pitch " +
                                 std::to_string(pitch_deg);
        EXPECT_GT(faults.inked, 50) << what;
        // On a crest of steep relief that is seen at a slant, a pixel spans many texels, and the line ends a little
        // before or behind the place where the ground hides it.
        const int at_crests = exaggeration > 1.0 && pitch_deg > -90.0 ? 6 : 0;
        EXPECT_LE(faults.gaps, at_crests) << what << faults.where;
        EXPECT_LE(faults.strays, at_crests) << what << faults.where;
      }
    }
  }
}

void DrapedObjects::expect_markers(const Globe& globe, const ObjectScene& scene, double over_m,
                                   const std::string& what) const {
  const View view = globe.view(kHills);
  const Picture shot = picture();
  std::vector<glm::dvec2> all_px;
  int missing = 0, open = 0, strays = 0;
  for (const PointObject& point : scene.points) {
    Geodetic stands = point.place;
    stands.height_m = globe.ground_height_m(stands.lat, stands.lon) + over_m;
    const Ecef place = globe.options().body.ellipsoid.to_ecef(stands);
    const auto px = project(view, place);
    if (!px) continue;
    all_px.push_back(*px);
    if (px->x < 2.0 || px->y < 2.0 || px->x > kHills.width_px - 2.0 || px->y > kHills.height_px - 2.0) continue;
    if (sight_of(globe, view, place, *px) != Sight::open) continue;
    ++open;
    missing += shot.at(int(px->x), int(px->y)) == kMeadow ? 1 : 0;
  }
  for (int k = 0; k < kHills.width_px * kHills.height_px; ++k) {
    const int x = k % kHills.width_px, y = k / kHills.width_px;
    if (shot.at(x, y) == kMeadow) continue;
    strays += nearest_px(all_px, {x + 0.5, y + 0.5}) > 3.0 + 1.0 ? 1 : 0;
  }
  EXPECT_GT(open, 2) << what;
  EXPECT_EQ(missing, 0) << what;
  EXPECT_EQ(strays, 0) << what;
}

/// Corners of a convex area, counterclockwise.
std::vector<Geodetic> meadow(double span_deg) {
  const auto corner = [&](double north, double east) {
    return hill_at(kHillLat + north * span_deg, kHillLon + east * span_deg);
  };
  return {corner(-0.3, -0.35), corner(-0.25, 0.4), corner(0.2, 0.3), corner(0.35, -0.1)};
}

/// Pixels whose ground lies in a convex area between great circles of geodetic latitude and longitude.
std::vector<bool> truth_of_area(const Globe& globe, const std::vector<Geodetic>& corners) {
  const View view = globe.view(kHills);
  std::vector<bool> in;
  for (int y = 0; y < kHills.height_px; ++y) {
    for (int x = 0; x < kHills.width_px; ++x) {
      const auto place = pick(view, globe.ground(), {x + 0.5, y + 0.5});
      bool inside = place.has_value();
      for (std::size_t k = 0; place && k < corners.size(); ++k) {
        const Geodetic &a = corners[k], &b = corners[(k + 1) % corners.size()];
        const glm::dvec3 side = glm::cross(Ellipsoid::normal(a.lat, a.lon).xyz, Ellipsoid::normal(b.lat, b.lon).xyz);
        inside = inside && glm::dot(side, Ellipsoid::normal(place->lat, place->lon).xyz) > 0.0;
      }
      in.push_back(inside);
    }
  }
  return in;
}

/// True if no pixel within two of it lies on the other side of the border.
bool is_inside(const std::vector<bool>& truth, std::size_t k) {
  const int x = int(k) % kHills.width_px, y = int(k) / kHills.width_px;
  for (int n = 0; n < 25; ++n) {
    const int at_x = std::clamp(x + n % 5 - 2, 0, kHills.width_px - 1),
              at_y = std::clamp(y + n / 5 - 2, 0, kHills.height_px - 1);
    if (truth[static_cast<std::size_t>(at_y * kHills.width_px + at_x)] != truth[k]) return false;
  }
  return true;
}

// A pixel that was coloured twice would be redder, one that was not would be green.
TEST_F(DrapedObjects, ATranslucentAreaColoursEachPixelOfItsGroundOnce) {
  constexpr ObjectColor kTint{220, 20, 20, 128};
  const int once = (220 * 128 + 127 * kMeadow[0]) / 255;
  for (const double exaggeration : {1.0, 20.0}) {
    const auto globe = hilly_globe(exaggeration);
    const LayerId layer = *globe->add_objects({});
    for (const double away_m : {100e3, 10e3, 1e3, 100.0}) {
      const auto corners = meadow(away_m / 111e3);
      ASSERT_TRUE(globe->set_objects(
          layer,
          {.polygons = {
               {.rings = {corners}, .fill = kTint, .stroke = {0, 0, 0, 0}, .heights = HeightMode::clamp_to_ground}}}));
      for (const double pitch_deg : {-90.0, -25.0}) {
        look(*globe, away_m, pitch_deg);
        settle(*globe, kHills);
        const std::string what = std::to_string(exaggeration) + " times, " + std::to_string(away_m) + " m, pitch " +
                                 std::to_string(pitch_deg);
        const auto truth = truth_of_area(*globe, corners);
        const Picture shot = picture();
        std::vector<bool> tinted;
        int not_once = 0;
        for (std::size_t k = 0; k < truth.size(); ++k) {
          const int red = shot.rgba[4 * k];
          tinted.push_back(red > once / 2);
          // Pixels on the border have a part of the colour.
          not_once += red > once + 1 || (red > 1 && red < once - 1 && is_inside(truth, k)) ? 1 : 0;
        }
        EXPECT_GT(std::ranges::count(truth, true), 500) << what;
        EXPECT_EQ(off_by_more_than_a_pixel(tinted, truth), 0) << what;
        EXPECT_EQ(not_once, 0) << what;
      }
    }
  }
}

TEST_F(DrapedObjects, DrapesAgreeWithTheGroundInAllDepthModes) {
  for (const DepthMode depth : {DepthMode::logarithmic, DepthMode::standard}) {
    const auto globe = hilly_globe(5.0, depth);
    const auto places = winding(0.1), corners = meadow(0.1);
    const LayerId layer = *globe->add_objects(
        {.lines = {
             {.places = places, .width_px = kWidth_px, .color = kHillInk, .heights = HeightMode::clamp_to_ground}}});
    look(*globe, 10e3, -25.0);
    settle(*globe, kHills);
    const LineFaults faults = faults_of(inked(), line_truth(*globe, places));
    EXPECT_EQ(faults.gaps, 0);
    EXPECT_EQ(faults.strays, 0);
    ASSERT_TRUE(globe->set_objects(
        layer,
        {.polygons = {
             {.rings = {corners}, .fill = kHillInk, .stroke = {0, 0, 0, 0}, .heights = HeightMode::clamp_to_ground}}}));
    settle(*globe, kHills);
    EXPECT_EQ(off_by_more_than_a_pixel(inked(), truth_of_area(*globe, corners)), 0);
  }
}

// Planes through the sides of a triangle are rounded. If a triangle is as thin as the rounding, its planes can enclose
// ground far beyond the triangle, and that ground must have no ink.
TEST_F(DrapedObjects, AThinAreaHasNoInkBesideIt) {
  const auto globe = hilly_globe(20.0);
  const LayerId layer = *globe->add_objects({});
  look(*globe, 100e3, -25.0);
  constexpr double kThin_deg = 1e-8;  // a millimetre; floats 100 km from the eye have steps of 8 mm
  for (int turn_deg = 0; turn_deg < 180; turn_deg += 15) {
    const double north = std::cos(glm::radians(1.0 * turn_deg)), east = std::sin(glm::radians(1.0 * turn_deg));
    const auto along = [&](double far_deg, double beside_deg) {
      return hill_at(kHillLat + far_deg * north - beside_deg * east, kHillLon + far_deg * east + beside_deg * north);
    };
    const std::vector<Geodetic> corners = {along(-0.1, 0.0), along(0.3, kThin_deg), along(0.07, kThin_deg)};
    ASSERT_TRUE(globe->set_objects(
        layer,
        {.polygons = {
             {.rings = {corners}, .fill = kHillInk, .stroke = {0, 0, 0, 0}, .heights = HeightMode::clamp_to_ground}}}));
    settle(*globe, kHills);
    std::vector<Geodetic> middle;
    for (int k = 0; k <= 250; ++k) middle.push_back(along(-0.1 + 0.4 * k / 250.0, 0.0));
    const LineFaults faults = faults_of(inked(), line_truth(*globe, middle));
    EXPECT_EQ(faults.strays, 0) << turn_deg << " degrees" << faults.where;
  }
}

// A pixel that two pieces of a line coloured would be redder than the line's colour makes it.
TEST_F(DrapedObjects, ATranslucentLineColoursEachPixelOnce) {
  constexpr ObjectColor kTint{220, 20, 20, 128};
  const int once = (220 * 128 + 127 * kMeadow[0]) / 255;
  for (const double exaggeration : {1.0, 20.0}) {
    const auto globe = hilly_globe(exaggeration);
    ASSERT_TRUE(globe->add_objects({.lines = {{.places = winding(0.1),
                                               .width_px = 2.0F * kWidth_px,
                                               .color = kTint,
                                               .heights = HeightMode::clamp_to_ground}}}));
    for (const double pitch_deg : {-90.0, -15.0}) {
      look(*globe, 10e3, pitch_deg);
      settle(*globe, kHills);
      const Picture shot = picture();
      int tinted = 0, twice = 0;
      for (std::size_t k = 0; k < shot.rgba.size(); k += 4) {
        tinted += shot.rgba[k] > once / 2 ? 1 : 0;
        twice += shot.rgba[k] > once + 2 ? 1 : 0;
      }
      EXPECT_GT(tinted, 500) << pitch_deg;
      EXPECT_EQ(twice, 0) << exaggeration << " times, pitch " << pitch_deg << ", of " << tinted;
    }
  }
}

// Each marker stands where its ground is drawn, and no marker shows elsewhere. Labels and models share the code.
TEST_F(DrapedObjects, PointsFollowTheGroundWhenHeightsArriveAndChange) {
  for (const double over_m : {0.0, 200.0}) {
    for (const double away_m : {100e3, 10e3, 1e3}) {
      const auto globe = hilly_globe(1.0);
      ObjectScene scene;
      const auto places = winding(away_m / 111e3 * 0.9);
      for (std::size_t k = 0; k < places.size(); k += 10) {
        Geodetic place = places[k];
        place.height_m = over_m > 0.0 ? over_m : 4321.0;
        scene.points.push_back(
            {.place = place,
             .size_px = 6.0F,
             .color = kHillInk,
             .heights = over_m > 0.0 ? HeightMode::relative_to_ground : HeightMode::clamp_to_ground});
      }
      ASSERT_TRUE(globe->add_objects(scene));  // before any heights are there
      for (const double exaggeration : {1.0, 5.0, 20.0}) {
        globe->set_exaggeration(exaggeration);
        look(*globe, away_m, -35.0);
        settle(*globe, kHills);
        expect_markers(*globe, scene, over_m, std::to_string(exaggeration) + " " + std::to_string(away_m));
      }
    }
  }
}

// Lines and areas on the ground are picked where they are drawn, and not beside.
TEST_F(DrapedObjects, PicksFindWhatLiesOnTheGround) {
  const auto globe = hilly_globe(5.0);
  const auto places = winding(0.1), corners = meadow(0.1);
  const LayerId lines = *globe->add_objects(
      {.lines = {
           {.places = places, .width_px = kWidth_px, .color = kHillInk, .heights = HeightMode::clamp_to_ground}}});
  look(*globe, 10e3, -25.0);
  settle(*globe, kHills);
  const auto truth = line_truth(*globe, places);
  const auto ink = inked();
  int found = 0;
  for (int k = 0; k < kHills.width_px * kHills.height_px; k += 7) {
    const glm::dvec2 middle(k % kHills.width_px + 0.5, k / kHills.width_px + 0.5);
    const bool picked = globe->pick(middle, kHills).objects == lines;
    if (ink[static_cast<std::size_t>(k)]) {
      EXPECT_TRUE(picked) << middle.x << " " << middle.y;
    }
    // The slack of a pick is 2 px.
    if (nearest_px(truth.perhaps_px, middle) > 0.5 * double(kWidth_px) + 3.0) {
      EXPECT_FALSE(picked) << middle.x << " " << middle.y;
    }
    found += picked ? 1 : 0;
  }
  EXPECT_GT(found, 20);
  ASSERT_TRUE(globe->set_objects(
      lines,
      {.polygons = {
           {.rings = {corners}, .fill = kHillInk, .stroke = {0, 0, 0, 0}, .heights = HeightMode::clamp_to_ground}}}));
  settle(*globe, kHills);
  const auto inside = inked();
  for (int k = 0; k < kHills.width_px * kHills.height_px; k += 7) {
    const int x = k % kHills.width_px, y = k / kHills.width_px;
    const bool picked = globe->pick({x + 0.5, y + 0.5}, kHills).objects == lines;
    bool border = x == 0 || y == 0 || x + 1 == kHills.width_px || y + 1 == kHills.height_px;
    for (int n = 0; !border && n < 9; ++n) {
      const auto at = static_cast<std::size_t>(k + (n / 3 - 1) * kHills.width_px + n % 3 - 1);
      border = inside[at] != inside[static_cast<std::size_t>(k)];
    }
    EXPECT_TRUE(border || picked == inside[static_cast<std::size_t>(k)]) << x << " " << y;
  }
}

}  // namespace
}  // namespace terrella::test
