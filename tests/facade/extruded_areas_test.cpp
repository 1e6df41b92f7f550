// Extruded areas: their outlines beside rays that are cast in double, their light, picks and edits.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <string>

#include "caller_scene.h"
#include "objects/object_picker.h"
#include "objects/solid/solid_area.h"
#include "tests/facade/geodetic_at.h"

namespace terrella::test {
namespace {

constexpr double kSolidLat = 46.0, kSolidLon = 7.0, kHigh_m = 5000.0;
constexpr std::uint64_t kTower = 7;
const Color kGrass{0, 160, 0};
constexpr ObjectColor kOpaqueBrick{230, 20, 20}, kGlass{230, 20, 20, 128};

/// A tower 10 km wide and not quite square, counterclockwise.
std::vector<Geodetic> tower_corners() {
  const double north = 0.045, east = 0.065;
  return {at(kSolidLat - north, kSolidLon - east), at(kSolidLat - 0.9 * north, kSolidLon + east),
          at(kSolidLat + north, kSolidLon + 0.8 * east), at(kSolidLat + 0.8 * north, kSolidLon - east)};
}

ObjectScene tower(ObjectColor fill, HeightMode heights) {
  return {.polygons = {{.rings = {tower_corners()},
                        .fill = fill,
                        .stroke = {0, 0, 0, 0},
                        .of = {.id = ObjectId{kTower}},
                        .heights = heights,
                        .extrude_m = kHigh_m}}};
}

/// The tower as planes: walls along the normals of the ellipsoid, and a roof. It goes far down; the ground ends it.
/// Over 10 km the planes are wrong by under 10 m, which is a tenth of a pixel.
class TowerTruth {
 public:
  explicit TowerTruth(const Globe& globe) {
    const Ellipsoid& e = globe.options().body.ellipsoid;
    const auto corners = tower_corners();
    double ground_m = 0.0;
    for (const Geodetic& corner : corners) ground_m += globe.ground_height_m(corner.lat, corner.lon) / 4.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Geodetic &a = corners[k], &b = corners[(k + 1) % corners.size()];
      const glm::dvec3 from_m = e.to_ecef(a).xyz_m, up = up_of(a) + up_of(b);
      add(glm::normalize(glm::cross(e.to_ecef(b).xyz_m - from_m, up)), from_m);
    }
    const Geodetic middle = at(kSolidLat, kSolidLon, ground_m + kHigh_m);
    add(up_of(middle), e.to_ecef(middle).xyz_m);
    add(-up_of(middle), e.to_ecef(at(kSolidLat, kSolidLon, -5000.0)).xyz_m);
  }
  /// Distance along a ray to the tower; infinite if the ray misses.
  [[nodiscard]] double hit_m(const glm::dvec3& from_m, const glm::dvec3& way) const { return hit(from_m, way).first; }
  /// The side that the ray meets: walls 0 to 3, from the south counterclockwise, 4 the roof; -1: none.
  [[nodiscard]] int side(const glm::dvec3& from_m, const glm::dvec3& way) const { return hit(from_m, way).second; }
  [[nodiscard]] const glm::dvec3& normal(int side) const { return sides_[static_cast<std::size_t>(side)].out; }

 private:
  struct Side {
    glm::dvec3 out;
    double far_m;
  };
  static glm::dvec3 up_of(const Geodetic& place) { return Ellipsoid::normal(place.lat, place.lon).xyz; }
  void add(const glm::dvec3& out, const glm::dvec3& on_m) { sides_.push_back({out, glm::dot(out, on_m)}); }
  [[nodiscard]] std::pair<double, int> hit(const glm::dvec3& from_m, const glm::dvec3& way) const {
    double enter = 0.0, leave = HUGE_VAL;
    int side = -1;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const double along = glm::dot(sides_[k].out, way), to_m = sides_[k].far_m - glm::dot(sides_[k].out, from_m);
      if (along > 0.0) leave = std::min(leave, to_m / along);
      if (along == 0.0 && to_m < 0.0) return {HUGE_VAL, -1};
      if (along < 0.0 && to_m / along > enter) {
        enter = to_m / along;
        side = static_cast<int>(k);
      }
    }
    return enter < leave ? std::pair{enter, side} : std::pair{HUGE_VAL, -1};
  }
  std::vector<Side> sides_;
};

