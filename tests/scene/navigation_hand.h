#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "geo/body.h"
#include "view/navigation.h"
#include "view/surface_pin.h"

namespace terrella::test {

inline constexpr double kHeld_px = 0.05;      // a twentieth of a pixel, the least shift that a user sees
inline constexpr double kArrived_deg = 1e-6;  // 0.1 m on Earth
inline constexpr double kFrame_s = 1.0 / 60.0;
inline constexpr Viewport kViewport{1024, 768};
inline constexpr glm::dvec2 kCentre(512.0, 384.0);

/// A navigator of Earth with a hand and a clock.
struct Hand {
  explicit Hand(const Camera& start) : navigator(start, earth().ellipsoid, kViewport) {}

  Ecef under(glm::dvec2 px) const {
    const Grab held = grab(make_view(navigator.camera(), earth().ellipsoid, kViewport), earth().ellipsoid, px);
    EXPECT_TRUE(held.on_surface);
    return held.point;
  }
  double miss_px(const Ecef& point, glm::dvec2 px) const {
    const auto seen = project(make_view(navigator.camera(), earth().ellipsoid, kViewport), point);
    return seen ? glm::distance(*seen, px) : HUGE_VAL;
  }
  /// Drags in 20 steps and rests before letting go, so that nothing glides on.
  void drag(glm::dvec2 from, glm::dvec2 to, PointerButton button = PointerButton::left, bool ctrl = false) {
    navigator.pointer_down(button, ctrl, from, now);
    for (int i = 1; i <= 20; ++i) {
      now += Seconds(kFrame_s);
      navigator.pointer_move(from + (to - from) * (i / 20.0), now);
    }
    now += Seconds(0.5);
    navigator.pointer_up(button, now);
  }
  /// Runs frames until nothing moves; returns how long that took.
  Seconds settle() {
    const Seconds start = now;
    while (navigator.animating() && now - start < Seconds(20.0)) {
      now += Seconds(kFrame_s);
      navigator.advance(now);
    }
    EXPECT_TRUE(navigator.at_rest());
    return now - start;
  }

  Navigator navigator;
  Seconds now{100.0};
};

}  // namespace terrella::test
