// Lines that grow, objects that get another shape, dashes, casings and arrows.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "objects/layer_objects.h"
#include "tests/facade/caller_scene.h"

namespace terrella::test {
namespace {

constexpr Viewport kShot{400, 300};
constexpr ObjectColor kInk{240, 0, 0}, kGlass{220, 20, 20, 128}, kBlue{0, 0, 230};
const Color kMeadow{0, 160, 0};
constexpr ObjectId kTrack{7};
constexpr double kLat = 46.0, kLon = 7.0, kHeight_m = 2e5, kPixel_m = 485.3;  // 2 · kHeight_m · tan 20° / 300

/// Places of a way through the picture.
Geodetic place_at(int k, double height_m) {
  const double t = 0.01 * k;
  return {Angle::degrees(kLat + 0.4 * std::sin(3.0 * t)), Angle::degrees(kLon + 0.9 * std::sin(2.2 * t - 0.8)),
          height_m};
}
std::vector<Geodetic> places(int first, int end, double height_m) {
  std::vector<Geodetic> all;
  for (int k = first; k < end; ++k) all.push_back(place_at(k, height_m));
  return all;
}

/// A kind of line: on the ground, over it, and each part of its look.
struct Look {
  const char* name;
  double height_m = 0.0;
  HeightMode heights = HeightMode::absolute;
  LineDashes dashes = {};
  float casing_px = 0.0F;
  ObjectColor color = kInk;
};
const Look kLooks[] = {{"on the ellipsoid"},
                       {"draped", 0.0, HeightMode::clamp_to_ground},
                       {"over the ground", 500.0},
                       {"translucent, on the ellipsoid", 0.0, HeightMode::absolute, {}, 0.0F, kGlass},
                       {"translucent, over the ground", 500.0, HeightMode::absolute, {}, 0.0F, kGlass},
                       {"dashed, on the ellipsoid", 0.0, HeightMode::absolute, {20.0F, 10.0F}},
                       {"dashed, over the ground", 500.0, HeightMode::absolute, {20.0F, 10.0F}},
                       {"with a casing, on the ellipsoid", 0.0, HeightMode::absolute, {}, 2.0F},
                       {"with a casing, over the ground", 500.0, HeightMode::absolute, {}, 2.0F}};

LineObject line_of(const Look& look, std::vector<Geodetic> way) {
  return {.places = std::move(way),
          .width_px = 4.0F,
          .color = look.color,
          .of = {.id = kTrack},
          .heights = look.heights,
          .dashes = look.dashes,
          .casing_px = look.casing_px,
          .casing = kBlue};
}

class LivingLinesTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    globe_ = *Globe::create(unlit_options(), one_colour({.tile_px = 16, .max_level = 1}, kMeadow));
    globe_->set_camera(camera_at(kLat, kLon, kHeight_m));
  }
  LayerId add(std::vector<LineObject> lines) {
    ObjectScene scene;
    scene.lines = std::move(lines);
    return *globe_->add_objects(std::move(scene));
  }
  Picture show() {
    settle(*globe_, kShot);
    return picture();
  }
  Picture whole(const Look& look, std::vector<Geodetic> way) {
    const LayerId layer = add({line_of(look, std::move(way))});
    Picture shot = show();
    EXPECT_TRUE(globe_->remove(layer));
    return shot;
  }
  void edit(LayerId layer, ObjectEdits edits) {
    const Status done = globe_->edit_objects(layer, std::move(edits));
    EXPECT_TRUE(done) << done.error().message;
  }
  void draw() { static_cast<void>(GlTest::draw(*globe_, kShot)); }

  std::unique_ptr<Globe> globe_;
};

int most_difference(const Picture& a, const Picture& b) {
  int most = 0;
  for (std::size_t k = 0; k < a.rgba.size(); ++k) most = std::max(most, std::abs(int(a.rgba[k]) - int(b.rgba[k])));
  return most;
}
int count(const Picture& shot, const Color& color) {
  int sum = 0;
  for (int k = 0; k < kShot.width_px * kShot.height_px; ++k) {
    sum += shot.at(k % kShot.width_px, k / kShot.width_px) == color ? 1 : 0;
  }
  return sum;
}
const Color kPlainInk{kInk.red, kInk.green, kInk.blue};

