#include "scene/sphere_splats.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/geometric.hpp>

#include "scene/patch_mesh.h"

namespace terrella {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kSmallest_px = 0.75F;  // as in object_sphere.vert
constexpr float kWidestAngle = 0.02F;  // radius over distance, up to which the outline is taken for an ellipse

// GCC's and Clang's vectors: four pixels at once.
constexpr int kLanes = 4;
using Floats = float __attribute__((vector_size(sizeof(float) * kLanes)));
using Integers = std::int32_t __attribute__((vector_size(sizeof(std::int32_t) * kLanes)));

Floats at_least(const Floats& values, float least) {
  return values > least ? values : Floats{least, least, least, least};
}
Floats at_most(const Floats& values, float most) { return values < most ? values : Floats{most, most, most, most}; }
Floats root(const Floats& v) { return Floats{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])}; }

/// The ten low bits of a number, two apart.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16U) & 0x030000FFU;
  bits = (bits | bits << 8U) & 0x0300F00FU;
  bits = (bits | bits << 4U) & 0x030C30C3U;
  return (bits | bits << 2U) & 0x09249249U;
}

}  // namespace

/// Whether a sphere around the planet's centre that the eye is outside of hides all of a ball: the ball lies in it, or
/// the way to the ball's middle ends behind it, having passed its middle by less than the difference of the radii.
class SphereSplats::Hiding {
 public:
  Hiding(const SplatView& view)
      : eye_(glm::dvec3(view.eye_high_ecef) + glm::dvec3(view.eye_low_ecef)),
        eye2_(glm::dot(eye_, eye_)),
        radius_(0.999 * view.hiding_radius_m) {}

  [[nodiscard]] bool hides(const vec3& center, float away, float ball_radius) const {
    const double within = radius_ - double(ball_radius);
    if (within <= 0.0) return false;
    const double along = -(eye_.x * double(center.x) + eye_.y * double(center.y) + eye_.z * double(center.z));
    const double away2 = double(away) * double(away);
    if (eye2_ - 2.0 * along + away2 < within * within) return true;
    if (along <= 0.0 || along >= away2) return false;
    return eye2_ - along * along / away2 < within * within;
  }

 private:
  glm::dvec3 eye_;
  double eye2_, radius_;
};

/// The view in pixels.
struct SphereSplats::Lens {
  explicit Lens(const SplatView& v)
      : view(v),
        half_px(0.5F * float(v.viewport.width_px), 0.5F * float(v.viewport.height_px)),
        focal_px(half_px * v.focal) {}

  [[nodiscard]] vec3 from_eye(const vec3& high_m, const vec3& low_m) const {
    return (high_m - view.eye_high_ecef) + (low_m - view.eye_low_ecef);
  }
  /// False only if nothing of a ball is in the picture.
  [[nodiscard]] bool may_show(const vec3& center, float radius) const {
    const vec3 p = view.view_from_ecef * center;
    const vec2 slope = 1.0F / view.focal;
    const float w = -p.z, reach = 2.0F * radius + 0.01F * glm::length(center);
    return w > -reach && std::abs(p.x) < slope.x * (w + reach) + reach && std::abs(p.y) < slope.y * (w + reach) + reach;
  }

  const SplatView& view;
  vec2 half_px, focal_px;
};

/// A sphere's outline on the picture, an ellipse: how pixels and the disc's axes go over into each other.
struct SphereSplats::Disc {
  vec2 center_px;
  vec2 reach_px;                   ///< half the ellipse's box, with the pixels that it covers in part
  vec2 u_of_px, v_of_px;           ///< rows of the matrix from pixels to the disc's axes
  float radius_px;                 ///< in the picture's middle
  float part;                      ///< radius over distance
  float nearness, tilt_u, tilt_v;  ///< in the disc's middle, and how much it shrinks along the disc's axes
  vec3 sun_disc;
  vec3 color;  ///< 0 to 255
};

