#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../streaming/streaming_test_support.h"
#include "codecs/png_codec.h"
#include "elevation_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

std::string hex(const std::vector<std::byte>& bytes) {
  std::string text;
  for (const std::byte byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
  return text;
}

/// A set of GDAL's, spoilt in one place; what is said of it.
class RefusedHeights : public testing::Test {
 protected:
  static constexpr int kTile_px = 256;

  void SetUp() override {
    write_raster(folder_ / "in.tif", random_raster(2 * kTile_px, kTile_px, 0, 9000), "Int16");
    write_gdal_geopackage(folder_ / "in.tif", path_);
  }

  void spoil(const std::string& sql) { run_sql(path_, sql); }
  void spoil_tiles(const std::vector<std::byte>& bytes) {
    spoil(fmt::format("UPDATE heights SET tile_data = X'{}'", hex(bytes)));
  }

  void expect_refused(const std::vector<std::string>& says, const GeoRect& covered = {}) const {
    auto tiles = open_tile_set(path_);
    std::string message;
    if (!tiles) {
      message = tiles.error().message;
    } else {
      const auto source = ElevationSource::open(*std::move(tiles), path_.string(), covered);
      ASSERT_FALSE(source);
      message = source.error().message;
    }
    EXPECT_EQ(message.rfind(path_.string(), 0), 0U) << message;
    for (const std::string& text : says) EXPECT_NE(message.find(text), std::string::npos) << text << "\n" << message;
  }

  ScratchFolder folder_;
  fs::path path_ = folder_ / "heights.gpkg";
};

TEST_F(RefusedHeights, AsItIsItIsTaken) { EXPECT_TRUE(must_open(path_)); }

TEST_F(RefusedHeights, TilesThatAreColours) {
  spoil_tiles(*encode_png(gradient(kTile_px, kTile_px)));
  expect_refused({"RGB of 8 bits", "gray of 16 bits", "level"});
}

TEST_F(RefusedHeights, TilesThatAreJpeg) {
  spoil_tiles(*encode_jpeg(gradient(kTile_px, kTile_px), 80));
  expect_refused({"a JPEG picture"});
}

TEST_F(RefusedHeights, TilesOfAnotherSize) {
  spoil_tiles(gray16_png(std::vector<std::uint16_t>(64 * 64)));
  expect_refused({"64×64", "256×256"});
}

TEST_F(RefusedHeights, WholeNumbersThatAreSaidToBeFloats) {
  spoil("UPDATE gpkg_2d_gridded_coverage_ancillary SET datatype = 'float'");
  expect_refused({"TIFF"});
}

TEST_F(RefusedHeights, AnUndefinedSystem) {
  spoil("UPDATE gpkg_tile_matrix_set SET srs_id = 3857; UPDATE gpkg_contents SET srs_id = 3857");
  expect_refused({"the heights of", "3857: gpkg_spatial_ref_sys gives it no known code"});
}

TEST_F(RefusedHeights, LessThanThePlanet) {
  spoil("UPDATE gpkg_contents SET min_x = -180, max_x = 10, min_y = -60");
  expect_refused({"-180,-60,10,90", "-180,-90,180,90"});
  const GeoRect inside{Angle::degrees(-180.0), Angle::degrees(-60.0), Angle::degrees(10.0), Angle::degrees(80.0)};
  EXPECT_TRUE(ElevationSource::open(*open_tile_set(path_), "x", inside));
  const GeoRect crossing{Angle::degrees(170.0), Angle::degrees(0.0), Angle::degrees(-170.0), Angle::degrees(10.0)};
  expect_refused({"170,0,-170,10"}, crossing);
}

TEST_F(RefusedHeights, WordsOfTheCoverageThatAreNotUnderstood) {
  const std::string table = "UPDATE gpkg_2d_gridded_coverage_ancillary SET ";
  const std::vector<std::pair<std::string, std::string>> spoilt = {
      {"grid_cell_encoding = 'grid-value-is-corner'", "corners"},
      {"scale = 0", "scale"},
      {"\"offset\" = 'much'", "offset"},
      {"tile_matrix_set_name = 'another'", "nothing is said"},
  };
  spoil("CREATE TABLE kept AS SELECT * FROM gpkg_2d_gridded_coverage_ancillary");
  for (const auto& [sql, says] : spoilt) {
    spoil(table + sql);
    expect_refused({"gpkg_2d_gridded_coverage_ancillary", says});
    spoil(
        "DELETE FROM gpkg_2d_gridded_coverage_ancillary; INSERT INTO gpkg_2d_gridded_coverage_ancillary SELECT * "
        "FROM kept");
  }
}

TEST_F(RefusedHeights, NumbersInAnotherUnit) {
  spoil("UPDATE gpkg_2d_gridded_coverage_ancillary SET uom = 'ft'");
  expect_refused({"\"ft\"", "metres"});
}

TEST_F(RefusedHeights, ButNotThoseWithoutAColumnOfUnits) {
  spoil("ALTER TABLE gpkg_2d_gridded_coverage_ancillary DROP COLUMN uom");
  EXPECT_TRUE(must_open(path_));
}

TEST_F(RefusedHeights, TablesThatAreNotThere) {
  spoil("DROP TABLE gpkg_2d_gridded_tile_ancillary");
  expect_refused({"gpkg_2d_gridded_tile_ancillary"});
  spoil("DROP TABLE gpkg_2d_gridded_coverage_ancillary");
  expect_refused({"gpkg_2d_gridded_coverage_ancillary"});
}

TEST_F(RefusedHeights, Pictures) {
  const fs::path pictures = fs::path(TERRELLA_FIXTURES) / "natural_earth_ii";
  auto tiles = open_tile_set(pictures);
  ASSERT_TRUE(tiles) << tiles.error().message;
  const auto source = ElevationSource::open(*std::move(tiles), pictures.string());
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("pictures, not heights"), std::string::npos) << source.error().message;
}

}  // namespace
}  // namespace terrella::test
