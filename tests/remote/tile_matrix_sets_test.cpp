// Tile matrix sets in coordinate systems of their own: pixels lie where PROJ and the set's figures put them.
#include "tile_matrix_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geo/body.h"
#include "streaming/raster/tile_raster.h"
#include "streaming/remote/source_json.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/wmts/wmts.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/warp/warp_source.h"
#include "tiles/tile_range.h"
#include "wmts_documents.h"

namespace terrella {
namespace {

using test::capabilities;
using test::LayerText;
using test::MatrixPlace;
using test::MatrixSetText;
using test::PublishedSet;
using test::quads;

constexpr double kMostOff_px = 0.05;

std::string document_of(const PublishedSet& set) {
  std::string text = fmt::format(
      "<TileMatrixSet><ows:Identifier>set</ows:Identifier><ows:SupportedCRS>{}"
      "</ows:SupportedCRS>",
      set.crs);
  for (std::size_t i = 0; i < set.matrices; ++i) {
    const bool halves = set.denominators.size() == 1, doubles = set.sizes.size() == 1;
    const double denominator = halves ? std::ldexp(set.denominators[0], -static_cast<int>(i)) : set.denominators[i];
    const auto size = doubles ? std::pair(set.sizes[0].first << i, set.sizes[0].second << i) : set.sizes[i];
    text += fmt::format(
        "<TileMatrix><ows:Identifier>m{}</ows:Identifier><ScaleDenominator>{:.16g}</ScaleDenominator><TopLeftCorner>{}"
        "</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256</TileHeight><MatrixWidth>{}</MatrixWidth>"
        "<MatrixHeight>{}</MatrixHeight></TileMatrix>",
        i, denominator, set.corner, size.first, size.second);
  }
  std::string all = capabilities({{.matrix_sets = {"set"}}}, {});
  return all.insert(all.find("</Contents>"), text + "</TileMatrixSet>");
}

RemoteTileSet read_set(const std::string& xml, const RemoteOptions& options = {}) {
  auto set = parse_wmts_capabilities(xml, options, "caps");
  EXPECT_TRUE(set) << set.error().message;
  return set ? *std::move(set) : RemoteTileSet{};
}

/// Places on a set, by the code that draws it.
class Drawn {
 public:
  explicit Drawn(const TileSetInfo& info) : info_(info) {
    if (!info.square) return;
    raster_ = raster_info_of(info);
    const auto body = parse_body(info.body);
    const WarpOptions options{.figure = {.ellipsoid = body->ellipsoid}, .body = info.body};
    const auto grid = warp_grid(raster_, options, "set");
    EXPECT_TRUE(grid) << grid.error().message;
    auto planner = TilePlanner::open(raster_, options.figure, *grid, Overviews::made);
    EXPECT_TRUE(planner) << planner.error().message;
    planner_ = *std::move(planner);
  }

  /// The pixel of a level that shows a place.
  [[nodiscard]] CrsPoint pixel(const MatrixPlace& place, int level) const {
    const TileGrid& grid = info_.grid;
    if (!planner_) {
      const double row = row_latitude_deg(grid, earth().ellipsoid,
                                          Ellipsoid::normal(Angle::degrees(place.lat), Angle::degrees(place.lon)));
      const TileXY at = tile_xy(grid, level, row, place.lon);
      return {at.x * grid.tile_px, at.y * grid.tile_px};
    }
    const auto finest = planner_->pixel_at({.lon_deg = place.lon, .row_deg = place.lat});
    EXPECT_TRUE(finest);
    const RasterLevel& from = raster_.levels.back();
    const RasterLevel& to = raster_.levels[static_cast<std::size_t>(level - grid.min_level)];
    const double x = from.to_crs.x0 + finest->x * from.to_crs.x_per_column;
    const double y = from.to_crs.y0 + finest->y * from.to_crs.y_per_row;
    return {(x - to.to_crs.x0) / to.to_crs.x_per_column, (y - to.to_crs.y0) / to.to_crs.y_per_row};
  }

