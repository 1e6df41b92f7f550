#include "surface/patch_id.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <unordered_set>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo_test_support.h"

namespace terrella {
namespace {

using test::Bits;
using test::bits_of;
using test::Draw;
using test::kNaN;

constexpr std::array kSides = {PatchSide::west, PatchSide::east, PatchSide::south, PatchSide::north};
constexpr std::array kBothMappings = {CubeMapping::plain, CubeMapping::tangent};

PatchId random_patch(Draw& draw, int level) {
  const std::uint32_t last = (1U << level) - 1U;
  // A third of the draws at each end, so that edges and corners of the cube come up at every level.
  const auto cell = [&] {
    const int choice = draw.whole(0, 2);
    return choice == 0 ? 0U : choice == 1 ? last : draw.whole(0U, last);
  };
  return {static_cast<CubeFace>(draw.whole(0, kCubeFaces - 1)), level, cell(), cell()};
}

std::vector<PatchId> all_patches(int level) {
  std::vector<PatchId> patches;
  for (int face = 0; face < kCubeFaces; ++face) {
    for (std::uint32_t y = 0; y < 1U << level; ++y) {
      for (std::uint32_t x = 0; x < 1U << level; ++x) patches.push_back({static_cast<CubeFace>(face), level, x, y});
    }
  }
  return patches;
}

/// The points along a side of a patch, in growing j or i.
std::vector<Bits> side_points(const PatchId& id, PatchSide side, int n, CubeMapping mapping) {
  std::vector<Bits> points;
  for (int k = 0; k <= n; ++k) {
    const bool along_j = side == PatchSide::west || side == PatchSide::east;
    const int edge = side == PatchSide::east || side == PatchSide::north ? n : 0;
    points.push_back(bits_of(patch_point(id, along_j ? edge : k, along_j ? k : edge, n, mapping).xyz));
  }
  return points;
}

/// Checks that the patch across a side shares that side's points, bit for bit, in the same or the opposite order.
void expect_shared_side(const PatchId& id, PatchSide side, CubeMapping mapping) {
  constexpr int n = 8;
  const PatchId next = neighbour(id, side);
  std::vector<Bits> mine = side_points(id, side, n, mapping);
  int matches = 0;
  for (const PatchSide other : kSides) {
    const std::vector<Bits> theirs = side_points(next, other, n, mapping);
    const bool same = std::ranges::equal(mine, theirs) || std::equal(mine.rbegin(), mine.rend(), theirs.begin());
    if (!same) continue;
    ++matches;
    EXPECT_EQ(neighbour(next, other), id) << "and the way back leads here";
  }
  EXPECT_EQ(matches, 1) << "face " << static_cast<int>(id.face) << " level " << id.level << " x " << id.x << " y "
                        << id.y << " side " << static_cast<int>(side);
}

TEST(PatchId, NeighboursShareTheirSideBitForBitOnCoarseLevels) {
  for (const CubeMapping mapping : kBothMappings) {
    for (int level = 0; level <= 3; ++level) {
      for (const PatchId& id : all_patches(level)) {
        for (const PatchSide side : kSides) expect_shared_side(id, side, mapping);
      }
    }
  }
}

TEST(PatchId, NeighboursShareTheirSideBitForBitOnAllLevels) {
  Draw draw(31);
  for (int k = 0; k < 2000; ++k) {
    const PatchId id = random_patch(draw, draw.whole(1, kMaxPatchLevel));
    for (const PatchSide side : kSides) expect_shared_side(id, side, CubeMapping::tangent);
  }
}

TEST(PatchId, AllTwentyFourFaceBordersAreCrossed) {
  std::set<std::pair<CubeFace, CubeFace>> crossed;
  for (const PatchId& id : all_patches(0)) {
    for (const PatchSide side : kSides) crossed.insert({id.face, neighbour(id, side).face});
  }
  EXPECT_EQ(crossed.size(), 24U);
  for (const auto& [from, to] : crossed) EXPECT_EQ(glm::dot(face_frame(from).n, face_frame(to).n), 0.0);
}

TEST(PatchId, EastOfTheEquatorialFacesGoesRoundTheWorld) {
  for (int level = 0; level <= kMaxPatchLevel; ++level) {
    PatchId id{CubeFace::pos_x, level, (1U << level) - 1U, (1U << level) / 3};
    for (const CubeFace expected : {CubeFace::pos_y, CubeFace::neg_x, CubeFace::neg_y, CubeFace::pos_x}) {
      const PatchId next = neighbour(id, PatchSide::east);
      EXPECT_EQ(next, (PatchId{expected, level, 0, id.y}));
      id = next;
      id.x = (1U << level) - 1U;
    }
  }
}

TEST(PatchId, LatticePointsAreTheSameFromEveryLevel) {
  Draw draw(32);
  for (int k = 0; k < 2000; ++k) {
    const PatchId id = random_patch(draw, draw.whole(0, kMaxPatchLevel - 1));
    const int n = 1 << draw.whole(0, 7);
    const int i = draw.whole(0, n);
    const int j = draw.whole(0, n);
    const Bits here = bits_of(patch_point(id, i, j, n).xyz);
    EXPECT_EQ(here, bits_of(patch_point(id, 2 * i, 2 * j, 2 * n).xyz)) << "a finer lattice";
    for (const PatchId& child : children(id)) {
      const int ci = 2 * i - static_cast<int>(child.x % 2) * n;
      const int cj = 2 * j - static_cast<int>(child.y % 2) * n;
      if (std::min(ci, cj) < 0 || std::max(ci, cj) > n) continue;
      EXPECT_EQ(here, bits_of(patch_point(child, ci, cj, n).xyz)) << "a child's lattice";
    }
  }
}

TEST(PatchId, CornersOfTheCubeAreOnePointFromThreeFaces) {
  for (int level = 0; level <= kMaxPatchLevel; ++level) {
    std::vector<Bits> corners;
    const std::uint32_t last = (1U << level) - 1U;
    for (int face = 0; face < kCubeFaces; ++face) {
      for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
          const PatchId id{static_cast<CubeFace>(face), level, i == 0 ? 0 : last, j == 0 ? 0 : last};
          corners.push_back(bits_of(patch_point(id, i * 4, j * 4, 4).xyz));
        }
      }
    }
    for (const Bits& corner : corners) EXPECT_EQ(std::ranges::count(corners, corner), 3) << level;
  }
}

