// Edges of areas and lines on the ground, beside rays that are cast at the ground in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "tests/facade/caller_scene.h"

namespace terrella::test {
namespace {

constexpr Viewport kFrame{160, 120};
constexpr int kRays = 6;               // a side of a pixel at an edge
constexpr int kBefore = 4, kWin = 10;  // pixels of an edge's profile before the edge; in all
constexpr float kStroke_px = 3.0F;
constexpr ObjectColor kRed{240, 0, 0}, kTint{220, 20, 20, 128}, kNone{0, 0, 0, 0};
const Color kGreen{0, 160, 0};

/// A convex area around a middle, and an eye that looks at a place south of the middle.
struct EdgeCase {
  const char* name;
  double lat, lon, radius_deg;
  double away_m, pitch_deg, exaggeration = 0.0;  // 0: no relief
  double south_deg = 0.0;
};

// An edge that is off by half a pixel is seen; pixels at 80 degrees are six times as long as wide.
const EdgeCase kEdges[] = {
    {"straight down", 46.0, 7.0, 0.022, 1e4, -90.0},
    {"at a pole", 90.0, 0.0, 4.4, 2e6, -90.0},
    {"beside a pole", -89.0, 20.0, 3.0, 2e6, -90.0},
    {"over the antimeridian", 10.0, 180.0, 4.4, 2e6, -90.0},
    {"at the limb", 46.0, 7.0, 12.0, 2.6e6, -50.0, 0.0, 13.0},
    {"1 times relief", 46.0, 7.0, 0.22, 1e5, -90.0, 1.0},
    {"5 times relief", 46.0, 7.0, 0.22, 1e5, -90.0, 5.0},
    {"20 times relief", 46.0, 7.0, 0.22, 1e5, -90.0, 20.0},
    {"relief, at a pole", 90.0, 0.0, 0.22, 1e5, -90.0, 5.0},
    {"relief, over the antimeridian", 10.0, 180.0, 0.22, 1e5, -90.0, 5.0},
    {"tilted", 46.0, 7.0, 0.045, 1e4, -10.0},
    {"tilted, at a pole", 90.0, 0.0, 0.045, 1e4, -10.0},
    {"tilted, over the antimeridian", 10.0, 180.0, 0.045, 1e4, -10.0},
    {"1 times relief, tilted", 46.0, 7.0, 0.45, 1e5, -10.0, 1.0},
    {"5 times relief, tilted", 46.0, 7.0, 0.45, 1e5, -10.0, 5.0},
    {"20 times relief, tilted", 46.0, 7.0, 0.45, 1e5, -10.0, 20.0},
    {"20 times relief, tilted, at a pole", 90.0, 0.0, 0.45, 1e5, -10.0, 20.0},
    {"20 times relief, tilted, over the antimeridian", 10.0, 180.0, 0.45, 1e5, -10.0, 20.0},
    {"20 times relief, at the limb", 46.0, 7.0, 12.0, 2.6e6, -50.0, 20.0, 13.0},
};

glm::dvec3 normal_at(double lat_deg, double lon_deg) {
  return Ellipsoid::normal(Angle::degrees(lat_deg), Angle::degrees(lon_deg)).xyz;
}
Geodetic place_of(const glm::dvec3& normal) {
  const Geodetic at = Ellipsoid::lat_lon(EcefDir{glm::normalize(normal)});
  return {.lat = at.lat, .lon = at.lon, .height_m = 0.0};
}

/// A place beside the middle, by parts of the radius to the east and the north.
glm::dvec3 beside(const EdgeCase& c, double east, double north) {
  const glm::dvec3 up = normal_at(c.lat, c.lon);
  const double lon = glm::radians(c.lon);
  const glm::dvec3 to_east(-std::sin(lon), std::cos(lon), 0.0);
  return glm::normalize(up + glm::radians(c.radius_deg) * (east * to_east + north * glm::cross(up, to_east)));
}

/// Corners, counterclockwise.
std::array<glm::dvec3, 6> corners_of(const EdgeCase& c) {
  std::array<glm::dvec3, 6> corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double turn = glm::radians(60.0 * double(k) + 11.0), far = k % 2 == 0 ? 1.0 : 0.8;
    corners[k] = beside(c, far * std::cos(turn), far * std::sin(turn));
  }
  return corners;
}

/// Hills of 300 m, 100 km apart, as smooth at a pole as elsewhere.
double hills_m(double lat_rad, double lon_rad) {
  const glm::dvec3 n(std::cos(lat_rad) * std::cos(lon_rad), std::cos(lat_rad) * std::sin(lon_rad), std::sin(lat_rad));
  return 300.0 * std::sin(400.0 * (n.x + 0.7 * n.z)) * std::cos(400.0 * (n.y - 0.3 * n.z));
}

std::vector<Geodetic> ring_of(const EdgeCase& c) {
  std::vector<Geodetic> ring;
  for (const glm::dvec3& corner : corners_of(c)) ring.push_back(place_of(corner));
  return ring;
}

/// Parts of pixels in the area. Less than 0: a ray meets no ground.
struct RayPicture {
  std::vector<double> in, away_m;
  [[nodiscard]] static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kFrame.width_px + x); }
};

