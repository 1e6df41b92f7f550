#include "streaming/remote/gdal_wms/gdal_wms.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace terrella {
namespace {

struct Window {
  const char* name;
  const char* projection;
  double west, north, east, south;
  int columns, rows;  ///< tiles at level 0
  const char* body;
  bool own_square;
};

constexpr double kMercator = 20037508.342789244;
const std::vector<Window> kWindows = {
    {"planet", "EPSG:4326", -180, 90, 180, -90, 2, 1, "earth", false},
    {"one root", "EPSG:4326", -180, 90, 180, -270, 1, 1, "earth", false},
    {"GIBS", "EPSG:4326", -180, 90, 396, -198, 2, 1, "earth", false},
    {"from 0", "+proj=longlat +R=1737400 +no_defs", 0, 90, 360, -90, 2, 1, "moon", false},
    {"WKT of Mars",
     "GEOGCS[\"GCS_Mars_2000_Sphere\",DATUM[\"D_Mars_2000_Sphere\",SPHEROID[\"Mars_2000_Sphere_IAU_IAG\",3396190.0,0.0]"
     "],"
     "PRIMEM[\"Reference_Meridian\",0.0],UNIT[\"Degree\",0.0174532925199433]]",
     -180, 90, 180, -90, 2, 1, "mars", false},
    {"metres of Mercury", "+proj=eqc +R=2439400", -7663601.122, 3831800.561, 7663601.122, -3831800.561, 2, 1, "mercury",
     false},
    {"IAU Moon", "IAU:30100", -180, 90, 180, -90, 2, 1, "moon", false},
    {"Web Mercator", "EPSG:3857", -20037508.34, 20037508.34, 20037508.34, -20037508.34, 1, 1, "earth", false},
    {"EPSG:900913", "EPSG:900913", -kMercator, kMercator, kMercator, -kMercator, 1, 1, "earth", false},
    {"a part", "EPSG:4326", -45, 67.5, 0, 45, 2, 1, "earth", false},
    {"beside the grid", "EPSG:4326", -31, 71, 14, 48.5, 2, 1, "earth", true},
    {"polar", "EPSG:3413", -4194304, 4194304, 4194304, -4194304, 1, 1, "earth", true},
    {"UTM", "EPSG:32633", 300000, 5400000, 404857.6, 5295142.4, 1, 1, "earth", true},
    {"standard parallel", "+proj=eqc +lat_ts=40 +R=3396190", -4000000, 4000000, 4000000, -4000000, 1, 1, "mars", true},
};

std::string document(const Window& window, int block, const std::string& origin, const std::string& more = {}) {
  const double columns = window.columns, rows = window.rows;
  return fmt::format(
      "<GDAL_WMS><Service "
      "name=\"TMS\"><ServerUrl>http://host/${{z}}/${{x}}/${{y}}.png</ServerUrl></Service><DataWindow>"
      "<UpperLeftX>{}</UpperLeftX><UpperLeftY>{}</UpperLeftY><LowerRightX>{}</LowerRightX><LowerRightY>{}</LowerRightY>"
      "<TileLevel>3</TileLevel><TileCountX>{}</TileCountX><TileCountY>{}</TileCountY><YOrigin>{}</YOrigin></DataWindow>"
      "<Projection>{}</Projection><BlockSizeX>{}</BlockSizeX><BlockSizeY>{}</BlockSizeY>{}</GDAL_WMS>",
      window.west, window.north, window.east, window.south, columns, rows, origin, window.projection, block, block,
      more);
}

/// Our tile that holds a place of the window, found without the code under test.
TileId tile_at(const TileSetInfo& info, int level, const Window& window, double x, double y) {
  double lon = x, row = y;
  if (info.square) {
    lon = (x - info.square->west) / info.square->unit_per_deg - 180.0;
    row = 180.0 - (info.square->north - y) / info.square->unit_per_deg;
  } else if (info.grid.projection == Projection::web_mercator) {
    lon = x / kMercator * 180.0;
    row = y / kMercator * 180.0;
  } else if (std::string(window.name) == "metres of Mercury") {
    lon = x / 2439400.0 * 180.0 / M_PI;
    row = y / 2439400.0 * 180.0 / M_PI;
  }
  if (!info.square && window.west >= 0.0 && lon > 180.0) lon -= 360.0;
  const double span = info.grid.root_span_deg / std::ldexp(1.0, level);
  const double top = info.grid.projection == Projection::equirectangular ? 90.0 : 180.0;
  return {level, static_cast<std::int64_t>(std::floor((lon + 180.0) / span)),
          static_cast<std::int64_t>(std::floor((top - row) / span))};
}

/// Every tile of a level that lies on the planet is asked for by its place in the window.
void expect_addresses(const RemoteTileSet& set, const Window& window, int steps, bool from_south) {
  const int level = set.info.grid.max_level - steps;
  if (level < set.info.grid.min_level) return;
  const int z = 3 - steps, columns = window.columns << z, rows = window.rows << z;
  int compared = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double east = window.west + (x + 0.5) * (window.east - window.west) / columns;
      const double north = window.north - (y + 0.5) * (window.north - window.south) / rows;
      const TileId id = tile_at(set.info, level, window, east, north);
      if (!exists(set.info.grid, id)) continue;
      ++compared;
      EXPECT_EQ(tile_url(set, id).with_secrets(),
                fmt::format("http://host/{}/{}/{}.png", z, x, from_south ? rows - 1 - y : y));
    }
  }
  EXPECT_GT(compared, 0);
}

