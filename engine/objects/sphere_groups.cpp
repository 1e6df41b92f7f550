#include "objects/sphere_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "geo/split_position.h"

namespace terrella {
namespace {

using glm::vec3;

constexpr unsigned kCurveBits = 30;
constexpr float kAround_px = 4.0F;  // the smallest sphere's largest radius plus its edge (object_sphere_seen.glsl)

/// Spreads the ten low bits of a number to every third bit.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16U) & 0x030000FFU;
  bits = (bits | bits << 8U) & 0x0300F00FU;
  bits = (bits | bits << 4U) & 0x030C30C3U;
  return (bits | bits << 2U) & 0x09249249U;
}

/// Returns the position of a place on a Morton curve through a cube around the planet's centre, half as wide as
/// `reach_m`.
std::uint32_t place_on_curve(const vec3& place_m, float reach_m) {
  const vec3 cell = (place_m / reach_m + 1.0F) * 511.0F;
  return spread(static_cast<std::uint32_t>(cell.x)) | spread(static_cast<std::uint32_t>(cell.y)) << 1U |
         spread(static_cast<std::uint32_t>(cell.z)) << 2U;
}

/// Sorts spheres along the curve and returns the position of each on the curve.
std::vector<std::uint32_t> sort_along_curve(std::span<DotInstance> spheres, std::span<std::uint32_t> sources) {
  float reach_m = 1.0F;
  for (const DotInstance& d : spheres) reach_m = std::max(reach_m, glm::length(d.high_m));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // the place on the curve, and the index
  for (const DotInstance& d : spheres) order.emplace_back(place_on_curve(d.high_m, reach_m), order.size());
  std::ranges::sort(order);
  const std::vector<DotInstance> old(spheres.begin(), spheres.end());
  const std::vector<std::uint32_t> old_sources(sources.begin(), sources.end());
  std::vector<std::uint32_t> places;
  for (std::size_t k = 0; k < order.size(); ++k) {
    spheres[k] = old[order[k].second];
    sources[k] = old_sources[order[k].second];
    places.push_back(order[k].first);
  }
  return places;
}

/// The same as is_hidden() of object_common.glsl.
bool is_hidden(const vec3& center, float away, float radius_m, const SphereSight& sight) {
  const float within = 0.999F * sight.hiding_radius_m - radius_m;
  if (within <= 0.0F) return false;
  const vec3& eye = sight.eye_high_m;
  if (glm::length(eye + center) < within) return true;
  const float passes = -glm::dot(eye, center) / away;
  return passes > 0.0F && passes < away && glm::length(glm::cross(eye, center)) / away < within;
}

/// Planes through the eye that bound the picture. Normals point inwards, unit, Earth-fixed.
std::array<vec3, 4> sides(const SphereSight& sight) {
  const glm::mat3 ecef_from_plane = glm::transpose(sight.view_from_ecef);
  const auto plane = [&ecef_from_plane](float x, float y) {
    return glm::normalize(ecef_from_plane * vec3(x, y, -1.0F));
  };
  return {plane(sight.clip_scale.x, 0.0F), plane(-sight.clip_scale.x, 0.0F), plane(0.0F, sight.clip_scale.y),
          plane(0.0F, -sight.clip_scale.y)};
}

void append(std::vector<SphereGroups::Run>& runs, SphereGroups::Run run) {
  if (!runs.empty() && runs.back().first + runs.back().count == run.first) {
    runs.back().count += run.count;
  } else {
    runs.push_back(run);
  }
}

}  // namespace

SphereGroups::SphereGroups(const Batch<DotInstance>& spheres) : items_(spheres.items), sources_(spheres.items.size()) {
  std::iota(sources_.begin(), sources_.end(), std::uint32_t{0});
  for (std::size_t bucket = 0; bucket < Batch<DotInstance>::kBuckets; ++bucket) {
    const std::size_t first = spheres.first[bucket], end = spheres.first[bucket + 1];
    const std::span<DotInstance> all(items_.data() + first, end - first);
    if (Batch<DotInstance>::is_opaque(bucket)) {
      add_cubes({first, end - first}, sort_along_curve(all, std::span(sources_).subspan(first, end - first)), first,
                kCurveBits);
    } else {
      add_groups({first, end - first}, false);
    }
  }
}