class Rays {
 public:
  Rays(const Globe& globe, const EdgeCase& c)
      : view_(globe.view(kFrame)), ground_(globe.ground()), corners_(corners_of(c)) {}

  [[nodiscard]] RayPicture cast() const {
    RayPicture all;
    for (int k = 0; k < kFrame.width_px * kFrame.height_px; ++k) {
      double away_m = 0.0;
      all.in.push_back(ray({k % kFrame.width_px + 0.5, k / kFrame.width_px + 0.5}, away_m));
      all.away_m.push_back(away_m);
    }
    const std::vector<double> middles = all.in;
    for (int y = 1; y + 1 < kFrame.height_px; ++y) {
      for (int x = 1; x + 1 < kFrame.width_px; ++x) {
        bool border = false;
        for (int n = 0; n < 9; ++n) {
          border = border || middles[RayPicture::at(x + n % 3 - 1, y + n / 3 - 1)] != middles[RayPicture::at(x, y)];
        }
        if (border) all.in[RayPicture::at(x, y)] = part(x, y);
      }
    }
    return all;
  }

 private:
  [[nodiscard]] double ray(glm::dvec2 px, double& away_m) const {
    const EcefDir way = pixel_ray(view_, px);
    const auto hit_m = ground_.intersect_m(view_.eye, way, 1e-4);
    if (!hit_m) return -1.0;
    away_m = *hit_m;
    const Geodetic place = ground_.ellipsoid().to_geodetic(Ecef{view_.eye.xyz_m + *hit_m * way.xyz});
    const glm::dvec3 normal = Ellipsoid::normal(place.lat, place.lon).xyz;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      if (glm::dot(glm::cross(corners_[k], corners_[(k + 1) % corners_.size()]), normal) < 0.0) return 0.0;
    }
    return 1.0;
  }
  [[nodiscard]] double part(int x, int y) const {
    double sum = 0.0, away_m = 0.0;
    for (int k = 0; k < kRays * kRays; ++k) {
      const double in = ray({x + (k % kRays + 0.5) / kRays, y + (k / kRays + 0.5) / kRays}, away_m);
      if (in < 0.0) return in;
      sum += in;
    }
    return sum / (kRays * kRays);
  }

  View view_;
  Ground ground_;
  std::array<glm::dvec3, 6> corners_;
};

/// Profiles across the edges, along rows or columns of the picture.
class Profiles {
 public:
  Profiles(const RayPicture& rays, bool rows) : rays_(rays), rows_(rows) {}

  /// Length over width of the ground under a profile's longest pixel.
  [[nodiscard]] double stretch(const glm::ivec2& at, double px_a_radian) const {
    double most = 0.0;
    for (int step = 1; step < kWin; ++step) {
      const auto away = [&](int x, int y) { return rays_.away_m[place(at.x + x, at.y + step + y)]; };
      most = std::max(most, std::hypot(away(1, 0) - away(-1, 0), away(0, 1) - away(0, -1)) / away(0, 0));
    }
    return std::hypot(1.0, 0.5 * most * px_a_radian);
  }

