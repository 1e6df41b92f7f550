#include "surface/patch_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>
#include <set>

#include "patch_test_support.h"

namespace terrella::test {
namespace {

/// Both halves of a vertex's position, every bit of them.
using PositionBits = std::array<std::uint32_t, 6>;

PositionBits bits(const PatchVertex& v) {
  PositionBits out{};
  for (int k = 0; k < 3; ++k) {
    out[static_cast<std::size_t>(k)] = std::bit_cast<std::uint32_t>(v.position_high_m[k]);
    out[static_cast<std::size_t>(k + 3)] = std::bit_cast<std::uint32_t>(v.position_low_m[k]);
  }
  return out;
}

std::set<PositionBits> bits_of_all(const std::vector<PatchVertex>& vertices) {
  std::set<PositionBits> all;
  for (const PatchVertex& v : vertices) all.insert(bits(v));
  return all;
}

std::vector<PatchVertex> side_of(const std::vector<PatchVertex>& vertices, PatchSide side) {
  std::vector<PatchVertex> edge;
  for (int k = 0; k <= kSegments; ++k) {
    const int i = side == PatchSide::west ? 0 : side == PatchSide::east ? kSegments : k;
    const int j = side == PatchSide::south ? 0 : side == PatchSide::north ? kSegments : k;
    edge.push_back(vertices[static_cast<std::size_t>(j * (kSegments + 1) + i)]);
  }
  return edge;
}

glm::dvec3 position_m(const PatchVertex& v) { return glm::dvec3(v.position_high_m) + glm::dvec3(v.position_low_m); }

/// Patches at places where things go wrong, and anywhere.
std::vector<PatchId> sample_patches(Draw& draw, int level) {
  std::vector<PatchId> ids = {patch_beside(90, 10, level),      patch_beside(-90, -100, level),
                              patch_beside(89.99, 179, level),  patch_beside(0, 179.999, level),
                              patch_beside(0, -179.999, level), patch_beside(30, 45, level),
                              patch_beside(35.3, 44.9, level),  patch_beside(-35.2, -135, level)};
  for (int k = 0; k < 8; ++k) ids.push_back(random_patch(draw, level));
  return ids;
}

TEST(PatchMesh, NeighboursShareTheBitsOfTheirVertices) {
  Draw draw(11);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, {.max_level = 10}, kSegments);
    for (const int level : {1, 2, 3, 4, 5, 6, 11, 16, 24}) {
      for (const PatchId& id : sample_patches(draw, level)) {
        const auto mine = patch_vertices(tree, node_of(tree, id));
        for (int side = 0; side < 4; ++side) {
          const PatchId other = neighbour(id, static_cast<PatchSide>(side));
          const auto theirs = bits_of_all(patch_vertices(tree, node_of(tree, other)));
          for (const PatchVertex& v : side_of(mine, static_cast<PatchSide>(side))) {
            ASSERT_TRUE(theirs.contains(bits(v))) << "level " << level << " side " << side;
          }
        }
      }
    }
  }
}

TEST(PatchMesh, LevelsShareTheBitsOfTheirVertices) {
  Draw draw(12);
  PatchTree tree(earth().ellipsoid, {.max_level = 10}, kSegments);
  for (int level = 1; level < 24; level += 2) {
    for (const PatchId& id : sample_patches(draw, level)) {
      std::set<PositionBits> finer;
      for (const PatchId& child : children(id)) finer.merge(bits_of_all(patch_vertices(tree, node_of(tree, child))));
      for (const PatchVertex& v : patch_vertices(tree, node_of(tree, id))) ASSERT_TRUE(finer.contains(bits(v)));
    }
  }
}

TEST(PatchMesh, SplitPositionKeepsFortyEightBits) {
  Draw draw(13);
  for (int k = 0; k < 1000; ++k) {
    const double x = draw.between(-1.0e10, 1.0e10);
    const SplitPosition p = split_position(glm::dvec3(x));
    EXPECT_NEAR(double(p.high.x) + double(p.low.x), x, std::ldexp(std::abs(x), -48));
  }
}