/// Expects the same picture of a line that grew and of one that did not. Over the ground, the same vertices make the
/// same pixels; dashes of parts round their lengths. On the ground, the edge of a joint may be off by a quarter of a
/// pixel.
void expect_same(const Look& look, const Picture& truth, const Picture& grown) {
  const bool on_ground = look.height_m == 0.0;
  const int same = on_ground || look.dashes.off_px == 0.0F ? 2 : 24;
  int others = 0;
  for (int k = 0; k < kShot.width_px * kShot.height_px; ++k) {
    const Color a = truth.at(k % kShot.width_px, k / kShot.width_px),
                b = grown.at(k % kShot.width_px, k / kShot.width_px);
    int most = 0;
    for (std::size_t part = 0; part < 3; ++part) most = std::max(most, std::abs(a[part] - b[part]));
    others += most > same ? 1 : 0;
    EXPECT_LE(most, on_ground ? 60 : same) << k % kShot.width_px << ", " << k / kShot.width_px;
  }
  EXPECT_LE(others, on_ground ? 4 : 0);
}

TEST_F(LivingLinesTest, GrowthDrawsWhatALineAddedWholeDraws) {
  constexpr int kPlaces = 80;
  for (const Look& look : kLooks) {
    SCOPED_TRACE(look.name);
    const Picture truth = whole(look, places(0, kPlaces, look.height_m));
    for (const int first : {2, 37}) {
      const LayerId layer = add({line_of(look, places(0, first, look.height_m))});
      draw();
      for (int k = first; k < kPlaces; ++k) {
        edit(layer, {.growths = {{.id = kTrack, .append = {place_at(k, look.height_m)}}}});
        if (k % 3 == 0) draw();
      }
      const Picture grown = show();
      expect_same(look, truth, grown);
      EXPECT_TRUE(globe_->remove(layer));
    }
    EXPECT_GT(most_difference(truth, show()), 100);
  }
}

TEST_F(LivingLinesTest, AStartThatIsCutIsNotDrawn) {
  for (const Look& look : kLooks) {
    if (look.dashes.off_px > 0.0F) continue;  // dashes keep their places
    SCOPED_TRACE(look.name);
    const LayerId layer = add({line_of(look, places(0, 70, look.height_m))});
    draw();
    edit(layer, {.growths = {{.id = kTrack, .drop_first = 25}}});
    draw();
    edit(layer, {.growths = {{.id = kTrack, .append = places(70, 90, look.height_m), .drop_first = 22}}});
    const Picture cut = show();
    edit(layer, {.growths = {{.id = kTrack, .drop_first = 1000}}});
    const Picture none = show();
    edit(layer, {.growths = {{.id = kTrack, .append = places(3, 30, look.height_m)}}});
    const Picture again = show();
    EXPECT_TRUE(globe_->remove(layer));
    expect_same(look, whole(look, places(47, 90, look.height_m)), cut);
    EXPECT_EQ(most_difference(none, show()), 0);
    expect_same(look, whole(look, places(3, 30, look.height_m)), again);
  }
}

// The memory of parts that have gone is used again; the indices of those that are left change then.
TEST_F(LivingLinesTest, ManyGrowthsKeepTheWay) {
  for (const double height_m : {0.0, 500.0}) {
    const Look look{"", height_m};
    const LayerId layer = add({line_of(look, places(0, 2, height_m))});
    std::mt19937 random(5);
    int first = 0, end = 2;
    while (end < 30'000) {
      LineGrowth growth{.id = kTrack};
      const int more = static_cast<int>(random() % 60), fewer = static_cast<int>(random() % 60);
      growth.append = places(end, end + more, height_m);
      end += more;
      growth.drop_first = static_cast<std::size_t>(std::max(0, std::min(fewer, end - first - 40)));
      first += static_cast<int>(growth.drop_first);
      edit(layer, {.growths = {std::move(growth)}});
      if (random() % 50 == 0) draw();
    }
    const Picture grown = show();
    EXPECT_TRUE(globe_->remove(layer));
    expect_same(look, whole(look, places(first, end, height_m)), grown);
  }
}

