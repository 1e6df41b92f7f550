#include "streaming/georeference/figure.h"

#include <gtest/gtest.h>

namespace terrella::test {
namespace {

PlacedPicture on(double a_m, double b_m) {
  PlacedPicture placed;
  placed.crs = CrsFacts{};
  placed.crs->a_m = a_m;
  placed.crs->b_m = b_m;
  placed.claim = "in.tif: its GeoTIFF tags say that it is geographic";
  return placed;
}
Body body(const char* text) { return *parse_body(text); }

TEST(FigureTest, ASphereForAFlattenedBodyCountsPlanetocentricLatitudes) {
  struct Row {
    const char* body;
    double a_m, b_m;
    LatitudeKind expected;
  };
  for (const Row& row :
       {Row{"mars", 3396190, 3396190, LatitudeKind::centric}, Row{"mars", 3396190, 3376200, LatitudeKind::graphic},
        Row{"moon", 1737400, 1737400, LatitudeKind::graphic},
        // By common practice latitudes on a sphere count as geodetic on the Earth.
        Row{"earth", 6371000, 6371000, LatitudeKind::graphic},
        Row{"71492000,0.0649", 71492000, 71492000, LatitudeKind::centric}}) {
    PlacedPicture placed = on(row.a_m, row.b_m);
    const auto latitude = check_figure(placed, body(row.body), {});
    ASSERT_TRUE(latitude) << latitude.error().message;
    EXPECT_EQ(*latitude, row.expected) << row.body;
    EXPECT_TRUE(placed.remarks.empty());
  }
}

TEST(FigureTest, TheUsersLatitudeWinsWithARemark) {
  PlacedPicture sphere = on(3396190, 3396190);
  EXPECT_EQ(*check_figure(sphere, body("mars"), LatitudeKind::graphic), LatitudeKind::graphic);
  ASSERT_EQ(sphere.remarks.size(), 1U);
  EXPECT_NE(sphere.remarks[0].find("‹latitude› graphic is used instead"), std::string::npos) << sphere.remarks[0];
  PlacedPicture agrees = on(3396190, 3396190);
  EXPECT_EQ(*check_figure(agrees, body("mars"), LatitudeKind::centric), LatitudeKind::centric);
  EXPECT_TRUE(agrees.remarks.empty());
}

TEST(FigureTest, AnotherBodyIsRefusedByBothNames) {
  struct Row {
    const char* body;
    double a_m, b_m;
    const char* cure;
  };
  for (const Row& row : {Row{"earth", 1737400, 1737400, "‹body› moon"}, Row{"moon", 3396190, 3376200, "‹body› mars"},
                         Row{"mars", 6378137, 6356752, "‹body› earth"}, Row{"moon", 1560800, 1560800, "‹body› "},
                         Row{"289000,0", 289000, 229000, "‹body› 289000,0.2076"}}) {
    PlacedPicture placed = on(row.a_m, row.b_m);
    const auto latitude = check_figure(placed, body(row.body), {});
    ASSERT_FALSE(latitude) << row.body;
    for (const std::string& part :
         {std::string(row.cure), body(row.body).name, std::to_string(static_cast<long>(row.a_m))}) {
      EXPECT_NE(latitude.error().message.find(part), std::string::npos) << latitude.error().message;
    }
  }
}

}  // namespace
}  // namespace terrella::test