TEST(PatchMesh, LongitudesUnwrapAroundThePatchAndStayInItsExtent) {
  Draw draw(14);
  // Offsets are floats of at most 90°: half a step of them.
  constexpr double kFloat_deg = 4.0e-6;
  for (const LatitudeKind kind : {LatitudeKind::graphic, LatitudeKind::centric}) {
    PatchTree tree(Ellipsoid(6378137.0, 0.098), {.max_level = 10, .latitude = kind}, kSegments);
    for (int level = 1; level <= 22; level += 3) {
      for (const PatchId& id : sample_patches(draw, level)) {
        const PatchNode& node = node_of(tree, id);
        ASSERT_LE(node.east_deg - node.west_deg, 90.0 + 1e-9);
        for (const PatchVertex& v : patch_vertices(tree, node)) {
          ASSERT_TRUE(std::isfinite(glm::dot(v.direction, v.direction) + v.offset_deg.x + v.offset_deg.y));
          const double row = node.row_center_deg + double(v.offset_deg.y);
          EXPECT_GE(row, node.south_row_deg - kFloat_deg);
          EXPECT_LE(row, node.north_row_deg + kFloat_deg);
          EXPECT_GE(double(v.offset_deg.x), node.west_deg - kFloat_deg);
          EXPECT_LE(double(v.offset_deg.x), node.east_deg + kFloat_deg);
          // The antimeridian is a border: no patch reaches over it.
          EXPECT_LE(std::abs(node.lon_center_deg + double(v.offset_deg.x)), 180.0 + kFloat_deg);
        }
      }
    }
  }
}

TEST(PatchMesh, DirectionsAreThoseOfTheRowsRelativeToTheCentre) {
  Draw draw(15);
  for (const LatitudeKind kind : {LatitudeKind::graphic, LatitudeKind::centric}) {
    PatchTree tree(Ellipsoid(6378137.0, 0.098), {.max_level = 10, .latitude = kind}, kSegments);
    for (int level = 1; level <= 22; level += 7) {
      for (const PatchId& id : sample_patches(draw, level)) {
        const PatchNode& node = node_of(tree, id);
        const double length = glm::length(row_direction(tree.grid(), tree.ellipsoid(), node.normal));
        // The frame holds longitude and counted latitude of the centre.
        const glm::dvec3 center(node.frame.x * node.frame.z, node.frame.y * node.frame.z, node.frame.w);
        for (const PatchVertex& v : patch_vertices(tree, node)) {
          const glm::dvec3 m = center + glm::dvec3(v.direction);
          const double row = std::atan2(m.z, std::hypot(m.x, m.y)) * 180.0 / std::numbers::pi;
          EXPECT_NEAR(row, node.row_center_deg + double(v.offset_deg.y), 1e-5);
        }
        EXPECT_GT(length, 0.8);
      }
    }
  }
}

/// A triangle's corners as numbers of vertices.
using Corners = std::array<int, 3>;

std::vector<Corners> triangles(const PatchIndices& list, bool forward, unsigned coarse) {
  const PatchIndices::Range range = list.ranges[forward ? 1 : 0][coarse];
  std::vector<Corners> out;
  for (std::uint32_t k = range.first; k < range.first + range.count; k += 3) {
    out.push_back({list.indices[k], list.indices[k + 1], list.indices[k + 2]});
  }
  return out;
}

/// The directed edges that no triangle shares: the outline, counter-clockwise, each from its first to its last corner.
std::map<std::pair<int, int>, int> outline(const std::vector<Corners>& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const Corners& t : mesh) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [it, is_new] = edges.try_emplace({t[k], t[(k + 1) % 3]}, 0);
      EXPECT_TRUE(is_new) << "two triangles on the same side of an edge";
    }
  }
  std::erase_if(edges, [copy = edges](const auto& e) { return copy.contains({e.first.second, e.first.first}); });
  return edges;
}

