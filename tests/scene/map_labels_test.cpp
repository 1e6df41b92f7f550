// Names of a map: priority, collisions, the far side of the globe, and no flicker while the camera moves.
#include "objects/map_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "geo/body.h"

namespace terrella {
namespace {

using glm::dvec2;

constexpr Viewport kPicture{1024, 768};
constexpr double kCharacter_px = 8.0, kLine_px = 15.0;

MapName name(const std::string& text, double lat, double lon, double rank, bool is_area = false) {
  return {.text = text,
          .place = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)},
          .rank = rank,
          .widest_m = HUGE_VAL,
          .is_area = is_area};
}

View seen_from(double lat, double lon, double height_m) {
  Camera camera;
  camera.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m};
  return make_view(camera, earth().ellipsoid, kPicture);
}

dvec2 size_of(const MapName& name) { return {kCharacter_px * double(name.text.size()), kLine_px}; }

LabelPage page(std::vector<LabelBox> taken = {}) { return {.size_px = size_of, .taken = std::move(taken)}; }

LabelBox box_of(const MapLabels& labels, const ShownName& shown) {
  const dvec2 low = shown.place_px + shown.text_px;
  return {glm::vec2(low), glm::vec2(low + size_of(labels.names()[shown.name]))};
}

bool overlap(const LabelBox& a, const LabelBox& b) {
  return a.low_px.x < b.high_px.x && b.low_px.x < a.high_px.x && a.low_px.y < b.high_px.y && b.low_px.y < a.high_px.y;
}

std::vector<std::string> texts(MapLabels& labels, const View& view, const LabelPage& on = page()) {
  std::vector<std::string> found;
  for (const ShownName& shown : labels.place(view, Ground(earth().ellipsoid), on))
    found.push_back(labels.names()[shown.name].text);
  return found;
}

std::vector<MapName> random_names(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> lat(30.0, 60.0), lon(-20.0, 20.0), size(4.0, 7.0);
  std::vector<MapName> names;
  for (std::size_t k = 0; k < count; ++k) {
    names.push_back(
        name("place " + std::to_string(k), lat(random), lon(random), std::pow(10.0, size(random)), k % 7 == 0));
    names.back().widest_m = names.back().rank / 320.0;
  }
  return names;
}

TEST(MapLabels, TheHigherRankGetsTheRoom) {
  MapLabels labels({name("village", 0.0, 0.0, 1.0, true), name("city", 0.0, 0.01, 2.0, true)}, earth().ellipsoid);
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 5.0e6)), std::vector<std::string>{"city"});
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 5.0e3)).size(), 2U);
}

TEST(MapLabels, APlaceWithoutRoomAtItsRightHasItAtItsLeft) {
  MapLabels labels({name("town", 0.0, 0.0, 1.0)}, earth().ellipsoid);
  const Ground ground(earth().ellipsoid);
  const auto right = labels.place(seen_from(0.0, 0.0, 1.0e6), ground, page());
  ASSERT_EQ(right.size(), 1U);
  EXPECT_GT(right.front().text_px.x, 0.0);
  const LabelBox panel{{530.0F, 300.0F}, {900.0F, 500.0F}};
  const auto left = labels.place(seen_from(0.0, 0.0, 1.0e6), ground, page({panel}));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_LT(left.front().text_px.x, -4.0 * kCharacter_px);
}

TEST(MapLabels, NoNameCoversAnotherOrAPanel) {
  MapLabels labels(random_names(1500), earth().ellipsoid);
  const std::vector<LabelBox> panels{
      {{0.0F, 700.0F}, {400.0F, 768.0F}}, {{-50.0F, -20.0F}, {300.0F, 90.0F}}, {{700.0F, 200.0F}, {1400.0F, 420.0F}}};
  for (const double height_m : {4.0e6, 1.0e6, 5.0e5}) {
    const auto shown = labels.place(seen_from(45.0, 0.0, height_m), Ground(earth().ellipsoid), page(panels));
    EXPECT_GT(shown.size(), 5U) << height_m;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const LabelBox box = box_of(labels, shown[i]);
      EXPECT_TRUE(box.low_px.x >= 0.0F && box.low_px.y >= 0.0F && box.high_px.x <= 1024.0F && box.high_px.y <= 768.0F);
      for (const LabelBox& panel : panels) EXPECT_FALSE(overlap(box, panel));
      for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(box, box_of(labels, shown[k])));
    }
  }
}