  /// Calls use(first pixel, place of the edge after it, part of a pixel that a step along the profile goes across the
  /// edge) for each profile that is an edge from one plateau to another, on ground without a crest before it.
  template <class Use>
  void each(Use use) const {
    const int lines = rows_ ? kFrame.height_px : kFrame.width_px, length = rows_ ? kFrame.width_px : kFrame.height_px;
    for (int line = 3; line + 3 < lines; ++line) {
      for (int k = 1; k + kWin + 1 < length; ++k) {
        const double here = in(line, k + kBefore), next = in(line, k + kBefore + 1);
        if (here < 0.0 || (here >= 0.5) == (next >= 0.5) || !is_edge(line, k)) continue;
        const double slope = 0.5 * (edge(line + 1, k) - edge(line - 1, k));
        const double bend = edge(line + 2, k) - 2.0 * edge(line, k) + edge(line - 2, k);
        if (std::abs(slope) <= 1.0 && std::abs(bend) < 0.2)
          use(glm::ivec2(line, k), edge(line, k), 1.0 / std::sqrt(1.0 + slope * slope));
      }
    }
  }
  /// The same place in a picture.
  [[nodiscard]] double ink(const Picture& shot, const glm::ivec2& at, int step) const {
    const int x = rows_ ? at.y + step : at.x, y = rows_ ? at.x : at.y + step;
    return shot.at(x, y)[0] / double(kRed.red);
  }
  [[nodiscard]] bool rises(const glm::ivec2& at) const { return in(at.x, at.y) < 0.5; }

 private:
  [[nodiscard]] std::size_t place(int line, int k) const {
    return rows_ ? RayPicture::at(k, line) : RayPicture::at(line, k);
  }
  [[nodiscard]] double in(int line, int k) const { return rays_.in[place(line, k)]; }
  // Steps until the edge.
  [[nodiscard]] double edge(int line, int k) const {
    double sum = 0.0;
    for (int step = 0; step < kWin; ++step) sum += in(line, k) < 0.5 ? 1.0 - in(line, k + step) : in(line, k + step);
    return sum;
  }
  [[nodiscard]] bool is_edge(int line, int k) const {
    const double from = in(line, k), to = 1.0 - from;
    for (int beside = -2; beside <= 2; ++beside) {
      for (int step = -1; step <= kWin; ++step) {
        const double at = in(line + beside, k + step), away = rays_.away_m[place(line + beside, k + step)];
        const bool plateau = step < 2 ? at == from : step < kWin - 2 || at == to;
        const double next = rays_.away_m[place(line + beside, k + step + 1)];
        constexpr double kCrest = 1.2;
        if (at < 0.0 || !plateau || std::max(away, next) > kCrest * std::min(away, next)) return false;
      }
    }
    return from == 0.0 || from == 1.0;
  }

  const RayPicture& rays_;
  bool rows_;
};