TEST(GdalWms, AHundredVariantsOpenAndAskForTheTilesOfTheirWindow) {
  int variants = 0;
  for (const Window& window : kWindows) {
    for (const int block : {240, 256, 360, 512, 513}) {
      for (const char* origin : {"top", "bottom"}) {
        SCOPED_TRACE(fmt::format("{}, blocks of {}, {}", window.name, block, origin));
        ++variants;
        const auto set = parse_gdal_wms(document(window, block, origin), {}, "x.xml");
        ASSERT_TRUE(set) << set.error().message;
        EXPECT_EQ(set->info.body, window.body);
        EXPECT_EQ(set->info.grid.tile_px, block);
        EXPECT_EQ(set->info.square.has_value(), window.own_square);
        EXPECT_FALSE(set->info.numbers);
        for (int steps = 0; steps <= 2; ++steps) expect_addresses(*set, window, steps, origin == std::string("bottom"));
      }
    }
  }
  EXPECT_GE(variants, 100);
}

TEST(GdalWms, SizesOfPlanetariumSoftwareGiveRootsOfAnySpan) {
  const auto sized = [](const char* size, int block) {
    return fmt::format(
        "<GDAL_WMS><Service name=\"TMS\" ServerUrl=\"http://h/${{z}}/${{y}}/${{x}}\"/><DataWindow UpperLeftX=\"-180\" "
        "UpperLeftY=\"90\" LowerRightX=\"180\" LowerRightY=\"-90\" {} "
        "YOrigin=\"top\"/><Projection>EPSG:4326</Projection>"
        "<BlockSizeX>{}</BlockSizeX><BlockSizeY>{}</BlockSizeY></GDAL_WMS>",
        size, block, block);
  };
  const auto mola = parse_gdal_wms(sized("SizeX=\"46080\" SizeY=\"23040\" TileLevel=\"6\"", 360), {}, "x");
  ASSERT_TRUE(mola) << mola.error().message;
  EXPECT_EQ(mola->info.grid.root_span_deg, 180.0);
  EXPECT_EQ(mola->info.grid.max_level, 6);
  EXPECT_EQ(tile_url(*mola, {6, 127, 3}).with_secrets(), "http://h/6/3/127");
  const auto ceres = parse_gdal_wms(sized("SizeX=\"131072\" SizeY=\"65536\" TileLevel=\"9\"", 256), {}, "x");
  ASSERT_TRUE(ceres) << ceres.error().message;
  EXPECT_EQ(ceres->info.grid.root_span_deg, 360.0);
  // 168.75 tiles: the last may be cut, so the raster is the window's own.
  const auto odd = parse_gdal_wms(sized("SizeX=\"86400\" SizeY=\"43200\" TileLevel=\"7\"", 512), {}, "x");
  ASSERT_TRUE(odd) << odd.error().message;
  EXPECT_TRUE(odd->info.square);
  EXPECT_EQ(tile_url(*odd, {odd->info.grid.max_level, 168, 84}).with_secrets(), "http://h/7/84/168");
  EXPECT_NEAR(tile_span_deg(odd->info.grid, odd->info.grid.max_level) * odd->info.square->unit_per_deg,
              512.0 * 360.0 / 86400.0, 1e-9);
}

