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

/// How many pixels a picture point is off the nearest line of the net, by its latitude and longitude.
double off_net_px(const View& view, const Graticule& net, glm::dvec2 px) {
  const Grab there = grab(view, earth().ellipsoid, px);
  if (!there.on_surface) return 0.0;  // the limb's own end points
  const Geodetic place = earth().ellipsoid.to_geodetic(there.point);
  const double lat = net.parallels_deg * std::round(place.lat.deg() / net.parallels_deg);
  const double lon = net.meridians_deg * std::round(place.lon.deg() / net.meridians_deg);
  double off = HUGE_VAL;
  for (const Geodetic line : {Geodetic{.lat = Angle::degrees(lat), .lon = place.lon},
                              Geodetic{.lat = place.lat, .lon = Angle::degrees(lon)}}) {
    const auto seen = project(view, earth().ellipsoid.to_ecef(line));
    if (seen) off = std::min(off, glm::distance(*seen, px));
  }
  return off;
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
      for (std::size_t i = 1; i + 2 < line.points_px.size(); ++i) {
        EXPECT_LT(off_net_px(view, net, line.points_px[i]), kOnLine_px);
        EXPECT_LT(off_net_px(view, net, 0.5 * (line.points_px[i] + line.points_px[i + 1])), kChord_px);
      }
    }
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
        EXPECT_LT(net.lines.size(), 300U);
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
