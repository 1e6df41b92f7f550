#include "apps/bench/truth/ray_caster.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>

namespace terrella::truth {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double row_fraction(const RowRule& rows, const Hit& hit) {
  const glm::dvec3& up = rows.centric ? hit.position_m : hit.normal;
  if (rows.equal_area) return 0.5 - 0.5 * up.z / std::sqrt(glm::dot(up, up));
  return 0.5 - latitude_rad(up) / std::numbers::pi;
}

struct Scene {
  const Picture& source;
  const RowRule& rows;
  const Spheroid& body;
  PixelRays rays;
  int rays_per_side;
};

void cast_colour(const Scene& scene, int x, int y, TruthImage& out) {
  const int n = scene.rays_per_side;
  glm::dvec3 sum(0.0);
  int hits = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const glm::dvec2 pixel(x + (i + 0.5) / n, y + (j + 0.5) / n);
      const std::optional<Hit> hit = first_hit(scene.body, scene.rays.eye_m(), scene.rays.direction(pixel));
      if (!hit) continue;
      ++hits;
      sum += sample(scene.source, texel_position(scene.source, scene.rows, *hit));
    }
  }
  const std::size_t at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x);
  out.hits[at] = static_cast<std::uint16_t>(hits);
  for (int c = 0; c < 3; ++c) out.rgb[3 * at + static_cast<std::size_t>(c)] = static_cast<float>(sum[c] / (n * n));
}

void cast_place(const Scene& scene, int x, int y, TruthImage& out) {
  const glm::dvec3 direction = scene.rays.direction({x + 0.5, y + 0.5});
  const std::optional<Hit> hit = first_hit(scene.body, scene.rays.eye_m(), direction);
  if (!hit) return;  // the arrays hold NaN
  const std::size_t at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x);
  out.lat_deg[at] = static_cast<float>(latitude_rad(hit->normal) / kDegree);
  out.lon_deg[at] = static_cast<float>(longitude_rad(hit->normal) / kDegree);
  const double cosine = -glm::dot(hit->normal, glm::normalize(direction));
  out.incidence_deg[at] = static_cast<float>(std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree);
}

}  // namespace

PixelRays::PixelRays(const Spheroid& body, const TruthCamera& camera, int width, int height)
    : eye_m_(position_m(body, camera.eye)), centre_px_(0.5 * width, 0.5 * height) {
  const LocalFrame frame = local_frame(camera.eye.lat_deg, camera.eye.lon_deg);
  const double heading = camera.heading_deg * kDegree;
  const double pitch = camera.pitch_deg * kDegree;
  const glm::dvec3 ahead = std::sin(heading) * frame.east + std::cos(heading) * frame.north;
  const glm::dvec3 right = std::cos(heading) * frame.east - std::sin(heading) * frame.north;
  forward_ = std::cos(pitch) * ahead + std::sin(pitch) * frame.up;
  const glm::dvec3 up = std::cos(pitch) * frame.up - std::sin(pitch) * ahead;
  const double pixel_step = std::tan(0.5 * camera.fov_deg * kDegree) / (0.5 * height);
  right_step_ = pixel_step * right;
  up_step_ = pixel_step * up;
}

glm::dvec3 PixelRays::direction(const glm::dvec2& pixel) const {
  return forward_ + (pixel.x - centre_px_.x) * right_step_ - (pixel.y - centre_px_.y) * up_step_;
}

glm::dvec2 texel_position(const Picture& source, const RowRule& rows, const Hit& hit) {
  const double u = 0.5 + longitude_rad(hit.normal) / (2.0 * std::numbers::pi);
  return {u * source.width, row_fraction(rows, hit) * source.height};
}

glm::dvec3 sample(const Picture& source, const glm::dvec2& texel) {
  const double x = texel.x - 0.5;
  const double y = std::clamp(texel.y - 0.5, 0.0, source.height - 1.0);
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(y);
  const double tx = x - column;
  const double ty = y - row;
  const int west = column < 0 ? column + source.width : (column >= source.width ? column - source.width : column);
  const int east = west + 1 == source.width ? 0 : west + 1;
  const int below = std::min(row + 1, source.height - 1);
  const std::uint8_t* nw = source.texel(west, row);
  const std::uint8_t* ne = source.texel(east, row);
  const std::uint8_t* sw = source.texel(west, below);
  const std::uint8_t* se = source.texel(east, below);
  glm::dvec3 value;
  for (int c = 0; c < 3; ++c) {
    const double upper = nw[c] + tx * (ne[c] - nw[c]);
    const double lower = sw[c] + tx * (se[c] - sw[c]);
    value[c] = upper + ty * (lower - upper);
  }
  return value;
}

TruthImage cast(const Picture& source, const RowRule& rows, const Spheroid& body, const TruthCamera& camera,
                const TruthOptions& options) {
  const std::size_t pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  TruthImage out{.width = options.width,
                 .height = options.height,
                 .rays_per_pixel = options.rays_per_side * options.rays_per_side,
                 .rgb = std::vector<float>(3 * pixels),
                 .hits = std::vector<std::uint16_t>(pixels),
                 .lat_deg = std::vector<float>(pixels, kNan),
                 .lon_deg = std::vector<float>(pixels, kNan),
                 .incidence_deg = std::vector<float>(pixels, kNan)};
  const Scene scene{source, rows, body, PixelRays(body, camera, options.width, options.height), options.rays_per_side};
  // Workers take rows one by one. With fixed shares, a worker with rows of sky would be idle.
  std::atomic<int> next_row{0};
  const auto work = [&] {
    for (int y = next_row++; y < options.height; y = next_row++) {
      for (int x = 0; x < options.width; ++x) {
        cast_place(scene, x, y, out);
        cast_colour(scene, x, y, out);
      }
    }
  };
  std::vector<std::jthread> workers;
  for (int i = 0; i < options.threads; ++i) workers.emplace_back(work);
  workers.clear();
  return out;
}

}  // namespace terrella::truth