TEST_F(LivingLinesTest, EditsAndPicksMeanTheWholeLine) {
  for (const double height_m : {0.0, 500.0}) {
    const Look look{"", height_m};
    const LayerId layer = add({line_of(look, places(0, 40, height_m))});
    draw();
    const auto picked = [&](int k) {
      const auto px = globe_->project(place_at(k, height_m), kShot);
      return px && globe_->pick(*px, kShot).object.value_or(PickedObject{}).of.id == kTrack;
    };
    EXPECT_TRUE(picked(20));
    EXPECT_FALSE(picked(100));
    edit(layer, {.growths = {{.id = kTrack, .append = places(40, 110, height_m), .drop_first = 30}}});
    draw();
    EXPECT_FALSE(picked(20));
    EXPECT_TRUE(picked(100));
    EXPECT_TRUE(picked(60));
    EXPECT_EQ(globe_->pick(*globe_->project(place_at(100, height_m), kShot), kShot).object->index, 0U);
    edit(layer, {.changes = {{.id = kTrack, .color = kBlue}}});
    const Picture blue = show();
    EXPECT_EQ(count(blue, kPlainInk), 0);
    EXPECT_GT(count(blue, {kBlue.red, kBlue.green, kBlue.blue}), 200);
    edit(layer, {.changes = {{.id = kTrack, .visible = false}}});
    EXPECT_EQ(count(show(), kMeadow), kShot.width_px * kShot.height_px);
    edit(layer, {.growths = {{.id = kTrack, .append = places(110, 150, height_m)}}});
    EXPECT_EQ(count(show(), kMeadow), kShot.width_px * kShot.height_px);
    edit(layer, {.remove = {kTrack}});
    EXPECT_FALSE(globe_->edit_objects(layer, {.growths = {{.id = kTrack, .append = places(0, 2, height_m)}}}));
    EXPECT_TRUE(globe_->remove(layer));
  }
}

TEST_F(LivingLinesTest, AnotherShapeIsDrawnInPlaceOfTheEarlier) {
  for (const Look& look : kLooks) {
    SCOPED_TRACE(look.name);
    const LayerId layer = add({line_of(look, places(0, 40, look.height_m))});
    draw();
    edit(layer, {.growths = {{.id = kTrack, .append = places(40, 80, look.height_m)}}});
    draw();
    edit(layer, {.shapes = {{.id = kTrack, .ways = {places(100, 150, look.height_m)}}}});
    const Picture other = show();
    edit(layer, {.growths = {{.id = kTrack, .append = places(150, 160, look.height_m)}}});
    const Picture grown = show();
    EXPECT_TRUE(globe_->remove(layer));
    EXPECT_EQ(most_difference(other, whole(look, places(100, 150, look.height_m))), 0);
    expect_same(look, whole(look, places(100, 160, look.height_m)), grown);
  }
  for (const double height_m : {0.0, 500.0}) {
    const auto area = [&](double size_deg) {
      std::vector<Geodetic> ring;
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        ring.push_back({Angle::degrees(kLat + size_deg * y), Angle::degrees(kLon + size_deg * x), height_m});
      }
      return PolygonObject{.rings = {ring}, .fill = kGlass, .stroke = kInk, .of = {.id = kTrack}};
    };
    const LayerId layer = *globe_->add_objects({.polygons = {area(0.2)}});
    draw();
    edit(layer, {.shapes = {{.id = kTrack, .ways = area(0.3).rings}}});
    const Picture other = show();
    EXPECT_TRUE(globe_->remove(layer));
    const LayerId truth = *globe_->add_objects({.polygons = {area(0.3)}});
    EXPECT_EQ(most_difference(other, show()), 0);
    EXPECT_TRUE(globe_->remove(truth));
  }
}

