#include "streaming/remote/wms/wms.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "streaming/raster/tile_raster.h"
#include "streaming/remote/describe_remote.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

std::string document(const std::string& version, const std::string& layers,
                     const std::string& formats = "<Format>image/png</Format><Format>image/jpeg</Format>",
                     const std::string& service = {}) {
  const bool is_1_3 = version.starts_with("1.3");
  return fmt::format(
      "<{0} version=\"{1}\"><Service><Name>WMS</Name>{4}</Service><Capability><Request><GetMap>{3}<DCPType><HTTP><Get>"
      "<OnlineResource "
      "xlink:href=\"http://host/map?map=a.map&amp;SERVICE=WMS\"/></Get></HTTP></DCPType></GetMap></Request>"
      "{2}</Capability></{0}>",
      is_1_3 ? "WMS_Capabilities" : "WMT_MS_Capabilities", version, layers, formats, service);
}

std::string layer(const std::string& systems, const std::string& more = {}) {
  std::string all = "<Layer><Name>a</Name><Title>A</Title>";
  for (std::size_t at = 0; at < systems.size();) {
    const std::size_t end = std::min(systems.find(' ', at), systems.size());
    all += "<CRS>" + systems.substr(at, end - at) + "</CRS>";
    at = end + 1;
  }
  return all + more + "</Layer>";
}

Result<RemoteTileSet> parsed(const std::string& xml, const std::string& address = "http://host/map",
                             const RemoteOptions& options = {}) {
  return parse_wms_capabilities(xml, read_wms_address(address), options, "w");
}

std::string bbox(const RemoteTileSet& set, const TileId& id) {
  const std::string url = tile_url(set, id).with_secrets();
  const std::size_t at = url.find("BBOX=");
  return at == std::string::npos ? url : url.substr(at + 5, url.find('&', at) - at - 5);
}

constexpr const char* kPolarBox =
    "<BoundingBox CRS=\"EPSG:3413\" minx=\"-4194304\" miny=\"-4194304\" maxx=\"4194304\" maxy=\"4194304\"/>";

TEST(Wms, AxesAreInTheOrderOfTheVersionAndOfProj) {
  const auto in_1_3 = [&](const std::string& crs, const std::string& more = {}) {
    return parsed(document("1.3.0", layer(crs, more)));
  };
  ASSERT_TRUE(in_1_3("EPSG:4326"));
  EXPECT_EQ(bbox(*in_1_3("EPSG:4326"), {1, 1, 0}), "0,-90,90,0");
  EXPECT_EQ(bbox(*in_1_3("CRS:84"), {1, 1, 0}), "-90,0,0,90");
  EXPECT_EQ(bbox(*in_1_3("urn:ogc:def:crs:OGC:1.3:CRS84"), {1, 1, 0}), "-90,0,0,90");
  EXPECT_EQ(bbox(*in_1_3("EPSG:3413", kPolarBox), {1, 1, 0}), "0,0,4194304,4194304");
  // Poland's northing comes first, in the box of the layer too.
  const auto poland = in_1_3("EPSG:2180",
                             "<BoundingBox CRS=\"EPSG:2180\" minx=\"100000\" miny=\"200000\" maxx=\"700000\" "
                             "maxy=\"800000\"/>");
  ASSERT_TRUE(poland) << poland.error().message;
  EXPECT_EQ(bbox(*poland, {1, 1, 0}), "400000,500000,700000,800000");
  EXPECT_EQ(poland->info.square->west, 200000.0);
  EXPECT_EQ(poland->info.square->north, 700000.0);
  // Version 1.1 has the easting first always.
  const auto old = parsed(document("1.1.1", layer("EPSG:4326")));
  ASSERT_TRUE(old) << old.error().message;
  EXPECT_EQ(bbox(*old, {1, 1, 0}), "-90,0,0,90");
  EXPECT_NE(tile_url(*old, {0, 0, 0}).with_secrets().find("&SRS=EPSG:4326&"), std::string::npos);
}

