#include "objects/graticule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "geo/body.h"
#include "view/surface_pin.h"

namespace terrella {
namespace {

constexpr double kOnLine_px =
    0.01;                          // points are projected in double; picking them back loses no more away from the limb
constexpr double kChord_px = 0.5;  // between points, the header's promise

View view_of(double lat, double lon, double height_m, double heading = 0.0, double pitch = -90.0,
             Viewport viewport = {1024, 768}) {
  const Camera camera{.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
                      .heading = Angle::degrees(heading),
                      .pitch = Angle::degrees(pitch)};
  return make_view(camera, earth().ellipsoid, viewport);
}

constexpr double kFinest_deg = 0.001;  // every line's degrees are a multiple of it

/// Pixels from a point of the picture to a parallel (`axis` 0) or a meridian (1); nothing outside the planet.
double off_line_px(const View& view, glm::dvec2 px, int axis, double deg) {
  const Grab there = grab(view, earth().ellipsoid, px);
  if (!there.on_surface) return 0.0;  // the limb's own end points
  Geodetic place = earth().ellipsoid.to_geodetic(there.point);
  (axis == 0 ? place.lat : place.lon) = Angle::degrees(deg);
  const auto seen = project(view, earth().ellipsoid.to_ecef(place));
  return seen ? glm::distance(*seen, px) : HUGE_VAL;
}

/// The parallel or meridian of round degrees on which the line's inner points lie, and how many pixels they are off.
double off_round_px(const View& view, const GraticuleLine& line, double spacing_deg) {
  double best = HUGE_VAL;
  for (const int axis : {0, 1}) {
    const Grab there = grab(view, earth().ellipsoid, line.points_px[line.points_px.size() / 2]);
    const Geodetic place = earth().ellipsoid.to_geodetic(there.point);
    const double deg = spacing_deg * std::round((axis == 0 ? place.lat : place.lon).deg() / spacing_deg);
    double worst = 0.0;
    for (std::size_t i = 1; i + 2 < line.points_px.size(); ++i) {
      const double at = off_line_px(view, line.points_px[i], axis, deg);
      const double between = off_line_px(view, 0.5 * (line.points_px[i] + line.points_px[i + 1]), axis, deg);
      worst = std::max({worst, at / kOnLine_px, between / kChord_px});
    }
    best = std::min(best, worst);
  }
  return best;
}

bool has_label(const Graticule& net, const std::string& text) {
  return std::ranges::any_of(net.labels, [&](const GraticuleLabel& l) { return l.text == text; });
}

TEST(Graticule, LiesOnRoundLatitudesAndLongitudes) {
  for (const View& view : {view_of(20, 10, 1.5e7), view_of(46, 179.9, 3e5, 30, -35), view_of(89.5, 0, 2e6),
                           view_of(-33, -70, 5e3, 100, -60), view_of(10, 20, 200)}) {
    const Graticule net = make_graticule(view, earth().ellipsoid);
    ASSERT_FALSE(net.lines.empty());
    for (const GraticuleLine& line : net.lines) {
      ASSERT_GE(line.points_px.size(), 2U);
      EXPECT_LT(off_round_px(view, line, kFinest_deg), 1.0);
    }
  }
}

// Pixels between neighbouring lines that cross a row or a column of the picture.
std::vector<double> gaps(const Graticule& net, int axis, double value, double most) {
  std::vector<double> at;
  for (const GraticuleLine& line : net.lines) {
    for (std::size_t i = 1; i < line.points_px.size(); ++i) {
      const double a = line.points_px[i - 1][axis] - value, b = line.points_px[i][axis] - value;
      if ((a < 0.0) == (b < 0.0)) continue;
      const glm::dvec2 px = line.points_px[i - 1] + (line.points_px[i] - line.points_px[i - 1]) * (a / (a - b));
      if (px[1 - axis] > 0.0 && px[1 - axis] < most) at.push_back(px[1 - axis]);
    }
  }
  std::ranges::sort(at);
  std::vector<double> out;
  for (std::size_t i = 1; i < at.size(); ++i) out.push_back(at[i] - at[i - 1]);
  return out;
}

// With one spacing for the whole picture, lines stood 2 px apart at the horizon and there were none in front.
TEST(Graticule, HasRoomBetweenItsLinesFromTheForegroundToTheHorizon) {
  const View view = view_of(36, -5, 1.5e5, 60, -12, {1280, 800});
  const Graticule net = make_graticule(view, earth().ellipsoid);
  // Rows from the lower edge to just under the horizon, which lies 17 px over the middle.
  for (const double y : {780.0, 700.0, 600.0, 500.0, 430.0}) {
    std::vector<double> found = gaps(net, 1, y, 1280.0);
    ASSERT_GE(found.size(), 2U) << "at row " << y << " there are hardly any lines";
    std::ranges::nth_element(found, found.begin() + std::ptrdiff_t(found.size() / 2));
    EXPECT_GT(found[found.size() / 2], 15.0) << "at row " << y << " the lines run together";
    EXPECT_LT(std::ranges::max(found), 700.0) << y;
  }
}

TEST(Graticule, GetsFinerTowardsTheGround) {
  double last = 31.0;
  for (const double height_m : {1e8, 1e7, 1e6, 1e5, 1e4, 1e3}) {
    const Graticule net = make_graticule(view_of(10, 20, height_m), earth().ellipsoid);
    EXPECT_LT(net.parallels_deg, last) << height_m;
    last = net.parallels_deg;
  }
  EXPECT_DOUBLE_EQ(last, 0.001);
}

TEST(Graticule, EndsAtTheLimb) {
  const View view = view_of(0, 0, 1.5e7);
  const glm::dvec2 centre(512, 384);
  double farthest = 0.0;
  for (const GraticuleLine& line : make_graticule(view, earth().ellipsoid).lines) {
    for (const glm::dvec2 px : line.points_px) {
      farthest = std::max(farthest, glm::distance(px, centre));
      const glm::dvec2 inwards = px + (centre - px) * 1e-3;
      EXPECT_TRUE(grab(view, earth().ellipsoid, inwards).on_surface);
    }
  }
  const double ratio = 6378137.0 / (6378137.0 + 1.5e7);
  const double limb_px = view.pixels_per_radian() * std::tan(std::asin(ratio));
  EXPECT_NEAR(farthest, limb_px, 0.5);
}

TEST(Graticule, NamesItsLines) {
  const Graticule globe = make_graticule(view_of(10, 0, 1.5e7), earth().ellipsoid);
  for (const char* text : {"0°", "30° N", "30° S", "30° E", "30° W"}) EXPECT_TRUE(has_label(globe, text)) << text;
  const Graticule near = make_graticule(view_of(46.02, 7.75, 5e3), earth().ellipsoid);
  EXPECT_TRUE(has_label(near, "46.020° N"));
  EXPECT_TRUE(has_label(near, "7.75° E"));
  const Graticule seam = make_graticule(view_of(10, 179.5, 1e6), earth().ellipsoid);
  EXPECT_TRUE(has_label(seam, "180°"));
  EXPECT_TRUE(has_label(seam, "179° W") || has_label(seam, "178° W"));
}

TEST(Graticule, KeepsLabelsApartAndInThePicture) {
  const LabelSize size{.character_px = 9.0, .line_px = 18.0, .foot_px = 50.0};
  for (const View& view : {view_of(20, 10, 1.5e7), view_of(46, 179.9, 3e5, 30, -35), view_of(90, 0, 2e6)}) {
    const Graticule net = make_graticule(view, earth().ellipsoid, size);
    ASSERT_FALSE(net.labels.empty());
    for (std::size_t i = 0; i < net.labels.size(); ++i) {
      EXPECT_LE(net.labels[i].at_px.y, 768.0 - 50.0 + 18.0);
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT(glm::distance(net.labels[i].at_px, net.labels[j].at_px), 9.0);
      }
    }
  }
}

TEST(Graticule, DrawsEachMeridianOnce) {
  const Graticule net = make_graticule(view_of(90, 0, 1.5e7), earth().ellipsoid);
  std::set<std::string> names;
  for (const GraticuleLabel& label : net.labels) EXPECT_TRUE(names.insert(label.text).second) << label.text;
  EXPECT_DOUBLE_EQ(net.meridians_deg, 30.0);
}

TEST(Graticule, StaysSmallEverywhere) {
  for (const double height_m : {-6.378137e6, -1e4, 0.0, 1.0, 1e3, 3e5, 1e9}) {
    for (const double pitch : {-90.0, -10.0, 0.0, 90.0}) {
      for (const Viewport viewport : {Viewport{1, 1}, Viewport{16384, 16}, Viewport{1024, 768}}) {
        const Graticule net = make_graticule(view_of(89.999, 180, height_m, 45, pitch, viewport), earth().ellipsoid);
        EXPECT_LT(net.lines.size(), 600U);
        for (const GraticuleLine& line : net.lines) {
          for (const glm::dvec2 px : line.points_px) EXPECT_TRUE(std::isfinite(px.x) && std::isfinite(px.y));
        }
      }
    }
  }
}

double arc_deg(const EcefDir& a, const EcefDir& b) {
  return Angle::radians(2.0 * std::asin(0.5 * glm::distance(a.xyz, b.xyz))).deg();
}

TEST(Graticule, AsALayerIsTheWholePlanetsAndItsLinesAreNearWhereTheyShould) {
  constexpr double kOffParallel_deg = 0.0003;  // the header's promise
  const ObjectScene net = graticule_objects({.spacing_deg = 30.0, .height_m = 100.0, .width_px = 3.0F});
  ASSERT_EQ(net.lines.size(), 5U + 12U);
  for (const LineObject& line : net.lines) {
    EXPECT_EQ(line.width_px, 3.0F);
    const bool parallel = line.places[0].lat == line.places[1].lat;
    for (std::size_t k = 0; k < line.places.size(); ++k) {
      const Geodetic& at = line.places[k];
      EXPECT_EQ(at.height_m, 100.0);
      const double deg = parallel ? at.lat.deg() : at.lon.deg();
      EXPECT_NEAR(deg, 30.0 * std::round(deg / 30.0), 1e-9);
      if (!parallel || k == 0) continue;
      const EcefDir a = Ellipsoid::normal(line.places[k - 1].lat, line.places[k - 1].lon),
                    b = Ellipsoid::normal(at.lat, at.lon), between{glm::normalize(a.xyz + b.xyz)};
      const EcefDir on = Ellipsoid::normal(at.lat, Angle::degrees(at.lon.deg() - 0.25));
      EXPECT_LE(arc_deg(between, on), kOffParallel_deg);
    }
  }
  std::set<std::string> texts;
  for (const LabelObject& label : net.labels) texts.insert(label.text);
  EXPECT_EQ(texts.size(), 4U + 12U);
  for (const char* text : {"60° N", "30° S", "0°", "150° W", "30° E", "180°"})
    EXPECT_TRUE(texts.contains(text)) << text;
  EXPECT_TRUE(graticule_objects({.labels = false}).labels.empty());
}

TEST(Graticule, AsALayerItsSpacingDivides90) {
  const auto lines = [](double spacing_deg) { return graticule_objects({.spacing_deg = spacing_deg}).lines.size(); };
  EXPECT_EQ(lines(90.0), 1U + 4U);
  EXPECT_EQ(lines(15.0), 11U + 24U);
  EXPECT_EQ(lines(17.0), lines(18.0)) << "five a quarter";
  EXPECT_EQ(lines(1.0), lines(0.01));
  EXPECT_EQ(lines(1.0), 179U + 360U);
}

}  // namespace
}  // namespace terrella
