// Picks by the spatial index beside picks by a scan of everything: random objects, places and cameras.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "geo/body.h"
#include "objects/layer_objects.h"

namespace terrella {
namespace {

constexpr Viewport kPicture{640, 480};

class Chance {
 public:
  double from(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Geodetic place(double lowest_m, double highest_m) {
    return {.lat = Angle::radians(std::asin(from(-1.0, 1.0))),
            .lon = Angle::degrees(from(-180.0, 180.0)),
            .height_m = from(lowest_m, highest_m)};
  }
  Geodetic near(const Geodetic& p, double reach_deg) {
    return {.lat = Angle::degrees(std::clamp(p.lat.deg() + from(-reach_deg, reach_deg), -90.0, 90.0)),
            .lon = Angle::degrees(p.lon.deg() + from(-reach_deg, reach_deg)),
            .height_m = p.height_m};
  }
  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_); }

 private:
  std::mt19937 random_{11};
};

ObjectScene any_scene(Chance& chance, std::size_t points) {
  ObjectScene scene;
  MeshModel cube;
  cube.parts.push_back({.vertices = {{.position_m = {3e4F, 1e4F, 0}}, {.position_m = {-2e4F, 0, 5e4F}}}});
  const auto model = std::make_shared<const MeshModel>(cube);
  for (std::size_t k = 0; k < points; ++k) {
    scene.points.push_back({.place = chance.place(-2e4, 4e5),
                            .size_px = static_cast<float>(chance.from(2.0, 20.0)),
                            .of = {.id = ObjectId{k + 1}}});
    if (k % 5 == 0) scene.points.back().radius_m = chance.from(1e3, 3e5);
  }
  for (int k = 0; k < 6; ++k) {
    const Geodetic from = chance.place(0.0, 2e4);
    const double reach_deg = k == 0 ? 60.0 : 2.0;
    scene.lines.push_back({.places = {from, chance.near(from, reach_deg), chance.near(from, reach_deg)}});
    scene.polygons.push_back(
        {.rings = {{from, chance.near(from, reach_deg), chance.near(from, reach_deg), chance.near(from, 2.0)}}});
    scene.meshes.push_back({.model = model, .place = chance.place(0.0, 1e5), .scale = chance.from(0.5, 4.0)});
  }
  const auto corner = [](double lat, double lon) {
    return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)};
  };
  scene.polygons.push_back({.rings = {{corner(80, 0), corner(75, 120), corner(82, -120)}}});  // round a pole
  scene.polygons.push_back({.rings = {{corner(-10, 170), corner(-10, -170), corner(10, -170), corner(10, 170)}}});
  scene.points.push_back({.place = {.lat = Angle::degrees(NAN), .lon = {}}});
  return scene;
}

Geodetic place_of_any(Chance& chance, const ObjectScene& scene) {
  const Geodetic places[] = {scene.points[chance.below(scene.points.size() - 1)].place,
                             scene.lines[chance.below(scene.lines.size())].places[1],
                             scene.polygons[chance.below(scene.polygons.size())].rings[0][0],
                             scene.meshes[chance.below(scene.meshes.size())].place};
  return places[chance.below(4)];
}

View any_view(Chance& chance, const Geodetic& near) {
  Camera camera;
  camera.eye = chance.near(near, 0.3);
  camera.eye.height_m = std::pow(10.0, chance.from(3.5, 7.5));
  camera.heading = Angle::degrees(chance.from(0.0, 360.0));
  camera.pitch = Angle::degrees(chance.from(-90.0, -50.0));
  camera.fov_y = Angle::degrees(chance.from(15.0, 120.0));
  return make_view(camera, earth().ellipsoid, kPicture);
}

/// A pixel beside a place, if that is in front of the eye.
glm::dvec2 any_pixel(Chance& chance, const View& view, const Geodetic& beside) {
  const auto pixel = project(view, earth().ellipsoid.to_ecef(beside));
  const glm::dvec2 aside(chance.from(-6.0, 6.0), chance.from(-6.0, 6.0));
  if (pixel && std::abs(pixel->x) < 2000.0 && std::abs(pixel->y) < 2000.0) return *pixel + aside;
  return {chance.from(0.0, kPicture.width_px), chance.from(0.0, kPicture.height_px)};
}

void expect_as_scan(LayerObjects& layer, const ObjectScene& scene, Chance& chance, int picks, int& found) {
  const Ground ground(earth().ellipsoid);
  for (int k = 0; k < picks; ++k) {
    const Geodetic place = place_of_any(chance, scene);
    const View view = any_view(chance, place);
    const glm::dvec2 pixel = any_pixel(chance, view, place);
    const PickOptions how{.through_ground = k % 3 == 0};
    const auto scan = pick_object(view, ground, scene, pixel, how), quick = layer.pick(view, ground, pixel, how, {});
    ASSERT_EQ(scan.has_value(), quick.has_value()) << k;
    if (!scan) continue;
    ++found;
    EXPECT_EQ(scan->kind, quick->kind) << k;
    EXPECT_EQ(scan->index, quick->index) << k;
    EXPECT_EQ(scan->of.id, quick->of.id) << k;
    EXPECT_DOUBLE_EQ(scan->distance_m, quick->distance_m) << k;
  }
}