class GroundEdgesTest : public GlTest {
 protected:
  void make(const EdgeCase& c) {
    globe_.reset();
    GlobeOptions options = unlit_options();
    options.relief_meshes_per_frame = 10000;
    if (c.exaggeration > 0.0) options.exaggeration = c.exaggeration;
    std::optional<ElevationSource> heights;
    if (c.exaggeration > 0.0)
      heights = *ElevationSource::open(painted_heights({.tile_px = 128, .max_level = 5}, hills_m), "hills");
    globe_ = *Globe::create(options, one_colour({.tile_px = 16, .max_level = 1}, kGreen), heights);
    const double pitch = glm::radians(c.pitch_deg);
    const double back_deg =
        c.south_deg + glm::degrees(c.away_m * std::cos(pitch) / globe_->options().body.ellipsoid.a_m());
    Camera camera = camera_at(c.lat < 0.0 ? c.lat : c.lat - back_deg, c.lon, 0.0, 0.0, c.pitch_deg);
    const auto over_m = [&](double lat_deg) {
      return c.exaggeration * hills_m(glm::radians(lat_deg), glm::radians(c.lon));
    };
    camera.eye.height_m =
        std::max(over_m(c.lat) - c.away_m * std::sin(pitch), over_m(camera.eye.lat.deg()) + 0.1 * c.away_m);
    globe_->set_camera(camera);
  }
  Picture show(std::vector<PolygonObject> areas) {
    ObjectScene scene{.polygons = std::move(areas)};
    for (PolygonObject& each : scene.polygons) each.heights = HeightMode::clamp_to_ground;
    const LayerId layer = *globe_->add_objects(scene);
    settle(*globe_, kFrame);
    Picture shot = picture();
    EXPECT_TRUE(globe_->remove(layer));
    return shot;
  }
  [[nodiscard]] double corner_px(const EdgeCase& c, const glm::dvec2& from_px) const {
    double nearest = HUGE_VAL;
    for (Geodetic corner : ring_of(c)) {
      corner.height_m = globe_->ground_height_m(corner.lat, corner.lon);
      const auto px = project(globe_->view(kFrame), globe_->options().body.ellipsoid.to_ecef(corner));
      if (px) nearest = std::min(nearest, glm::distance(*px, from_px));
    }
    return nearest;
  }

  std::unique_ptr<Globe> globe_;
};

// Lines are measured away from corners, and up to 80 degrees: beyond, they fade.
TEST_F(GroundEdgesTest, AreasAndLinesEndWhereRaysMeetTheirEdges) {
  constexpr double kLongestPixel = 5.75, kCorner_px = 8.0;  // 1 / cos(80 degrees)
  for (const EdgeCase& c : kEdges) {
    SCOPED_TRACE(c.name);
    make(c);
    const Picture fill = show({{.rings = {ring_of(c)}, .fill = kRed, .stroke = kNone}});
    const Picture line = show({{.rings = {ring_of(c)}, .fill = kNone, .stroke = kRed, .stroke_width_px = kStroke_px}});
    const RayPicture rays = Rays(*globe_, c).cast();
    const View view = globe_->view(kFrame);
    int fills = 0, lines = 0;
    double fill_px = 0.0, line_px = 0.0, width_px = 0.0;
    for (const bool rows : {true, false}) {
      const Profiles all(rays, rows);
      all.each([&](const glm::ivec2& at, double truth, double across) {
        double filled = 0.0, lined = 0.0, middle = 0.0;
        for (int step = 0; step < kWin; ++step) {
          const double in = all.ink(fill, at, step), on = all.ink(line, at, step);
          filled += all.rises(at) ? 1.0 - in : in;
          lined += on;
          middle += on * (step + 0.5);
        }
        ++fills;
        fill_px = std::max(fill_px, std::abs(filled - truth) * across);
        const glm::dvec2 px = rows ? glm::dvec2(at.y + truth, at.x + 0.5) : glm::dvec2(at.x + 0.5, at.y + truth);
        if (all.stretch(at, view.pixels_per_radian()) > kLongestPixel || corner_px(c, px) < kCorner_px) return;
        ++lines;
        line_px = std::max(line_px, std::abs(middle / lined - truth) * across);
        width_px = std::max(width_px, std::abs(lined * across - double(kStroke_px)));
      });
    }
    const double most_px = c.pitch_deg == -90.0 ? 0.5 : 1.0;
    EXPECT_GT(fills, 30);
    EXPECT_GT(lines, 15);
    EXPECT_LE(fill_px, most_px);
    EXPECT_LE(line_px, most_px);
    EXPECT_LE(width_px, most_px);
  }
}