TEST(PatchId, NeighbouringPointsDifferAtTheFinestLevel) {
  // 2^-26 of a face is 0.15 m on Earth; a lattice of 64 divides it to 2 mm, 2 million times what a double resolves.
  const PatchId id{CubeFace::neg_y, kMaxPatchLevel, (1U << kMaxPatchLevel) - 1U, 12345678};
  for (int i = 0; i < 64; ++i) {
    EXPECT_NE(bits_of(patch_point(id, i, 7, 64).xyz), bits_of(patch_point(id, i + 1, 7, 64).xyz));
  }
}

TEST(PatchId, PatchAtFindsThePatchOfItsCentre) {
  Draw draw(33);
  for (const CubeMapping mapping : kBothMappings) {
    for (int k = 0; k < 2000; ++k) {
      const PatchId id = random_patch(draw, draw.whole(0, kMaxPatchLevel));
      EXPECT_EQ(patch_at(patch_point(id, 1, 1, 2, mapping), id.level, mapping), id);
    }
  }
}

TEST(PatchId, PatchesOfOneDirectionContainEachOther) {
  Draw draw(34);
  for (int k = 0; k < 500; ++k) {
    const EcefDir d = draw.direction();
    for (int level = 1; level <= kMaxPatchLevel; ++level) {
      const PatchId fine = patch_at(d, level);
      const PatchId coarse = patch_at(d, level - 1);
      EXPECT_EQ(parent(fine), coarse);
      EXPECT_TRUE(contains(coarse, fine) && contains(fine, fine) && !contains(fine, coarse));
    }
  }
}

TEST(PatchId, PatchAtOfBordersAndOfNaNIsAPatch) {
  for (int level = 0; level <= kMaxPatchLevel; ++level) {
    const std::uint32_t cells = 1U << level;
    for (const glm::dvec3& d : {glm::dvec3(1, 1, 1), glm::dvec3(-1, -1, -1), glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0),
                                glm::dvec3(0), glm::dvec3(kNaN)}) {
      const PatchId id = patch_at(EcefDir{d}, level);
      EXPECT_TRUE(id.x < cells && id.y < cells && id.level == level);
    }
  }
}

TEST(PatchId, ChildrenAndParent) {
  const PatchId id{CubeFace::neg_z, 3, 5, 2};
  const std::array<PatchId, 4> four = children(id);
  EXPECT_EQ(four[0], (PatchId{CubeFace::neg_z, 4, 10, 4}));
  EXPECT_EQ(four[1], (PatchId{CubeFace::neg_z, 4, 11, 4}));
  EXPECT_EQ(four[2], (PatchId{CubeFace::neg_z, 4, 10, 5}));
  EXPECT_EQ(four[3], (PatchId{CubeFace::neg_z, 4, 11, 5}));
  for (const PatchId& child : four) {
    EXPECT_EQ(parent(child), id);
    EXPECT_TRUE(contains(id, child));
  }
  EXPECT_FALSE(contains(PatchId{CubeFace::neg_z, 3, 5, 3}, four[0]));
  EXPECT_FALSE(contains(PatchId{CubeFace::pos_z, 3, 5, 2}, four[0]));
}

TEST(PatchId, AntimeridianAndPolesLieOnBordersFromLevelOneOn) {
  constexpr int n = 8;
  for (int level = 1; level <= 3; ++level) {
    for (const PatchId& id : all_patches(level)) {
      for (int i = 1; i < n; ++i) {
        for (int j = 1; j < n; ++j) {
          const EcefDir d = patch_point(id, i, j, n);
          EXPECT_TRUE(d.xyz.y != 0.0 || d.xyz.x > 0.0) << "a point inside a patch lies on the antimeridian";
          EXPECT_LT(std::abs(d.xyz.z), 1.0);
        }
      }
    }
  }
}

TEST(PatchId, DiagonalsFollowTheQuadrants) {
  for (int level = 1; level <= 4; ++level) {
    for (const PatchId& id : all_patches(level)) {
      const FacePoint centre = sphere_to_cube(patch_point(id, 1, 1, 2));
      EXPECT_EQ(forward_diagonal(id), centre.i * centre.j > 0.0);
    }
  }
}

TEST(PatchId, HashesOfNearPatchesSpread) {
  std::unordered_set<std::size_t> hashes;
  std::vector<int> buckets(256, 0);
  std::size_t patches = 0;
  for (int level = 0; level <= 6; ++level) {
    for (const PatchId& id : all_patches(level)) {
      const std::size_t hash = PatchIdHash{}(id);
      hashes.insert(hash);
      ++buckets[hash % buckets.size()];
      ++patches;
    }
  }
  EXPECT_EQ(hashes.size(), patches);
  // 32766 patches in 256 buckets: 128 each with a deviation of 11; seven deviations leave room for chance only.
  EXPECT_LT(*std::ranges::max_element(buckets), 128 + 7 * 11);
}

}  // namespace
}  // namespace terrella
