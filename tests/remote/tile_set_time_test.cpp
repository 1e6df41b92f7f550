// A set at another instant: the addresses and the keys are those of a set that was opened at that instant.
#include "streaming/remote/tile_set_time.h"

#include <gtest/gtest.h>

#include "streaming/remote/remote_source.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/wmts/wmts.h"
#include "streaming/warp/web_mercator.h"
#include "wmts_documents.h"

namespace terrella {
namespace {

UtcTime instant(const char* text) { return *parse_utc(text); }

RemoteTileSet daily(const std::string& time = {}) {
  return *parse_wmts_capabilities(test::gibs_document(), {.layer = "Daily", .time = time}, "caps");
}

RemoteOptions days(const std::string& time = {}) {
  return {.time = time, .times = {"2026-01-01/2026-12-31/P1D"}, .max_level = 3};
}

RemoteTileSet dated(const std::string& url, const RemoteOptions& options = days()) {
  auto set = template_tile_set(url, options, true, "here");
  EXPECT_TRUE(set) << set.error().message;
  return set ? *std::move(set) : RemoteTileSet{};
}

void expect_dated_refused(const std::string& url, const std::string& why, const RemoteOptions& options = days()) {
  const auto set = template_tile_set(url, options, true, "here");
  ASSERT_FALSE(set) << url;
  EXPECT_TRUE(set.error().message.starts_with("here: ")) << set.error().message;
  EXPECT_NE(set.error().message.find(why), std::string::npos) << set.error().message;
}

const std::string kDays = "https://h/{time}/{z}/{x}/{y}.png";

TEST(TileSetTime, AddressesAndKeysAreThoseOfASetOpenedThen) {
  const RemoteTileSet opened = daily("2012-07-09");
  EXPECT_EQ(source_key(opened),
            R"({"url":"https://example.com/wmts/epsg4326/best/Daily/default/2012-07-09/250m/{z}/{row}/{col}.png",)"
            R"("subdomains":[],"levels":["0","1","2","3","4","5","6","7","8"],"shifts":[]})");
  const auto set = at_time(daily(), instant("2012-07-09T23:59Z"));
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(tile_url(*set, {2, 4, 2}), tile_url(opened, {2, 4, 2}));
  EXPECT_EQ(source_key(*set), source_key(opened));
  EXPECT_EQ(set->info.time, "2012-07-09");
  EXPECT_EQ(set->info.instant, instant("2012-07-09"));
  EXPECT_FALSE(set->missing_life) << "it is not the newest";
  const auto newest = at_time(*set, instant("2030-01-01"));
  ASSERT_TRUE(newest);
  EXPECT_EQ(source_key(*newest), source_key(daily()));
  EXPECT_EQ(newest->missing_life, kNewestMissingLife);
}

TEST(TileSetTime, ATimeInAGapIsTheStepBeforeIt) {
  const auto set = at_time(daily(), instant("2021-01-15"));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->info.time, "2020-12-31");
}

TEST(TileSetTime, ATimeBeforeTheFirstIsRefusedByItsName) {
  const auto set = at_time(daily(), instant("1999-12-31T12:00Z"));
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("nothing at 1999-12-31T12:00:00Z"), std::string::npos) << set.error().message;
  EXPECT_NE(set.error().message.find("2000-02-24"), std::string::npos) << set.error().message;
  const auto still = at_time(*parse_wmts_capabilities(test::gibs_document(), {.layer = "Still"}, "caps"), UtcTime());
  EXPECT_NE(still.error().message.find("no list of times"), std::string::npos);
}

TEST(TileSetTime, ATemplateHasTheNewestStepOrTheOneAtATime) {
  EXPECT_EQ(tile_url(dated(kDays), {1, 2, 0}), "https://h/2026-12-31/1/2/0.png");
  EXPECT_EQ(tile_url(dated(kDays, days("2026-02-03T10:00Z")), {1, 2, 0}), "https://h/2026-02-03/1/2/0.png");
  EXPECT_EQ(dated(kDays, days("latest")).info.time, "2026-12-31");
  EXPECT_EQ(dated(kDays).info.times, "2026-01-01 to 2026-12-31: 365 instants, P1D");
  EXPECT_NE(source_key(dated(kDays)), source_key(dated(kDays, days("2026-02-03"))));
}