// The truth is apart from the code: from this height the disc is a circle whose radius follows from the horizon's
// angle.
TEST(MapLabels, NamesStayWithinThePlanetsDisc) {
  std::vector<MapName> names;
  for (int lon = -70; lon <= 70; lon += 10) {
    for (int lat = -60; lat <= 60; lat += 20) names.push_back(name("a long name", lat, lon, 1.0, lat == 0));
  }
  MapLabels labels(std::move(names), earth().ellipsoid);
  const double height_m = 2.0e7, radius_m = earth().ellipsoid.a_m(), away_m = radius_m + height_m;
  const View view = seen_from(0.0, 0.0, height_m);
  const double disc_px = view.pixels_per_radian() * radius_m / std::sqrt(away_m * away_m - radius_m * radius_m);
  const auto shown = labels.place(view, Ground(earth().ellipsoid), page());
  EXPECT_GT(shown.size(), 10U);
  for (const ShownName& one : shown) {
    const LabelBox box = box_of(labels, one);
    for (const float x : {box.low_px.x, box.high_px.x}) {
      const double right = double(x) - 0.5 * kPicture.width_px;
      const double up = 0.5 * double(box.low_px.y + box.high_px.y) - 0.5 * kPicture.height_px;
      EXPECT_LT(std::hypot(right, up), disc_px + 1.0);
    }
  }
}

TEST(MapLabels, TheFarSideHasNoNames) {
  MapLabels labels({name("near", 0.0, 0.0, 1.0), name("far", 0.0, 180.0, 2.0), name("limb", 0.0, 66.0, 3.0)},
                   earth().ellipsoid);
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 1.0e7)), std::vector<std::string>{"near"});
}

// A saved picture has the names that its view has in any program, and the window's names do not jump after it.
TEST(MapLabels, APictureOfItsOwnKnowsNoOther) {
  MapLabels labels(random_names(1500), earth().ellipsoid), fresh(random_names(1500), earth().ellipsoid);
  MapLabels undisturbed(random_names(1500), earth().ellipsoid);
  const View before = seen_from(45.0, 0.0, 6.0e5), now = seen_from(45.0, 0.5, 5.0e5);
  EXPECT_EQ(texts(labels, before), texts(undisturbed, before));
  std::vector<std::string> apart;
  labels.apart([&] { apart = texts(labels, now); });
  EXPECT_EQ(apart, texts(fresh, now));
  const std::vector<std::string> after = texts(labels, now);
  EXPECT_EQ(after, texts(undisturbed, now));
  EXPECT_NE(after, apart) << "names that are shown stay";
}

TEST(MapLabels, ASmallPlaceShowsFromNearby) {
  std::vector<MapName> names{name("village", 0.0, 0.0, 1.0)};
  names.front().widest_m = 100.0;
  MapLabels labels(std::move(names), earth().ellipsoid);
  // A picture 768 pixels high of 40 degrees: a pixel covers 100 m from 105.5 km.
  EXPECT_TRUE(texts(labels, seen_from(0.0, 0.0, 1.1e5)).empty());
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 1.0e5)).size(), 1U);
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 1.1e5)).size(), 1U) << "a name that is shown stays a little longer";
  EXPECT_TRUE(texts(labels, seen_from(0.0, 0.0, 1.5e5)).empty());
}

// Counts names that vanish and come back within a few frames.
int flickers(const std::function<View(int)>& view_at, int frames) {
  constexpr int kBlink = 8;
  MapLabels labels(random_names(1500), earth().ellipsoid);
  std::map<std::size_t, int> last;
  int blinks = 0;
  for (int frame = 0; frame < frames; ++frame) {
    LabelPage moving = page();
    moving.moves = true;
    for (const ShownName& shown : labels.place(view_at(frame), Ground(earth().ellipsoid), moving)) {
      const auto before = last.find(shown.name);
      if (before != last.end() && before->second < frame - 1 && before->second > frame - kBlink) ++blinks;
      last[shown.name] = frame;
    }
  }
  EXPECT_GT(last.size(), 30U);
  return blinks;
}

TEST(MapLabels, NamesDoNotFlickerWhileTheCameraMoves) {
  EXPECT_EQ(flickers([](int frame) { return seen_from(45.0, -8.0 + 0.05 * frame, 1.5e6); }, 240), 0);
  EXPECT_EQ(flickers([](int frame) { return seen_from(45.0, 0.0, 4.0e6 * std::pow(0.985, frame)); }, 240), 0);
}

TEST(MapLabels, ANameThatVanishedComesBackWhenTheCameraRests) {
  MapLabels labels({name("town", 0.0, 0.0, 1.0)}, earth().ellipsoid);
  LabelPage moving = page();
  moving.moves = true;
  ASSERT_EQ(texts(labels, seen_from(0.0, 0.0, 1.0e6), moving).size(), 1U);
  ASSERT_TRUE(texts(labels, seen_from(0.0, 20.0, 1.0e6), moving).empty());
  EXPECT_TRUE(texts(labels, seen_from(0.0, 0.0, 1.0e6), moving).empty());
  EXPECT_EQ(texts(labels, seen_from(0.0, 0.0, 1.0e6)).size(), 1U);
}

}  // namespace
}  // namespace terrella
