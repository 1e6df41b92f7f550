#include "streaming/remote/bulk_terms.h"

#include <gtest/gtest.h>

#include "streaming/remote/url_template.h"

namespace terrella {
namespace {

TEST(BulkTerms, NamesTheHostAndWhoForbidsIt) {
  const std::string why = bulk_refusal("https://tile.openstreetmap.org/0/0/0.png");
  EXPECT_NE(why.find("tile.openstreetmap.org"), std::string::npos) << why;
  EXPECT_NE(why.find("OpenStreetMap"), std::string::npos) << why;
}

TEST(BulkTerms, HoldForSubdomainsHoweverTheyAreWritten) {
  for (const char* url :
       {"https://a.tile.openstreetmap.org/0/0/0.png", "https://TILE.OpenStreetMap.ORG./0/0/0.png",
        "http://someone:secret@tile.openstreetmap.org:8080/0/0/0.png", "https://tile.openstreetmap%2Eorg/0/0/0.png",
        "https://mt1.google.com/vt?x=0", "https://ecn.t0.tiles.virtualearth.net/tiles/a0.jpeg",
        "https://server.arcgisonline.com/ArcGIS/rest/services/World_Imagery/MapServer/tile/0/0/0"}) {
    EXPECT_FALSE(bulk_refusal(url).empty()) << url;
  }
}

TEST(BulkTerms, DoNotHoldForLookAlikes) {
  for (const char* url :
       {"https://mytile.openstreetmap.org/0/0/0.png", "https://tile.openstreetmap.org.example.com/0/0/0.png",
        "https://example.com/tile.openstreetmap.org/0.png", "https://tile.openstreetmap.org@example.com/0/0/0.png",
        "https://notgoogle.com/a", "https://storage.googleapis.com/planet/0/0/0.jpg", "file:///tile.openstreetmap.org",
        "https://gibs.earthdata.nasa.gov/wmts/epsg4326/best/a.jpg", "not an address"}) {
    EXPECT_TRUE(bulk_refusal(url).empty()) << url << ": " << bulk_refusal(url);
  }
}

TEST(BulkTerms, AreFoundThroughEverySubdomain) {
  RemoteOptions options{.max_level = 3, .subdomains = {"tiles.example.com", "tile.openstreetmap.org"}};
  const auto set = template_tile_set("https://{s}/{z}/{x}/{y}.png", options, false, "test");
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_FALSE(set->refuse_bulk.empty());
}

}  // namespace
}  // namespace terrella