SphereGroups::SphereGroups(const Batch<DotInstance>& batch) : items_(batch.items) {
  float extent = 1.0F;
  for (const DotInstance& d : items_) {
    extent = std::max({extent, std::abs(d.high_m.x), std::abs(d.high_m.y), std::abs(d.high_m.z)});
  }
  const auto key = [extent](const DotInstance& d) {
    const vec3 cell = (d.high_m / extent + 1.0F) * 511.0F;
    return spread(static_cast<std::uint32_t>(cell.x)) | spread(static_cast<std::uint32_t>(cell.y)) << 1U |
           spread(static_cast<std::uint32_t>(cell.z)) << 2U;
  };
  for (std::size_t k = 0; k + 1 < batch.first.size(); ++k) {
    std::stable_sort(items_.begin() + static_cast<std::ptrdiff_t>(batch.first[k]),
                     items_.begin() + static_cast<std::ptrdiff_t>(batch.first[k + 1]),
                     [&key](const DotInstance& a, const DotInstance& b) { return key(a) < key(b); });
  }
  for (std::size_t k = 0; k < items_.size(); k += kSize) {
    const std::span<const DotInstance> group(items_.data() + k, std::min(kSize, items_.size() - k));
    glm::dvec3 sum(0.0);
    for (const DotInstance& d : group) sum += glm::dvec3(d.high_m) + glm::dvec3(d.low_m);
    const SplitPosition middle = split_position(sum / double(group.size()));
    float radius_m = 0.0F;
    for (const DotInstance& d : group) {
      const float off_m = glm::length((d.high_m - middle.high) + (d.low_m - middle.low));
      radius_m = std::max(radius_m, off_m + d.size);
    }
    balls_.push_back({middle.high, middle.low, 1.0001F * radius_m});
  }
}

void SphereSplats::begin(Viewport viewport) {
  columns_ = (viewport.width_px + kSplatBlock_px - 1) / kSplatBlock_px;
  const int rows = (viewport.height_px + kSplatBlock_px - 1) / kSplatBlock_px;
  slots_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows), -1);
  places_.clear();
  blocks_.clear();
  large_.clear();
}

void SphereSplats::draw(const SphereGroups& spheres, std::size_t first, std::size_t count, const SplatView& view) {
  begin(view.viewport);
  const Hiding hiding(view);
  const Lens lens(view);
  for (std::size_t k = first; k < first + count;) {
    const std::size_t group = k / SphereGroups::kSize;
    const std::size_t end = std::min(first + count, (group + 1) * SphereGroups::kSize);
    const SphereGroups::Ball& ball = spheres.balls()[group];
    const vec3 c = lens.from_eye(ball.high_m, ball.low_m);
    const bool seen = !hiding.hides(c, glm::length(c), ball.radius_m) && lens.may_show(c, ball.radius_m);
    for (; k < end; ++k) {
      if (seen) add(spheres.items()[k], lens, hiding);
    }
    k = end;
  }
}

void SphereSplats::add(const DotInstance& sphere, const Lens& lens, const Hiding& hiding) {
  const SplatView& view = lens.view;
  const vec3 c = lens.from_eye(sphere.high_m, sphere.low_m);
  const float away = glm::length(c);
  const float r = std::max(sphere.size, kSmallest_px * away / lens.focal_px.y);
  if (hiding.hides(c, away, r)) return;
  const float part = r / away;
  if (part > kWidestAngle || part * lens.focal_px.y > kMostRadius_px) return large_.push_back(sphere);
  const vec3 p = view.view_from_ecef * c;
  // Nothing that small reaches into the picture from beside the eye.
  const float w = -p.z;
  if (w < 0.05F * away) return;
  const float in = 1.0F / w;
  const vec2 at_px = lens.half_px + lens.focal_px * vec2(p) * in;
  const vec3 axis = c / away;
  const vec3 side = glm::normalize(std::abs(axis.x) < 0.7F ? vec3(0.0F, axis.z, -axis.y) : vec3(-axis.z, 0.0F, axis.x));
  const vec3 up = glm::cross(axis, side);
  const float k = std::sqrt(1.0F - part * part), rim = r / k;
  const vec3 side_view = view.view_from_ecef * side, up_view = view.view_from_ecef * up;
  const vec2 u_px = lens.focal_px * (rim * in * in) * (vec2(side_view) * w + vec2(p) * side_view.z);
  const vec2 v_px = lens.focal_px * (rim * in * in) * (vec2(up_view) * w + vec2(p) * up_view.z);
  const float det = 1.0F / (u_px.x * v_px.y - u_px.y * v_px.x);
  const float radius_px = lens.focal_px.y * part / k, edge = 1.0F + 0.5F / radius_px;
  add({.center_px = at_px,
       .reach_px =
           edge * vec2(std::sqrt(u_px.x * u_px.x + v_px.x * v_px.x), std::sqrt(u_px.y * u_px.y + v_px.y * v_px.y)),
       .u_of_px = vec2(v_px.y, -v_px.x) * det,
       .v_of_px = vec2(-u_px.y, u_px.x) * det,
       .radius_px = radius_px,
       .part = part,
       .nearness = in,
       .tilt_u = -side_view.z * r * in,
       .tilt_v = -up_view.z * r * in,
       .sun_disc = vec3(glm::dot(view.sun_ecef, side), glm::dot(view.sun_ecef, up), -glm::dot(view.sun_ecef, axis)),
       .color = vec3(sphere.color.red, sphere.color.green, sphere.color.blue)},
      view);
}

