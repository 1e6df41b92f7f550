// Models alone, judged pixel by pixel against where geometry says they are.
#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "codecs/image.h"
#include "object_canvas.h"
#include "streaming/objects/gltf_model.h"
#include "support/model_file.h"

namespace terrella::test {
namespace {

// A pixel is drawn if its centre is covered: what geometry says is met to this.
constexpr double kOutline_px = 1.0;
constexpr ObjectColor kExactRed{255, 0, 0};
const std::array<float, 3> kBoxLow{-30.0F, 0.0F, -10.0F}, kBoxHigh{30.0F, 40.0F, 60.0F};

std::shared_ptr<const MeshModel> model_of(const ModelFixture& fixture) {
  const std::string bytes = fixture.bytes();
  const auto file = parse_gltf_model(std::as_bytes(std::span(bytes)), "test.glb", {});
  EXPECT_TRUE(file) << file.error().message;
  EXPECT_TRUE(file && file->complaints.empty());
  return file ? file->model : nullptr;
}
std::shared_ptr<const MeshModel> red_box() { return model_of(box_model(kBoxLow, kBoxHigh, {1.0, 0.0, 0.0, 1.0})); }

Geodetic place_at(double lat_deg, double lon_deg, double height_m) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}
Camera looking(double lat_deg, double lon_deg, double height_m, double pitch_deg, double heading_deg) {
  Camera camera;
  camera.eye = place_at(lat_deg, lon_deg, height_m);
  camera.pitch = Angle::degrees(pitch_deg);
  camera.heading = Angle::degrees(heading_deg);
  return camera;
}

/// Place of a model's point: east, north and up of the model's place, by GeographicLib. Forward (z) is at the heading
/// clockwise from north, x to the left of it.
Ecef place_of_corner(const MeshObject& mesh, const Ellipsoid& ellipsoid, glm::dvec3 corner) {
  const GeographicLib::Geocentric earth(ellipsoid.a_m(), ellipsoid.f());
  const GeographicLib::LocalCartesian frame(mesh.place.lat.deg(), mesh.place.lon.deg(), mesh.place.height_m, earth);
  const double s = std::sin(mesh.heading.rad()), c = std::cos(mesh.heading.rad());
  const double right = -corner.x * mesh.scale, forward = corner.z * mesh.scale;
  double lat = 0.0, lon = 0.0, height_m = 0.0;
  frame.Reverse(c * right + s * forward, c * forward - s * right, corner.y * mesh.scale, lat, lon, height_m);
  return ellipsoid.to_ecef(place_at(lat, lon, height_m));
}

double cross_of(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// The outline of points, in turn.
std::vector<glm::dvec2> hull_of(std::vector<glm::dvec2> points) {
  std::ranges::sort(points, [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<glm::dvec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t least = hull.size() + 2;
    for (const glm::dvec2 p : points) {
      while (hull.size() >= least && cross_of(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// Negative inside; outside a lower bound.
double off_hull_px(const std::vector<glm::dvec2>& hull, glm::dvec2 p) {
  double off = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const glm::dvec2 edge = hull[(k + 1) % hull.size()] - hull[k];
    off = std::max(off, cross_of(p - hull[k], edge) / glm::length(edge));
  }
  return off;
}

class MeshPassTest : public ObjectCanvas {
 protected:
  /// The box must cover what the outline of its projected corners does.
  void expect_box_seen(const MeshObject& mesh, const Camera& camera) {
    std::vector<glm::dvec2> corners;
    for (unsigned k = 0; k < 8; ++k) {
      const auto side = [k](unsigned axis) { return double((k >> axis & 1U) != 0 ? kBoxHigh[axis] : kBoxLow[axis]); };
      const auto seen =
          project(view(camera), place_of_corner(mesh, ellipsoid(), glm::dvec3(side(0), side(1), side(2))));
      ASSERT_TRUE(seen);
      corners.push_back(*seen);
    }
    const std::vector<glm::dvec2> hull = hull_of(corners);
    const ObjectPicture picture = draw({.meshes = {mesh}}, camera);
    int covered = 0;
    for (int y = 0; y < picture.size.height_px; ++y) {
      for (int x = 0; x < picture.size.width_px; ++x) {
        const double off_px = off_hull_px(hull, {x + 0.5, y + 0.5});
        if (off_px < -kOutline_px) {
          ASSERT_EQ(picture.at(x, y), kExactRed) << x << ',' << y << " off " << off_px;
          ++covered;
        }
        if (off_px > kOutline_px) {
          ASSERT_EQ(picture.at(x, y).alpha, 0) << x << ',' << y << " off " << off_px;
        }
      }
    }
    EXPECT_GT(covered, 300);
  }
};

TEST_F(MeshPassTest, ABoxCoversWhatItsProjectedCornersEnclose) {
  const std::shared_ptr<const MeshModel> model = red_box();
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 200});
    for (const double heading_deg : {0.0, -123.0}) {
      MeshObject box{.model = model, .place = place_at(47.0, 8.0, 500.0), .heading = Angle::degrees(heading_deg)};
      expect_box_seen(box, looking(47.0, 8.0, 850.0, -90.0, 0.0));
      expect_box_seen(box, looking(46.998, 7.999, 700.0, -35.0, 20.0));
      box.scale = 1000.0;
      expect_box_seen(box, looking(47.0, 8.0, 300.0e3, -90.0, 0.0));
    }
  }
}

TEST_F(MeshPassTest, ItStandsStillFromAFewMetresAway) {
  // Floats relative to the planet's centre would be wrong by half a metre: tens of pixels.
  MeshObject box{.model = red_box(), .place = place_at(-33.123456, 151.654321, 12.0), .scale = 0.01};
  for (int k = 0; k < 5; ++k) {
    Camera camera = looking(-33.123456, 151.654321, 15.0, -90.0, 10.0);
    camera.eye.lon = camera.eye.lon + Angle::radians(k * 1.0e-5 / ellipsoid().a_m());
    expect_box_seen(box, camera);
  }
}

TEST_F(MeshPassTest, APictureLiesOnATriangleAsItsCoordinatesSay) {
  // A square on the ground, 100 m wide: red, green / blue, white from the north-west.
  ModelFixture square = box_model(kBoxLow, kBoxHigh, {1.0, 1.0, 1.0, 1.0});
  square.json["accessors"].clear();
  square.json["bufferViews"].clear();
  square.buffer.clear();
  square.add_accessor(std::vector<float>{50, 0, 50, -50, 0, 50, 50, 0, -50, -50, 0, -50}, 5126, "VEC3", 4);
  square.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 6);
  square.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, 5126, "VEC2", 4);
  Image image{8, 8, {}};
  for (int k = 0; k < 64; ++k) {
    const bool north = k < 32, west = k % 8 < 4;
    const ObjectColor c = north ? (west ? kExactRed : ObjectColor{0, 200, 0})
                                : (west ? ObjectColor{0, 0, 130} : ObjectColor{255, 255, 255});
    for (const std::uint8_t level : {c.red, c.green, c.blue, c.alpha}) image.rgba.push_back(level);
  }
  const auto png = encode_png(image);
  ASSERT_TRUE(png);
  square.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", square.buffer.size()}, {"byteLength", png->size()}});
  square.buffer.append(reinterpret_cast<const char*>(png->data()), png->size());
  square.buffer.resize((square.buffer.size() + 3) / 4 * 4);
  square.json["images"] = {{{"bufferView", 3}, {"mimeType", "image/png"}}};
  square.json["textures"] = {{{"source", 0}}};
  square.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2;
  square.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const MeshObject mesh{.model = model_of(square), .place = place_at(10.0, 20.0, 0.0)};
  const ObjectPicture picture = draw({.meshes = {mesh}}, looking(10.0, 20.0, 120.0, -90.0, 0.0));
  const double px_of_metre = view(looking(10.0, 20.0, 120.0, -90.0, 0.0)).pixels_per_radian() / 120.0;
  const auto seen = [&](double east_m, double north_m) {
    return picture.at(static_cast<int>(100.0 + east_m * px_of_metre), static_cast<int>(100.0 - north_m * px_of_metre));
  };
  const auto expect_color = [](ObjectColor a, ObjectColor b) {
    constexpr int kLevels = 2;  // levels lost on the way to linear light and back
    EXPECT_NEAR(a.red, b.red, kLevels);
    EXPECT_NEAR(a.green, b.green, kLevels);
    EXPECT_NEAR(a.blue, b.blue, kLevels);
  };
  expect_color(seen(-25.0, 25.0), {255, 0, 0});
  expect_color(seen(25.0, 25.0), {0, 200, 0});
  expect_color(seen(-25.0, -25.0), {0, 0, 130});
  expect_color(seen(25.0, -25.0), {255, 255, 255});
}

TEST_F(MeshPassTest, ThoseThatShareAModelAreDrawnAtOnce) {
  ObjectScene scene;
  const std::shared_ptr<const MeshModel> model = red_box();
  for (int k = 0; k < 200; ++k) scene.meshes.push_back({.model = model, .place = place_at(0.01 * k, 0.01 * k, 10.0)});
  const ObjectPicture picture = draw(scene, looking(0.0, 0.0, 200.0, -90.0, 0.0));
  EXPECT_EQ(draw_calls_, 1);
  EXPECT_EQ(picture.at(100, 80), kExactRed);
}

/// Red glass below, facing down, and green glass over it, facing up; their triangles in this order or the other.
std::shared_ptr<const MeshModel> two_panes(bool green_first) {
  const glm::vec4 red(1.0F, 0.0F, 0.0F, 0.5F), green(0.0F, 1.0F, 0.0F, 0.5F);
  auto model = std::make_shared<MeshModel>();
  MeshPart& part = model->parts.emplace_back();
  part.translucent = true;
  for (const bool upper : {false, true}) {
    const float y = upper ? 20.0F : 0.0F;
    for (const glm::vec2 at : {glm::vec2(-30, -30), glm::vec2(-30, 30), glm::vec2(30, 30), glm::vec2(30, -30)}) {
      part.vertices.push_back({.position_m = {at.x, y, at.y}, .color_linear = upper ? green : red});
    }
  }
  const std::vector<std::uint32_t> red_down{0, 2, 1, 0, 3, 2}, green_up{4, 5, 6, 4, 6, 7};
  for (const auto* pane : {green_first ? &green_up : &red_down, green_first ? &red_down : &green_up}) {
    part.indices.insert(part.indices.end(), pane->begin(), pane->end());
  }
  return model;
}

TEST_F(MeshPassTest, GlassIsSeenThroughGlassWhateverTheOrderOfTriangles) {
  for (const bool green_first : {true, false}) {
    const MeshObject glass{.model = two_panes(green_first), .place = place_at(10.0, 20.0, 50.0)};
    const ObjectColor above = draw({.meshes = {glass}}, looking(10.0, 20.0, 250.0, -90.0, 0.0)).at(100, 100);
    EXPECT_GT(above.green, above.red + 40) << green_first;
    EXPECT_GT(above.red, 30) << "the lower pane shows";
    const ObjectColor below = draw({.meshes = {glass}}, looking(10.0, 20.0, -150.0, 90.0, 0.0)).at(100, 100);
    EXPECT_GT(below.red, below.green + 40) << green_first;
    EXPECT_GT(below.green, 30) << "the upper pane shows";
  }
}

TEST_F(MeshPassTest, LightFallsOnFacesAsTheyAreTurned) {
  const ObjectScene scene{.meshes = {{.model = red_box(), .place = place_at(0.0, 0.0, 0.0)}}};
  lit_ = true;
  const ObjectPicture picture = draw(scene, looking(-0.0015, 0.0, 150.0, -35.0, 0.0));
  std::vector<int> levels;
  for (int y = 0; y < 200; ++y) {
    if (picture.shown(100, y)) levels.push_back(picture.at(100, y).red);
  }
  ASSERT_FALSE(levels.empty());
  EXPECT_GT(*std::ranges::max_element(levels), *std::ranges::min_element(levels) + 10) << "roof and wall look the same";
}

TEST_F(MeshPassTest, ATranslucentMaterialBlends) {
  ModelFixture half = box_model({-50.0F, 0.0F, -50.0F}, {50.0F, 1.0F, 50.0F}, {0.0, 0.0, 1.0, 0.5});
  half.json["materials"][0]["alphaMode"] = "BLEND";
  // The roof alone: its two triangles are the 7th and 8th.
  half.json["accessors"][1]["count"] = 6;
  half.json["accessors"][1]["byteOffset"] = 18 * sizeof(std::uint16_t);
  const PointObject ball{.place = place_at(0.0, 0.0, -60.0), .radius_m = 40.0, .color = kExactRed};
  const ObjectScene scene{.points = {ball}, .meshes = {{.model = model_of(half), .place = place_at(0.0, 0.0, 0.0)}}};
  const ObjectColor seen = draw(scene, looking(0.0, 0.0, 100.0, -90.0, 0.0)).at(100, 100);
  EXPECT_NEAR(seen.red, 128, 1);
  EXPECT_NEAR(seen.blue, 128, 1);
}

}  // namespace
}  // namespace terrella::test