 private:
  const TileSetInfo info_;
  RasterInfo raster_;
  std::shared_ptr<TilePlanner> planner_;
};

TEST(TileMatrixSets, PublishedOnesLieInTheirPlace) {
  double worst_px = 0.0;
  for (const PublishedSet& published : test::published_sets()) {
    SCOPED_TRACE(published.name);
    const RemoteTileSet set = read_set(document_of(published));
    ASSERT_EQ(set.level_names.back(), fmt::format("m{}", published.matrices - 1));
    EXPECT_LE(count_places(set.info.grid, set.info.grid.min_level), 512);
    const Drawn drawn(set.info);
    for (const MatrixPlace& place : published.places) {
      const auto named = std::ranges::find(set.level_names, fmt::format("m{}", place.matrix));
      ASSERT_NE(named, set.level_names.end());
      const CrsPoint pixel = drawn.pixel(place, static_cast<int>(named - set.level_names.begin()));
      EXPECT_NEAR(pixel.x, place.column_px, kMostOff_px) << place.lat;
      EXPECT_NEAR(pixel.y, place.row_px, kMostOff_px) << place.lat;
      worst_px = std::max({worst_px, std::abs(pixel.x - place.column_px), std::abs(pixel.y - place.row_px)});
    }
  }
  RecordProperty("worst_px", fmt::format("{:.4f}", worst_px));
}

MatrixSetText arctic(const std::string& name, int matrices = 3) {
  // 8192 m, as NASA GIBS begins; 512 pixels.
  return {.name = name,
          .crs = "urn:ogc:def:crs:EPSG::3413",
          .denominator = 8192.0 / 0.00028,
          .tile_px = 512,
          .sizes = quads(2, 2, matrices),
          .corner = "-4194304 4194304"};
}

std::string one_set_of(const MatrixSetText& set, const LayerText& like = {}) {
  LayerText layer = like;
  layer.matrix_sets = {set.name};
  return capabilities({layer}, {set});
}

TEST(TileMatrixSets, APolarQuadtreeIsOne) {
  const RemoteTileSet set = read_set(one_set_of(arctic("polar")));
  ASSERT_TRUE(set.info.square);
  EXPECT_TRUE(set.info.square->levels.empty());
  EXPECT_EQ(set.info.square->crs, "EPSG:3413");
  EXPECT_EQ(set.info.square->west, -4194304.0);
  EXPECT_EQ(set.info.square->north, 4194304.0);
  EXPECT_NEAR(set.info.square->unit_per_deg * 360.0, 8388608.0, 1e-6);
  EXPECT_EQ(count_places(set.info.grid, 0), 4);
  EXPECT_EQ(count_places(set.info.grid, 2), 64);
  EXPECT_EQ(set.info.body, "earth");
  EXPECT_EQ(tile_url(set, {2, 7, 5}), "https://example.com/wmts/layer/default/polar/2/5/7.jpg");
}

TEST(TileMatrixSets, LimitsNarrowLevelsAndTiles) {
  const LayerText limited{
      .limits =
          "<TileMatrixSetLimits><TileMatrixLimits><TileMatrix>1</TileMatrix><MinTileRow>1</MinTileRow>"
          "<MaxTileRow>2</MaxTileRow><MinTileCol>0</MinTileCol><MaxTileCol>2</MaxTileCol></TileMatrixLimits>"
          "</TileMatrixSetLimits>"};
  const RemoteTileSet set = read_set(one_set_of(arctic("polar"), limited));
  EXPECT_EQ(set.level_names, std::vector<std::string>{"1"});
  EXPECT_EQ(count_places(set.info.grid, 0), 6);
  EXPECT_EQ(tile_url(set, {0, 2, 1}), "https://example.com/wmts/layer/default/polar/1/1/2.jpg");
}

TEST(TileMatrixSets, PlateCarreeAndWebMercatorComeFirst) {
  const MatrixSetText geodetic{.name = "geodetic", .denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 3)};
  const MatrixSetText mercator{.name = "mercator",
                               .crs = "EPSG:3857",
                               .denominator = 559082264.0287178,
                               .sizes = quads(1, 1, 3),
                               .corner = "-20037508.34 20037508.34"};
  const auto chosen = [&](const std::vector<std::string>& sets, const RemoteOptions& options = {}) {
    LayerText layer;
    layer.matrix_sets = sets;
    const auto set = read_set(capabilities({layer}, {arctic("polar"), geodetic, mercator}), options);
    return set.info.grid.projection;
  };
  EXPECT_EQ(chosen({"polar", "mercator", "geodetic"}), Projection::equirectangular);
  EXPECT_EQ(chosen({"polar", "mercator"}), Projection::web_mercator);
  EXPECT_EQ(chosen({"polar"}), Projection::projected);
  EXPECT_EQ(chosen({"geodetic", "polar"}, {.matrix_set = "polar"}), Projection::projected);
}

TEST(TileMatrixSets, EitherAxisMayComeFirst) {
  // EPSG:3035 has the northing first; many servers write the easting first.
  const auto with = [](const std::string& corner, const std::string& box) {
    MatrixSetText europe{.name = "europe",
                         .crs = "urn:ogc:def:crs:EPSG::3035",
                         .denominator = 62779017.8571428,
                         .sizes = quads(1, 1, 3),
                         .corner = corner};
    const LayerText layer{.more = box};
    const auto set = read_set(one_set_of(europe, layer));
    return std::pair(set.info.square->west, set.info.square->north);
  };
  const std::string box =
      "<ows:WGS84BoundingBox><ows:LowerCorner>-10 35</ows:LowerCorner><ows:UpperCorner>30 65</ows:UpperCorner>"
      "</ows:WGS84BoundingBox>";
  EXPECT_EQ(with("5500000 2000000", ""), std::pair(2000000.0, 5500000.0));
  EXPECT_EQ(with("5500000 2000000", box), std::pair(2000000.0, 5500000.0));
  EXPECT_EQ(with("2000000 5500000", box), std::pair(2000000.0, 5500000.0));
  MatrixSetText europe{.name = "europe", .crs = "EPSG:3035", .denominator = 62779017.8571428, .sizes = quads(1, 1, 3)};
  europe.corner = "2000000 5500000";
  std::string xml = one_set_of(europe);
  xml.insert(xml.find("<TileMatrix>"),
             "<ows:BoundingBox><ows:LowerCorner>2000000 1000000</ows:LowerCorner><ows:UpperCorner>6500000 5500000"
             "</ows:UpperCorner></ows:BoundingBox>");
  EXPECT_EQ(read_set(xml).info.square->north, 5500000.0);
}

TEST(TileMatrixSets, LevelsOfAnyRatioKeepTheirPlaces) {
  MatrixSetText swiss{.name = "swiss",
                      .crs = "EPSG:2056",
                      .denominator = 1000.0 / 0.00028,
                      .sizes = {{2, 2}, {3, 2}, {5, 4}},
                      .corner = "2420000 1350000",
                      .ratio = 1.6};
  const RemoteTileSet set = read_set(one_set_of(swiss));
  ASSERT_TRUE(set.info.square);
  ASSERT_EQ(set.info.square->levels.size(), 3U);
  EXPECT_EQ(set.info.square->levels[1].columns, 3);
  EXPECT_NEAR(set.info.square->levels[2].unit_per_px, 1000.0 / 2.56, 1e-9);
  const auto kept = parse_tileset_json(to_tileset_json(set.info), "kept");
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->square, set.info.square);
  const RasterInfo raster = raster_info_of(set.info);
  EXPECT_EQ(raster.levels[1].width_px, 3 * 256);
  EXPECT_EQ(raster.levels[2].to_crs.x0, 2420000.0);
  for (int level = 0; level < 3; ++level) {
    const CrsLevel& place = set.info.square->levels[static_cast<std::size_t>(level)];
    EXPECT_TRUE(exists(set.info.grid, {level, place.columns - 1, place.rows - 1}));
  }
}

