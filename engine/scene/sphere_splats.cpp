#include "scene/sphere_splats.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <thread>

#include "geo/split_position.h"

namespace terrella {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kSmallest_px = 0.75F;  // as in object_sphere.vert
constexpr float kWidestAngle = 0.02F;  // radius over distance, up to which the outline is taken for an ellipse
constexpr int kMostThreads = 8;
constexpr int kBandsOfAThread = 2;

/// The ten low bits of a number, two apart.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16U) & 0x030000FFU;
  bits = (bits | bits << 8U) & 0x0300F00FU;
  bits = (bits | bits << 4U) & 0x030C30C3U;
  return (bits | bits << 2U) & 0x09249249U;
}

SplatLens lens_of(const SplatView& view) {
  SplatLens lens{};
  for (int k = 0; k < 9; ++k) lens.view_from_ecef[k] = view.view_from_ecef[k / 3][k % 3];
  for (int k = 0; k < 3; ++k) {
    lens.eye_high[k] = view.eye_high_ecef[k];
    lens.eye_low[k] = view.eye_low_ecef[k];
    lens.sun[k] = view.sun_ecef[k];
  }
  lens.size_px[0] = float(view.viewport.width_px);
  lens.size_px[1] = float(view.viewport.height_px);
  for (int k = 0; k < 2; ++k) {
    lens.half_px[k] = 0.5F * lens.size_px[k];
    lens.focal_px[k] = lens.half_px[k] * view.focal[k];
  }
  lens.smallest_px = kSmallest_px;
  lens.most_px = SphereSplats::kMostRadius_px;
  lens.widest_angle = kWidestAngle;
  // A float's step at the eye's distance, several times, is what is hidden by more than.
  const float hiding_m = 0.999F * float(view.hiding_radius_m) - 1.0e-6F * glm::length(view.eye_high_ecef);
  lens.hiding_m = std::max(hiding_m, 0.0F);
  return lens;
}

vec3 from_eye(const SplatView& view, const SphereGroups::Ball& ball) {
  return (ball.high_m - view.eye_high_ecef) + (ball.low_m - view.eye_low_ecef);
}

/// As SplatLens::hiding_m hides spheres.
bool is_hidden(const SplatLens& lens, const SplatView& view, const SphereGroups::Ball& ball) {
  const float within = lens.hiding_m - ball.radius_m;
  if (within <= 0.0F) return false;
  const vec3& eye = view.eye_high_ecef;
  const vec3 c = from_eye(view, ball);
  if (glm::length(eye + c) < within) return true;
  const float away = glm::length(c);
  const vec3 axis = c / away;
  const float along = -glm::dot(eye, axis);
  return along > 0.0F && along < away && glm::length(glm::cross(eye, axis)) < within;
}

/// Rows of blocks of a picture.
struct Rows {
  int first, end;
};

/// False only if nothing of a ball, or of the pixels around it, is in these rows of the picture.
bool may_show(const SplatView& view, const Rows& rows, const SphereGroups::Ball& ball) {
  constexpr float kAround_px = 2.0F;  // the smallest sphere's radius, and its edge
  const vec3 p = view.view_from_ecef * from_eye(view, ball);
  const float half_px = 0.5F * float(view.viewport.height_px);
  const float w = -p.z, reach = ball.radius_m + kAround_px / (half_px * view.focal.y) * glm::length(p);
  // A plane through the eye, `slope` to the right or up per distance before it: how far left or below of it p is.
  const auto beyond = [w](float across, float slope) { return (slope * w - across) / std::sqrt(1.0F + slope * slope); };
  const auto slope_at = [&](int row) { return (float(row * kSplatBlockHeight_px) / half_px - 1.0F) / view.focal.y; };
  const float side = 1.0F / view.focal.x;
  return w > -reach && beyond(p.x, side) > -reach && beyond(-p.x, side) > -reach &&
         beyond(p.y, slope_at(rows.end)) > -reach && beyond(-p.y, -slope_at(rows.first)) > -reach;
}

