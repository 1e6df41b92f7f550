#include "apps/viewer/tools/gazetteer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

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

TEST(Gazetteer, AnExactNameComesBeforeLongerOnesWhateverTheirSize) {
  const auto places = Gazetteer::load(TERRELLA_PLACES);
  ASSERT_TRUE(places);
  for (const char* name : {"Bern", "Lima", "Mexico"}) {
    const auto found = places->find(name, 24323);
    ASSERT_FALSE(found.empty()) << name;
    const auto is_exact = [&](const NamedPlace* place) { return place->folded.size() == std::string(name).size(); };
    EXPECT_TRUE(std::ranges::is_partitioned(found, is_exact)) << name;
  }
  EXPECT_EQ(places->find("mexico", 1)[0]->people, 43694.0) << "a town of this name before Mexico City";
}

TEST(Gazetteer, NamesAPlaceByItsLargestNeighbour) {
  auto places = Gazetteer::load(TERRELLA_PLACES);
  ASSERT_TRUE(places);
  const auto nearest = [&places](double lat, double lon, double distance_deg) {
    const NamedPlace* found =
        places->near({.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}, Angle::degrees(distance_deg));
    return found == nullptr ? std::string() : found->name;
  };
  EXPECT_EQ(nearest(47.38, 8.54, 0.1), "Zürich");
  EXPECT_EQ(nearest(-17.7, 178.4, 1.0), nearest(-17.7, 178.4 - 360.0, 1.0));
  EXPECT_EQ(nearest(-40.0, -140.0, 2.0), "") << "the ocean";
  ASSERT_TRUE(places->add_areas(TERRELLA_MAP));
  EXPECT_EQ(nearest(46.9, 8.2, 1.0), "Switzerland") << "seen whole";
  EXPECT_EQ(nearest(47.38, 8.54, 0.1), "Zürich") << "seen from nearby";
}

TEST(Gazetteer, CountriesAndSeasOfTheMapAreFound) {
  auto places = Gazetteer::load(TERRELLA_PLACES);
  ASSERT_TRUE(places);
  const std::size_t cities = places->size();
  ASSERT_TRUE(places->add_areas(TERRELLA_MAP));
  EXPECT_GT(places->size(), cities + 200U);
  for (const char* name : {"india", "mexico", "Georgia", "black sea", "north", "Caspian"}) {
    const auto found = places->find(name, 3);
    ASSERT_FALSE(found.empty()) << name;
    EXPECT_GT(found[0]->area_km2, 0.0) << name << ": a city of this name, or a longer name, is first";
  }
  EXPECT_EQ(places->find("sant", 1)[0]->name, "Santiago") << "a dwarf of a country before a large city";
  const auto missing = places->add_areas("nowhere.json");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("nowhere.json"), std::string::npos);
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
