// Patches on which a day layer or a night layer has anything to show.
#include "surface/daylight.h"
#include "patch_test_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geo/body.h"

namespace terrella::test {
namespace {

constexpr double kDaylightDegree = std::numbers::pi / 180.0;
constexpr double kBesideTwilight = 1e-12;  // rounding of a cubic

TEST(Daylight, FadesThroughCivilTwilight) {
  for (const double height_deg : {-90.0, -6.0, -3.0, -0.5, 0.0, 40.0}) {
    const double sine = std::sin(height_deg * kDaylightDegree);
    EXPECT_EQ(part_shown(Daylight::both, sine), 1.0);
    EXPECT_NEAR(part_shown(Daylight::day, sine) + part_shown(Daylight::night, sine), 1.0, kBesideTwilight);
  }
  EXPECT_EQ(part_shown(Daylight::day, 0.0), 1.0);
  EXPECT_NEAR(part_shown(Daylight::day, std::sin(-6.0 * kDaylightDegree)), 0.0, kBesideTwilight);
  EXPECT_NEAR(part_shown(Daylight::night, std::sin(-3.0 * kDaylightDegree)), 0.5, 0.002) << "the sine is all but even";
}

/// True if anything shows at one of the patch's points.
bool shows_somewhere(Daylight side, const PatchId& patch, const glm::dvec3& sun) {
  constexpr int kPoints = 8;
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      if (part_shown(side, glm::dot(patch_point(patch, i, j, kPoints).xyz, sun)) > 0.0) return true;
    }
  }
  return false;
}

TEST(Daylight, PatchesAreLeftOutWhereNothingShowsAndOnlyThere) {
  for (const Ellipsoid& e : {earth().ellipsoid, Ellipsoid(6378137.0, 0.1)}) {
    PatchTree tree(e, TileGrid{}, 4);
    for (const glm::dvec3& towards : {glm::dvec3(1, 0, 0), glm::dvec3(-0.6, 0.7, 0.39), glm::dvec3(0.1, 0.2, -1)}) {
      const glm::dvec3 sun = glm::normalize(towards);
      int left_out = 0, in_vain = 0, patches = 0;
      for (int face = 0; face < 6; ++face) {
        for (std::uint32_t k = 0; k < 64; ++k) {
          const PatchNode& patch = node_of(tree, {static_cast<CubeFace>(face), 3, k % 8, k / 8});
          for (const Daylight side : {Daylight::day, Daylight::night}) {
            EXPECT_TRUE(may_show(Daylight::both, patch, e, sun));
            const bool shows = shows_somewhere(side, patch.id, sun), may = may_show(side, patch, e, sun);
            EXPECT_TRUE(may || !shows);
            ++patches;
            left_out += may ? 0 : 1;
            in_vain += may && !shows ? 1 : 0;
          }
        }
      }
      EXPECT_GT(left_out, patches / 3);
      EXPECT_LT(in_vain, patches / 10);
    }
  }
}

}  // namespace
}  // namespace terrella::test
