#include "surface/patch_mesh.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella {
namespace {

class IndexWriter {
 public:
  IndexWriter(int n, unsigned coarse, bool forward, std::vector<std::uint16_t>& out)
      : n_(n), coarse_(coarse), forward_(forward), out_(out) {}

  void write() {
    for (int j = 0; j < n_; ++j) {
      for (int i = 0; i < n_; ++i) quad(i, j);
    }
  }

 private:
  [[nodiscard]] bool coarse(PatchSide side) const { return (coarse_ >> static_cast<unsigned>(side) & 1U) != 0; }

  [[nodiscard]] std::uint16_t index(int i, int j) const {
    if ((i == 0 && coarse(PatchSide::west)) || (i == n_ && coarse(PatchSide::east))) j &= ~1;
    if ((j == 0 && coarse(PatchSide::south)) || (j == n_ && coarse(PatchSide::north))) i &= ~1;
    return static_cast<std::uint16_t>(j * (n_ + 1) + i);
  }

  void triangle(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    if (a == b || b == c || c == a) return;
    out_.insert(out_.end(), {a, b, c});
  }

  void quad(int i, int j) {
    const std::uint16_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
    // If two coarse sides meet in this corner, a lies on the line from b to d: the three make no triangle.
    const bool on_a_line = i == n_ - 1 && j == n_ - 1 && coarse(PatchSide::east) && coarse(PatchSide::north);
    if (forward_ || on_a_line) {
      triangle(a, b, c);
      triangle(a, c, d);
    } else {
      triangle(a, b, d);
      triangle(b, c, d);
    }
  }

  int n_;
  unsigned coarse_;
  bool forward_;
  std::vector<std::uint16_t>& out_;
};

}  // namespace

std::vector<PatchVertex> patch_vertices(const PatchTree& tree, const PatchNode& node) {
  const int n = tree.segments();
  const double row0 = node.row_center_deg;
  const glm::dvec3 direction0 = row_direction(tree.grid(), tree.ellipsoid(), node.normal);
  const double length0 = glm::length(direction0);
  std::vector<PatchVertex> vertices;
  vertices.reserve(static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1));
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const EcefDir normal = patch_point(node.id, i, j, n, tree.mapping());
      const bool at_pole = normal.xyz.x == 0.0 && normal.xyz.y == 0.0;
      const double lon = at_pole ? 0.0 : wrapped_deg(Ellipsoid::lat_lon(normal).lon.deg() - node.lon_center_deg);
      const double row = row_latitude_deg(tree.grid(), tree.ellipsoid(), normal);
      glm::dvec3 position_m = tree.ellipsoid().position(normal).xyz_m;
      if (!node.relief.heights_m.empty()) position_m += node.relief.heights_m[vertices.size()] * normal.xyz;
      const SplitPosition p = split_position(position_m);
      const glm::dvec3 direction = (row_direction(tree.grid(), tree.ellipsoid(), normal.xyz) - direction0) / length0;
      vertices.push_back({p.high, p.low, glm::vec3(direction), glm::vec2(lon, row - row0)});
    }
  }
  return vertices;
}

PatchIndices patch_indices(int segments) {
  PatchIndices result;
  for (int forward = 0; forward < 2; ++forward) {
    for (unsigned coarse = 0; coarse < 16; ++coarse) {
      auto& range = result.ranges[forward][coarse];
      range.first = static_cast<std::uint32_t>(result.indices.size());
      IndexWriter(segments, coarse, forward == 1, result.indices).write();
      range.count = static_cast<std::uint32_t>(result.indices.size()) - range.first;
    }
  }
  return result;
}

}  // namespace terrella
