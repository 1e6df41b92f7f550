#include "objects/sphere_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "geo/body.h"
#include "geo/camera.h"
#include "surface/patch_mesh.h"

namespace terrella {
namespace {

constexpr Viewport kSeen{300, 200};
constexpr float kLargestPoint_px = 4.0F;

SphereSight sight(const Geodetic& eye, double pitch_deg, double heading_deg, double shear) {
  Camera camera;
  camera.eye = eye;
  camera.pitch = Angle::degrees(pitch_deg);
  camera.heading = Angle::degrees(heading_deg);
  View view = make_view(camera, earth().ellipsoid, kSeen);
  view.shear_x = shear;
  const SplitPosition split = split_position(view.eye.xyz_m);
  const glm::dvec2 scale(1.0 / (view.tan_half_fov_y * view.aspect()), 1.0 / view.tan_half_fov_y);
  return {.view_from_ecef = glm::mat3(view_from_ecef_rotation(view)),
          .eye_high_m = split.high,
          .eye_low_m = split.low,
          .clip_scale = glm::vec2(scale),
          .focal_px = static_cast<float>(view.pixels_per_radian()),
          .hiding_radius_m = 6.3e6F,
          .largest_point_px = kLargestPoint_px};
}

Batch<DotInstance> any_spheres(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> sine(-1.0, 1.0), lon(-180.0, 180.0), height_m(-7.0e5, 2.0e6);
  std::uniform_real_distribution<float> radius_m(1.0e3F, 2.0e5F);
  Batch<DotInstance> batch;
  for (std::size_t k = 0; k < count; ++k) {
    const Geodetic place{.lat = Angle::radians(std::asin(sine(random))),
                         .lon = Angle::degrees(lon(random)),
                         .height_m = height_m(random)};
    const SplitPosition p = split_position(earth().ellipsoid.to_ecef(place).xyz_m);
    batch.items.push_back({p.high, p.low, radius_m(random), {std::uint8_t(k % 251), 0, 0}});
  }
  const std::size_t bucket = Batch<DotInstance>::bucket(ObjectPart::above_ground, true, false);
  std::fill(batch.first.begin() + std::ptrdiff_t(bucket) + 1, batch.first.end(), count);
  return batch;
}

/// Group of each sphere: 0 not drawn, 1 drawn as a triangle, 2 drawn as a point.
std::vector<int> drawn(SphereGroups& groups, const SphereSight& sight) {
  std::vector<int> how(groups.items().size(), 0);
  const SphereGroups::Seen seen = groups.seen({0, groups.items().size()}, sight);
  for (const auto& run : seen.triangles) {
    for (std::size_t k = 0; k < run.count; ++k) ++how[run.first + k];
  }
  for (const auto& run : seen.points) {
    for (std::size_t k = 0; k < run.count; ++k) how[run.first + k] += 2;
  }
  return how;
}

/// True if any part of a sphere is in the picture and not behind the hiding sphere.
bool is_seen(const DotInstance& sphere, const SphereSight& sight) {
  const glm::vec3 c = (sphere.high_m - sight.eye_high_m) + (sphere.low_m - sight.eye_low_m);
  const glm::vec3 p = sight.view_from_ecef * c;
  const float w = -p.z, r = sphere.size;
  if (w < 0.0F) return false;
  if (std::abs(p.x) * sight.clip_scale.x > w || std::abs(p.y) * sight.clip_scale.y > w) return false;
  const float along = -glm::dot(sight.eye_high_m, c) / glm::length(c);
  const float passes = glm::length(sight.eye_high_m + along * (c / glm::length(c)));
  return along > glm::length(c) || along < 0.0F ? glm::length(sight.eye_high_m + c) > sight.hiding_radius_m
                                                : passes > sight.hiding_radius_m - r;
}

std::vector<SphereSight> sights() {
  const auto at = [](double lat, double lon, double height_m) {
    return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m};
  };
  return {sight(at(10, 20, 2.0e7), -90, 0, 0.0), sight(at(-40, 170, 3.0e6), -50, 30, 0.1),
          sight(at(80, 0, 5.0e5), -5, 200, 0.0), sight(at(0, 0, 1.0e7), -90, 0, -0.1)};
}

TEST(SphereGroups, WhatIsSeenIsDrawnOnceAndMuchOfTheRestIsNot) {
  std::mt19937 random(8);
  SphereGroups groups(any_spheres(random, 100'000));
  for (const SphereSight& from : sights()) {
    const std::vector<int> how = drawn(groups, from);
    std::size_t seen = 0, all = 0;
    for (std::size_t k = 0; k < how.size(); ++k) {
      ASSERT_LE(how[k], 2) << "twice";
      const bool visible = is_seen(groups.items()[k], from);
      if (visible) {
        ASSERT_NE(how[k], 0) << "sphere " << k << " is seen";
      }
      seen += visible ? 1 : 0;
      all += how[k] != 0 ? 1 : 0;
    }
    EXPECT_GT(seen, 0U);
    // Groups reach over the picture's edge and the horizon by their own width.
    EXPECT_LT(all, seen + how.size() * 4 / 10) << "with " << seen << " seen";
  }
}

TEST(SphereGroups, PointsAreSmallAndWhollyInThePicture) {
  std::mt19937 random(9);
  Batch<DotInstance> batch = any_spheres(random, 20'000);
  for (DotInstance& sphere : batch.items) sphere.size *= 0.2F;
  SphereGroups groups(batch);
  std::size_t points = 0;
  for (const SphereSight& from : sights()) {
    const std::vector<int> how = drawn(groups, from);
    for (std::size_t k = 0; k < how.size(); ++k) {
      if (how[k] != 2) continue;
      ++points;
      const DotInstance& sphere = groups.items()[k];
      const glm::vec3 p = from.view_from_ecef * ((sphere.high_m - from.eye_high_m) + (sphere.low_m - from.eye_low_m));
      const float w = -p.z;
      ASSERT_GT(w, 0.0F);
      ASSERT_LT(from.focal_px * sphere.size / w, kLargestPoint_px);
      ASSERT_LT(std::abs(p.x) * from.clip_scale.x, w);
      ASSERT_LT(std::abs(p.y) * from.clip_scale.y, w);
    }
  }
  EXPECT_GT(points, 1000U);
}

TEST(SphereGroups, TranslucentSpheresKeepTheirOrderAndAreNoPoints) {
  std::mt19937 random(10);
  Batch<DotInstance> batch = any_spheres(random, 500);
  for (DotInstance& sphere : batch.items) sphere.color.alpha = 100;
  const std::size_t translucent = Batch<DotInstance>::bucket(ObjectPart::above_ground, false, false);
  std::fill(batch.first.begin(), batch.first.begin() + std::ptrdiff_t(translucent) + 1, 0);
  SphereGroups groups(batch);
  for (std::size_t k = 0; k < batch.items.size(); ++k) ASSERT_EQ(groups.items()[k].high_m, batch.items[k].high_m);
  EXPECT_TRUE(groups.seen({0, batch.items.size()}, sights().front()).points.empty());
}

// A sphere that moves away is seen where it comes to, and its group's ball follows it.
TEST(SphereGroups, AMovedSphereIsSeenWhereItIs) {
  std::mt19937 random(12);
  const Batch<DotInstance> before = any_spheres(random, 3000), after = any_spheres(random, 3000);
  SphereGroups moved(before);
  std::vector<DotInstance> spheres(3000);
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    EXPECT_EQ(moved.items()[k].high_m, before.items[moved.source(k)].high_m);
    spheres[k] = after.items[moved.source(k)];
    moved.set(k, spheres[k]);
  }
  for (const SphereSight& from : sights()) {
    const std::vector<int> how = drawn(moved, from);
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      ASSERT_TRUE(how[k] > 0 || !is_seen(spheres[k], from)) << k;
    }
  }
}

TEST(SphereGroups, ARangeIsItsOwnBuckets) {
  std::mt19937 random(11);
  Batch<DotInstance> batch = any_spheres(random, 100);
  const std::size_t chosen = Batch<DotInstance>::bucket(ObjectPart::above_ground, true, true);
  batch.first[chosen] = 37;
  SphereGroups groups(batch);
  SphereSight everywhere = sights().front();
  everywhere.hiding_radius_m = 0.0F;
  for (const ObjectChoice choice : {ObjectChoice::all, ObjectChoice::others, ObjectChoice::chosen}) {
    const auto range = batch.range(ObjectPart::above_ground, true, choice);
    std::size_t count = 0;
    const auto seen = groups.seen(range, everywhere);
    for (const auto* runs : {&seen.triangles, &seen.points}) {
      for (const auto& run : *runs) {
        EXPECT_GE(run.first, range.first);
        EXPECT_LE(run.first + run.count, range.first + range.count);
        count += run.count;
      }
    }
    EXPECT_EQ(count, range.count) << "all of the planet is in the picture";
  }
}

}  // namespace
}  // namespace terrella
