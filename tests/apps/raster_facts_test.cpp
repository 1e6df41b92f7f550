// Facts about a raster for the layers panel: the raster's own system and pixels, not those of the tiles' grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "apps/commands/raster_facts.h"
#include "apps/open_scene/open_imagery.h"
#include "tests/remote_tiff/served_folder.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

const fs::path kSea = fs::path(TERRELLA_DATA_SOURCE) / "ocean/sea_surface_temperature.tif";

std::string line_with(const std::vector<std::string>& lines, const std::string& name) {
  const auto found =
      std::ranges::find_if(lines, [&](const std::string& line) { return line.starts_with(name + ": "); });
  return found == lines.end() ? std::string() : found->substr(name.size() + 2);
}

TEST(RasterFactsTest, AreThoseOfTheFile) {
  const auto lines = raster_facts(kSea, {}, {});
  EXPECT_EQ(line_with(lines, "no data"), "-9999");
  EXPECT_NE(line_with(lines, "system").find("4326"), std::string::npos) << line_with(lines, "system");
  EXPECT_NE(line_with(lines, "bounds").find("west -180"), std::string::npos);
  EXPECT_FALSE(line_with(lines, "pixel size").empty());
  EXPECT_EQ(line_with(lines, "to show it"), "");
}

TEST(RasterFactsTest, NameTheSystemThatTheUserSays) {
  const auto lines =
      raster_facts(kSea, {.crs = "EPSG:32633", .bounds = CrsBounds{500000.0, 5000000.0, 572000.0, 5036000.0}}, {});
  EXPECT_NE(line_with(lines, "system").find("32633"), std::string::npos) << line_with(lines, "system");
  EXPECT_NE(line_with(lines, "corners").find("500000 to 572000"), std::string::npos) << line_with(lines, "corners");
}

/// Facts about TILESET as the window's panel gets them.
std::vector<std::string> facts_of_opened(const std::string& tile_set) {
  OpenedRasters opened;
  const auto tiles = open_any_tiles({.address = tile_set, .cache = "off", .opened = &opened});
  EXPECT_TRUE(tiles) << tiles.error().message;
  const FactsReader reader = facts_reader(tile_set, {}, {}, opened);
  return reader ? reader() : std::vector<std::string>();
}

TEST(RasterFactsTest, OfManyFilesNameEachSystemAndValueOnce) {
  const test::ScratchFolder folder;
  for (const char* name : {"a.tif", "b.tif", "c.tif"}) fs::copy(kSea, folder / name);
  std::ofstream(folder / "sea.json") << R"({"mosaic": ["a.tif", "b.tif", {"file": "c.tif", "nodata": -1,
      "crs": "EPSG:32633", "bounds": [500000, 5000000, 572000, 5036000]}]})";
  const auto lines = facts_of_opened((folder / "sea.json").string());
  EXPECT_EQ(line_with(lines, "files"), "3 rasters in 2 groups, 0 left out");
  EXPECT_NE(line_with(lines, "system").find("4326"), std::string::npos) << line_with(lines, "system");
  EXPECT_NE(line_with(lines, "system").find("32633"), std::string::npos) << line_with(lines, "system");
  EXPECT_EQ(line_with(lines, "system").find("4326"), line_with(lines, "system").rfind("4326"));
  EXPECT_EQ(line_with(lines, "no data"), "-9999, -1");
  EXPECT_NE(line_with(lines, "bounds").find("west -180"), std::string::npos) << line_with(lines, "bounds");
  // 72 km and 360° in the same number of pixels, and UTM's scale is 0.9996 there.
  const std::string sizes = line_with(lines, "pixel size");
  EXPECT_NEAR(std::stod(sizes.substr(sizes.find("to") + 3)) / std::stod(sizes), 360.0 * 111319.5 / 72000.0, 3.0)
      << sizes;
}

TEST(RasterFactsTest, OfATiffOnAServerAreThoseOfTheFileAndCostNoRequest) {
  const test::ServedFolder served;
  fs::copy(kSea, served / "sea.tif");
  const Url url = served.url("sea.tif");
  const auto opened = open_remote_tiff({.source = {.address = url}});
  ASSERT_TRUE(opened) << opened.error().message;
  const std::size_t asked = served.requests(1);
  const auto here = raster_facts(kSea, {}, {});
  const auto there = facts_reader(url, {}, {}, {.remote = {{url.with_secrets(), opened->tiff}}})();
  ASSERT_FALSE(there.empty());
  EXPECT_EQ(there, here);
  EXPECT_EQ(served.requests(0), asked);
}

TEST(RasterFactsTest, AreNoneForAnotherFile) {
  EXPECT_TRUE(raster_facts(fs::path(TERRELLA_DATA_SOURCE) / "stars.csv", {}, {}).empty());
}

}  // namespace
}  // namespace terrella