SphereGroups::Ball ball_around(std::span<const DotInstance> spheres) {
  glm::dvec3 sum(0.0);
  for (const DotInstance& d : spheres) sum += glm::dvec3(d.high_m) + glm::dvec3(d.low_m);
  const SplitPosition middle = split_position(sum / double(spheres.size()));
  float radius_m = 0.0F;
  for (const DotInstance& d : spheres) {
    const float off_m = glm::length((d.high_m - middle.high) + (d.low_m - middle.low));
    radius_m = std::max(radius_m, off_m + d.size);
  }
  return {middle.high, middle.low, 1.0001F * radius_m};
}

SplatSpheres numbers_of(std::span<const DotInstance> spheres) {
  SplatSpheres s{};
  for (std::size_t k = 0; k < kSplatGroup; ++k) {
    const DotInstance& d = spheres[std::min(k, spheres.size() - 1)];
    s.high_x[k] = d.high_m.x, s.high_y[k] = d.high_m.y, s.high_z[k] = d.high_m.z;
    s.low_x[k] = d.low_m.x, s.low_y[k] = d.low_m.y, s.low_z[k] = d.low_m.z;
    s.radius_m[k] = d.size;
    s.red[k] = d.color.red, s.green[k] = d.color.green, s.blue[k] = d.color.blue;
  }
  return s;
}

}  // namespace

SphereGroups::SphereGroups(const Batch<DotInstance>& batch) : items_(batch.items) {
  const auto key = [](const DotInstance& d) {
    const vec3 cell = (glm::normalize(d.high_m + vec3(1.0F, 0.0F, 0.0F)) + 1.0F) * 511.0F;
    return spread(static_cast<std::uint32_t>(cell.x)) | spread(static_cast<std::uint32_t>(cell.y)) << 1U |
           spread(static_cast<std::uint32_t>(cell.z)) << 2U;
  };
  for (std::size_t bucket = 0; bucket + 1 < batch.first.size(); ++bucket) {
    const std::size_t first = batch.first[bucket], end = batch.first[bucket + 1];
    std::stable_sort(items_.begin() + static_cast<std::ptrdiff_t>(first),
                     items_.begin() + static_cast<std::ptrdiff_t>(end),
                     [&key](const DotInstance& a, const DotInstance& b) { return key(a) < key(b); });
    for (std::size_t k = first; k < end; k += kSplatGroup) {
      const std::span<DotInstance> some(items_.data() + k, std::min<std::size_t>(kSplatGroup, end - k));
      std::stable_sort(some.begin(), some.end(), [](const DotInstance& a, const DotInstance& b) {
        return glm::dot(a.high_m, a.high_m) > glm::dot(b.high_m, b.high_m);
      });
      groups_.push_back({k, static_cast<int>(some.size()), ball_around(some), numbers_of(some)});
    }
  }
}

SphereSplats::SphereSplats() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") != 0) code_ = {place_splats_avx2, draw_splat_avx2};
#endif
}

std::size_t SphereSplats::blocks_of(Viewport viewport) {
  const int columns = (viewport.width_px + kSplatBlockWidth_px - 1) / kSplatBlockWidth_px;
  const int rows = (viewport.height_px + kSplatBlockHeight_px - 1) / kSplatBlockHeight_px;
  return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}

/// Some rows of blocks, and what one thread needs to draw the spheres in them.
class SphereSplats::Band {
 public:
  Band(SphereSplats& splats, std::span<SplatBlock> picture, const SplatView& view, const Rows& rows)
      : splats_(splats), picture_(picture), view_(view), lens_(lens_of(view)), rows_(rows) {}

  void draw(const SphereGroups& spheres, std::size_t first, std::size_t count) {
    for (const SphereGroups::Group& group : spheres.groups()) {
      if (group.first < first || group.first >= first + count) continue;
      if (!may_show(view_, rows_, group.ball) || is_hidden(lens_, view_, group.ball)) continue;
      splats_.code_.place(group.spheres, group.count, lens_, discs_);
      for (int k = 0; k < group.count; ++k) {
        if (discs_.large[k] != 0) large_.push_back(group.first + static_cast<std::size_t>(k));
        if (discs_.shown[k] != 0) add(group.spheres, k);
      }
    }
  }
  /// Numbers of the spheres that are left to triangles; those of another band may be among them.
  [[nodiscard]] const std::vector<std::size_t>& large() const { return large_; }