/// Straight down, oblique and horizontal.
std::array<Camera, 3> tower_views() {
  return {camera_at(kSolidLat + 0.01, kSolidLon + 0.02, 40e3), camera_at(45.8, 6.75, 20e3, 40.0, -35.0),
          camera_at(45.8, 6.8, 2500.0, 35.0, 0.0)};
}

class ExtrudedAreas : public GlTest {
 protected:
  static std::unique_ptr<Globe> globe_with(GlobeOptions options, bool hills) {
    options.relief_meshes_per_frame = 10000;
    options.exaggeration = 4.0;  // over 10 km the ground rises by hundreds of metres
    auto imagery = one_colour({.tile_px = 16, .max_level = 1}, kGrass);
    auto globe = hills ? Globe::create(options, imagery, *ElevationSource::open(wave_heights(), "waves"))
                       : Globe::create(options, imagery);
    EXPECT_TRUE(globe) << globe.error().message;
    return *std::move(globe);
  }
  Picture settled(Globe& globe) {
    settle(globe, kScene);
    return picture();
  }
};

// The base of an absolute area is the ellipsoid. On hills, walls reach down to the ground everywhere.
TEST_F(ExtrudedAreas, ATowerCoversThePixelsWhoseRaysMeetItInAllDepthModes) {
  for (const bool hills : {false, true}) {
    std::array<std::vector<bool>, 3> truths;
    for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
      GlobeOptions options = unlit_options();
      options.depth = depth;
      const auto globe = globe_with(options, hills);
      const LayerId layer = *globe->add_objects({});
      for (std::size_t k = 0; k < truths.size(); ++k) {
        globe->set_camera(tower_views()[k]);
        for (const ObjectColor fill : {kOpaqueBrick, kGlass}) {
          const HeightMode on_hills = k == 1 ? HeightMode::relative_to_ground : HeightMode::clamp_to_ground;
          ASSERT_TRUE(globe->set_objects(layer, tower(fill, hills ? on_hills : HeightMode::absolute)));
          const Picture shot = settled(*globe);
          if (truths[k].empty()) truths[k] = truth_of(*globe, TowerTruth(*globe), false);
          const std::string what = std::to_string(hills) + " hills, view " + std::to_string(k) + ", depth " +
                                   std::to_string(int(depth)) + ", alpha " + std::to_string(fill.alpha);
          EXPECT_GT(std::ranges::count(truths[k], true), 1000) << what;
          EXPECT_EQ(off_by_more_than_a_pixel(reds(shot, 80), truths[k]), 0U) << what;
        }
      }
    }
  }
}

/// Brightness of a side: the light of spheres and models. The Sun stands over 23.4 degrees north at the summer
/// solstice, and in the tower's south at 11:34 UTC.
double light_of(const glm::dvec3& normal, const glm::dvec3& ray) {
  const double sunny = std::clamp(
      (glm::dot(normal, Ellipsoid::normal(Angle::degrees(23.4), Angle::degrees(kSolidLon)).xyz) + 0.5) / 1.3, 0.0, 1.0);
  return (0.5 + 0.5 * std::abs(glm::dot(normal, ray))) * (0.8 + 0.28 * sunny * sunny * (3.0 - 2.0 * sunny));
}