void SphereGroups::add_groups(Run run, bool opaque) {
  for (std::size_t k = 0; k < run.count; k += kMostInGroup) {
    groups_.push_back(group_of({run.first + k, std::min(kMostInGroup, run.count - k)}));
    groups_.back().opaque = opaque;
  }
}

// Neighbours on the curve may be far apart, but the spheres of one cube are not. Cubes with too many spheres are
// divided into eight.
void SphereGroups::add_cubes(Run run, const std::vector<std::uint32_t>& places, std::size_t zeroth, unsigned bits) {
  if (run.count <= kMostInGroup || bits == 0) return add_groups(run, true);
  const auto begin = places.begin() + std::ptrdiff_t(run.first - zeroth), end = begin + std::ptrdiff_t(run.count);
  const unsigned below = bits - 3;
  for (auto from = begin; from != end;) {
    const auto cube = [below](std::uint32_t place) { return place >> below; };
    const auto to = std::ranges::upper_bound(from, end, cube(*from), {}, cube);
    add_cubes({zeroth + std::size_t(from - places.begin()), std::size_t(to - from)}, places, zeroth, below);
    from = to;
  }
}

SphereGroups::Group SphereGroups::group_of(Run run) const {
  const std::span<const DotInstance> some(items_.data() + run.first, run.count);
  glm::dvec3 sum(0.0);
  for (const DotInstance& d : some) sum += glm::dvec3(d.high_m) + glm::dvec3(d.low_m);
  const SplitPosition middle = split_position(sum / double(some.size()));
  float radius_m = 0.0F, largest_m = 0.0F;
  for (const DotInstance& d : some) {
    const float off_m = glm::length((d.high_m - middle.high) + (d.low_m - middle.low));
    radius_m = std::max(radius_m, off_m + d.size);
    largest_m = std::max(largest_m, d.size);
  }
  return {run, true, middle.high, middle.low, 1.0001F * radius_m, largest_m};
}

void SphereGroups::set(std::size_t k, const DotInstance& sphere) {
  items_[k] = sphere;
  const auto after = std::ranges::upper_bound(groups_, k, {}, [](const Group& g) { return g.run.first; });
  std::prev(after)->stale = true;
}

SphereGroups::Look SphereGroups::look_of(const Group& group, const SphereSight& sight) {
  const vec3 center = (group.high_m - sight.eye_high_m) + (group.low_m - sight.eye_low_m);
  const float away = glm::length(center);
  const float reach_m = group.radius_m + kAround_px * (away + group.radius_m) / sight.focal_px;
  if (is_hidden(center, away, reach_m, sight)) return Look::hidden;
  const vec3 forward = -glm::transpose(sight.view_from_ecef)[2];
  const float ahead = glm::dot(forward, center) / glm::length(forward);
  if (ahead < -reach_m) return Look::hidden;
  bool whole = true;
  for (const vec3& inwards : sides(sight)) {
    const float inside_m = glm::dot(inwards, center);
    if (inside_m < -reach_m) return Look::hidden;
    whole = whole && inside_m > reach_m;
  }
  const float nearest_m = ahead - reach_m;
  if (!whole || !group.opaque || nearest_m <= 0.0F) return Look::triangles;
  // Towards the picture's edge a sphere is drawn longer, by the ratio of its distance to its depth ahead of the eye.
  const float widest_px = sight.focal_px * group.largest_m * (away + reach_m) / (nearest_m * nearest_m);
  return widest_px <= sight.largest_point_px ? Look::points : Look::triangles;
}

SphereGroups::Seen SphereGroups::seen(Run range, const SphereSight& sight) {
  Seen seen;
  const auto first = std::ranges::lower_bound(groups_, range.first, {}, [](const Group& g) { return g.run.first; });
  for (auto group = first; group != groups_.end() && group->run.first < range.first + range.count; ++group) {
    if (group->stale) {
      const bool opaque = group->opaque;
      *group = group_of(group->run);
      group->opaque = opaque;
    }
    const Look look = look_of(*group, sight);
    if (look == Look::triangles) append(seen.triangles, group->run);
    if (look == Look::points) append(seen.points, group->run);
  }
  return seen;
}

}  // namespace terrella