TEST(Wms, DegreesComeFirstThenWebMercatorThenOthers) {
  const auto chosen = [](const std::string& systems, const RemoteOptions& options = {}) {
    const auto set = parsed(document("1.3.0", layer(systems, kPolarBox)), "http://host/map", options);
    if (!set) return set.error().message;
    const std::string url = tile_url(*set, {set->info.grid.min_level, 0, 0}).with_secrets();
    const std::size_t at = url.find("CRS=");
    return url.substr(at + 4, url.find('&', at) - at - 4);
  };
  EXPECT_EQ(chosen("EPSG:3413 EPSG:3857 CRS:84 EPSG:4326"), "EPSG:4326");
  EXPECT_EQ(chosen("EPSG:3413 EPSG:3857 CRS:84"), "CRS:84");
  EXPECT_EQ(chosen("EPSG:3413 EPSG:3857"), "EPSG:3857");
  EXPECT_EQ(chosen("EPSG:999999 EPSG:3413"), "EPSG:3413");
  EXPECT_EQ(chosen("EPSG:4326 EPSG:3857", {.projection = Projection::web_mercator}), "EPSG:3857");
  EXPECT_NE(chosen("EPSG:32633").find("no BoundingBox"), std::string::npos);
}

TEST(Wms, LayersInherit) {
  const std::string nested =
      "<Layer><CRS>EPSG:4326</CRS><EX_GeographicBoundingBox><westBoundLongitude>170</"
      "westBoundLongitude><eastBoundLongitude>"
      "-170</eastBoundLongitude><southBoundLatitude>-20</southBoundLatitude><northBoundLatitude>-10</"
      "northBoundLatitude>"
      "</EX_GeographicBoundingBox><Attribution><Title>Us</Title></Attribution><MaxScaleDenominator>1e7</"
      "MaxScaleDenominator>"
      "<Layer><Name>fiji</Name><Title>Fiji</Title></Layer><Layer><Name>other</Name></Layer></Layer>";
  EXPECT_NE(parsed(document("1.3.0", nested)).error().message.find("fiji, other"), std::string::npos);
  const auto set = parsed(document("1.3.0", nested), "http://host/map", {.layer = "fiji"});
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->info.attribution, "Us");
  EXPECT_EQ(set->info.name, "Fiji");
  EXPECT_NEAR(set->info.grid.bounds.west.deg(), 170.0, 1e-9);
  EXPECT_NEAR(set->info.grid.bounds.east.deg(), -170.0, 1e-9);
  // A pixel of 512 in 180° is 1:139770566; four halvings come under 1:1e7.
  EXPECT_EQ(set->info.grid.min_level, 4);
  const auto both = parsed(document("1.3.0", nested), "http://host/map?layers=fiji,other");
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_NE(tile_url(*both, {5, 0, 0}).with_secrets().find("LAYERS=fiji,other&STYLES=,&"), std::string::npos);
}

TEST(Wms, LimitsFormatsAndTimesAreTheServers) {
  const auto small = parsed(document("1.3.0", layer("EPSG:4326"), "<Format>image/jpeg</Format>",
                                     "<MaxWidth>300</MaxWidth><MaxHeight>200</MaxHeight>"));
  ASSERT_TRUE(small) << small.error().message;
  EXPECT_EQ(small->info.grid.tile_px, 200);
  EXPECT_EQ(small->info.format, ImageFormat::jpeg);
  EXPECT_FALSE(parsed(document("1.3.0", layer("EPSG:4326"), "<Format>image/tiff</Format>")));
  const std::string time = "<Dimension name=\"time\" default=\"2004\">2003,2004</Dimension>";
  const auto timed = parsed(document("1.3.0", layer("EPSG:4326", time)), "http://host/map?TIME=2003");
  ASSERT_TRUE(timed) << timed.error().message;
  EXPECT_NE(tile_url(*timed, {0, 0, 0}).with_secrets().find("&TIME=2003"), std::string::npos);
  EXPECT_FALSE(timed->missing_life);
  EXPECT_EQ(timed->info.times, "2003 to 2004: 2 instants");
  EXPECT_TRUE(parsed(document("1.3.0", layer("EPSG:4326", time)))->missing_life) << "the newest time";
  EXPECT_FALSE(parsed(document("1.3.0", layer("EPSG:4326", time)), "http://host/map?TIME=1999"));
}