TEST_F(ExtrudedAreas, EachSideIsLitByItsDirectionToTheEyeAndToTheSun) {
  GlobeOptions options;
  options.time = *parse_utc("2026-06-21T11:34Z");
  const auto globe = globe_with(options, false);
  ASSERT_TRUE(globe->add_objects(tower(kOpaqueBrick, HeightMode::absolute)));
  globe->set_camera(tower_views()[1]);
  const Picture shot = settled(*globe);
  const View view = globe->view(kScene);
  const TowerTruth truth(*globe);
  std::array<std::vector<double>, 5> reds;
  for (int y = 2; y < kScene.height_px - 2; ++y) {
    for (int x = 2; x < kScene.width_px - 2; ++x) {
      const auto side_at = [&](double dx, double dy) {
        const glm::dvec2 px(x + 0.5 + dx, y + 0.5 + dy);
        return meets(*globe, view, truth, false, px) ? truth.side(view.eye.xyz_m, pixel_ray(view, px).xyz) : -1;
      };
      const int side = side_at(0.0, 0.0);
      if (side < 0 || side_at(2, 2) != side || side_at(-2, -2) != side || side_at(2, -2) != side ||
          side_at(-2, 2) != side) {
        continue;
      }
      const double red = double(shot.at(x, y)[0]);
      reds[static_cast<std::size_t>(side)].push_back(red);
      const double light = light_of(truth.normal(side), pixel_ray(view, {x + 0.5, y + 0.5}).xyz);
      EXPECT_NEAR(red, kOpaqueBrick.red * light, 2.0) << side << " at " << x << " " << y;
    }
  }
  const auto mean = [](const std::vector<double>& all) {
    return std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
  };
  for (const std::size_t seen : {0U, 3U, 4U}) EXPECT_GT(reds[seen].size(), 100U) << seen;
  EXPECT_GT(mean(reds[0]), mean(reds[3]) + 10.0) << "the south wall has the Sun";
  EXPECT_GT(std::abs(mean(reds[4]) - mean(reds[0])), 2.0);
}

