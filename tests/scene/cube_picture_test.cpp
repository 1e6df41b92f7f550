#include "sky/cube_picture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace terrella::test {
namespace {

GreyPicture painted_map(int width, int height, double (*value)(double lon_deg, double lat_deg)) {
  GreyPicture map{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      map.values.push_back(
          static_cast<std::uint8_t>(value((x + 0.5) / width * 360.0 - 180.0, 90.0 - (y + 0.5) / height * 180.0)));
    }
  }
  return map;
}

// The middle of each face by OpenGL's own table: +x is 0°N 0°E, +y 0°N 90°E, +z the north pole.
TEST(CubePicture, PutsEachFaceWhereItBelongs) {
  const GreyPicture map = painted_map(
      256, 128, [](double lon, double lat) { return std::abs(lon) + 20.0 * (lat > 60.0) + 40.0 * (lat < -60.0); });
  const auto faces = cube_faces(map, 65);
  const auto middle = [&faces](std::size_t face) { return int(faces[face][32 * 65 + 32]); };
  EXPECT_NEAR(middle(0), 0, 2);
  EXPECT_NEAR(middle(1), 180, 2);
  EXPECT_NEAR(middle(2), 90, 2);
  EXPECT_NEAR(middle(3), 90, 2);
  const GreyPicture poles = painted_map(256, 128, [](double, double lat) { return lat + 90.0; });
  const auto north_and_south = cube_faces(poles, 65);
  EXPECT_NEAR(int(north_and_south[4][32 * 65 + 32]), 180, 2);
  EXPECT_NEAR(int(north_and_south[5][32 * 65 + 32]), 0, 2);
  // A face's first row is its t = -1: of +x the east, where +y begins (the table's tc is -y there).
  const GreyPicture east = painted_map(256, 128, [](double lon, double) { return lon > 0.0 ? 200.0 : 0.0; });
  const auto turned = cube_faces(east, 65);
  EXPECT_EQ(int(turned[0][32]), 200);
  EXPECT_EQ(int(turned[0][64 * 65 + 32]), 0);
  // Its first column is s = -1: of +x the north, as its sc is -z.
  EXPECT_GT(int(north_and_south[0][32 * 65]), int(north_and_south[0][32 * 65 + 64]));
}

TEST(CubePicture, HasNoSeamAtTheAntimeridian) {
  // Smooth round the globe: what lies beside 180° differs by what a texel's step makes, 2 levels.
  const GreyPicture map =
      painted_map(256, 128, [](double lon, double) { return 100.0 + 90.0 * std::cos(lon * 3.14159265 / 180.0); });
  const auto faces = cube_faces(map, 64);
  for (std::size_t k = 0; k + 64 < 64 * 64; ++k) EXPECT_NEAR(int(faces[1][k]), int(faces[1][k + 64]), 4) << k;
}

}  // namespace
}  // namespace terrella::test