TEST(GdalWms, OffsetsOfTilesAreAdded) {
  const Window& part = kWindows[9];
  std::string text = document(part, 256, "top");
  text.insert(text.find("<YOrigin>"), "<TileX>100</TileX><TileY>41</TileY>");
  const auto set = parse_gdal_wms(text, {}, "x");
  ASSERT_TRUE(set) << set.error().message;
  // The first tile of the window, at the finest level and half as fine.
  const int last = set->info.grid.max_level;
  EXPECT_EQ(tile_url(*set, tile_at(set->info, last, part, -44.9, 67.4)).with_secrets(), "http://host/3/100/41.png");
  EXPECT_EQ(tile_url(*set, tile_at(set->info, last - 1, part, -44.9, 67.4)).with_secrets(), "http://host/2/50/20.png");
}

TEST(GdalWms, NumbersAreHeights) {
  const auto heights = [](const std::string& more) {
    return parse_gdal_wms(document(kWindows[0], 256, "top", more), {}, "x");
  };
  const auto int16 = heights("<BandsCount>1</BandsCount><DataType>Int16</DataType><DataValues NoData=\"-32768\"/>");
  ASSERT_TRUE(int16) << int16.error().message;
  ASSERT_TRUE(int16->info.numbers);
  EXPECT_TRUE(int16->info.numbers->is_signed);
  EXPECT_EQ(int16->info.numbers->nodata, -32768.0);
  const auto floats = heights(
      "<BandsCount>1</BandsCount><DataType>Float32</DataType><DataValues><NoData>-3.4e38</NoData></DataValues>");
  ASSERT_TRUE(floats) << floats.error().message;
  EXPECT_TRUE(floats->info.numbers->floats);
  EXPECT_FALSE(heights("<DataType>Int16</DataType>"));
  EXPECT_FALSE(heights("<BandsCount>1</BandsCount><DataType>Float64</DataType>"));
  EXPECT_TRUE(heights("<BandsCount>1</BandsCount>"));
  EXPECT_TRUE(heights("<BandsCount>4</BandsCount>"));
}

TEST(GdalWms, WhatItSaysOfTheServerIsKept) {
  const auto set = parse_gdal_wms(
      document(kWindows[0], 256, "top",
               "<ZeroBlockHttpCodes>400, 204,404</ZeroBlockHttpCodes><ZeroBlockOnServerException>true"
               "</ZeroBlockOnServerException><Timeout>5</Timeout><MaxConnections>3</MaxConnections><Referer>http://me/"
               "</Referer><UserPwd>me:a:b/c</UserPwd><Cache><Expires>60</Expires></Cache><UserAgent>x</UserAgent>"),
      {}, "x");
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->missing_statuses, (std::vector<int>{400, 204, 404}));
  EXPECT_TRUE(set->exception_is_missing);
  EXPECT_EQ(set->timeout, std::chrono::seconds(5));
  EXPECT_EQ(set->connections, 3);
  EXPECT_EQ(set->tile_life, std::chrono::seconds(60));
  EXPECT_EQ(set->headers, std::vector<std::string>{"Referer: http://me/"});
  EXPECT_EQ(tile_url(*set, {0, 1, 0}).with_secrets(), "http://me:a%3Ab%2Fc@host/0/1/0.png");
  EXPECT_EQ(source_key(*set).find("a%3Ab"), std::string::npos);
  EXPECT_EQ(set->info.name.find("me:"), std::string::npos);
}