 private:
  void add(const SplatSpheres& spheres, int k) {
    if (discs_.x_first[k] > discs_.x_last[k] || discs_.y_first[k] > discs_.y_last[k]) return;
    const int last_column = discs_.x_last[k] / kSplatBlockWidth_px;
    const int last_row = std::min(discs_.y_last[k] / kSplatBlockHeight_px, rows_.end - 1);
    for (int row = std::max(discs_.y_first[k] / kSplatBlockHeight_px, rows_.first); row <= last_row; ++row) {
      for (int column = discs_.x_first[k] / kSplatBlockWidth_px; column <= last_column; ++column) {
        SplatBlock& block = block_at(column, row);
        splats_.code_.draw(spheres, discs_, k, column, row, view_.lit, block.nearness.data(), block.rgba.data());
      }
    }
  }

  SplatBlock& block_at(int column, int row) {
    const std::size_t at =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(splats_.columns_) + static_cast<std::size_t>(column);
    SplatBlock& block = picture_[at];
    if (splats_.touched_[at] == 0) {
      splats_.touched_[at] = 1;
      block.nearness.fill(0.0F);
    }
    return block;
  }

  SphereSplats& splats_;
  std::span<SplatBlock> picture_;
  const SplatView& view_;
  SplatLens lens_;
  Rows rows_;
  SplatDiscs discs_{};
  std::vector<std::size_t> large_;
};

void SphereSplats::draw(const SphereGroups& spheres, std::size_t first, std::size_t count, const SplatView& view,
                        std::span<SplatBlock> picture) {
  assert(picture.size() >= blocks_of(view.viewport));
  columns_ = (view.viewport.width_px + kSplatBlockWidth_px - 1) / kSplatBlockWidth_px;
  const int rows = static_cast<int>(blocks_of(view.viewport)) / columns_;
  touched_.assign(blocks_of(view.viewport), 0);
  // More bands than threads: where the spheres are is not known.
  const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostThreads);
  const int count_of_bands = std::min(threads == 1 ? 1 : kBandsOfAThread * threads, rows);
  std::vector<Band> bands;
  bands.reserve(static_cast<std::size_t>(count_of_bands));
  for (int k = 0; k < count_of_bands; ++k) {
    bands.emplace_back(*this, picture, view, Rows{k * rows / count_of_bands, (k + 1) * rows / count_of_bands});
  }
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t k = next++; k < bands.size(); k = next++) bands[k].draw(spheres, first, count);
  };
  {
    std::vector<std::jthread> others;
    for (int k = 1; k < threads; ++k) others.emplace_back(work);
    work();
  }
  std::vector<std::size_t> large;
  for (const Band& band : bands) large.insert(large.end(), band.large().begin(), band.large().end());
  std::ranges::sort(large);
  large.erase(std::unique(large.begin(), large.end()), large.end());
  large_.clear();
  for (const std::size_t k : large) large_.push_back(spheres.items()[k]);
}

std::vector<SphereSplats::Run> SphereSplats::runs() const {
  std::vector<Run> runs;
  const auto columns = static_cast<std::size_t>(columns_);
  for (std::size_t k = 0; k < touched_.size();) {
    std::size_t end = k;
    const std::size_t row_end = (k / columns + 1) * columns;
    while (end < row_end && touched_[end] != 0) ++end;
    if (end > k) {
      runs.push_back({static_cast<std::uint32_t>(k % columns), static_cast<std::uint32_t>(k / columns),
                      static_cast<std::uint32_t>(end - k), static_cast<std::uint32_t>(k)});
    }
    k = std::max(end, k + 1);
  }
  return runs;
}

}  // namespace terrella