TEST_F(ExtrudedAreas, PicksFindRoofAndWallsAtTheirDistance) {
  for (const bool hills : {false, true}) {
    const auto globe = globe_with(unlit_options(), hills);
    const LayerId layer =
        *globe->add_objects(tower(kGlass, hills ? HeightMode::clamp_to_ground : HeightMode::absolute));
    for (const Camera& camera : tower_views()) {
      globe->set_camera(camera);
      settle(*globe, kScene);
      const View view = globe->view(kScene);
      const TowerTruth truth(*globe);
      int found = 0;
      for (int k = 0; k < kScene.width_px * kScene.height_px; k += 37) {
        const glm::dvec2 px(k % kScene.width_px + 0.5, k / kScene.width_px + 0.5);
        const bool is_there = meets(*globe, view, truth, false, px);
        bool border = false;
        for (const glm::dvec2 off : {glm::dvec2(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
          border = border || meets(*globe, view, truth, false, px + off) != is_there;
        }
        if (border) continue;
        const GlobePick picked = globe->pick(px, kScene);
        const std::string what = std::to_string(px.x) + " " + std::to_string(px.y);
        EXPECT_EQ(picked.objects == layer, is_there) << what;
        if (!is_there || !picked.object) continue;
        ++found;
        EXPECT_EQ(picked.object->of.id, ObjectId{kTower}) << what;
        const double away_m = truth.hit_m(view.eye.xyz_m, pixel_ray(view, px).xyz);
        EXPECT_NEAR(picked.object->distance_m, away_m, 0.015 * away_m) << what;
      }
      EXPECT_GT(found, 20);
    }
  }
}

// An edited tower shows the same pixels as one that was set to what the edit leads to, and is not cut again.
TEST_F(ExtrudedAreas, EditsChangeColourSightAndSelectionWithoutANewCut) {
  const auto globe = globe_with(unlit_options(), false), other = globe_with(unlit_options(), false);
  const LayerId layer = *globe->add_objects(tower(kOpaqueBrick, HeightMode::absolute)), set = *other->add_objects({});
  for (Globe* one : {globe.get(), other.get()}) one->set_camera(tower_views()[1]);
  const auto bare = settled(*other).rgba, whole = settled(*globe).rgba;
  EXPECT_NE(whole, bare);
  const auto after = [&](const ObjectChange& change) {
    EXPECT_TRUE(globe->edit_objects(layer, {.changes = {change}}));
    EXPECT_EQ(draw(*globe, kScene).objects_cut, 0U);
    return settled(*globe).rgba;
  };
  const auto new_one = [&](ObjectColor fill) {
    EXPECT_TRUE(other->set_objects(set, tower(fill, HeightMode::absolute)));
    return settled(*other).rgba;
  };
  const ObjectId id{kTower};
  EXPECT_EQ(after({.id = id, .visible = false}), bare);
  EXPECT_EQ(after({.id = id, .visible = true}), whole);
  EXPECT_EQ(after({.id = id, .selected = true}), new_one(kSelectedColor));
  EXPECT_EQ(after({.id = id, .selected = false}), whole);
  EXPECT_EQ(after({.id = id, .fill = kGlass}), new_one(kGlass));
  EXPECT_EQ(after({.id = id, .fill = kOpaqueBrick}), whole);
  EXPECT_TRUE(globe->edit_objects(layer, {.remove = {id}}));
  EXPECT_EQ(settled(*globe).rgba, bare);
}

TEST_F(ExtrudedAreas, ATowerFollowsTheGroundWhenItChanges) {
  const auto globe = globe_with(unlit_options(), true);
  globe->set_camera(tower_views()[1]);
  for (const HeightMode heights : {HeightMode::clamp_to_ground, HeightMode::relative_to_ground}) {
    globe->set_exaggeration(4.0);
    const LayerId layer = *globe->add_objects(tower(kOpaqueBrick, heights));
    const auto low = settled(*globe).rgba;
    globe->set_exaggeration(8.0);
    const auto high = settled(*globe).rgba;
    EXPECT_NE(high, low);
    ASSERT_TRUE(globe->set_objects(layer, tower(kOpaqueBrick, heights)));
    EXPECT_EQ(settled(*globe).rgba, high);
    ASSERT_TRUE(globe->remove(layer));
  }
}

// Rings in both directions, a courtyard, ±180 degrees and a pole.
TEST(ExtrudedShapes, EachWallLooksOutOfTheAreaAndIsCounterclockwiseFromOutside) {
  using Rings = std::vector<std::vector<Geodetic>>;
  const std::vector<Geodetic> yard{at(45.97, 6.97), at(45.97, 7.03), at(46.03, 7.0)};
  const std::vector<Geodetic> yard_back(yard.rbegin(), yard.rend());
  std::vector<Geodetic> back = tower_corners();
  std::ranges::reverse(back);
  const Ellipsoid e = earth().ellipsoid;
  for (const Rings& rings : {Rings{tower_corners()},
                             {back},
                             {back, yard},
                             {back, yard_back},
                             {tower_corners(), yard_back},
                             {{at(-1, 179.5), at(-1, -179.5), at(1, -179.5), at(1, 179.5)}},
                             {{at(80, 0), at(80, 120), at(80, -120)}}}) {
    const PolygonObject area{.rings = rings, .extrude_m = kHigh_m};
    const FillMesh roof = fill_area(roof_of(area), e, 1'000'000);
    const auto solid = solid_of(area, roof, e, kLineStep);
    const PickArea truth(area, e);
    ASSERT_GT(solid.size(), roof.indices.size());
    const auto corner = [&](std::size_t k) { return glm::dvec3(solid[k].high_m) + glm::dvec3(solid[k].low_m); };
    int faults = 0;
    for (std::size_t k = 0; k < solid.size(); k += 3) {
      const glm::dvec3 a = corner(k), b = corner(k + 1), c = corner(k + 2), normal(solid[k].normal);
      const glm::dvec3 middle = (a + b + c) / 3.0, faces = glm::cross(b - a, c - a);
      constexpr double kSliver_m2 = 1.0;  // a pole has triangles without a size
      faults += glm::dot(faces, normal) > 0.99 * glm::length(faces) - kSliver_m2 ? 0 : 1;
      if (k < roof.indices.size()) {
        faults += glm::dot(normal, glm::normalize(middle)) > 0.9 ? 0 : 1;
        continue;
      }
      const auto covers = [&](double out_m) {
        const Geodetic place = e.to_geodetic(Ecef{middle + out_m * normal});
        return truth.covers({place.lon.deg(), place.lat.deg()});
      };
      faults += covers(20.0) || !covers(-20.0) ? 1 : 0;
    }
    EXPECT_EQ(faults, 0) << rings.size() << " rings, the first at " << rings[0][0].lat.deg();
  }
}

}  // namespace
}  // namespace terrella::test
