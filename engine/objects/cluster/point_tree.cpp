#include "objects/cluster/point_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "base/hash_mix.h"
#include "geo/ellipsoid.h"

namespace terrella {
namespace {

constexpr int kFinest = 26;  // 2^-26 rad are 0.1 m on the Earth
constexpr int kCoarsest = 2;

struct Cell {
  std::int64_t x = 0, y = 0, z = 0;
  bool operator==(const Cell&) const = default;
};

Cell cell_of(const glm::dvec3& normal, double side) {
  const auto index = [side](double at) { return static_cast<std::int64_t>(std::floor(at / side)); };
  return {index(normal.x), index(normal.y), index(normal.z)};
}

/// Places of nodes in cubes of one side, with open addressing: a table of std costs ten times the time.
class CellTable {
 public:
  explicit CellTable(std::size_t nodes) : heads_(std::bit_ceil(2 * nodes + 1)), next_(nodes, PointTree::kNone) {}

  void add(const Cell& cell, std::uint32_t at) {
    Head& head = find(cell);
    head.cell = cell;
    next_[at] = std::exchange(head.first, at);
  }

  /// Calls use(at) for what lies in the eight cubes nearest to a place: at least half a side around it.
  template <class Use>
  void each_near(const glm::dvec3& place, double side, const Use& use) {
    const Cell low = cell_of(place - glm::dvec3(0.5 * side), side);
    for (std::int64_t i = 0; i < 8; ++i) {
      const Head& head = find({low.x + i % 2, low.y + i / 2 % 2, low.z + i / 4});
      for (std::uint32_t at = head.first; at != PointTree::kNone; at = next_[at]) use(at);
    }
  }

 private:
  struct Head {
    Cell cell;
    std::uint32_t first = PointTree::kNone;
  };

  /// The entry of a cube, or the free one where it belongs.
  Head& find(const Cell& cell) {
    const std::size_t mask = heads_.size() - 1;
    std::size_t at = mix_bits(static_cast<std::uint64_t>(cell.x) ^ mix_bits(static_cast<std::uint64_t>(cell.y)) ^
                              mix_bits(mix_bits(static_cast<std::uint64_t>(cell.z)))) &
                     mask;
    while (heads_[at].first != PointTree::kNone && heads_[at].cell != cell) at = (at + 1) & mask;
    return heads_[at];
  }

