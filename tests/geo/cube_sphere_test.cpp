#include "geo/cube_sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "geo/ellipsoid.h"
#include "geo_test_support.h"

namespace terrella {
namespace {

using test::bits_of;
using test::Draw;
using test::kEpsilon;
using test::kNaN;

constexpr std::array kMappings = {CubeMapping::plain, CubeMapping::tangent};
// The header's promise for sphere_to_cube.
constexpr double kFaceCoordinateError = 4e-16;

CubeFace face_number(int face) { return static_cast<CubeFace>(face); }

TEST(CubeSphere, FramesAreRightHandedAndEquatorialOnesStandUpright) {
  for (int face = 0; face < kCubeFaces; ++face) {
    const CubeFaceFrame& frame = face_frame(face_number(face));
    EXPECT_EQ(glm::cross(frame.t, frame.b), frame.n) << face;
    if (face < 4) {
      EXPECT_EQ(frame.b, glm::dvec3(0, 0, 1));
      EXPECT_EQ(std::atan2(frame.n.y, frame.n.x), std::remainder(face * std::numbers::pi / 2, 2 * std::numbers::pi));
    }
  }
}

TEST(CubeSphere, PlainIsPaperFormulaOne) {
  Draw draw(21);
  for (int k = 0; k < 500; ++k) {
    const FacePoint p{face_number(k % kCubeFaces), draw.between(-1, 1), draw.between(-1, 1)};
    const CubeFaceFrame& frame = face_frame(p.face);
    const glm::dvec3 expected = glm::normalize(frame.n + p.i * frame.t + p.j * frame.b);
    EXPECT_LE(glm::distance(cube_to_sphere(p, CubeMapping::plain).xyz, expected), 2.0 * kEpsilon);
  }
}

TEST(CubeSphere, UnitLengthAndThereAndBack) {
  Draw draw(22);
  for (const CubeMapping mapping : kMappings) {
    for (int k = 0; k < 20000; ++k) {
      const FacePoint p{face_number(k % kCubeFaces), draw.between(-1, 1), draw.between(-1, 1)};
      const EcefDir d = cube_to_sphere(p, mapping);
      EXPECT_NEAR(glm::length(d.xyz), 1.0, 2.0 * kEpsilon);
      const FacePoint back = sphere_to_cube(d, mapping);
      ASSERT_EQ(back.face, p.face);
      EXPECT_NEAR(back.i, p.i, kFaceCoordinateError) << p.i << ' ' << p.j;
      EXPECT_NEAR(back.j, p.j, kFaceCoordinateError) << p.i << ' ' << p.j;
      EXPECT_TRUE(std::abs(back.i) <= 1.0 && std::abs(back.j) <= 1.0);
    }
  }
}

TEST(CubeSphere, DirectionsThereAndBack) {
  Draw draw(23);
  for (const CubeMapping mapping : kMappings) {
    for (int k = 0; k < 5000; ++k) {
      const EcefDir d = draw.direction();
      EXPECT_LE(glm::distance(cube_to_sphere(sphere_to_cube(d, mapping), mapping).xyz, d.xyz), 4.0 * kEpsilon);
    }
  }
}

TEST(CubeSphere, TiesGoToXThenY) {
  EXPECT_EQ(sphere_to_cube({{0.5, 0.5, 0.5}}).face, CubeFace::pos_x);
  EXPECT_EQ(sphere_to_cube({{-0.5, 0.5, -0.5}}).face, CubeFace::neg_x);
  EXPECT_EQ(sphere_to_cube({{0.1, -0.5, 0.5}}).face, CubeFace::neg_y);
  const FacePoint corner = sphere_to_cube({{0.5, 0.5, 0.5}});
  EXPECT_EQ(corner.i, 1.0);
  EXPECT_EQ(corner.j, 1.0);
}

/// The face's coordinates of a point of the cube [-1, 1]³.
FacePoint on_face(CubeFace face, const glm::dvec3& cube_point) {
  const CubeFaceFrame& frame = face_frame(face);
  return {face, glm::dot(cube_point, frame.t), glm::dot(cube_point, frame.b)};
}

TEST(CubeSphere, EdgesHaveTheSameBitsFromBothFaces) {
  Draw draw(24);
  int pairs = 0;
  for (const CubeMapping mapping : kMappings) {
    for (int a = 0; a < kCubeFaces; ++a) {
      for (int b = 0; b < kCubeFaces; ++b) {
        const glm::dvec3 na = face_frame(face_number(a)).n;
        const glm::dvec3 nb = face_frame(face_number(b)).n;
        if (glm::dot(na, nb) != 0.0) continue;
        ++pairs;
        for (int k = 0; k < 300; ++k) {
          constexpr std::array special = {-1.0, 1.0, 0.0, -0.0, 0.5, -0x1p-26};
          const double s = k < 6 ? special.at(static_cast<std::size_t>(k)) : draw.between(-1, 1);
          const glm::dvec3 edge_point = na + nb + s * glm::cross(na, nb);
          EXPECT_EQ(bits_of(cube_to_sphere(on_face(face_number(a), edge_point), mapping).xyz),
                    bits_of(cube_to_sphere(on_face(face_number(b), edge_point), mapping).xyz))
              << a << ' ' << b << ' ' << s;
        }
      }
    }
  }
  EXPECT_EQ(pairs, 2 * 24);
}

TEST(CubeSphere, OddInBothCoordinates) {
  Draw draw(25);
  for (const CubeMapping mapping : kMappings) {
    for (int k = 0; k < 1000; ++k) {
      const CubeFace face = face_number(k % kCubeFaces);
      const CubeFaceFrame& frame = face_frame(face);
      const double i = draw.between(-1, 1);
      const double j = draw.between(-1, 1);
      const glm::dvec3 d = cube_to_sphere({face, i, j}, mapping).xyz;
      const glm::dvec3 mirrored = cube_to_sphere({face, -i, -j}, mapping).xyz;
      EXPECT_EQ(glm::dot(mirrored, frame.n), glm::dot(d, frame.n));
      EXPECT_EQ(glm::dot(mirrored, frame.t), -glm::dot(d, frame.t));
      EXPECT_EQ(glm::dot(mirrored, frame.b), -glm::dot(d, frame.b));
    }
  }
}

TEST(CubeSphere, ZerosAreExactAndPositive) {
  for (const CubeMapping mapping : kMappings) {
    for (int face = 0; face < kCubeFaces; ++face) {
      for (const double zero : {0.0, -0.0}) {
        for (const FacePoint& p : {FacePoint{face_number(face), zero, zero}, FacePoint{face_number(face), zero, 0.3},
                                   FacePoint{face_number(face), -0.7, zero}}) {
          const glm::dvec3 d = cube_to_sphere(p, mapping).xyz;
          int zeros = 0;
          for (int axis = 0; axis < 3; ++axis) {
            EXPECT_FALSE(d[axis] == 0.0 && std::signbit(d[axis])) << face;
            zeros += d[axis] == 0.0 ? 1 : 0;
          }
          EXPECT_EQ(zeros, (p.i == 0.0 ? 1 : 0) + (p.j == 0.0 ? 1 : 0)) << face;
        }
      }
    }
  }
}

TEST(CubeSphere, MiddleOfTheFarFaceIsLongitudePlus180) {
  for (const double j : {-1.0, -0.25, 0.0, 1.0}) {
    for (const double zero : {0.0, -0.0}) {
      EXPECT_EQ(Ellipsoid::lat_lon(cube_to_sphere({CubeFace::neg_x, zero, j})).lon.deg(), 180.0);
    }
  }
}

/// Solid angle of a spherical triangle (Van Oosterom and Strackee 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return 2.0 *
         std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

struct CellAreas {
  double smallest, mean, largest;
};

CellAreas cell_areas(CubeMapping mapping, int cells) {
  const auto corner = [&](int i, int j) {
    return cube_to_sphere({CubeFace::pos_z, 2.0 * i / cells - 1.0, 2.0 * j / cells - 1.0}, mapping).xyz;
  };
  CellAreas areas{.smallest = 10.0, .mean = 0.0, .largest = 0.0};
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const double area = solid_angle(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)) +
                          solid_angle(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
      areas.smallest = std::min(areas.smallest, area);
      areas.largest = std::max(areas.largest, area);
      areas.mean += area / (cells * cells);
    }
  }
  return areas;
}

