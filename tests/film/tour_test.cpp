#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "apps/flight/tour_flight.h"
#include "geo/body.h"
#include "geo/ellipsoid.h"
#include "streaming/objects/vector/kml_tours.h"

namespace terrella {
namespace {

std::string kml_of(const std::string& steps) {
  return R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">
<Document><Folder><gx:Tour><name>Alps</name><gx:Playlist>)" +
         steps + "</gx:Playlist></gx:Tour></Folder></Document></kml>";
}

std::string fly_to(const std::string& duration, const std::string& view) {
  return "<gx:FlyTo><gx:duration>" + duration + "</gx:duration><gx:flyToMode>smooth</gx:flyToMode>" + view +
         "</gx:FlyTo>";
}

std::string camera(const std::string& lon, const std::string& more = "") {
  return "<Camera><longitude>" + lon +
         "</longitude><latitude>46</latitude><altitude>5000</altitude><heading>90</heading><tilt>70</tilt>"
         "<altitudeMode>absolute</altitudeMode>" +
         more + "</Camera>";
}

TEST(Tour, HasItsViewsAtTheirTimes) {
  const auto read =
      read_tours(kml_of(fly_to("5", camera("7")) + fly_to("4", camera("8")) +
                        "<gx:Wait><gx:duration>2.5</gx:duration></gx:Wait>" + fly_to("1.5", camera("9"))));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->tours.size(), 1U);
  EXPECT_EQ(read->tours[0].name, "Alps");
  EXPECT_TRUE(read->complaints.empty());
  const auto flights = flights_of(read->tours);
  ASSERT_EQ(flights.size(), 1U);
  // The way to the first view is not flown: a film begins there.
  EXPECT_EQ(flights[0].times(), (std::vector{0.0, 4.0, 6.5, 8.0}));
  for (const double waiting_s : {4.0, 5.0, 6.5}) EXPECT_NEAR(flights[0].at(waiting_s).camera.eye.lon.deg(), 8.0, 1e-9);
  const Camera first = flights[0].at(0.0).camera;
  EXPECT_NEAR(first.eye.height_m, 5000.0, 1e-6);
  EXPECT_NEAR(first.heading.deg(), 90.0, 1e-9);
  EXPECT_NEAR(first.pitch.deg(), -20.0, 1e-9);
}

/// The eye of a LookAt is its range away from the point, sees it in the middle of the picture, from the stated side.
TEST(Tour, LooksAtAPoint) {
  const auto read =
      read_tours(kml_of(fly_to("1",
                               "<LookAt><longitude>8</longitude><latitude>46.5</latitude><altitude>900</altitude>"
                               "<heading>300</heading><tilt>60</tilt><range>20000</range>"
                               "<altitudeMode>absolute</altitudeMode></LookAt>")));
  ASSERT_TRUE(read) << read.error().message;
  const Camera seen = flights_of(read->tours)[0].at(0.0).camera;
  const Ellipsoid& ellipsoid = earth().ellipsoid;
  const glm::dvec3 eye = ellipsoid.to_ecef(seen.eye).xyz_m;
  const glm::dvec3 point =
      ellipsoid.to_ecef({.lat = Angle::degrees(46.5), .lon = Angle::degrees(8.0), .height_m = 900.0}).xyz_m;
  EXPECT_NEAR(glm::length(point - eye), 20000.0, 1e-3);
  // Seen from the point, the eye stands 30° over the horizon, towards 120°.
  const glm::dvec3 up = Ellipsoid::normal(Angle::degrees(46.5), Angle::degrees(8.0)).xyz;
  EXPECT_NEAR(glm::dot(glm::normalize(eye - point), up), 0.5, 1e-6);
  EXPECT_GT(seen.eye.lon.deg(), 8.1);
  EXPECT_LT(seen.eye.lat.deg(), 46.5);
  EXPECT_NEAR(std::remainder(seen.heading.deg() - 300.0, 360.0), 0.0, 0.2);  // meridians converge by 0.15° on the way
}