  std::vector<Head> heads_;
  std::vector<std::uint32_t> next_;
};

/// The angle between unit vectors; accurate for small ones.
double angle_rad(const glm::dvec3& a, const glm::dvec3& b) {
  return 2.0 * std::asin(std::min(0.5 * glm::distance(a, b), 1.0));
}

/// True if a ball may touch the picture.
bool may_show(const View& view, const glm::dvec3& middle_m, double radius_m) {
  const glm::dvec3 from_eye = middle_m - view.eye.xyz_m;
  const double ahead = glm::dot(from_eye, view.forward), up = glm::dot(from_eye, view.up);
  const double right = glm::dot(from_eye, view.right) - view.shear_x * ahead;
  const double reach_m = radius_m + view.eye_spread_m;
  const auto is_within = [&](double aside, double slope) {
    return std::abs(aside) - slope * ahead <= reach_m * (std::sqrt(1.0 + slope * slope) + std::abs(view.shear_x));
  };
  return ahead > -reach_m && is_within(up, view.tan_half_fov_y) &&
         is_within(right, view.tan_half_fov_y * view.aspect());
}

/// Pixels of a radian on the ground at the point of a node that is nearest to the eye, where the ground is seen at the
/// least slant.
double pixels_per_radian(const View& view, const Ellipsoid& planet, const PointTree::Node& node,
                         const glm::dvec3& middle_m) {
  constexpr double kMostSlant = 0.25;  // the ground at the limb has no more groups than this much of its length
  const glm::dvec3 to_eye = view.eye.xyz_m - middle_m;
  const double distance_m = std::max(glm::length(to_eye), 1.0);
  const double slant = std::acos(std::clamp(std::abs(glm::dot(to_eye, node.normal)) / distance_m, 0.0, 1.0));
  const double nearest_m = std::max(distance_m - node.reach_rad * planet.a_m(), 1.0);
  const double shortened = std::max(std::cos(std::max(slant - node.reach_rad, 0.0)), kMostSlant);
  return planet.a_m() / nearest_m * view.pixels_per_radian() * shortened;
}

}  // namespace

PointTree::PointTree(std::span<const Geodetic> places) : points_(places.size()) {
  nodes_.reserve(2 * places.size());
  for (const Geodetic& place : places) nodes_.push_back({.normal = Ellipsoid::normal(place.lat, place.lon).xyz});
  for (std::uint32_t i = 0; i < places.size(); ++i) tops_.push_back(i);
  for (int level = kFinest; level >= kCoarsest; --level) join(tops_, std::ldexp(1.0, -level));
}

// The largest group is the seed of the next one, whose place it keeps.
void PointTree::join(std::vector<std::uint32_t>& tops, double radius_rad) {
  std::ranges::stable_sort(tops, std::ranges::greater(), [this](std::uint32_t top) { return nodes_[top].count; });
  const double side = 2.0 * radius_rad;
  CellTable table(tops.size());
  for (std::uint32_t at = 0; at < tops.size(); ++at) table.add(cell_of(nodes_[tops[at]].normal, side), at);
  std::vector<char> taken(tops.size());
  std::vector<std::uint32_t> joined, parts;
  joined.reserve(tops.size());
  for (std::uint32_t at = 0; at < tops.size(); ++at) {
    if (taken[at] != 0) continue;
    parts.clear();
    const glm::dvec3 place = nodes_[tops[at]].normal;
    table.each_near(place, side, [&](std::uint32_t other) {
      if (taken[other] != 0 || glm::distance(place, nodes_[tops[other]].normal) > radius_rad) return;
      taken[other] = 1;
      parts.push_back(tops[other]);
    });
    joined.push_back(parts.size() == 1 ? parts.front() : group_of(place, parts, radius_rad));
  }
  tops = std::move(joined);
}

std::uint32_t PointTree::group_of(const glm::dvec3& place, std::span<const std::uint32_t> parts, double radius_rad) {
  Node group{.normal = place, .radius_rad = radius_rad, .count = 0};
  for (const std::uint32_t at : parts) {
    Node& part = nodes_[at];
    group.count += part.count;
    group.reach_rad = std::max(group.reach_rad, angle_rad(place, part.normal) + part.reach_rad);
    part.next = std::exchange(group.first_part, at);
  }
  nodes_.push_back(group);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::vector<std::uint32_t> PointTree::points_of(std::uint32_t node) const {
  std::vector<std::uint32_t> points, waiting{node};
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    if (at < points_) points.push_back(at);
    for (std::uint32_t part = nodes_[at].first_part; part != kNone; part = nodes_[part].next) waiting.push_back(part);
  }
  std::ranges::sort(points);
  return points;
}

std::vector<std::uint32_t> PointTree::cut(const View& view, const Ellipsoid& planet, double radius_px) const {
  std::vector<std::uint32_t> shown, waiting(tops_.rbegin(), tops_.rend());
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[at];
    const glm::dvec3 middle_m = planet.position(EcefDir{node.normal}).xyz_m;
    if (!may_show(view, middle_m, node.reach_rad * planet.a_m())) continue;
    if (at < points_ || node.radius_rad * pixels_per_radian(view, planet, node, middle_m) < 2.0 * radius_px) {
      shown.push_back(at);
      continue;
    }
    for (std::uint32_t part = node.first_part; part != kNone; part = nodes_[part].next) waiting.push_back(part);
  }
  return shown;
}

}  // namespace terrella