TEST(CubeSphere, AreasDifferFiveToOneInPlainAndByLessThanHalfInTangent) {
  constexpr int cells = 64;
  // In the limit of small cells 3^(3/2) and sqrt(2); 64 cells come within 5 % of it.
  const CellAreas plain = cell_areas(CubeMapping::plain, cells);
  EXPECT_NEAR(plain.largest / plain.smallest, 5.2, 0.26);
  const CellAreas tangent = cell_areas(CubeMapping::tangent, cells);
  EXPECT_NEAR(tangent.largest / tangent.smallest, 1.41, 0.07);
  for (const CellAreas& areas : {plain, tangent}) {
    EXPECT_NEAR(areas.mean * cells * cells * kCubeFaces, 4.0 * std::numbers::pi, 1e-9);  // 4096 sums of 1e-13 each
    EXPECT_TRUE(areas.smallest < areas.mean && areas.mean < areas.largest);
  }
}

TEST(CubeSphere, NaNStaysNaN) {
  EXPECT_TRUE(std::isnan(cube_to_sphere({CubeFace::pos_x, kNaN, 0.0}).xyz.y));
  EXPECT_TRUE(std::isnan(sphere_to_cube({{kNaN, kNaN, kNaN}}).i));
}

}  // namespace
}  // namespace terrella