/// Without an altitudeMode the point of a LookAt lies on the ground.
TEST(Tour, PointOnTheGround) {
  const auto read = read_tours(kml_of(fly_to("1",
                                             "<LookAt><longitude>8</longitude><latitude>46</latitude>"
                                             "<altitude>900</altitude><range>20000</range></LookAt>")));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(flights_of(read->tours)[0].at(0.0).camera.eye.height_m, 20000.0, 1e-3);
}

TEST(Tour, JumpsWithoutADuration) {
  const auto read = read_tours(kml_of(fly_to("0", camera("7")) + fly_to("2", camera("8")) + fly_to("0", camera("100")) +
                                      fly_to("3", camera("101"))));
  ASSERT_TRUE(read) << read.error().message;
  const auto flights = flights_of(read->tours);
  ASSERT_EQ(flights.size(), 2U);
  EXPECT_EQ(flights[0].duration_s(), 2.0);
  EXPECT_EQ(flights[1].duration_s(), 3.0);
  EXPECT_NEAR(flights[1].at(0.0).camera.eye.lon.deg(), 100.0, 1e-9);
}

/// A duration that the time so far swallows is none: two keyframes at one time have no way between them.
TEST(Tour, DurationsTooSmallToCount) {
  const auto read = read_tours(kml_of(fly_to("1", camera("7")) + fly_to("100000", camera("8")) +
                                      "<gx:Wait><gx:duration>1e-12</gx:duration></gx:Wait>" +
                                      fly_to("1e-12", camera("9")) + fly_to("1", camera("10"))));
  ASSERT_TRUE(read) << read.error().message;
  const auto flights = flights_of(read->tours);
  ASSERT_EQ(flights.size(), 2U);
  EXPECT_EQ(flights[0].times(), (std::vector{0.0, 100000.0}));
  EXPECT_NEAR(flights[1].at(0.5).camera.eye.lon.deg(), 9.5, 0.1);
}

TEST(Tour, SunFollowsTheViewsThatAllHaveATime) {
  const auto with = [](const std::string& when) { return "<gx:TimeStamp><when>" + when + "</when></gx:TimeStamp>"; };
  const std::string first = fly_to("1", camera("7", with("2026-06-21T08:00:00Z")));
  const auto read = read_tours(kml_of(first + fly_to("1", camera("8", with("2026-06-21T10:00:00Z")))));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(flights_of(read->tours)[0].at(0.0).sun, *parse_utc("2026-06-21T08:00Z"));
  const auto some = read_tours(kml_of(first + fly_to("1", camera("8"))));
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_FALSE(flights_of(some->tours)[0].at(0.0).sun);
}

TEST(Tour, NamesWhatIsLeftOut) {
  const auto read =
      read_tours(kml_of(fly_to("1", camera("7", "<roll>10</roll>")) + "<gx:SoundCue><href>a.mp3</href></gx:SoundCue>" +
                        "<gx:SoundCue><href>b.mp3</href></gx:SoundCue>" + "<gx:FlyTo/>" +
                        fly_to("1", "<Camera><altitudeMode>relativeToGround</altitudeMode></Camera>")));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->complaints, (std::vector<std::string>{"roll of views is left out", "SoundCue of tours is left out",
                                                        "FlyTo without a Camera or a LookAt is left out",
                                                        "heights over the ground or the sea floor count from the "
                                                        "ellipsoid"}));
}

TEST(Tour, RefusesWhatIsNoView) {
  const auto says = [](const std::string& steps) {
    const auto read = read_tours(kml_of(steps));
    return read ? std::string("read") : read.error().message;
  };
  EXPECT_EQ(says(fly_to("1", camera("7e3"))),
            "its tour \"Alps\": view 1: longitude \"7e3\" is not a number in -360...360");
  EXPECT_EQ(says(fly_to("-1", camera("7"))), "its tour \"Alps\": duration \"-1\" is not a number in 0...1000000");
  EXPECT_EQ(says(fly_to("nan", camera("7"))), "its tour \"Alps\": duration \"nan\" is not a number in 0...1000000");
  EXPECT_NE(says(fly_to("1", camera("7", "<TimeStamp><when>noon</when></TimeStamp>"))).find("TimeStamp"),
            std::string::npos);
  EXPECT_NE(says("<gx:FlyTo>").find("it is no XML"), std::string::npos);
}

}  // namespace
}  // namespace terrella