TEST(GdalWms, ServicesThatAreReadAskAsGdalDoes) {
  const auto bing = parse_gdal_wms(
      "<GDAL_WMS><Service name=\"VirtualEarth\"><ServerUrl>http://a${server_num}.host/a${quadkey}.jpeg?g=90</ServerUrl>"
      "</Service></GDAL_WMS>",
      {}, "x");
  ASSERT_TRUE(bing) << bing.error().message;
  EXPECT_EQ(bing->info.grid.min_level, 1);
  EXPECT_EQ(bing->info.grid.max_level, 19);
  const std::string url = tile_url(*bing, {3, 3, 5}).with_secrets();
  EXPECT_NE(url.find(".host/a213.jpeg?g=90"), std::string::npos) << url;  // Bing Maps Tile System: (3, 5) at level 3
  const auto wms = parse_gdal_wms(
      "<GDAL_WMS><Service "
      "name=\"WMS\"><Version>1.1.1</Version><ServerUrl>http://host/wms.cgi?</ServerUrl><SRS>EPSG:4326"
      "</SRS><ImageFormat>image/png</ImageFormat><Layers>modis%2Cmosaic</Layers><Styles></Styles></Service><DataWindow>"
      "<UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90"
      "</LowerRightY><SizeX>2666666</SizeX><SizeY>1333333</SizeY></DataWindow></GDAL_WMS>",
      {}, "x");
  ASSERT_TRUE(wms) << wms.error().message;
  EXPECT_EQ(
      tile_url(*wms, {1, 0, 0}).with_secrets(),
      "http://host/wms.cgi?SERVICE=WMS&VERSION=1.1.1&REQUEST=GetMap&LAYERS=modis,mosaic&STYLES=&SRS=EPSG:4326&FORMAT="
      "image%2Fpng&WIDTH=512&HEIGHT=512&BBOX=-180,0,-90,90");
  // Pixels no larger than the window's.
  EXPECT_LE(tile_span_deg(wms->info.grid, wms->info.grid.max_level) / 512, 360.0 / 2666666);
}

TEST(GdalWms, MistakesAreNamedWithTheirCure) {
  const auto refusal = [](const std::string& text) {
    const auto set = parse_gdal_wms(text, {}, "x.xml");
    return set ? std::string("it opened") : set.error().message;
  };
  const auto changed = [](const std::string& old, const std::string& now) {
    std::string text = document(kWindows[0], 256, "top");
    return text.replace(text.find(old), old.size(), now);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {changed("name=\"TMS\"", "name=\"TiledWMS\""), "WMTS"},
      {changed("name=\"TMS\"", ""), "not named"},
      {changed("${z}", "${zoom}"), "${zoom}"},
      {changed("http://host", "gopher://host"), "http"},
      {changed("EPSG:4326", ""), "<Projection>"},
      {changed("EPSG:4326", "+proj=utm +zone=33 +nadgrids=/etc/passwd"), "coordinate system"},
      {changed("EPSG:4326", "+init=epsg:4326"), "coordinate system"},
      {changed("EPSG:4326", "+proj=eqc +R=1737400"), "+proj=longlat +a=1737400"},
      {changed("<UpperLeftX>-180</UpperLeftX>", ""), "UpperLeftX"},
      {changed("<LowerRightX>180", "<LowerRightX>190"), "not square"},
      {changed("<LowerRightX>180", "<LowerRightX>-190"), "no window"},
      {changed("<TileCountX>2</TileCountX>", ""), "TileCountX"},
      {changed("<TileCountX>2", "<TileCountX>2e9"), "pixels"},
      {changed("<TileLevel>3", "<TileLevel>-1"), "TileLevel"},
      {changed("<YOrigin>top", "<YOrigin>left"), "YOrigin"},
      {changed("<BlockSizeX>256", "<BlockSizeX>8"), "8 by 256"},
      {changed("<BlockSizeX>256", "<BlockSizeX>many"), "BlockSizeX"},
      {changed("</GDAL_WMS>", "<ZeroBlockHttpCodes>404;500</ZeroBlockHttpCodes></GDAL_WMS>"), "ZeroBlockHttpCodes"},
      {changed("</GDAL_WMS>", "<Referer>a&#10;Host: b</Referer></GDAL_WMS>"), "Referer"},
      {changed("</GDAL_WMS>", "<DataValues NoData=\"0\"/></GDAL_WMS>"), "NoData"},
      {changed("</GDAL_WMS>", ""), "not XML"},
      {std::string(2UL << 20, 'x'), "longer"},
  };
  for (const auto& [text, part] : cases) {
    const std::string said = refusal(text);
    EXPECT_NE(said.find(part), std::string::npos) << said;
    EXPECT_TRUE(said.starts_with("x.xml: ")) << said;
  }
}

}  // namespace
}  // namespace terrella
