#include "apps/bench/mesh_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/bench/truth/masked_error.h"
#include "geo/body.h"

namespace terrella::bench {
namespace {

constexpr TileGrid kGrid{.root_span_deg = 180.0, .tile_px = 256, .max_level = 5};
constexpr double kRadius_m = 6371008.8;
const Ellipsoid& round_body() {
  static const Body body = *parse_body("sphere");
  return body.ellipsoid;
}

struct Looked {
  MeshError error;
  MeshCount count;
};
Looked look(const Camera& camera, int segments, double max_error_px) {
  PatchTree tree(round_body(), kGrid, segments);
  const View view = make_view(camera, round_body(), {1024, 1024});
  std::vector<SelectedPatch> patches;
  select_patches(tree, view, {.max_error_px = max_error_px, .max_window = 1000}, patches);
  return {mesh_error(tree, view, camera, patches, false), mesh_count(tree, view, patches)};
}

Camera over(double lat_deg, double lon_deg, double height_m) {
  return {.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m}};
}

TEST(MeshErrorTest, APolygonsOutlineIsShortOfTheLimbByItsSagitta) {
  // Two quads a side of patches that are a quarter of a face, seen from far away: the outline has 16 equal sides.
  Camera camera = over(0, 0, 99 * kRadius_m);
  camera.fov_y = Angle::degrees(1.5);
  const double radius_px = 512.0 * std::tan(std::asin(0.01)) / std::tan(Angle::degrees(0.75).rad());
  const double sagitta_px = radius_px * (1.0 - std::cos(Angle::degrees(11.25).rad()));
  constexpr double kPerspective = 0.03;  // the limb is not quite the great circle that the polygon lies in
  EXPECT_NEAR(look(camera, 2, 1e9).error.silhouette_px, sagitta_px, kPerspective * sagitta_px);
}

TEST(MeshErrorTest, FinerMeshesAreNearerToWhereThingsAre) {
  const Camera camera = over(35, 20, 6e6);
  const MeshError coarse = look(camera, 4, 4.0).error, fine = look(camera, 24, 0.2).error;
  EXPECT_GT(coarse.position_px, 4 * fine.position_px);
  EXPECT_GT(coarse.texture_texels, 4 * fine.texture_texels);
  EXPECT_LE(coarse.position_rms_px, coarse.position_px);
  constexpr double kPromised_px = 0.25;
  EXPECT_LE(fine.position_px, kPromised_px);
  EXPECT_GT(fine.position_px, 0.0);
}

TEST(MeshErrorTest, TheFarSideAndWhatIsBesideThePictureIsCountedAsDrawnInVain) {
  const Camera low = over(10, 20, 3e5);
  const MeshCount count = look(low, 4, 1e9).count;  // whole faces for a small part of one
  EXPECT_GT(count.needless_triangles, count.triangles / 2);
  EXPECT_LT(count.needless_triangles, count.triangles);
  EXPECT_EQ(count.triangles, count.patches * 2 * 4 * 4);
}

TEST(MaskedErrorTest, LooksAtTheMaskAlone) {
  truth::TruthImage truth{.width = 2,
                          .height = 1,
                          .rays_per_pixel = 1,
                          .rgb = {10, 10, 10, 10, 10, 10},
                          .hits = {1, 1},
                          .lat_deg = {85, 30},
                          .lon_deg = {0, 0},
                          .incidence_deg = {20, 20}};
  const truth::Picture shot{2, 1, {13, 13, 13, 10, 10, 16}};
  const truth::ZoneError pole = truth::masked_error(shot, truth, truth::pole_band_mask(truth));
  EXPECT_EQ(pole.pixels, 1U);
  EXPECT_DOUBLE_EQ(pole.rms, 3.0);
  const truth::ZoneError mid = truth::masked_error(shot, truth, truth::mid_latitude_mask(truth));
  EXPECT_EQ(mid.max, 6.0);
  EXPECT_DOUBLE_EQ(mid.rms, std::sqrt(12.0));
  truth.hits[1] = 0;
  EXPECT_EQ(truth::masked_error(shot, truth, truth::clear_mask(truth)).pixels, 1U);
}

}  // namespace
}  // namespace terrella::bench
