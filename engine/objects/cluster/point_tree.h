#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "geo/camera.h"
#include "geo/coordinates.h"

namespace terrella {

/// Points in groups, and these in larger groups. Groups are made as in supercluster (Mapbox): the largest group takes
/// all others within a radius of it, then the next one does, and then the radius doubles, from 0.1 m on the Earth to a
/// quarter of a radian. So groups of one radius are at least that far apart. Building takes some 10 µs a point. Heights
/// do not count. thread: any
class PointTree {
 public:
  static constexpr std::uint32_t kNone = ~0U;

  /// A point or a group.
  struct Node {
    glm::dvec3 normal{0.0};            ///< unit; of one of its points, where the points are dense
    double radius_rad = 0.0;           ///< radius within which its parts were joined; 0: a point
    double reach_rad = 0.0;            ///< no point of it is farther from `normal`
    std::uint32_t count = 1;           ///< its points
    std::uint32_t first_part = kNone;  ///< index of its first part
    std::uint32_t next = kNone;        ///< index of the next part of the same group
  };

  explicit PointTree(std::span<const Geodetic> places);

  /// The points in their order, and then the groups.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Number of points.
  [[nodiscard]] std::size_t points() const { return points_; }

  /// Indices of the points of a node, in ascending order.
  [[nodiscard]] std::vector<std::uint32_t> points_of(std::uint32_t node) const;
  /// Indices of the largest nodes in the picture whose radius is under twice `radius_px` there, so that they are at
  /// least `radius_px` apart where the ground is seen from above. Near the limb the radius counts as it is seen. Nodes
  /// beside the picture are left out. Costs a little for each of them and of the nodes around them.
  [[nodiscard]] std::vector<std::uint32_t> cut(const View& view, const Ellipsoid& planet, double radius_px) const;

 private:
  void join(std::vector<std::uint32_t>& tops, double radius_rad);
  std::uint32_t group_of(const glm::dvec3& place, std::span<const std::uint32_t> parts, double radius_rad);

  std::vector<Node> nodes_;
  std::size_t points_;
  std::vector<std::uint32_t> tops_;  ///< nodes that are in no group
};

}  // namespace terrella
