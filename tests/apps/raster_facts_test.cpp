// Facts about a raster for the layers panel: the raster's own system and pixels, not those of the tiles' grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/commands/picture_report.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

std::string line_with(const std::vector<std::string>& lines, const std::string& name) {
  const auto found =
      std::ranges::find_if(lines, [&](const std::string& line) { return line.starts_with(name + ": "); });
  return found == lines.end() ? std::string() : found->substr(name.size() + 2);
}

TEST(RasterFactsTest, AreThoseOfTheFile) {
  const fs::path sea = fs::path(TERRELLA_DATA_SOURCE) / "ocean/sea_surface_temperature.tif";
  const auto lines = raster_facts(sea, {}, {});
  EXPECT_EQ(line_with(lines, "no data"), "-9999");
  EXPECT_NE(line_with(lines, "system").find("4326"), std::string::npos) << line_with(lines, "system");
  EXPECT_NE(line_with(lines, "bounds").find("west -180"), std::string::npos);
  EXPECT_FALSE(line_with(lines, "pixel size").empty());
  EXPECT_EQ(line_with(lines, "to show it"), "");
}

TEST(RasterFactsTest, NameTheSystemThatTheUserSays) {
  const fs::path sea = fs::path(TERRELLA_DATA_SOURCE) / "ocean/sea_surface_temperature.tif";
  const auto lines =
      raster_facts(sea, {.crs = "EPSG:32633", .bounds = CrsBounds{500000.0, 5000000.0, 572000.0, 5036000.0}}, {});
  EXPECT_NE(line_with(lines, "system").find("32633"), std::string::npos) << line_with(lines, "system");
  EXPECT_NE(line_with(lines, "corners").find("500000 to 572000"), std::string::npos) << line_with(lines, "corners");
}

TEST(RasterFactsTest, AreNoneForAnotherFile) {
  EXPECT_TRUE(raster_facts(fs::path(TERRELLA_DATA_SOURCE) / "stars.csv", {}, {}).empty());
}

}  // namespace
}  // namespace terrella
