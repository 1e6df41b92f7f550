#include "apps/viewer/tools/measure_tool.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/viewer/tools/measure_export.h"

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
  EXPECT_EQ(tool.text(sphere, at(0, 0)), tool.text(sphere)) << "the cursor has not left the place";
  EXPECT_EQ(tool.text(sphere, at(0, 45)), "Length 5,004 km");
  EXPECT_EQ(tool.scene(sphere).points.size(), 1U);
  tool.add(at(0, 90));
  EXPECT_EQ(tool.text(sphere), "Length 10,008 km");
  EXPECT_EQ(tool.text(sphere, at(0, 90)), "Length 10,008 km");
  EXPECT_EQ(tool.text(sphere, at(0, 135)), "Length 10,008 km + 5,004 km = 15,011 km");
  ASSERT_EQ(tool.scene(sphere).labels.size(), 1U);
  EXPECT_EQ(tool.scene(sphere).labels[0].text, "10,008 km");
  EXPECT_NEAR(tool.scene(sphere).labels[0].place.lon.deg(), 45.0, 1e-9);
  EXPECT_TRUE(tool.scene(sphere).polygons.empty());
  tool.add(at(90, 0));
  EXPECT_EQ(tool.text(sphere), "Length 20,015 km   Area 63,758,059 km²");
  EXPECT_EQ(tool.scene(sphere).polygons.size(), 1U);
  EXPECT_EQ(tool.scene(sphere).lines.size(), 2U);
  ASSERT_EQ(tool.scene(sphere).labels.size(), 3U) << "two segments and the total";
  EXPECT_EQ(tool.scene(sphere).labels[2].text, "Total 20,015 km");
  tool.take_back();
  EXPECT_EQ(tool.text(sphere), "Length 10,008 km");
  tool.clear();
  tool.take_back();
  EXPECT_TRUE(tool.places().empty());
}

// Truth: quarters of a great circle of 6371 km, and an eighth of the sphere.
TEST(MeasureTool, IsCopiedAsTextWithEachSegment) {
  const Ellipsoid sphere(6371000.0, 0.0);
  const std::vector<Geodetic> octant{at(0, 0), at(0, 90), at(90, 0)};
  EXPECT_EQ(measurement_text(sphere, octant),
            "0.0000000, 0.0000000\n0.0000000, 90.0000000\t10007543.398 m\n90.0000000, 0.0000000\t10007543.398 m\n"
            "Length\t20015086.796 m\nArea\t63758058988723.5 m²\n");
  EXPECT_EQ(measurement_text(sphere, std::vector{at(1, 2)}), "1.0000000, 2.0000000\n");
}

TEST(MeasureTool, IsSavedAsGeoJson) {
  const Ellipsoid sphere(6371000.0, 0.0);
  // Clockwise, and across ±180°.
  const auto json =
      nlohmann::json::parse(measurement_geojson(sphere, std::vector{at(0, 170), at(10, 175), at(0, -170)}));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), 2U);
  const auto& way = json["features"][0];
  EXPECT_EQ(way["geometry"]["type"], "LineString");
  EXPECT_EQ(way["geometry"]["coordinates"][2], nlohmann::json({190.0, 0.0}));
  EXPECT_EQ(way["properties"]["segment_lengths_m"].size(), 2U);
  const auto& ring = json["features"][1]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 4U) << "closed";
  EXPECT_EQ(ring[0], ring[3]);
  EXPECT_EQ(ring[1], nlohmann::json({190.0, 0.0})) << "against the clock, from the first place";
  const auto point = nlohmann::json::parse(measurement_geojson(sphere, std::vector{at(1, 2)}));
  EXPECT_EQ(point["features"][0]["geometry"]["type"], "Point");
}

}  // namespace
}  // namespace terrella
