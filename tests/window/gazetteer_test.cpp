#include "apps/viewer/tools/gazetteer.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch_folder.h"

namespace terrella {
namespace {

TEST(Gazetteer, FindsByBeginningsFirstTheLargestFirst) {
  const auto places = Gazetteer::load(TERRELLA_PLACES);
  ASSERT_TRUE(places) << places.error().message;
  EXPECT_EQ(places->size(), 24323U);
  const auto sao = places->find("sao", 8);
  ASSERT_FALSE(sao.empty());
  EXPECT_EQ(sao[0]->name, "São Paulo");
  EXPECT_NEAR(sao[0]->place.lat.deg(), -23.55, 0.1);
  EXPECT_NEAR(sao[0]->place.lon.deg(), -46.63, 0.1);
  const auto with_accent = places->find("São", 8);
  ASSERT_FALSE(with_accent.empty());
  EXPECT_EQ(with_accent[0], sao[0]);
  const auto york = places->find("  YORK ", 8);
  ASSERT_FALSE(york.empty());
  EXPECT_EQ(york[0]->name, "York");
  const auto new_york = places->find("new york", 8);
  ASSERT_FALSE(new_york.empty());
  EXPECT_EQ(new_york[0]->name, "New York City");
  EXPECT_EQ(new_york[0]->country, "United States");
  for (const char* typed : {"zurich", "ZÜRICH", "Zürich", "zürich"}) {
    const auto zurich = places->find(typed, 8);
    ASSERT_FALSE(zurich.empty()) << typed;
    EXPECT_EQ(zurich[0]->name, "Zürich") << typed;
  }
  const auto by_s = places->find("s", 3);
  ASSERT_EQ(by_s.size(), 3U);
  EXPECT_GE(by_s[0]->people, by_s[1]->people);
  EXPECT_TRUE(places->find("no such place", 8).empty());
  EXPECT_TRUE(places->find("   ", 8).empty());
}

TEST(Gazetteer, WhatIsNoPlaceIsLeftOutAndAFileOfNoneIsRefused) {
  const test::ScratchFolder folder;
  const auto write = [&](const char* text) {
    std::ofstream(folder.path() / "p.geojson") << text;
    return Gazetteer::load(folder.path() / "p.geojson");
  };
  for (const char* bad :
       {"", "{", "[]", "{\"features\":7}", "{\"features\":[1,{},{\"geometry\":null,\"properties\":{}}]}",
        R"({"features":[{"geometry":{"coordinates":[0,91]},"properties":{"name":"Beyond"}}]})"}) {
    const auto places = write(bad);
    ASSERT_FALSE(places) << bad;
    EXPECT_NE(places.error().message.find("p.geojson"), std::string::npos) << places.error().message;
  }
  const auto one = write(
      R"({"features":[5,{"geometry":{"coordinates":[7,46]},"properties":{"name":"Somewhere","pop_max":"many"}}]})");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->size(), 1U);
  EXPECT_FALSE(Gazetteer::load(folder.path() / "none"));
}

}  // namespace
}  // namespace terrella