TEST(TileMatrixSets, DegreesOfAnyRatioKeepTheirPlacesToo) {
  MatrixSetText thirds{.denominator = test::kCrs84QuadDenominator, .sizes = {{2, 1}, {6, 3}, {18, 9}}, .ratio = 3.0};
  thirds.name = "thirds";
  for (const char* crs : {"urn:ogc:def:crs:EPSG::4326", "urn:ogc:def:crs:OGC:1.3:CRS84"}) {
    for (const char* corner : {"-180 90", "90 -180"}) {
      thirds.crs = crs;
      thirds.corner = corner;
      const RemoteTileSet set = read_set(one_set_of(thirds));
      ASSERT_TRUE(set.info.square);
      ASSERT_EQ(set.info.square->levels.size(), 3U);
      EXPECT_EQ(set.info.square->west, -180.0);
      EXPECT_EQ(set.info.square->north, 90.0);
      EXPECT_NEAR(set.info.square->levels[1].unit_per_px * 256.0, 60.0, 1e-9);
    }
  }
}

TEST(TileMatrixSets, UnitsOfASystemCount) {
  // New York Long Island in survey feet: a pixel is 0.28 mm, whatever the unit.
  MatrixSetText feet{.name = "feet",
                     .crs = "EPSG:2263",
                     .denominator = 1200.0 / 3937.0 * 100.0 / 0.00028,
                     .sizes = {{1, 1}},
                     .corner = "900000 280000"};
  const RemoteTileSet set = read_set(one_set_of(feet));
  EXPECT_NEAR(set.info.square->unit_per_deg * 360.0, 25600.0, 1e-6);
  MatrixSetText moon = arctic("moon");
  moon.crs = "urn:ogc:def:crs:IAU_2015::30130";
  EXPECT_EQ(read_set(one_set_of(moon)).info.body, "moon");
}

