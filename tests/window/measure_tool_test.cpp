#include "apps/viewer/tools/measure_tool.h"

#include <gtest/gtest.h>

#include "geo/body.h"

namespace terrella {
namespace {

Geodetic at(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = 0.0};
}

TEST(MeasureTool, SaysWhatToDoThenHowLongThenHowLarge) {
  const Ellipsoid sphere(6371000.0, 0.0);
  MeasureTool tool;
  EXPECT_NE(tool.text(sphere).find("click a place"), std::string::npos);
  EXPECT_TRUE(tool.scene(sphere).empty());
  tool.add(at(0, 0));
  EXPECT_NE(tool.text(sphere).find("next"), std::string::npos);
  EXPECT_EQ(tool.scene(sphere).points.size(), 1U);
  tool.add(at(0, 90));
  EXPECT_EQ(tool.text(sphere), "Length 10,008 km");
  EXPECT_EQ(tool.scene(sphere).labels.at(0).text, "10,008 km");
  EXPECT_TRUE(tool.scene(sphere).polygons.empty());
  tool.add(at(90, 0));
  EXPECT_EQ(tool.text(sphere), "Length 20,015 km   Area 63,758,059 km²");
  EXPECT_EQ(tool.scene(sphere).polygons.size(), 1U);
  EXPECT_EQ(tool.scene(sphere).lines.size(), 2U);
  tool.take_back();
  EXPECT_EQ(tool.text(sphere), "Length 10,008 km");
  tool.clear();
  tool.take_back();
  EXPECT_TRUE(tool.places().empty());
}

}  // namespace
}  // namespace terrella