TEST(LayerPick, FindsWhatAScanOfEverythingFinds) {
  Chance chance;
  ObjectScene scene = any_scene(chance, 300);
  LayerObjects layer(scene, earth().ellipsoid, 1.0, kSelectedColor);
  int found = 0;
  expect_as_scan(layer, scene, chance, 150, found);
  for (std::size_t k = 0; k + 1 < scene.points.size(); ++k) {  // all but the last move: some far, most a little
    Geodetic& place = scene.points[k].place;
    place = k % 7 == 0 ? chance.place(0.0, 1e6) : chance.near(place, 0.5);
    ASSERT_TRUE(layer.move({scene.points[k].of.id, place}));
  }
  expect_as_scan(layer, scene, chance, 150, found);
  EXPECT_GT(found, 150) << "most picks find something";
}

std::shared_ptr<const IconImage> picture(int width_px, int height_px) {
  return std::make_shared<const IconImage>(
      IconImage{width_px, height_px, std::vector<std::uint8_t>(4UL * std::size_t(width_px * height_px), 255)});
}

TEST(LayerPick, FindsTheIconsThatAScanFinds) {
  Chance chance;
  ObjectScene scene = any_scene(chance, 300);
  const std::vector images{picture(20, 10), picture(7, 30)};
  for (std::size_t k = 0; k + 1 < scene.points.size(); ++k) {
    PointObject& point = scene.points[k];
    point.size_px *= 3.0F;
    point.icon = {.image = images[k % 2],
                  .anchor = {chance.from(0.0, 1.0), chance.from(-0.5, 1.5)},
                  .heading = Angle::degrees(chance.from(0.0, 360.0)),
                  .from_north = k % 3 == 0};
  }
  LayerObjects layer(scene, earth().ellipsoid, 1.0, kSelectedColor);
  int found = 0;
  expect_as_scan(layer, scene, chance, 200, found);
  EXPECT_GT(found, 60);
}

// The rectangle by trigonometry of its own: an icon of 40 by 20 pixels whose lower middle is at the place.
TEST(LayerPick, AnIconIsPickedInItsTurnedRectangle) {
  Camera camera;
  camera.eye = {.lat = {}, .lon = {}, .height_m = 1.0e6};
  const View view = make_view(camera, earth().ellipsoid, kPicture);
  const Ground ground(earth().ellipsoid);
  for (const bool from_north : {false, true}) {
    const double turn = Angle::degrees(30.0).rad();
    const ObjectScene scene{.points = {{.place = {.lat = {}, .lon = {}, .height_m = 10.0},
                                        .size_px = 40.0F,
                                        .icon = {.image = picture(10, 5),
                                                 .anchor = {0.5F, 1.0F},
                                                 .heading = Angle::radians(turn),
                                                 .from_north = from_north}}}};
    LayerObjects layer(scene, earth().ellipsoid, 1.0, kSelectedColor);
    int in = 0;
    for (int y = -50; y <= 50; ++y) {
      for (int x = -50; x <= 50; ++x) {
        const double along = x * std::cos(turn) + y * std::sin(turn), up = x * std::sin(turn) - y * std::cos(turn);
        const double outside = std::max({std::abs(along) - 20.0, -up, up - 20.0});
        if (std::abs(outside) < 0.01) continue;  // rounding decides
        const bool picked = layer.pick(view, ground, {320.0 + x, 240.0 + y}, {.slack_px = 0.0}, {}).has_value();
        ASSERT_EQ(picked, outside < 0.0) << x << ',' << y << ' ' << from_north;
        in += picked ? 1 : 0;
      }
    }
    EXPECT_NEAR(in, 800, 30);
  }
}

TEST(LayerPick, DoesNotFindWhatIsRemovedOrHiddenAndFindsWhatIsAdded) {
  Chance chance;
  ObjectScene scene = any_scene(chance, 3000);
  LayerObjects layer(scene, earth().ellipsoid, 1.0, kSelectedColor);
  layer.place(cut_objects(layer.take_job(), false));
  const auto in_view = [&](const Geodetic& place) {
    Camera camera;
    camera.eye = place;
    camera.eye.height_m = 3.0e6;
    const View view = make_view(camera, earth().ellipsoid, kPicture);
    const auto object = layer.pick(view, Ground(earth().ellipsoid), {320.0, 240.0}, {.through_ground = true}, {});
    return object ? object->of.id : ObjectId::none;
  };
  const auto id = [&](std::size_t k) { return scene.points[k].of.id; };
  for (std::size_t k = 0; k < 2800; ++k) ASSERT_TRUE(layer.remove(id(k)));
  EXPECT_FALSE(layer.remove(id(7))) << "it is gone";
  layer.tidy();  // most of the layer is removed: the lists are made anew
  EXPECT_EQ(layer.batches().markers.bucket(0).items.size() + layer.batches().markers.bucket(4).items.size(), 161U)
      << "200 points are left; a fifth of them are spheres; one is not finite";
  for (const std::size_t k : {3U, 1501U}) EXPECT_NE(in_view(scene.points[k].place), id(k));
  EXPECT_EQ(in_view(scene.points[2901].place), id(2901));
  ASSERT_TRUE(layer.change({.id = id(2901), .visible = false}));
  EXPECT_NE(in_view(scene.points[2901].place), id(2901));
  layer.add({.points = {{.place = scene.points[3].place, .of = {.id = ObjectId{9999}}}}});
  EXPECT_EQ(in_view(scene.points[3].place), ObjectId{9999});
  ASSERT_TRUE(layer.move({ObjectId{9999}, scene.points[4].place}));
  EXPECT_EQ(in_view(scene.points[4].place), ObjectId{9999});
}

}  // namespace
}  // namespace terrella