Result<RemoteTileSet> described(const std::string& fields) {
  const auto source = parse_source_json(R"({"url": "https://example.com/{z}/{x}/{-y}.png", )" + fields + "}", "here");
  if (!source) return source.error();
  return template_tile_set(source->address, source->options, false, "here");
}

TEST(TileMatrixSets, ADescriptionSaysTheSystemOfATemplate) {
  const auto square = described(R"("max_level": 3, "crs": "EPSG:3031", "extent": [-4000, -3000, 4000, 5000])");
  ASSERT_TRUE(square) << square.error().message;
  EXPECT_EQ(square->info.square->north, 5000.0);
  EXPECT_EQ(tile_url(*square, {3, 1, 0}), "https://example.com/3/1/7.png");
  const auto wide = described(
      R"("crs": "EPSG:2056", "extent": [2420000, 1030000, 2900000, 1350000], "resolutions": [650, 500, 100])");
  ASSERT_TRUE(wide) << wide.error().message;
  EXPECT_EQ(wide->info.square->levels[2].columns, 19);
  EXPECT_EQ(wide->info.square->levels[2].rows, 13);
  EXPECT_EQ(tile_url(*wide, {2, 1, 3}), "https://example.com/2/1/9.png");
  const std::string matrix = R"({"id": "a", "scaleDenominator": 1e8, "pointOfOrigin": [6918457.73, -918457.73],)"
                             R"("tileWidth": 256, "tileHeight": 256, "matrixWidth": 3, "matrixHeight": 2)";
  const auto with = [&](const std::string& more) {
    return described(R"("tile_matrix_set": {"id": "Ice", "crs": "http://www.opengis.net/def/crs/EPSG/0/5482",)"
                     R"("tileMatrices": [)" +
                     matrix + more + "}]}");
  };
  const auto ice = with("");
  ASSERT_TRUE(ice) << ice.error().message;
  EXPECT_EQ(ice->info.square->west, -918457.73);
  EXPECT_EQ(tile_url(*ice, {0, 2, 0}), "https://example.com/a/2/1.png");
  // CDB1GlobalGrid and GNOSISGlobalGrid are of this kind.
  const auto varying = with(R"(, "variableMatrixWidths": [{"coalesce": 2, "minTileRow": 0, "maxTileRow": 0}])");
  ASSERT_FALSE(varying);
  EXPECT_NE(varying.error().message.find(R"("Ice": matrix "a": its rows have variable widths)"), std::string::npos)
      << varying.error().message;
}

TEST(TileMatrixSets, TheAreaThatSaysWhichAxisIsFirstMayCrossTheDateLine) {
  const auto islands = described(
      R"("bounds": [166, -48, -177, -34], "tile_matrix_set": {"id": "Islands", "tileMatrices": [{"id": "a",)"
      R"("scaleDenominator": 27901785.714, "pointOfOrigin": [1000000, 6300000], "tileWidth": 256, "tileHeight": 256,)"
      R"("matrixWidth": 1, "matrixHeight": 1}], "crs": "http://www.opengis.net/def/crs/EPSG/0/2193"})");
  ASSERT_TRUE(islands) << islands.error().message;
  EXPECT_EQ(islands->info.square->west, 1000000.0);
}

TEST(TileMatrixSets, DescriptionsThatCannotBeAreNamed) {
  for (const auto& [fields, why] :
       {std::pair(R"("crs": "EPSG:3031", "max_level": 2)", "needs an \"extent\""),
        std::pair(R"("extent": [0, 0, 1, 1], "max_level": 2)", "needs a \"crs\""),
        std::pair(R"("crs": "EPSG:3031", "extent": [1, 0, 0, 1], "max_level": 2)", "west, south, east, north"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1, 1])", "how many levels"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1, 1], "resolutions": [1, 2])", "descend"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1, 1], "resolutions": [0])", "positive"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1e9, 1], "resolutions": [1e-3])", "root tiles"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1, 1], "bounds": [0, -90, 9, -80], "max_level": 2)",
                  "bounds in degrees"),
        std::pair(R"("crs": "EPSG:1", "extent": [0, 0, 1, 1], "max_level": 2)", "not one that PROJ knows"),
        std::pair(R"("tile_matrix_set": {"tileMatrices": []})", "no tileMatrices"),
        std::pair(R"("crs": "EPSG:3031", "extent": [0, 0, 1, 1], "tile_matrix_set": {}, "max_level": 2)",
                  "is that of")}) {
    const auto set = described(fields);
    ASSERT_FALSE(set) << fields;
    EXPECT_NE(set.error().message.find(why), std::string::npos) << set.error().message;
  }
}

TEST(TileMatrixSets, HostileOnesAreNamed) {
  const auto expect_named = [](const MatrixSetText& set, const std::string& why) {
    const auto read = parse_wmts_capabilities(one_set_of(set), {}, "caps");
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find(why), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("\"polar\""), std::string::npos) << read.error().message;
  };
  MatrixSetText set = arctic("polar");
  set.denominator = 0.0;
  expect_named(set, "ScaleDenominator is not a positive number");
  set = arctic("polar");
  set.corner = "nan 4194304";
  expect_named(set, "TopLeftCorner is not two numbers");
  set.corner = "-1e300 1e300";
  expect_named(set, "farther than any coordinate");
  set = arctic("polar");
  set.crs = "urn:ogc:def:crs:EPSG::999999";
  expect_named(set, "not one that PROJ knows (EPSG:999999)");
  set.crs = "/etc/passwd";
  expect_named(set, "is no code such as EPSG:4326");
  set = arctic("polar");
  set.sizes = {{1'000'000'000, 1'000'000'000}};
  expect_named(set, "at most 512 can be root tiles");
}

}  // namespace
}  // namespace terrella
