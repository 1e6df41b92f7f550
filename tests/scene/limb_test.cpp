#include "surface/limb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "patch_test_support.h"

namespace terrella::test {
namespace {

constexpr double kHalfWidth_px = 1.0;
// Error that limb_ribbon() promises, and that of a float of normalised device coordinates: half a step of 2^-24 of the
// width.
constexpr double kLimb_px = 0.02;
constexpr double kFloat_px_per_px = 1.2e-7;

/// Depth (> 0: inside) of a ray through a pixel: the discriminant of its crossing with the unit sphere in scaled space,
/// over the square of the ray.
double inside(const View& view, const Ellipsoid& body, glm::dvec2 px) {
  const glm::dvec3 axes(body.a_m(), body.a_m(), body.b_m());
  const glm::dvec3 eye = view.eye.xyz_m / axes;
  const glm::dvec3 ray = glm::normalize(pixel_ray(view, px).xyz / axes);
  const glm::dvec3 nearest = eye - ray * glm::dot(eye, ray);
  return 1.0 - glm::dot(nearest, nearest);
}

/// Distance of a pixel position to the true limb by Newton's step: positive inside.
double limb_distance_px(const View& view, const Ellipsoid& body, glm::dvec2 px) {
  constexpr double h = 0.25;
  const double gx = inside(view, body, px + glm::dvec2(h, 0)) - inside(view, body, px - glm::dvec2(h, 0));
  const double gy = inside(view, body, px + glm::dvec2(0, h)) - inside(view, body, px - glm::dvec2(0, h));
  return inside(view, body, px) * 2.0 * h / std::hypot(gx, gy);
}

glm::dvec2 pixel_of(const View& view, glm::dvec2 ndc) {
  return {(0.5 + 0.5 * ndc.x) * view.viewport.width_px, (0.5 - 0.5 * ndc.y) * view.viewport.height_px};
}

bool in_picture(const View& view, glm::dvec2 px) {
  return px.x >= 0.0 && px.y >= 0.0 && px.x <= view.viewport.width_px && px.y <= view.viewport.height_px;
}

/// A stretch of the ribbon's centre line.
struct Stretch {
  glm::dvec2 from_px, to_px, outward_px;  // outward in picture axes, y down
};

std::vector<Stretch> centre_line(const View& view, const std::vector<LimbVertex>& strip) {
  const auto centre = [&](const LimbVertex& v) {
    const glm::dvec2 outward(v.outward_px.x, -v.outward_px.y);
    return pixel_of(view, glm::dvec2(v.position_ndc)) - outward * double(v.distance_px);
  };
  std::vector<Stretch> line;
  for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
    const glm::dvec2 p[3] = {centre(strip[k]), centre(strip[k + 1]), centre(strip[k + 2])};
    const bool flat = strip[k].position_ndc == strip[k + 1].position_ndc ||
                      strip[k + 1].position_ndc == strip[k + 2].position_ndc ||
                      strip[k].position_ndc == strip[k + 2].position_ndc;
    if (flat) continue;
    const glm::dvec2 to = glm::distance(p[0], p[1]) > glm::distance(p[0], p[2]) ? p[1] : p[2];
    line.push_back({p[0], to, glm::dvec2(strip[k].outward_px.x, -strip[k].outward_px.y)});
  }
  return line;
}

double distance_px(const Stretch& s, glm::dvec2 p) {
  const glm::dvec2 d = s.to_px - s.from_px;
  const double t = glm::dot(d, d) > 0.0 ? std::clamp(glm::dot(p - s.from_px, d) / glm::dot(d, d), 0.0, 1.0) : 0.0;
  return glm::distance(p, s.from_px + t * d);
}

void check_on_limb(const View& view, const Ellipsoid& body, const std::vector<Stretch>& line) {
  const double allowed_px = kLimb_px + kFloat_px_per_px * std::max(view.viewport.width_px, view.viewport.height_px);
  for (const Stretch& s : line) {
    EXPECT_NEAR(glm::length(s.outward_px), 1.0, 1e-5);
    for (const double t : {0.0, 0.25, 0.5, 1.0}) {
      const glm::dvec2 p = glm::mix(s.from_px, s.to_px, t);
      if (!in_picture(view, p)) continue;
      ASSERT_LE(std::abs(limb_distance_px(view, body, p)), allowed_px) << "at " << p.x << ", " << p.y;
      // Well beyond the error of the line, and short of the far side of the smallest disc.
      ASSERT_LT(inside(view, body, p + 3.0 * allowed_px * s.outward_px), 0.0) << "outward is not outside";
      ASSERT_GT(inside(view, body, p - 3.0 * allowed_px * s.outward_px), 0.0) << "inward is not inside";
    }
  }
}

/// Points where the limb crosses the lines of a grid over the picture, found by bisection and apart from the ribbon.
std::vector<glm::dvec2> true_limb(const View& view, const Ellipsoid& body) {
  std::vector<glm::dvec2> found;
  const double w = view.viewport.width_px, h = view.viewport.height_px;
  constexpr int kLines = 9, kSteps = 64;
  const auto along = [&](glm::dvec2 a, glm::dvec2 b) {
    for (int k = 0; k < kSteps; ++k) {
      glm::dvec2 low = glm::mix(a, b, double(k) / kSteps), high = glm::mix(a, b, double(k + 1) / kSteps);
      const bool low_in = inside(view, body, low) > 0.0;
      if (low_in == (inside(view, body, high) > 0.0)) continue;
      for (int n = 0; n < 50; ++n) {
        const glm::dvec2 mid = 0.5 * (low + high);
        ((inside(view, body, mid) > 0.0) == low_in ? low : high) = mid;
      }
      // The discriminant also vanishes behind the eye; there is no limb there.
      const glm::dvec3 axes(body.a_m(), body.a_m(), body.b_m());
      if (glm::dot(pixel_ray(view, low).xyz / axes, view.eye.xyz_m / axes) < 0.0) found.push_back(low);
    }
  };
  for (int k = 1; k < kLines; ++k) {
    along({w * k / kLines, 0}, {w * k / kLines, h});
    along({0, h * k / kLines}, {w, h * k / kLines});
  }
  return found;
}

/// Returns how many points of the limb were found in the picture.
std::size_t check_covers(const View& view, const Ellipsoid& body, const std::vector<Stretch>& line) {
  const std::vector<glm::dvec2> limb = true_limb(view, body);
  for (const glm::dvec2 p : limb) {
    double nearest = 1e9;
    for (const Stretch& s : line) nearest = std::min(nearest, distance_px(s, p));
    EXPECT_LE(nearest, 2.0 * kLimb_px + kFloat_px_per_px * view.viewport.width_px)
        << "no ribbon at " << p.x << ", " << p.y;
  }
  return limb.size();
}

std::size_t check(const Camera& c, const Ellipsoid& body, Viewport viewport) {
  std::ostringstream name;
  name << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ',' << c.eye.height_m << ',' << c.heading.deg() << ','
       << c.pitch.deg() << ',' << c.fov_y.deg() << " picture " << viewport.width_px << 'x' << viewport.height_px
       << " f " << body.f();
  SCOPED_TRACE(name.str());
  const View view = make_view(c, body, viewport);
  const auto line = centre_line(view, limb_ribbon(view, body, kHalfWidth_px));
  check_on_limb(view, body, line);
  return check_covers(view, body, line);
}

/// A camera whose picture the limb crosses.
Camera camera_at_limb(Draw& draw, double a_m) {
  Camera c = random_camera(draw, 1e-4 * a_m, 20.0 * a_m);
  const double distance = a_m + c.eye.height_m;
  const double limb_pitch = 180.0 / std::numbers::pi * std::asin(a_m / distance) - 90.0;
  c.pitch = Angle::degrees(std::clamp(limb_pitch + c.fov_y.deg() * draw.between(-0.4, 0.4), -90.0, 90.0));
  return c;
}

TEST(Limb, LiesOnTheLimbWhereverItIsInThePicture) {
  Draw draw(31);
  for (const Body& body : selection_bodies()) {
    std::size_t seen = 0;
    for (int k = 0; k < 60 && !HasFailure(); ++k) {
      seen += check(camera_at_limb(draw, body.ellipsoid.a_m()), body.ellipsoid, {1024, 768});
    }
    EXPECT_GT(seen, 100U);
  }
}

/// True if a triangle of the strip covers the point.
bool covers(const std::vector<glm::dvec2>& strip, glm::dvec2 at) {
  for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
    const auto side = [&](glm::dvec2 a, glm::dvec2 b) {
      return (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
    };
    const double sides[] = {side(strip[k], strip[k + 1]), side(strip[k + 1], strip[k + 2]),
                            side(strip[k + 2], strip[k])};
    if (std::ranges::all_of(sides, [](double s) { return s > 0.0; })) return true;
    if (std::ranges::all_of(sides, [](double s) { return s < 0.0; })) return true;
  }
  return false;
}

// A wedge between two stretches would leave a pixel of the limb as it was, once in a picture or two.
TEST(Limb, HasNoGapAtItsBends) {
  const View view = make_view(camera_at(20.9, 0.1, 1.5202e7), earth().ellipsoid, {1024, 1024});
  const std::vector<LimbVertex> strip = limb_ribbon(view, earth().ellipsoid, kHalfWidth_px);
  std::vector<glm::dvec2> corners, outer;
  for (const LimbVertex& v : strip) {
    corners.push_back(pixel_of(view, glm::dvec2(v.position_ndc)));
    if (v.distance_px > 0.0F) outer.push_back(corners.back());
  }
  int bends = 0;
  for (std::size_t k = 0; k < outer.size(); ++k) {
    const glm::dvec2 a = outer[k], b = outer[(k + 1) % outer.size()];
    constexpr double kBend_px = 0.1, kFloat_px = 1e-3;  // a stretch is longer; corners that meet are nearer
    if (glm::distance(a, b) > kBend_px || glm::distance(a, b) < kFloat_px) continue;
    const glm::dvec2 middle = 0.5 * (a + b), inwards = glm::normalize(glm::dvec2(512.0) - middle);
    EXPECT_TRUE(covers(corners, middle + 2e-3 * inwards)) << middle.x << ' ' << middle.y;
    ++bends;
  }
  EXPECT_GE(bends, 48);
}

/// The point of the unit sphere in scaled space that a pixel's ray meets, or is nearest to.
glm::dvec3 met(const View& view, const Ellipsoid& body, glm::dvec2 px) {
  const glm::dvec3 axes(body.a_m(), body.a_m(), body.b_m());
  const glm::dvec3 eye = view.eye.xyz_m / axes, ray = glm::normalize(pixel_ray(view, px).xyz / axes);
  const double half = std::sqrt(std::max(0.0, inside(view, body, px)));
  return glm::normalize(eye - (glm::dot(eye, ray) + half) * ray);
}

TEST(Limb, ItsSquareIsThatOfTheCosineBetweenRayAndNormal) {
  Draw draw(33);
  for (const Body& body : selection_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    for (int k = 0; k < 60; ++k) {
      const View view = make_view(camera_at_limb(draw, e.a_m()), e, {1024, 768});
      const std::optional<LimbSquare> square = limb_square(view, e);
      ASSERT_TRUE(square);
      for (int n = 0; n < 20; ++n) {
        const glm::dvec2 px(draw.between(0.0, 1024.0), draw.between(0.0, 768.0));
        const glm::dvec3 ray = pixel_ray(view, px).xyz / glm::dot(pixel_ray(view, px).xyz, view.forward);
        const glm::dvec3 scaled = ray * glm::dvec3(1.0, 1.0, e.a_m() / e.b_m());
        EXPECT_NEAR(square->times_length_sq({px.x, 768.0 - px.y}), inside(view, e, px) * glm::dot(scaled, scaled),
                    1e-9);
      }
    }
  }
}

// The square of the cosine grows by twice the limb's distance, in radii, times a pixel's slope. Near the ground a ring
// as wide as what is in view holds more.
TEST(Limb, ItsRingHoldsTheGroundUpToItsPixelsInside) {
  Draw draw(34);
  std::size_t held = 0, left = 0;
  for (const Body& body : selection_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    for (int k = 0; k < 20; ++k) {
      const View view = make_view(camera_at_limb(draw, e.a_m()), e, {1024, 768});
      const LimbRing ring(view, e);
      const double eye = glm::length(view.eye.xyz_m / glm::dvec3(e.a_m(), e.a_m(), e.b_m()));
      const double most = terrella::kLimb_px * 2.0 * std::sqrt(eye * eye - 1.0) / view.pixels_per_radian();
      for (int n = 0; n < 400; ++n) {
        const glm::dvec2 px(draw.between(0.0, 1024.0), draw.between(0.0, 768.0));
        const double square = inside(view, e, px);
        const glm::dvec3 there = met(view, e, px);
        if (square > 0.0 && square < 0.9 * most) {
          EXPECT_TRUE(ring.holds(glm::vec3(there)));
          EXPECT_TRUE(ring.meets(there, 1.0, 0.0));
          ++held;
        } else if (square > 1.2 * most && std::sqrt(most) < 0.1 * std::acos(1.0 / eye)) {
          EXPECT_FALSE(ring.holds(glm::vec3(there)));
          ++left;
        }
      }
    }
  }
  EXPECT_GT(held, 20U);
  EXPECT_GT(left, 1000U);
}

TEST(Limb, LiesOnTheLimbThroughTheLongestLens) {
  Draw draw(32);
  for (const double fov : {0.01, 0.1, 1.0}) {
    std::size_t seen = 0;
    for (int k = 0; k < 20 && !HasFailure(); ++k) {
      Camera c = camera_at_limb(draw, 6378137.0);
      c.fov_y = Angle::degrees(fov);
      const double limb = 180.0 / std::numbers::pi * std::asin(6378137.0 / (6378137.0 + c.eye.height_m)) - 90.0;
      c.pitch = Angle::degrees(limb + 0.3 * fov);
      seen += check(c, Ellipsoid(6378137.0, 0.0), {1024, 1024});
    }
    EXPECT_GT(seen, 100U) << "field of view " << fov;
  }
}

TEST(Limb, LiesOnTheLimbInTheWidestPicture) {
  for (const double fov : {10.0, 40.0, 120.0}) {
    EXPECT_GT(check(camera_at(20, 30, 3.0e5, 40, -17, fov), earth().ellipsoid, {16384, 16}), 0U);
    EXPECT_GT(check(camera_at(20, 30, 3.0e7, 40, -80, fov), earth().ellipsoid, {16, 16384}), 0U);
    check(camera_at(20, 30, 3.0e7, 40, -80, fov), earth().ellipsoid, {1, 1});
  }
}

TEST(Limb, IsEmptyForAnEyeOnOrUnderTheGroundAndWhereItIsOutOfView) {
  const auto ribbon = [](const Camera& c) {
    return limb_ribbon(make_view(c, earth().ellipsoid, {640, 480}), earth().ellipsoid, 1.0);
  };
  EXPECT_TRUE(ribbon(camera_at(10, 20, -1.0, 0, 0)).empty());
  EXPECT_TRUE(ribbon(camera_at(90, 0, -earth().ellipsoid.b_m())).empty());
  EXPECT_TRUE(ribbon(camera_at(10, 20, 1.0e6, 0, 90)).empty());
  EXPECT_TRUE(ribbon(camera_at(10, 20, 1.0e5, 0, -90)).empty());
  EXPECT_FALSE(ribbon(camera_at(10, 20, 3.0e7, 0, -90)).empty());
  const Ellipsoid sphere(6371000.0, 0.0);
  EXPECT_TRUE(limb_ribbon(make_view(camera_at(0, 0, -6371000.0), sphere, {640, 480}), sphere, 1.0).empty());
}

TEST(Limb, IsEmptyForAViewThatIsNotFinite) {
  for (const double bad : {kNaN, kInfinity}) {
    for (int field = 0; field < 5; ++field) {
      View view = make_view(camera_at(10, 20, 1.0e7), earth().ellipsoid, {640, 480});
      double* const fields[] = {&view.eye.xyz_m.y, &view.right.x, &view.up.z, &view.forward.y, &view.tan_half_fov_y};
      *fields[field] = bad;
      EXPECT_TRUE(limb_ribbon(view, earth().ellipsoid, 1.0).empty());
    }
  }
}

}  // namespace
}  // namespace terrella::test
