#include "sky/star_catalogue.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <string>

namespace terrella::test {
namespace {

const std::string kStarHeading = "hip,ra_deg,dec_deg,vmag,bv\n";

TEST(StarCatalogue, IsReadFromCsv) {
  const auto stars =
      parse_stars(kStarHeading + "32349,101.2872,-16.7161,-1.44,0.009\r\n\n11767,37.9545,89.2641,1.97,\n");
  ASSERT_TRUE(stars) << stars.error().message;
  ASSERT_EQ(stars->size(), 2u);
  const Star& sirius = stars->front();
  EXPECT_FLOAT_EQ(sirius.magnitude, -1.44F);
  EXPECT_NEAR(glm::distance(sirius.direction_j2000, glm::vec3(-0.18747F, 0.93922F, -0.28763F)), 0.0F, 1e-4F);
  EXPECT_NEAR(stars->back().direction_j2000.z, 0.99992F, 1e-5F);
}

TEST(StarCatalogue, FindsItsColumnsByName) {
  const auto stars = parse_stars("vmag,bv,dec_deg,ra_deg\n1,0.5,90,0\n");
  ASSERT_TRUE(stars) << stars.error().message;
  EXPECT_NEAR(stars->front().direction_j2000.z, 1.0F, 1e-6F);
  EXPECT_EQ(stars->front().magnitude, 1.0F);
}

TEST(StarCatalogue, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& csv) {
    const auto stars = parse_stars(csv);
    return stars ? std::string("none") : stars.error().message;
  };
  const auto has = [](const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
  };
  has(message(""), {"line 1", "ra_deg"});
  has(message("hip,ra_deg,dec_deg,vmag\n"), {"line 1", "bv"});
  has(message("\x89PNG\r\n\x1a\n"), {"line 1"});
  has(message(kStarHeading), {"no star"});
  has(message(kStarHeading + "1,0,0,1,0\n2,0,91,1,0\n"), {"line 3", "dec_deg", "91"});
  has(message(kStarHeading + "1,nan,0,1,0\n"), {"line 2", "ra_deg", "nan"});
  has(message(kStarHeading + "1,0,0,,0\n"), {"line 2", "vmag"});
  has(message(kStarHeading + "1,0,0\n"), {"line 2", "vmag"});
}

// Published colours: Betelgeuse (B-V 1.85) is orange, Vega (0.0) bluish, the Sun (0.65) near white.
TEST(StarCatalogue, ColoursStarsByTheirIndex) {
  const glm::vec3 blue = star_color_linear(-0.3), vega = star_color_linear(0.0), sun = star_color_linear(0.65),
                  red = star_color_linear(1.85);
  EXPECT_GT(blue.b, vega.b);
  EXPECT_GT(vega.b, vega.r);
  EXPECT_NEAR(sun.r, 1.0F, 0.15F);
  EXPECT_NEAR(sun.b, 1.0F, 0.15F);
  EXPECT_GT(red.r, 1.5F);
  EXPECT_LT(red.b, 0.4F);
  for (double bv = -1.0; bv < 3.0; bv += 0.01) {
    const glm::vec3 c = star_color_linear(bv);
    EXPECT_NEAR(glm::dot(c, glm::vec3(0.2126F, 0.7152F, 0.0722F)), 1.0F, 1e-5F);
    EXPECT_GE(std::min({c.r, c.g, c.b}), 0.0F);
    EXPECT_LT(glm::distance(c, star_color_linear(bv + 0.01)), 0.1F) << "a step in colour at " << bv;
  }
}

}  // namespace
}  // namespace terrella::test
