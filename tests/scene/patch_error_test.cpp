// The errors that a patch states of itself, on which its level is chosen, are bounds.
#include <gtest/gtest.h>

#include <array>

#include "patch_test_support.h"
#include "surface/patch_mesh.h"

namespace terrella::test {
namespace {

// to_geodetic() promises 10 nm.
constexpr double kGeodetic_m = 2.0e-8;
// The pole bands of paper 1: there coordinates are taken for each fragment.
constexpr double kBand_rad = 0.05 * std::numbers::pi;

/// A lattice point in double: where it is and its coordinates.
struct Corner {
  glm::dvec3 position_m;
  double lon_deg, row_deg;
};

Corner corner(const PatchTree& tree, const PatchNode& node, int i, int j) {
  const EcefDir n = patch_point(node.id, i, j, tree.segments(), tree.mapping());
  const bool at_pole = n.xyz.x == 0.0 && n.xyz.y == 0.0;
  const double turn = Ellipsoid::lat_lon(n).lon.deg() - node.lon_center_deg;
  return {tree.ellipsoid().position(n).xyz_m, at_pole ? 0.0 : turn - 360.0 * std::round(turn / 360.0),
          row_latitude_deg(tree.grid(), tree.ellipsoid(), n)};
}

/// A random point of a random triangle of the patch, and the coordinates interpolated there.
Corner random_point(Draw& draw, const PatchTree& tree, const PatchNode& node) {
  const int i = draw.whole(0, kSegments - 1), j = draw.whole(0, kSegments - 1);
  std::array<Corner, 4> c = {corner(tree, node, i, j), corner(tree, node, i + 1, j), corner(tree, node, i + 1, j + 1),
                             corner(tree, node, i, j + 1)};
  if (!forward_diagonal(node.id)) c = {c[1], c[2], c[3], c[0]};
  // Half of the points lie where the error is largest: in the middle of the diagonal.
  double s = draw.between(0.0, 1.0), t = draw.between(0.0, 1.0 - s);
  if (draw.whole(0, 1) == 0) s = 0.0, t = draw.between(0.3, 0.7);
  const Corner& b = draw.whole(0, 1) == 0 ? c[1] : c[3];
  const double r = 1.0 - s - t;
  return {r * c[0].position_m + s * b.position_m + t * c[2].position_m,
          r * c[0].lon_deg + s * b.lon_deg + t * c[2].lon_deg, r * c[0].row_deg + s * b.row_deg + t * c[2].row_deg};
}

std::vector<Ellipsoid> figures() {
  return {Ellipsoid(6378137.0, 0.0), earth().ellipsoid, Ellipsoid(60268000.0, 0.098)};
}

TEST(PatchError, TheMeshIsNoFurtherFromTheEllipsoidThanStated) {
  Draw draw(21);
  for (const Ellipsoid& figure : figures()) {
    for (const CubeMapping mapping : {CubeMapping::tangent, CubeMapping::plain}) {
      PatchTree tree(figure, {.max_level = 10}, kSegments, mapping);
      for (int k = 0; k < 300; ++k) {
        const PatchNode& node = node_of(tree, random_patch(draw, 1 + k % 9));
        for (int p = 0; p < 20; ++p) {
          const double h = figure.to_geodetic(Ecef{random_point(draw, tree, node).position_m}).height_m;
          ASSERT_LE(std::abs(h), node.geometric_error_m + kGeodetic_m)
              << "level " << node.id.level << " f " << figure.f()
              << (mapping == CubeMapping::plain ? " plain" : " tangent");
        }
      }
    }
  }
}

/// Metres on the ground between where a point's interpolated coordinates say that it is and where it is.
double texture_error_m(const PatchTree& tree, const PatchNode& node, const Corner& p) {
  const Ellipsoid& figure = tree.ellipsoid();
  const Geodetic is = figure.to_geodetic(Ecef{p.position_m});
  const Angle lat = latitude_of_row(tree.grid(), figure, p.row_deg);
  const glm::dvec3 says =
      figure.position(Ellipsoid::normal(lat, Angle::degrees(p.lon_deg + node.lon_center_deg))).xyz_m;
  return glm::distance(says, figure.position(Ellipsoid::normal(is.lat, is.lon)).xyz_m);
}

TEST(PatchError, InterpolatedCoordinatesAreNoFurtherOffThanStatedOutsideTheBands) {
  Draw draw(22);
  for (const Ellipsoid& figure : figures()) {
    for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
      for (const LatitudeKind kind : {LatitudeKind::graphic, LatitudeKind::centric}) {
        PatchTree tree(figure, {.max_level = 10, .projection = projection, .latitude = kind}, kSegments);
        double worst = 0.0;
        for (int k = 0; k < 400; ++k) {
          const PatchNode& node = node_of(tree, random_patch(draw, 2 + k % 7));
          if (node.min_colatitude_rad < kBand_rad) continue;
          for (int p = 0; p < 20; ++p) {
            const double stated_m = node.geometric_error_m * node.texture_error_factor;
            worst = std::max(worst, texture_error_m(tree, node, random_point(draw, tree, node)) / stated_m);
          }
        }
        EXPECT_LE(worst, 1.0) << "f " << figure.f() << (projection == Projection::equal_area ? " equal-area" : "")
                              << (kind == LatitudeKind::centric ? " centric" : "");
      }
    }
  }
}

}  // namespace
}  // namespace terrella::test
