#include "scene/splat_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <random>

#include "scene/sphere_splats.h"

namespace terrella {
namespace {

constexpr int kWidth_px = 300, kHeight_px = 200;
constexpr float kEye_m = 2.0e7F;  // the eye's distance from the planet's centre

/// From an eye over 0°N 0°E, looking down, north up.
SplatLens looking_down() {
  SplatLens lens{.view_from_ecef = {0, 0, 1, 1, 0, 0, 0, 1, 0},
                 .eye_high = {kEye_m, 0, 0},
                 .eye_low = {0.25F, -0.25F, 0.125F},
                 .sun = {0.6F, 0.8F, 0},
                 .half_px = {kWidth_px / 2.0F, kHeight_px / 2.0F},
                 .focal_px = {250, 250},
                 .size_px = {kWidth_px, kHeight_px},
                 .smallest_px = 0.75F,
                 .most_px = 8.0F,
                 .widest_angle = 0.02F,
                 .hiding_m = 6.3e6F};
  return lens;
}

SplatSpheres any_spheres(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F), radius_m(1.0e3F, 8.0e5F), byte(0.0F, 255.0F);
  SplatSpheres s{};
  for (int k = 0; k < kSplatGroup; ++k) {
    s.high_x[k] = 7.0e6F * unit(random), s.high_y[k] = 7.0e6F * unit(random), s.high_z[k] = 7.0e6F * unit(random);
    s.low_x[k] = unit(random), s.low_y[k] = unit(random), s.low_z[k] = unit(random);
    s.radius_m[k] = radius_m(random);
    s.red[k] = byte(random), s.green[k] = byte(random), s.blue[k] = byte(random);
  }
  return s;
}

#ifdef __x86_64__
TEST(SplatKernel, NewerProcessorsDrawTheSameBits) {
  if (__builtin_cpu_supports("avx2") == 0) return;  // then there is but one way
  std::mt19937 random(5);
  const SplatLens lens = looking_down();
  int shown = 0;
  for (int turn = 0; turn < 40; ++turn) {
    const SplatSpheres spheres = any_spheres(random);
    SplatDiscs a{}, b{};
    place_splats(spheres, kSplatGroup, lens, a);
    place_splats_avx2(spheres, kSplatGroup, lens, b);
    for (int k = 0; k < kSplatGroup; ++k) {
      ASSERT_EQ(a.shown[k], b.shown[k]);
      ASSERT_EQ(a.large[k], b.large[k]);
      if (a.shown[k] == 0 || a.x_first[k] > a.x_last[k] || a.y_first[k] > a.y_last[k]) continue;
      const auto on_a = std::make_unique<SplatBlock>(), on_b = std::make_unique<SplatBlock>();
      const int column = a.x_last[k] / kSplatBlockWidth_px, row = a.y_last[k] / kSplatBlockHeight_px;
      draw_splat(spheres, a, k, column, row, turn % 2 == 0, on_a->nearness.data(), on_a->rgba.data());
      draw_splat_avx2(spheres, b, k, column, row, turn % 2 == 0, on_b->nearness.data(), on_b->rgba.data());
      ASSERT_EQ(on_a->rgba, on_b->rgba) << turn << ' ' << k;
      ASSERT_EQ(std::memcmp(on_a->nearness.data(), on_b->nearness.data(), sizeof on_a->nearness), 0);
      ++shown;
    }
  }
  EXPECT_GT(shown, 200);
}
#endif

TEST(SplatKernel, WhatThePlanetHidesIsNeitherSmallNorLarge) {
  SplatSpheres spheres{};
  for (int k = 0; k < kSplatGroup; ++k) {
    spheres.high_x[k] = k % 2 == 0 ? -6.9e6F : 6.9e6F;  // behind the planet, and before it
    spheres.radius_m[k] = k < kSplatGroup / 2 ? 1.0e4F : 3.0e6F;
  }
  SplatDiscs discs{};
  place_splats(spheres, kSplatGroup, looking_down(), discs);
  for (int k = 0; k < kSplatGroup; ++k) {
    const bool before = k % 2 != 0, small = k < kSplatGroup / 2;
    EXPECT_EQ(discs.shown[k] != 0, before && small) << k;
    EXPECT_EQ(discs.large[k] != 0, before && !small) << k;
  }
}

}  // namespace
}  // namespace terrella
