#include "streaming/mosaic/overlay_list.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "streaming/objects/vector_objects.h"
#include "tests/mosaic/cells.h"

namespace terrella::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// A KML file of elements.
std::string kml(const std::string& elements) {
  return R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2" )"
         R"(xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>)" +
         elements + "</Document></kml>";
}

std::string overlay(const std::string& picture, const std::string& place, const std::string& more = "") {
  return fmt::format("<GroundOverlay><name>O</name>{}<Icon><href>{}</href></Icon>{}</GroundOverlay>", more, picture,
                     place);
}

std::string box(double north, double south, double east, double west, double rotation = 0.0) {
  return fmt::format(
      "<LatLonBox><north>{}</north><south>{}</south><east>{}</east><west>{}</west><rotation>{}</rotation></LatLonBox>",
      north, south, east, west, rotation);
}

class OverlayList : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  MosaicList read(const std::string& elements) const {
    auto list = read_overlay_list(write("o.kml", kml(elements)), {});
    EXPECT_TRUE(list) << list.error().message;
    return list ? *std::move(list) : MosaicList{};
  }

  const ScratchFolder folder_;
};

void expect_corners(const MosaicEntry& entry, const std::array<CrsPoint, 4>& expected) {
  ASSERT_TRUE(entry.corners);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR((*entry.corners)[i].x, expected[i].x, 1e-12) << i;
    EXPECT_NEAR((*entry.corners)[i].y, expected[i].y, 1e-12) << i;
  }
}

TEST_F(OverlayList, BoxesAndQuadsGoOnOver180) {
  const MosaicList list = read(
      overlay("a.png", box(20, 10, -170, 170)) + overlay("b.png", box(20, 10, 190, 170)) +
      overlay("c.png", "<gx:LatLonQuad><coordinates>170,10,0 -170,11 -171,21 169,20</coordinates></gx:LatLonQuad>"));
  ASSERT_THAT(list.entries, SizeIs(3));
  const std::array<CrsPoint, 4> expected{{{170, 10}, {190, 10}, {190, 20}, {170, 20}}};
  expect_corners(list.entries[0], expected);
  expect_corners(list.entries[1], expected);
  expect_corners(list.entries[2], {{{170, 10}, {190, 11}, {189, 21}, {169, 20}}});
  EXPECT_EQ(list.entries[0].path, folder_ / "a.png");
}

// A box of 2 by 1 km is flat within 1 m here, and 1 m is more than its corners may be off by the ellipsoid.
TEST_F(OverlayList, ATurnedBoxKeepsItsShape) {
  const double lat = 60.0, lon = 5.0, turn = 30.0;
  const double high = 1.0 / 111.2, wide = 2.0 / (111.2 * std::cos(lat * 3.14159265358979 / 180.0));
  const MosaicList list =
      read(overlay("a.png", box(lat + 0.5 * high, lat - 0.5 * high, lon + 0.5 * wide, lon - 0.5 * wide, turn)));
  ASSERT_THAT(list.entries, SizeIs(1));
  const auto& corners = *list.entries[0].corners;
  const std::array<double, 4> bearings = {243.435, 116.565, 63.435, 296.565};  // atan(2) from north, unturned
  for (std::size_t i = 0; i < corners.size(); ++i) {
    double metres = 0.0, bearing = 0.0, back = 0.0;
    GeographicLib::Geodesic::WGS84().Inverse(lat, lon, corners[i].y, corners[i].x, metres, bearing, back);
    EXPECT_NEAR(metres, 1000.0 * std::sqrt(1.25), 0.005 * metres) << i;  // the ellipsoid's flattening, 1/298
    EXPECT_NEAR(std::remainder(bearing - (bearings[i] - turn), 360.0), 0.0, 0.3) << i;
  }
}