void SphereSplats::add(const Disc& disc, const SplatView& view) {
  const auto block = [](float px, int most_px) {
    return static_cast<int>(std::clamp(px, 0.0F, float(most_px) - 0.5F)) / kSplatBlock_px;
  };
  const vec2 low = disc.center_px - disc.reach_px, high = disc.center_px + disc.reach_px;
  if (!(high.x > 0.0F && high.y > 0.0F && low.x < float(view.viewport.width_px) &&
        low.y < float(view.viewport.height_px)))
    return;
  const int last_column = block(high.x, view.viewport.width_px), last_row = block(high.y, view.viewport.height_px);
  for (int row = block(low.y, view.viewport.height_px); row <= last_row; ++row) {
    for (int column = block(low.x, view.viewport.width_px); column <= last_column; ++column) {
      add_to_block(disc, column, row, view.lit);
    }
  }
}

SplatBlock& SphereSplats::block_at(int column, int row) {
  std::int32_t& slot =
      slots_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(places_.size());
    places_.push_back(static_cast<std::uint32_t>(column) | static_cast<std::uint32_t>(row) << 16U);
    blocks_.emplace_back();
  }
  return blocks_[static_cast<std::size_t>(slot)];
}

void SphereSplats::add_to_block(const Disc& disc, int column, int row, bool lit) {
  SplatBlock& block = block_at(column, row);
  const vec2 center = disc.center_px - vec2(float(column), float(row)) * float(kSplatBlock_px) - vec2(0.5F);
  const auto first = [](float px) { return std::max(0, static_cast<int>(std::ceil(px))); };
  const auto last = [](float px) { return std::min(kSplatBlock_px - 1, static_cast<int>(std::floor(px))); };
  const int x_first = first(center.x - disc.reach_px.x) / kLanes * kLanes, x_last = last(center.x + disc.reach_px.x);
  const int y_last = last(center.y + disc.reach_px.y);
  for (int y = first(center.y - disc.reach_px.y); y <= y_last; ++y) {
    for (int x = x_first; x <= x_last; x += kLanes) {
      const vec2 off = vec2(float(x), float(y)) - center;
      float* const nearness = block.nearness.data() + y * kSplatBlock_px + x;
      std::uint32_t* const rgba = block.rgba.data() + y * kSplatBlock_px + x;
      lit ? add_to_lanes<true>(disc, off, nearness, rgba) : add_to_lanes<false>(disc, off, nearness, rgba);
    }
  }
}

/// A few pixels of a row at once, without a branch.
template <bool lit>
void SphereSplats::add_to_lanes(const Disc& disc, const vec2& off, float* nearness, std::uint32_t* rgba) {
  const Floats along{0.0F, 1.0F, 2.0F, 3.0F};
  const Floats u = disc.u_of_px.x * off.x + disc.u_of_px.y * off.y + along * disc.u_of_px.x;
  const Floats v = disc.v_of_px.x * off.x + disc.v_of_px.y * off.y + along * disc.v_of_px.x;
  const Floats d2 = u * u + v * v;
  const Floats bulge = root(at_least(1.0F - d2, 0.0F));
  // object_sphere.frag's depth, to the first order of what is small here.
  const Floats near = disc.nearness * (1.0F + disc.part * bulge - disc.tilt_u * u - disc.tilt_v * v);
  const Floats coverage = at_least(at_most(0.5F + disc.radius_px - root(d2) * disc.radius_px, 1.0F), 0.0F);
  Floats light{1.0F, 1.0F, 1.0F, 1.0F};
  if constexpr (lit) {
    const Floats sun = u * disc.sun_disc.x + v * disc.sun_disc.y + bulge * disc.sun_disc.z;
    const Floats s = at_least(at_most((sun + 0.5F) * (1.0F / 1.3F), 1.0F), 0.0F);
    light = (0.5F + 0.5F * bulge) * (0.8F + 0.28F * s * s * (3.0F - 2.0F * s));
  }
  const auto byte = [](const Floats& value) {
    return __builtin_convertvector(at_most(value, 255.0F) + 0.5F, Integers);
  };
  const Integers alpha = byte(255.0F * coverage);
  const Integers color =
      byte(light * disc.color.x) | byte(light * disc.color.y) << 8 | byte(light * disc.color.z) << 16 | alpha << 24;
  Floats nearest;
  Integers shown;
  std::memcpy(&nearest, nearness, sizeof nearest);
  std::memcpy(&shown, rgba, sizeof shown);
  const Integers wins = (near > nearest) & (alpha > 0);
  nearest = wins ? near : nearest;
  shown = wins ? color : shown;
  std::memcpy(nearness, &nearest, sizeof nearest);
  std::memcpy(rgba, &shown, sizeof shown);
}

}  // namespace terrella
