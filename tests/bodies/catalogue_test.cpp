// The catalogue of public services: every entry that ships is well-formed, and faults are named. No request is sent.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/viewer/catalogue/catalogue.h"

namespace terrella {
namespace {

using Json = nlohmann::json;

Json good_entry() {
  return {{"title", "Tiles"},
          {"body", "moon"},
          {"theme", "Pictures"},
          {"max-level", 3},
          {"attribution", "Me"},
          {"licence", "Free"},
          {"source", "https://tiles.example/{z}/{y}/{x}.jpg"}};
}

Catalogue parse(const Json& entry) {
  const Json json = {{"catalogue", 1}, {"entries", Json::array({entry})}};
  return parse_catalogue(json.dump(), "/folder", "my.json");
}

TEST(Catalogue, EveryEntryThatShipsIsWellFormed) {
  const std::string file = CATALOGUE_FILE;
  std::ifstream stream(file);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  const Catalogue catalogue = parse_catalogue(text, {}, file);
  for (const std::string& complaint : catalogue.complaints) ADD_FAILURE() << complaint;
  EXPECT_GE(catalogue.entries.size(), 15U);
  std::set<std::string> names, bodies;
  for (const CatalogueEntry& entry : catalogue.entries) {
    bodies.insert(entry.body.name);
    EXPECT_TRUE(names.insert(entry.body.name + entry.title).second) << entry.title << " is there twice";
    const std::string address = entry.said.address.with_secrets();
    EXPECT_TRUE(address.starts_with("https://") || address == "relief.gpkg") << entry.title << ": " << address;
    EXPECT_EQ(entry.said.address.with_secrets(), entry.said.address.redacted()) << entry.title << " has a secret";
  }
  for (const char* body : {"earth", "moon", "mars", "mercury"}) EXPECT_TRUE(bodies.contains(body)) << body;
  for (const Json& entry : Json::parse(text)["entries"]) EXPECT_TRUE(entry.contains("facts")) << entry["title"];
}

TEST(Catalogue, AnEntryHasWhatALayerNeeds) {
  Json json = good_entry();
  json["layer-times"] = "2024-01-01/2024-01-03/P1D";
  json["source"] = "https://tiles.example/{time}/{z}/{y}/{x}.jpg";
  json["latitude"] = "centric";
  const Catalogue catalogue = parse(json);
  ASSERT_TRUE(catalogue.complaints.empty()) << catalogue.complaints.front();
  const CatalogueEntry& entry = catalogue.entries.at(0);
  EXPECT_EQ(entry.body.name, "moon");
  EXPECT_TRUE(entry.has_dates);
  EXPECT_EQ(entry.said.latitude, LatitudeKind::centric);
  EXPECT_EQ(entry.said.remote.name, "Tiles");
  EXPECT_EQ(entry.said.remote.attribution, "Me");
  EXPECT_EQ(entry.said.remote.max_level, 3);
}

TEST(Catalogue, APathIsSeenFromTheFolderOfItsFile) {
  Json json = good_entry();
  json["source"] = "tiles.gpkg";
  EXPECT_EQ(parse(json).entries.at(0).said.address.with_secrets(), "/folder/tiles.gpkg");
}

TEST(Catalogue, AFaultyEntryIsNamedAndLeftOut) {
  const std::pair<const char*, Json> faults[] = {{"title", nullptr},
                                                 {"body", nullptr},
                                                 {"theme", nullptr},
                                                 {"source", nullptr},
                                                 {"attribution", nullptr},
                                                 {"licence", ""},
                                                 {"max-level", nullptr},
                                                 {"body", "moonn"},
                                                 {"source", "htps://tiles.example/{z}/{y}/{x}.jpg"},
                                                 {"max-level", -1},
                                                 {"dates", 3},
                                                 {"source", "https://tiles.example/{z}/{x}.jpg"},
                                                 {"colour", "red"},
                                                 {"layer-times", "soon"},
                                                 {"max-level", "deep"}};
  for (const auto& [field, value] : faults) {
    Json json = good_entry();
    json[field] = value;
    if (value.is_null()) json.erase(field);
    const Catalogue catalogue = parse(json);
    EXPECT_TRUE(catalogue.entries.empty()) << field;
    ASSERT_EQ(catalogue.complaints.size(), 1U) << field;
    EXPECT_NE(catalogue.complaints.front().find("my.json: entry 1"), std::string::npos) << catalogue.complaints.front();
  }
}

TEST(Catalogue, AFaultyFileIsNamed) {
  for (const char* text : {"[", "{}", R"({"catalogue": 2, "entries": []})", R"({"catalogue": 1, "entries": {}})",
                           R"({"catalogue": 1, "entries": [], "more": 1})"}) {
    const Catalogue catalogue = parse_catalogue(text, {}, "my.json");
    ASSERT_EQ(catalogue.complaints.size(), 1U) << text;
    EXPECT_NE(catalogue.complaints.front().find("my.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace terrella