TEST_F(LivingLinesTest, FeaturesWithoutOneLineAreNamed) {
  const Look look{""};
  LineObject other = line_of(look, places(0, 5, 0.0));
  other.of.id = ObjectId{8};
  const LayerId layer = add({line_of(look, places(0, 10, 0.0)), other, other});
  const auto refused = [&](ObjectEdits edits, const std::string& what) {
    const Status done = globe_->edit_objects(layer, std::move(edits));
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find(what), std::string::npos) << done.error().message;
  };
  refused({.growths = {{.id = ObjectId{9}, .append = places(0, 2, 0.0)}}}, "9");
  refused({.growths = {{.id = ObjectId{8}, .append = places(0, 2, 0.0)}}}, "8");
  refused({.shapes = {{.id = ObjectId{8}, .ways = {places(0, 2, 0.0)}}}}, "8");
  refused({.shapes = {{.id = kTrack, .ways = {places(0, 2, 0.0), places(4, 6, 0.0)}}}}, "one way");
  refused({.growths = {{.id = kTrack, .append = {{Angle::degrees(91.0), {}, 0.0}}}}}, "growths");
  refused({.shapes = {{.id = kTrack, .ways = {{{Angle::degrees(NAN), {}, 0.0}}}}}}, "shapes");
  LineObject bad = line_of(look, places(0, 2, 0.0));
  bad.dashes = {5.0F, 0.0F};
  const auto not_added = globe_->add_objects({.lines = {bad}});
  ASSERT_FALSE(not_added);
  EXPECT_NE(not_added.error().message.find("gaps"), std::string::npos) << not_added.error().message;
}

/// Pixels of a row that have a colour.
std::vector<bool> row_of(const Picture& shot, int y) {
  std::vector<bool> on;
  for (int x = 0; x < kShot.width_px; ++x) on.push_back(shot.at(x, y)[0] > 120);
  return on;
}

// Lengths are powers of two on the ground, and a picture's texels are 0.7 to 1.4 of a pixel.
TEST_F(LivingLinesTest, DashesHaveTheirLengthWithinAFactorOf1p42) {
  constexpr LineDashes kDashes{20.0F, 10.0F};
  for (const double height_m : {0.0, 500.0}) {
    for (const double away_m : {1.3e5, 2e5, 2.6e5, 3.3e5}) {
      SCOPED_TRACE(testing::Message() << height_m << " m, from " << away_m << " m");
      globe_->set_camera(camera_at(kLat, kLon, away_m));
      const double span_deg = 0.4 * away_m / 2e5;
      const LayerId layer = add({line_of({"", height_m, HeightMode::absolute, kDashes},
                                         {{Angle::degrees(kLat), Angle::degrees(kLon - span_deg), height_m},
                                          {Angle::degrees(kLat), Angle::degrees(kLon + span_deg), height_m}})});
      const std::vector<bool> on = row_of(show(), kShot.height_px / 2);
      EXPECT_TRUE(globe_->remove(layer));
      std::vector<int> starts;
      for (std::size_t x = 1; x < on.size(); ++x) {
        if (on[x] && !on[x - 1]) starts.push_back(static_cast<int>(x));
      }
      ASSERT_GE(starts.size(), 3U);
      const double period_px = double(starts.back() - starts.front()) / double(starts.size() - 1);
      EXPECT_GT(period_px, 30.0 / 1.42 - 0.5);
      EXPECT_LT(period_px, 30.0 * 1.42 + 0.5);
      const auto covered = std::count(on.begin() + starts.front(), on.begin() + starts.back(), true);
      EXPECT_NEAR(double(covered) / (starts.back() - starts.front()), 2.0 / 3.0, 0.07);
    }
  }
}