TEST_F(OverlayList, HiddenOnesCountOnlyIfAllAre) {
  const std::string hidden = "<visibility>0</visibility>";
  const std::string one = overlay("a.png", box(1, 0, 1, 0), hidden);
  EXPECT_THAT(read(one + overlay("b.png", box(1, 0, 1, 0))).entries, SizeIs(1));
  EXPECT_THAT(read(one + one).entries, SizeIs(2));
  const std::string folder = "<Folder>" + hidden + overlay("c.png", box(1, 0, 1, 0)) + "</Folder>";
  EXPECT_EQ(read(overlay("b.png", box(1, 0, 1, 0)) + folder).entries[0].path, folder_ / "b.png");
}

TEST_F(OverlayList, WhatCannotBeDrawnIsNamed) {
  const MosaicList list =
      read(overlay("http://127.0.0.1:9/x.png", box(1, 0, 1, 0)) + overlay("../x.png", box(1, 0, 1, 0)) +
           overlay("a.png", box(0, 1, 1, 0)) + overlay("a.png", box(100, 0, 1, 0)) + overlay("", box(1, 0, 1, 0)) +
           overlay("a.png", "<gx:LatLonQuad><coordinates>1,2 3,4</coordinates></gx:LatLonQuad>") +
           overlay("my%20a.png", box(1, 0, 1, 0), "<color>7fffffff</color>") +
           "<NetworkLink><Link><href>http://127.0.0.1:9/y.kml</href></Link></NetworkLink>"
           "<NetworkLink><Link><href>missing.kml</href></Link></NetworkLink>");
  ASSERT_THAT(list.entries, SizeIs(1));
  EXPECT_EQ(list.entries[0].path, folder_ / "my a.png");
  EXPECT_THAT(list.remarks, SizeIs(9));
  for (const char* said : {"http://127.0.0.1:9/x.png", "../x.png", "no area", "no places", "names no picture",
                           "four places", "opaque", "y.kml", "missing.kml"}) {
    EXPECT_THAT(list.remarks, Contains(HasSubstr(said)));
  }
  const auto none = read_overlay_list(write("n.kml", kml("")), {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("n.kml"));
}

/// A super-overlay of a coarse picture and, in a file of its own that links back, a fine one.
TEST_F(OverlayList, LinksInTheFolderAndInAKmzFileAreFollowed) {
  const std::string root = overlay("0.png", box(40, 0, 40, 0), "<drawOrder>1</drawOrder>") +
                           "<NetworkLink><Link><href>1/a.kml</href></Link></NetworkLink>";
  const std::string leaf = overlay("a.png", box(40, 20, 20, 0), "<drawOrder>2</drawOrder>") +
                           "<NetworkLink><Link><href>../doc.kml</href></Link></NetworkLink>";
  const auto path = write("doc.kml", kml(root));
  write("1/a.kml", kml(leaf));
  write("0.png", "coarse");
  write("1/a.png", "fine");
  const auto list = read_overlay_list(path, {});
  ASSERT_TRUE(list) << list.error().message;
  ASSERT_THAT(list->entries, SizeIs(2));
  EXPECT_EQ(list->entries[1].path, folder_ / "1/a.png");
  EXPECT_EQ(list->entries[1].order, 2.0);
  EXPECT_THAT(list->remarks, SizeIs(0));
  const auto features = read_objects(path);
  ASSERT_TRUE(features) << features.error().message;
  EXPECT_THAT(features->complaints, SizeIs(0)) << "its links lead to pictures alone";
  const std::string zip =
      fmt::format("cd '{}' && python3 -m zipfile -c s.kmz doc.kml 0.png 1", folder_.path().string());
  ASSERT_EQ(std::system(zip.c_str()), 0);  // NOLINT(cert-env33-c): a fixed command
  EXPECT_FALSE(read_overlay_list(folder_ / "s.kmz", {}));
  for (int time = 0; time < 2; ++time) {
    const auto zipped = read_overlay_list(folder_ / "s.kmz", folder_ / "unpacked");
    ASSERT_TRUE(zipped) << zipped.error().message;
    ASSERT_THAT(zipped->entries, SizeIs(2));
    std::string text;
    std::ifstream(zipped->entries[1].path) >> text;
    EXPECT_EQ(text, "fine");
  }
}

}  // namespace
}  // namespace terrella::test