TEST(TileSetTime, ATemplateWritesATimeByItsFormat) {
  const RemoteOptions minutes{.times = {"2026-03-05T04:06:07Z"}, .max_level = 3};
  const auto written = [&](const std::string& format) {
    const std::string url = tile_url(dated("https://h/{time:" + format + "}/{z}/{x}/{y}", minutes), {}).with_secrets();
    return url.substr(10, url.size() - 16);
  };
  EXPECT_EQ(written("%Y/%m/%d"), "2026/03/05");
  EXPECT_EQ(written("%y%j-%H%M%S"), "26064-040607");
  EXPECT_EQ(written("%d%b%Y"), "05Mar2026");
  EXPECT_EQ(written("%B_%%3A"), "March_%3A");
  EXPECT_EQ(written("%s"), "1772683567");
}

TEST(TileSetTime, TheServersDefaultIsNoKnownInstant) {
  const auto instant_at = [](const std::string& time) {
    TileSetInfo info;
    info.time = time;
    set_steps(*TimeSteps::parse(std::vector<std::string>{"2026-01-01/2026-01-09/P1D"}, UtcTime()), info);
    return info.instant;
  };
  EXPECT_EQ(instant_at("current"), instant("2026-01-09"));
  EXPECT_EQ(instant_at("2026-01-05"), instant("2026-01-05"));
  EXPECT_EQ(instant_at("default"), std::nullopt);
  EXPECT_EQ(tile_url(dated(kDays, days("default")), {1, 2, 0}), "https://h/2026-12-31/1/2/0.png") << "ours is";
}

TEST(TileSetTime, ATemplateIsRefusedByTheReason) {
  expect_dated_refused("https://h/{time:%Q}/{z}/{x}/{y}", "unknown code %Q");
  expect_dated_refused("https://h/{time:%}/{z}/{x}/{y}", "unknown code %");
  expect_dated_refused("https://h/{time:}/{z}/{x}/{y}", "no format");
  expect_dated_refused("https://{time}/{z}/{x}/{y}", "in its host");
  expect_dated_refused("https://h/{z}/{x}/{y}", "no {time}");
  expect_dated_refused(kDays, "‹times›", {.max_level = 3});
  expect_dated_refused(kDays, "ends before it begins", {.times = {"2026-02-01/2026-01-01/P1D"}, .max_level = 3});
  expect_dated_refused(kDays, "its first time is 2026-01-01", days("2025-12-31"));
  expect_dated_refused(kDays, "\"yesterday\" is no time", days("yesterday"));
}

TEST(TileSetTime, ASourceIsHadAtAnotherTimeThroughWebMercatorToo) {
  for (const Projection projection : {Projection::equirectangular, Projection::web_mercator}) {
    RemoteOptions options = days();
    options.projection = projection;
    std::vector<std::string> cached;
    const OpenCache open_cache = [&](const RemoteTileSet& set) {
      cached.push_back(set.info.time);
      return Result<std::shared_ptr<TileCache>>(nullptr);
    };
    const auto source = as_geodetic(make_remote_source(dated(kDays, options), nullptr, {}, open_cache), "here");
    ASSERT_TRUE(source) << source.error().message;
    const auto other = (*source)->at_time(instant("2026-05-06T07:00Z"));
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_EQ((*other)->info().instant, instant("2026-05-06"));
    EXPECT_EQ((*other)->info().steps, (*source)->info().steps) << "shared";
    EXPECT_EQ((*(*other)->at_time(instant("2026-05-07")))->info().time, "2026-05-07");
    EXPECT_EQ(cached, (std::vector<std::string>{"2026-05-06", "2026-05-07"}));
    EXPECT_FALSE((*source)->at_time(instant("2025-01-01")));
  }
}

}  // namespace
}  // namespace terrella