// Two translucent areas in one colour are one: a gap would be greener there, a double pixel redder.
TEST_F(GroundEdgesTest, AreasThatShareABorderColourEachPixelOnce) {
  const int once = (kTint.red * kTint.alpha + (255 - kTint.alpha) * kGreen[0] + 127) / 255;
  for (const EdgeCase& c : kEdges) {
    SCOPED_TRACE(c.name);
    make(c);
    const std::vector<Geodetic> ring = ring_of(c);
    std::vector<Geodetic> west{ring[3], ring[2], ring[1], ring[0]}, east{ring[3], ring[4], ring[5], ring[0]};
    const glm::dvec3 from = corners_of(c)[0], to = corners_of(c)[3];
    for (int k = 1; k < 200; ++k) {
      const double t = k / 200.0, wind = 0.1 * std::sin(25.0 * t) * std::min(1.0, 4.0 * std::min(t, 1.0 - t));
      const Geodetic place = place_of(from + t * (to - from) + wind * glm::cross(from, to));
      west.push_back(place);
      east.push_back(place);
    }
    std::ranges::reverse(east);
    const PolygonObject one{.rings = {west}, .fill = kTint, .stroke = kNone},
        other{.rings = {east}, .fill = kTint, .stroke = kNone};
    const Picture shot = show({one, other});
    const RayPicture rays = Rays(*globe_, c).cast();
    int inside = 0, wrong = 0;
    for (int y = 2; y + 2 < kFrame.height_px; ++y) {
      for (int x = 2; x + 2 < kFrame.width_px; ++x) {
        bool in = true;
        for (int n = 0; n < 25; ++n) in = in && rays.in[RayPicture::at(x + n % 5 - 2, y + n / 5 - 2)] == 1.0;
        if (!in) continue;
        ++inside;
        wrong += std::abs(shot.at(x, y)[0] - once) > 2 ? 1 : 0;
      }
    }
    EXPECT_GT(inside, 500);
    EXPECT_EQ(wrong, 0);
  }
}

// Borders of 1 px along meridians, from the middle of a disc to the limb. Pixels that are longer than six times their
// width show a part of them, or many borders would become a solid rim.
TEST_F(GroundEdgesTest, BordersAtTheLimbAreSmoothAndFade) {
  constexpr Viewport kDisc{640, 480};
  constexpr int kStep_deg = 4, kRow = kDisc.height_px / 2;
  make({"a disc", 0.0, 0.0, 1.0, 1.2e7, -90.0});
  ObjectScene scene;
  for (int lon_deg = 0; lon_deg < 90; lon_deg += kStep_deg) {
    std::vector<Geodetic> ring;
    for (const double lat_deg : {-60.0, 0.0, 60.0, 0.0}) ring.push_back(place_of(normal_at(lat_deg, lon_deg)));
    scene.polygons.push_back({.rings = {ring}, .fill = kNone, .stroke = kRed, .stroke_width_px = 1.0F});
  }
  ASSERT_TRUE(globe_->add_objects(scene));
  settle(*globe_, kDisc);
  const Picture shot = picture();
  const View view = globe_->view(kDisc);
  int full = 0, faded = 0;
  for (int lon_deg = 4 * kStep_deg; lon_deg < 90; lon_deg += kStep_deg) {
    const glm::dvec3 up = normal_at(0.0, lon_deg),
                     there_m = globe_->options().body.ellipsoid.position(EcefDir{up}).xyz_m;
    const double cosine = glm::dot(glm::normalize(view.eye.xyz_m - there_m), up),
                 at_px = project(view, Ecef{there_m})->x;
    double sum = 0.0, middle = 0.0;
    for (int x = int(at_px) - 2; x <= int(at_px) + 2; ++x) {
      const double ink = shot.at(x, kRow)[0] / double(kRed.red);
      sum += ink;
      middle += ink * (x + 0.5);
    }
    if (cosine > 0.2) {
      ++full;
      EXPECT_NEAR(sum, 1.0, 0.1) << lon_deg;
      EXPECT_NEAR(middle / sum, at_px, 0.25) << lon_deg;
    } else if (cosine > 0.02 && cosine < 0.12) {
      ++faded;
      const double ink = shot.at(int(at_px), kRow)[0] / double(kRed.red);
      EXPECT_GT(ink, 0.1) << lon_deg;
      EXPECT_LT(ink, 0.5) << lon_deg;
    }
  }
  EXPECT_GT(full, 8);
  EXPECT_GT(faded, 1);
}

}  // namespace
}  // namespace terrella::test