TEST(Wms, AddressesKeepWhatIsTheServersOwn) {
  const auto wms =
      read_wms_address("http://host/wms?token=x%20y&Service=WMS&REQUEST=GetMap&LAYERS=a%2Cb&bbox=1,2,3,4#f");
  EXPECT_EQ(wms.layers, "a,b");
  EXPECT_EQ(wms.extra, "token=x%20y");
  EXPECT_EQ(wms.capabilities.with_secrets(),
            "http://host/wms?token=x%20y&SERVICE=WMS&REQUEST=GetCapabilities&VERSION=1.3.0");
  EXPECT_EQ(wms.capabilities.redacted().find("x%20y"), std::string::npos);
  EXPECT_EQ(wms_base("http://host/map?map=a&request=GetMap", "token=1&map=b"), "http://host/map?map=a&token=1&");
  EXPECT_TRUE(is_wms_address("http://h/?request=getmap&x=1"));
  EXPECT_FALSE(is_wms_address("http://h/?service=WMTS&request=GetCapabilities"));
}

TEST(Wms, ADocumentSaysWhatItIs) {
  std::vector<std::string> asked;
  const FetchDocument fetch = [&](const Url& url, const auto&) -> Result<std::vector<std::byte>> {
    asked.push_back(url.with_secrets());
    const std::string text = document("1.3.0", layer("EPSG:4326"));
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return std::vector<std::byte>(bytes, bytes + text.size());
  };
  EXPECT_TRUE(describe_remote("http://host/wms?request=GetCapabilities", {}, fetch));
  EXPECT_TRUE(describe_remote("http://host/wms?service=WMS", {}, fetch));
  EXPECT_EQ(asked.back(), "http://host/wms?SERVICE=WMS&REQUEST=GetCapabilities&VERSION=1.3.0");
}

/// Tiles that say their names.
class NamedTiles : public TileSource {
 public:
  explicit NamedTiles(TileSetInfo info) : info_(std::move(info)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    return TileFailure{MissingKind::absent, fmt::format("{}/{}/{}", id.level, id.x, id.y)};
  }

 private:
  TileSetInfo info_;
};

TEST(Wms, AProjectedLayerIsARasterOfItsSystem) {
  const std::string box =
      "<BoundingBox CRS=\"EPSG:3413\" minx=\"-3000000\" miny=\"-2000000\" maxx=\"1000000\" maxy=\"0\"/>";
  const auto set =
      parsed(document("1.3.0", layer("EPSG:3413", box)), "http://host/map", {.min_level = 1, .max_level = 3});
  ASSERT_TRUE(set) << set.error().message;
  const auto raster = raster_of_tiles(std::make_unique<NamedTiles>(set->info));
  ASSERT_EQ(raster->info().levels.size(), 3U);
  EXPECT_EQ(raster->info().crs, "EPSG:3413");
  const RasterLevel& finest = raster->info().levels.back();
  EXPECT_EQ(finest.width_px, 4096);
  EXPECT_EQ(finest.height_px, 2048);
  const CrsPoint corner = finest.to_crs.at(0, 0);
  EXPECT_NEAR(corner.x, -3e6, 1e-6);
  EXPECT_NEAR(corner.y, 0.0, 1e-6);
  const CrsPoint end = finest.to_crs.at(4096, 2048);
  EXPECT_NEAR(end.x, 1e6, 1e-3);
  EXPECT_NEAR(end.y, -2e6, 1e-3);
  EXPECT_EQ(count_places(set->info.grid, 3), 32) << "all tiles of the box are listed";
  // A block of the raster is the request for the rectangle that its transform gives.
  EXPECT_EQ(raster->read({2, 3, 1}).error().why, "3/3/1");
  EXPECT_EQ(bbox(*set, {3, 3, 1}), "-1500000,-1000000,-1000000,-500000");
}

}  // namespace
}  // namespace terrella