/// The outline that a patch must have: steps of one on its fine sides, of two on its coarse ones.
std::set<std::pair<int, int>> wanted_outline(int n, unsigned coarse) {
  std::set<std::pair<int, int>> edges;
  const auto at = [n](int i, int j) { return j * (n + 1) + i; };
  const auto step = [coarse](PatchSide side) { return (coarse >> static_cast<unsigned>(side) & 1U) != 0 ? 2 : 1; };
  for (int k = 0, s = step(PatchSide::south); k < n; k += s) edges.insert({at(k, 0), at(k + s, 0)});
  for (int k = 0, s = step(PatchSide::east); k < n; k += s) edges.insert({at(n, k), at(n, k + s)});
  for (int k = 0, s = step(PatchSide::north); k < n; k += s) edges.insert({at(k + s, n), at(k, n)});
  for (int k = 0, s = step(PatchSide::west); k < n; k += s) edges.insert({at(0, k + s), at(0, k)});
  return edges;
}

TEST(PatchIndices, CloseOnEverySideWithoutTJunctionOrFold) {
  for (const int n : {2, 4, 16, 32}) {
    const PatchIndices list = patch_indices(n);
    for (unsigned k = 0; k < 32; ++k) {
      const unsigned coarse = k % 16;
      const auto mesh = triangles(list, k >= 16, coarse);
      long twice_area = 0;
      for (const Corners& t : mesh) {
        const auto i = [&](std::size_t c) { return t[c] % (n + 1); };
        const auto j = [&](std::size_t c) { return t[c] / (n + 1); };
        const long area = long{i(1) - i(0)} * (j(2) - j(0)) - long{i(2) - i(0)} * (j(1) - j(0));
        EXPECT_GT(area, 0) << "a triangle lies on its back or has no area";
        twice_area += area;
      }
      EXPECT_EQ(twice_area, 2L * n * n);
      std::set<std::pair<int, int>> edges;
      for (const auto& [edge, unused] : outline(mesh)) edges.insert(edge);
      EXPECT_EQ(edges, wanted_outline(n, coarse)) << "n " << n << " coarse sides " << coarse;
    }
  }
}

TEST(PatchIndices, EveryTriangleFacesOutward) {
  Draw draw(16);
  const PatchIndices list = patch_indices(kSegments);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, {.max_level = 10}, kSegments);
    for (int level = 1; level <= 22; level += 3) {
      for (const PatchId& id : sample_patches(draw, level)) {
        const auto vertices = patch_vertices(tree, node_of(tree, id));
        for (unsigned coarse = 0; coarse < 16; coarse += 5) {
          for (const Corners& t : triangles(list, forward_diagonal(id), coarse)) {
            const auto p = [&](std::size_t k) { return position_m(vertices[static_cast<std::size_t>(t[k])]); };
            EXPECT_GT(glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(0)), 0.0);
          }
        }
      }
    }
  }
}

/// Position from the eye as the vertex program computes it: highs first, in floats.
glm::vec3 from_eye(const PatchVertex& v, const SplitPosition& eye) {
  return (v.position_high_m - eye.high) + (v.position_low_m - eye.low);
}

TEST(PatchIndices, NoTriangleTurnsOverInTheFloatsOfTheGpu) {
  Draw draw(17);
  const PatchIndices list = patch_indices(kSegments);
  PatchTree tree(earth().ellipsoid, {.max_level = 18}, kSegments);
  std::vector<SelectedPatch> patches;
  for (int k = 0; k < 60; ++k) {
    const View view = make_view(random_camera(draw, 1.0, 1.0e8), earth().ellipsoid, {512, 512});
    const SplitPosition eye = split_position(view.eye.xyz_m);
    select_patches(tree, view, {}, patches);
    for (std::size_t p = 0; p < patches.size(); p += 7) {
      const PatchNode& node = *patches[p].node;
      const auto vertices = patch_vertices(tree, node);
      for (const Corners& t : triangles(list, forward_diagonal(node.id), patches[p].coarse_sides)) {
        const auto at = [&](std::size_t c) {
          return glm::dvec3(from_eye(vertices[static_cast<std::size_t>(t[c])], eye));
        };
        ASSERT_GT(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), node.normal), 0.0) << "level " << node.id.level;
      }
    }
  }
}

}  // namespace
}  // namespace terrella::test
