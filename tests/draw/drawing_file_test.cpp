#include "apps/viewer/draw/drawing_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/viewer/draw/geojson_shape.h"
#include "support/scratch_folder.h"
#include "tests/draw/draw_samples.h"

namespace terrella {
namespace {

using test::place_at;
using test::text_of_file;

/// Marks of each kind in ordinary places, across ±180° and round both poles.
Drawing sample() {
  const auto at = place_at;
  Drawing drawing;
  drawing.add({.places = {at(37.9838, 23.7275)}, .name = "Αθήνα <&> \"1\"", .look = {.color = {1, 2, 3}}});
  drawing.add({.kind = MarkKind::line,
               .places = {at(10, 170), at(20.123456789, -170.123456789), at(0, 180), at(-5, 179.5)},
               .name = "Dateline",
               .look = {.color = {0, 128, 255, 77}, .width_px = 5.5F}});
  drawing.add({.kind = MarkKind::area,
               .places = {at(10, 170), at(10, -170), at(-10, -170), at(-10, 170)},
               .look = {.color = {9, 8, 7}, .width_px = 2.0F, .fill = {200, 100, 50, 91}}});
  drawing.add({.kind = MarkKind::area, .places = {at(70, 0), at(75, 90), at(80, 180), at(75, -90)}, .name = "North"});
  drawing.add({.kind = MarkKind::area, .places = {at(-70, 10), at(-75, -110), at(-80, 130)}, .name = "South"});
  drawing.add({.kind = MarkKind::area, .places = {at(0, 0), at(0, 10), at(9.000000001, 5)}});
  return drawing;
}

constexpr double kSame_deg = 1e-9;  // 0.1 mm on Earth: the last decimal of a file

/// True if two lists have the same places; a ring may run the other way.
bool same_places(const DrawnMark& one, const DrawnMark& other) {
  const auto same = [](const Geodetic& a, const Geodetic& b) {
    return std::abs(a.lat.deg() - b.lat.deg()) < kSame_deg &&
           std::abs(std::remainder(a.lon.deg() - b.lon.deg(), 360.0)) < kSame_deg;
  };
  std::vector<Geodetic> turned = other.places;
  if (one.kind == MarkKind::area) std::reverse(turned.begin() + 1, turned.end());
  return std::ranges::equal(one.places, other.places, same) || std::ranges::equal(one.places, turned, same);
}

TEST(DrawingFile, OpensAsItWasSavedAndIsSavedInTheSameBytes) {
  const test::ScratchFolder folder;
  const Drawing drawing = sample();
  for (const std::string ending : {".geojson", ".json", ".kml", ".KML"}) {
    const auto first = folder.path() / ("first" + ending), second = folder.path() / ("second" + ending);
    ASSERT_TRUE(save_drawing(first, drawing));
    const auto opened = open_drawing(first);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened->left_out, 0U);
    EXPECT_TRUE(opened->complaints.empty()) << opened->complaints[0];
    ASSERT_EQ(opened->drawing.marks.size(), drawing.marks.size()) << ending;
    for (std::size_t k = 0; k < drawing.marks.size(); ++k) {
      const DrawnMark &one = drawing.marks[k], &other = opened->drawing.marks[k];
      EXPECT_EQ(one.kind, other.kind);
      EXPECT_EQ(one.name, other.name);
      EXPECT_TRUE(same_places(one, other)) << ending << ", mark " << k + 1;
      EXPECT_EQ(one.look.color, other.look.color) << ending << ", mark " << k + 1;
      if (one.kind == MarkKind::place) continue;
      EXPECT_EQ(one.look.width_px, other.look.width_px);
      if (one.kind == MarkKind::line) continue;
      EXPECT_EQ(one.look.fill, other.look.fill);
    }
    ASSERT_TRUE(save_drawing(second, opened->drawing));
    EXPECT_EQ(text_of_file(first), text_of_file(second)) << ending;
  }
}

TEST(DrawingFile, GeoJsonHasSimplestyleAndRingsAgainstTheClock) {
  const auto json = nlohmann::json::parse(drawing_geojson(sample()));
  ASSERT_EQ(json["features"].size(), 6U);
  EXPECT_EQ(json["features"][0]["properties"]["marker-color"], "#010203");
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"], nlohmann::json({23.7275, 37.9838}));
  EXPECT_EQ(json["features"][1]["properties"]["stroke-opacity"], 0.302);
  EXPECT_EQ(json["features"][1]["geometry"]["coordinates"][1], nlohmann::json({189.876543211, 20.123456789}));
  EXPECT_EQ(json["features"][2]["geometry"]["coordinates"][0],
            nlohmann::json({{170.0, 10.0}, {170.0, -10.0}, {190.0, -10.0}, {190.0, 10.0}, {170.0, 10.0}}));
  EXPECT_EQ(json["features"][3]["geometry"]["coordinates"][0],
            nlohmann::json({{0.0, 70.0}, {90.0, 75.0}, {180.0, 80.0}, {-90.0, 75.0}, {0.0, 70.0}}));
}

TEST(DrawingFile, ABadNameOrFolderIsToldAndNothingIsLeft) {
  const test::ScratchFolder folder;
  for (const char* name : {"a.txt", "a", "none/a.kml"}) {
    const auto file = folder.path() / name;
    const Status saved = save_drawing(file, sample());
    ASSERT_FALSE(saved);
    EXPECT_NE(saved.error().message.find(file.string()), std::string::npos) << saved.error().message;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(open_drawing(folder.path() / "none.geojson"));
}

TEST(DrawingFile, NamesWithControlCharactersAreReadable) {
  const test::ScratchFolder folder;
  Drawing drawing;
  drawing.add({.places = {place_at(1, 2)},
               .name = "a\x01"
                       "b"});
  ASSERT_TRUE(save_drawing(folder.path() / "a.kml", drawing));
  const auto opened = open_drawing(folder.path() / "a.kml");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->drawing.marks[0].name, "ab");
}

}  // namespace
}  // namespace terrella