// A column through two lines that cross: line, casing, ground.
TEST_F(LivingLinesTest, CasingsLieBelowAllLines) {
  for (const double height_m : {0.0, 500.0}) {
    SCOPED_TRACE(height_m);
    const Look look{"", height_m, HeightMode::absolute, {}, 3.0F};
    const auto across = [&](double lat, double lon) {
      return line_of(look, {{Angle::degrees(kLat - lat), Angle::degrees(kLon - lon), height_m},
                            {Angle::degrees(kLat + lat), Angle::degrees(kLon + lon), height_m}});
    };
    LineObject meridian = across(0.3, 0.0);
    meridian.of.id = ObjectId{8};
    add({across(0.0, 0.4), meridian});
    const Picture shot = show();
    const int cx = kShot.width_px / 2, cy = kShot.height_px / 2;
    const auto profile = [&](int x, int y) {
      int red = 0, blue = 0;
      for (int k = -12; k <= 12; ++k) {
        const Color at = x == cx ? shot.at(x + k, y) : shot.at(x, y + k);
        red += at[0] > 120 ? 1 : 0;
        blue += at[2] > 115 ? 1 : 0;
      }
      return std::pair(red, blue);
    };
    for (const int away : {-60, 60}) {
      for (const auto& [red, blue] : {profile(cx + away, cy), profile(cx, cy + away)}) {
        EXPECT_NEAR(red, 4, 1);
        EXPECT_NEAR(blue, 6, 1);
      }
    }
    // Over the ground, the smooth edge of the nearer line hides the other: a pixel on each side.
    int along_x = 0, along_y = 0;
    for (int k = -20; k <= 20; ++k) {
      along_x += shot.at(cx + k, cy)[0] > 120 ? 1 : 0;
      along_y += shot.at(cx, cy + k)[0] > 120 ? 1 : 0;
    }
    EXPECT_GE(along_x, 39);
    EXPECT_GE(along_y, 39);
    for (const LayerId layer : globe_->objects()) EXPECT_TRUE(globe_->remove(layer));
  }
}

