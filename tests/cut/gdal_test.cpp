#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "picture_files.h"
#include "streaming/cut.h"

namespace terrella::test {
namespace {

constexpr double kExtent_deg = 1e-9;  // 0.1 mm on Earth

nlohmann::json gdalinfo(const ScratchFolder& folder, const std::string& file) {
  const auto out = folder / "info.json";
  const std::string command = fmt::format("{} -json '{}' > '{}' 2> '{}'", TERRELLA_GDALINFO, (folder / file).string(),
                                          out.string(), (folder / "info.log").string());
  if (std::system(command.c_str()) != 0) return {};
  std::ifstream text(out);
  return nlohmann::json::parse(text, nullptr, false);
}

Result<CutSummary> cut_png(const ScratchFolder& folder, const Image& picture, std::optional<GeoRect> bounds) {
  write_png(folder / "in.png", picture);
  return cut({.images = {folder / "in.png"},
              .output = folder / "out.gpkg",
              .tile_px = 16,
              .format = ImageFormat::png,
              .bounds = bounds});
}

void expect_gdal_reads(const Image& picture, std::optional<GeoRect> bounds) {
  const ScratchFolder folder;
  const auto made = cut_png(folder, picture, bounds);
  ASSERT_TRUE(made) << made.error().message;
  const auto info = gdalinfo(folder, "out.gpkg");
  ASSERT_TRUE(info.is_object());
  EXPECT_EQ(info["driverShortName"], "GPKG");
  EXPECT_EQ(info["size"], (nlohmann::json{picture.width_px, picture.height_px}));
  const GeoRect covered = bounds.value_or(GeoRect{});
  const auto& corners = info["cornerCoordinates"];
  EXPECT_NEAR(corners["upperLeft"][0].get<double>(), covered.west.deg(), kExtent_deg);
  EXPECT_NEAR(corners["upperLeft"][1].get<double>(), covered.north.deg(), kExtent_deg);
  EXPECT_NEAR(corners["lowerRight"][0].get<double>(), covered.east.deg(), kExtent_deg);
  EXPECT_NEAR(corners["lowerRight"][1].get<double>(), covered.south.deg(), kExtent_deg);
  // GDAL leaves out levels where the picture would be only a few pixels.
  EXPECT_GE(info["bands"][0]["overviews"].size(), 2U);

  const std::string command =
      fmt::format("{} -q -of PNG -b 1 -b 2 -b 3 '{}' '{}' 2> /dev/null", TERRELLA_GDAL_TRANSLATE,
                  (folder / "out.gpkg").string(), (folder / "back.png").string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto back = decode_image(read_bytes(folder / "back.png"));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->rgba, picture.rgba);
}

TEST(GdalTest, PlanetOfRootSpan180) { expect_gdal_reads(noise(128, 64), std::nullopt); }

// 270 pixels at 16: a root span of 341.3 degrees, whose matrix set reaches far beyond the planet.
TEST(GdalTest, PlanetOfAnotherRootSpan) { expect_gdal_reads(noise(270, 135), std::nullopt); }

TEST(GdalTest, Region) {
  expect_gdal_reads(noise(50, 30), GeoRect{.west = Angle::degrees(-37.0),
                                           .south = Angle::degrees(11.0),
                                           .east = Angle::degrees(13.0),
                                           .north = Angle::degrees(41.0)});
}

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};

/// The first column of the first row, as text.
std::string ask(sqlite3* database, const char* question) {
  std::string answer;
  sqlite3_exec(
      database, question,
      [](void* to, int, char** values, char**) {
        *static_cast<std::string*>(to) = values[0] != nullptr ? values[0] : "NULL";
        return 0;
      },
      &answer, nullptr);
  return answer;
}

TEST(GeoPackageTest, HoldsWhatTheStandardAsks) {
  const ScratchFolder folder;
  ASSERT_TRUE(cut_png(folder, noise(270, 135), std::nullopt));
  sqlite3* opened = nullptr;
  ASSERT_EQ(sqlite3_open_v2((folder / "out.gpkg").c_str(), &opened, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  const std::unique_ptr<sqlite3, CloseDatabase> base(opened);
  EXPECT_EQ(ask(opened, "PRAGMA application_id"), std::to_string(0x47504B47));
  EXPECT_EQ(ask(opened, "PRAGMA user_version"), "10300");
  EXPECT_EQ(ask(opened, "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(ask(opened, "PRAGMA foreign_key_check"), "");
  EXPECT_EQ(ask(opened, "SELECT group_concat(srs_id) FROM (SELECT srs_id FROM gpkg_spatial_ref_sys ORDER BY srs_id)"),
            "-1,0,4326");
  // At every level the extent is matrix size times tile size times pixel size, both ways.
  EXPECT_EQ(ask(opened,
                "SELECT count(*) FROM gpkg_tile_matrix m JOIN gpkg_tile_matrix_set s USING (table_name) WHERE "
                "abs(m.matrix_width * m.tile_width * m.pixel_x_size - (s.max_x - s.min_x)) > 1e-9 OR "
                "abs(m.matrix_height * m.tile_height * m.pixel_y_size - (s.max_y - s.min_y)) > 1e-9"),
            "0");
  EXPECT_EQ(ask(opened, "SELECT min_x || ',' || min_y || ',' || max_x || ',' || max_y FROM gpkg_contents"),
            "-180.0,-90.0,180.0,90.0");
}

}  // namespace
}  // namespace terrella::test
