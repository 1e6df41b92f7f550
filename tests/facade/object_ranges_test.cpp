// The contract of the Globe API, continued: the values of objects and of their edits (ranges_test.cpp).
#include <gtest/gtest.h>

#include "tests/facade/ranges.h"
#include "tests/gl/gl_fixture.h"

namespace terrella::test {
namespace {

class ObjectRanges : public GlTest {
 protected:
  [[nodiscard]] static std::unique_ptr<Globe> globe() { return make_globe({}, one_colour(kRangeGrid, {0, 200, 0})); }
};

TEST_F(ObjectRanges, OfObjects) {
  using S = ObjectScene;
  const auto planet = globe();
  const auto icon = [](int side, std::size_t bytes) {
    return std::make_shared<IconImage>(IconImage{side, side, std::vector<std::uint8_t>(bytes)});
  };
  const auto model = [](double index, double x, std::size_t bytes) {
    MeshPart part{.vertices = std::vector<MeshVertex>(3), .indices = {0, 1, static_cast<std::uint32_t>(index)}};
    part.vertices[1].position_m.x = static_cast<float>(x);
    part.texture = std::make_shared<MeshTexture>(MeshTexture{1, 1, std::vector<std::uint8_t>(bytes)});
    return std::make_shared<MeshModel>(MeshModel{{part}});
  };
  const S whole{.points = {{.place = kRangePlace}},
                .lines = {{.places = {kRangePlace, {}}}},
                .polygons = {{.rings = {{kRangePlace, {}, {.lat = Angle::degrees(5.0), .lon = {}}}}}},
                .labels = {{.text = "a", .place = kRangePlace}},
                .meshes = {{.model = model(2, 1.0, 4), .place = kRangePlace}}};
  std::vector<Row<S>> rows = {
      {"radius_m", {0.0, 1e12}, {-1.0, 1.1e12, kNoNumberAtAll}, [](S& s, double v) { s.points[0].radius_m = v; }},
      {"heights", {0, 2}, {-1, 3}, [](S& s, double v) { s.points[0].heights = HeightMode(int(v)); }},
      {"line heights", {0, 2}, {3}, [](S& s, double v) { s.lines[0].heights = HeightMode(int(v)); }},
      {"polygon heights", {0, 2}, {3}, [](S& s, double v) { s.polygons[0].heights = HeightMode(int(v)); }},
      {"label heights", {0, 2}, {3}, [](S& s, double v) { s.labels[0].heights = HeightMode(int(v)); }},
      {"mesh heights", {0, 2}, {3}, [](S& s, double v) { s.meshes[0].heights = HeightMode(int(v)); }},
      {"size_px", {0.0, 1e6}, {-1.0, 1.1e6, kNoNumberAtAll}, [](S& s, double v) { s.points[0].size_px = float(v); }},
      {"heading", {720.0}, {kNoNumberAtAll}, [](S& s, double v) { s.points[0].icon.heading = Angle::degrees(v); }},
      {"anchor", {0.0, 3.0}, {kNoNumberAtAll}, [](S& s, double v) { s.points[0].icon.anchor.x = float(v); }},
      {"image",
       {1, 256},
       {-1, 0, 257},
       [&](S& s, double v) { s.points[0].icon.image = icon(int(v), std::size_t(4 * v * v)); }},
      {"rgba", {16}, {0, 15, 17}, [&](S& s, double v) { s.points[0].icon.image = icon(2, std::size_t(v)); }},
      {"width_px", {0.0, 1e6}, {-1.0, 1.1e6, kNoNumberAtAll}, [](S& s, double v) { s.lines[0].width_px = float(v); }},
      {"stroke_width_px",
       {0.0, 1e6},
       {-1.0, 1.1e6, kNoNumberAtAll},
       [](S& s, double v) { s.polygons[0].stroke_width_px = float(v); }},
      {"extrude_m",
       {-1e12, 0.0},
       {1.1e12, kNoNumberAtAll, kInfinite},
       [](S& s, double v) { s.polygons[0].extrude_m = v; }},
      {"label size_px", {0.0, 1e6}, {-1.0, kNoNumberAtAll}, [](S& s, double v) { s.labels[0].size_px = float(v); }},
      {"label radius_m", {0.0, 1e12}, {-1.0, kNoNumberAtAll}, [](S& s, double v) { s.labels[0].radius_m = v; }},
      {"priority", {-kInfinite, kInfinite}, {kNoNumberAtAll}, [](S& s, double v) { s.labels[0].priority = v; }},
      {"text_px",
       {6.0, 64.0},
       {5.9, 64.1, kNoNumberAtAll},
       [](S& s, double v) { s.labels[0].look.text_px = float(v); }},
      {"halo_px", {0.0, 8.0}, {-0.1, 8.1, kNoNumberAtAll}, [](S& s, double v) { s.labels[0].look.halo_px = float(v); }},
      {"anchor", {0, 8}, {9}, [](S& s, double v) { s.labels[0].look.anchor = TextAnchor(int(v)); }},
      {"halo_blur_px",
       {0.0, 8.0},
       {-0.1, 8.1, kNoNumberAtAll},
       [](S& s, double v) { s.labels[0].look.halo_blur_px = float(v); }},
      {"weight", {0, 2}, {3}, [](S& s, double v) { s.labels[0].look.weight = TextWeight(int(v)); }},
      {"letter_spacing_em",
       {0.0, 1.0},
       {-0.1, 1.1, kNoNumberAtAll},
       [](S& s, double v) { s.labels[0].look.letter_spacing_em = float(v); }},
      {"scale", {1e-3, 1e12}, {-1.0, 0.0, kNoNumberAtAll, kInfinite}, [](S& s, double v) { s.meshes[0].scale = v; }},
      {"mesh heading", {720.0}, {kNoNumberAtAll}, [](S& s, double v) { s.meshes[0].heading = Angle::degrees(v); }},
      {"indices", {0, 2}, {3, 4e9}, [&](S& s, double v) { s.meshes[0].model = model(v, 1.0, 4); }},
      {"vertices", {-1e3}, {kNoNumberAtAll, kInfinite}, [&](S& s, double v) { s.meshes[0].model = model(0, v, 4); }},
      {"texture", {4}, {0, 3, 5}, [&](S& s, double v) { s.meshes[0].model = model(0, 1.0, std::size_t(v)); }},
      {"model", {}, {0}, [](S& s, double) { s.meshes[0].model = nullptr; }}};
  for (const auto& place : std::vector<std::function<Geodetic&(S&)>>{
           [](S& s) -> Geodetic& { return s.points[0].place; }, [](S& s) -> Geodetic& { return s.lines[0].places[1]; },
           [](S& s) -> Geodetic& { return s.polygons[0].rings[0][2]; },
           [](S& s) -> Geodetic& { return s.labels[0].place; }, [](S& s) -> Geodetic& { return s.meshes[0].place; }}) {
    for (auto& row : place_rows<S>(place)) {
      if (row.name != std::string("height_m")) row.good = {0.0};
      rows.push_back({row.name, {0.0}, row.bad, row.set});
    }
  }
  const LayerId layer = *planet->add_objects(whole);
  expect_ranges<S>(whole, rows, "Globe::add_objects: ", [&](const S& scene) {
    const auto added = planet->add_objects(scene);
    if (!added) return Status(added.error());
    return planet->remove(*added);
  });
  rows.resize(2);
  expect_ranges<S>(whole, rows, "Globe::set_objects: ", [&](const S& s) { return planet->set_objects(layer, s); });
  expect_ranges<S>(whole, rows,
                   "Globe::edit_objects: ", [&](const S& s) { return planet->edit_objects(layer, {.add = s}); });
  expect_ranges<double>(1.0, {{"opacity", {0.0, 1.0}, {-0.1, 1.1, kNoNumberAtAll}, [](double& o, double v) { o = v; }}},
                        "Globe::fade_objects: ", [&](double opacity) { return planet->fade_objects(layer, opacity); });
}

TEST_F(ObjectRanges, OfEdits) {
  const auto planet = globe();
  const ObjectId id{1};
  const LayerId layer = *planet->add_objects({.points = {{.place = kRangePlace, .of = {.id = id}}}});
  std::vector<Row<ObjectMove>> moves = place_rows<ObjectMove>([](ObjectMove& m) -> Geodetic& { return m.place; });
  moves.push_back({"heading", {720.0}, {kNoNumberAtAll, kInfinite}, [](ObjectMove& m, double v) {
                     m.heading = Angle::degrees(v);
                   }});
  expect_ranges<ObjectMove>({.id = id, .place = {}}, moves, "Globe::edit_objects: ", [&](const ObjectMove& move) {
    return planet->edit_objects(layer, {.moves = {move}});
  });
  expect_ranges<ObjectChange>(
      {.id = id},
      {{"size_px",
        {0.1, 1e6},
        {-1.0, 0.0, 1.1e6, kNoNumberAtAll},
        [](ObjectChange& c, double v) { c.size_px = float(v); }},
       {"heading", {720.0}, {kNoNumberAtAll}, [](ObjectChange& c, double v) { c.heading = Angle::degrees(v); }},
       {"text_px", {64.0}, {65.0}, [](ObjectChange& c, double v) { c.look = LabelLook{.text_px = float(v)}; }}},
      "Globe::edit_objects: ", [&](const ObjectChange& c) { return planet->edit_objects(layer, {.changes = {c}}); });
}

}  // namespace
}  // namespace terrella::test