// A cased line keeps its casing beside a line that it crosses. Distances are those to straight lines of the
// picture, straight down from where a degree has the same length along both.
TEST_F(LivingLinesTest, CasedLinesThatCrossAtASlantKeepTheirCasings) {
  constexpr double kHalfInk_px = 2.0, kHalfCasing_px = 6.0, kOff_px = 1.0;  // pixels nearer to an edge are mixed
  constexpr int kPart_px = 40;                                              // around the crossing
  for (const double slope : {0.15, 0.4, 1.0}) {
    SCOPED_TRACE(testing::Message() << "slope " << slope);
    globe_->set_camera(camera_at(0.0, kLon, kHeight_m));
    std::vector<LineObject> both;
    for (const double sign : {-1.0, 1.0}) {
      const double dlon = 0.4, dlat = sign * slope * dlon;
      const auto at = [&](double part) {
        return Geodetic{Angle::degrees(part * dlat), Angle::degrees(kLon + part * dlon), 0.0};
      };
      both.push_back(line_of({"", 0.0, HeightMode::absolute, {}, static_cast<float>(kHalfCasing_px - kHalfInk_px)},
                             {at(-1.0), at(1.0)}));
    }
    const std::array<Geodetic, 2> ends{both[0].places[1], both[1].places[1]};
    const LayerId layer = add(std::move(both));
    const Picture shot = show();
    const glm::dvec2 middle = *globe_->project({{}, Angle::degrees(kLon), 0.0}, kShot);
    std::array<glm::dvec2, 2> across;
    for (std::size_t k = 0; k < 2; ++k) {
      const glm::dvec2 way = glm::normalize(*globe_->project(ends[k], kShot) - middle);
      across[k] = {-way.y, way.x};
    }
    EXPECT_TRUE(globe_->remove(layer));
    int wrong = 0, inks = 0, casings = 0;
    for (int y = kShot.height_px / 2 - kPart_px; y < kShot.height_px / 2 + kPart_px; ++y) {
      for (int x = kShot.width_px / 2 - kPart_px; x < kShot.width_px / 2 + kPart_px; ++x) {
        const glm::dvec2 from = glm::dvec2(x + 0.5, y + 0.5) - middle;
        const double a = std::abs(glm::dot(across[0], from)), b = std::abs(glm::dot(across[1], from));
        const double nearest = std::min(a, b);
        const auto beside = [&](double edge) { return std::min(std::abs(a - edge), std::abs(b - edge)) < kOff_px; };
        if (beside(kHalfInk_px) || beside(kHalfCasing_px)) continue;
        const Color expected = nearest < kHalfInk_px      ? kPlainInk
                               : nearest < kHalfCasing_px ? Color{kBlue.red, kBlue.green, kBlue.blue}
                                                          : kMeadow;
        inks += nearest < kHalfInk_px ? 1 : 0;
        casings += nearest >= kHalfInk_px && nearest < kHalfCasing_px ? 1 : 0;
        wrong += shot.at(x, y) == expected ? 0 : 1;
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inks, 100);
    EXPECT_GT(casings, 50);
  }
}

TEST_F(LivingLinesTest, ArrowsPointAlongTheLineAndFollowItsEnds) {
  for (const double height_m : {0.0, 500.0}) {
    SCOPED_TRACE(height_m);
    const auto east = [&](double lon) { return Geodetic{Angle::degrees(kLat), Angle::degrees(kLon + lon), height_m}; };
    LineObject line = line_of({"", height_m}, {east(-0.5), east(-0.2)});
    line.arrow_at_end = true;
    const LayerId layer = add({line});
    // The head is 24 px long and 19 px wide at its base, and its tip 6 px beyond the line's end.
    const auto head = [&](double end_deg) {
      const Picture shot = show();
      const glm::dvec2 end = *globe_->project(east(end_deg), kShot);
      const auto width = [&](double along) {
        int wide = 0;
        for (int y = 0; y < kShot.height_px; ++y) {
          wide += shot.at(static_cast<int>(end.x + along), y)[0] > 120 ? 1 : 0;
        }
        return wide;
      };
      EXPECT_NEAR(width(-16.0), 18, 2);
      EXPECT_NEAR(width(-4.0), 8, 2);
      EXPECT_EQ(width(7.5), 0);
      EXPECT_NEAR(width(-30.0), 4, 1);
      EXPECT_EQ(globe_->pick(end + glm::dvec2(-14.0, 8.0), kShot).object, std::nullopt);
    };
    head(-0.2);
    edit(layer, {.growths = {{.id = kTrack, .append = {east(0.1), east(0.4)}}}});
    head(0.4);
    edit(layer, {.shapes = {{.id = kTrack, .ways = {{east(-0.4), east(0.2)}}}}});
    head(0.2);
    edit(layer, {.moves = {{.id = kTrack, .place = east(0.5)}}});
    head(0.2);
    edit(layer, {.changes = {{.id = kTrack, .color = kBlue}}});
    EXPECT_EQ(count(show(), kPlainInk), 0);
    edit(layer, {.remove = {kTrack}});
    EXPECT_EQ(count(show(), kMeadow), kShot.width_px * kShot.height_px);
    EXPECT_TRUE(globe_->remove(layer));
  }
}

// Two workers may end in another order than they began.
TEST(LivingLines, AnEarlierCutThatComesLaterDoesNotCount) {
  const Ground ground{GlobeOptions{}.body.ellipsoid};
  const auto items = [&](bool in_order) {
    LayerObjects objects({.lines = {line_of({"", 500.0}, places(0, 10, 500.0))}}, ground, 1.0, kSelectedColor);
    CutObjects first = cut_objects(objects.take_job(), false);
    EXPECT_TRUE(objects.reshape({.id = kTrack, .ways = {places(50, 70, 500.0)}}));
    CutObjects second = cut_objects(objects.take_job(), false);
    objects.place(std::move(in_order ? first : second));
    objects.place(std::move(in_order ? second : first));
    std::size_t live = 0;
    for (std::size_t bucket = 0; bucket < Batch<char>::kBuckets; ++bucket) {
      live += objects.batches().lines.bucket(bucket).live;
    }
    return live;
  };
  EXPECT_EQ(items(true), items(false));
  EXPECT_GT(items(true), 20U);
}

}  // namespace
}  // namespace terrella::test
