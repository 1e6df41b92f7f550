#include "apps/viewer/balloon/object_fields.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace terrella {
namespace {

using Rows = std::vector<ObjectField>;

TEST(ObjectFields, TheNameIsTheTitleAndTheOthersAreRows) {
  const ObjectFields fields = object_fields(R"({"name": "Αθήνα", "people": 664046, "high": 12.5, "port": false})");
  EXPECT_EQ(fields.title, "Αθήνα");
  EXPECT_EQ(fields.rows, (Rows{{"high", "12.5"}, {"people", "664046"}, {"port", "false"}}));
}

TEST(ObjectFields, AnEmptyNameLeavesTheTitleToTheNextField) {
  const ObjectFields fields = object_fields(R"({"name": " ", "Name": "Berlin", "title": null})");
  EXPECT_EQ(fields.title, "Berlin");
  EXPECT_TRUE(fields.rows.empty()) << "fields without a value are left out";
}

TEST(ObjectFields, ANameThatIsThereTwiceIsShownOnce) {
  const ObjectFields fields =
      object_fields(R"({"name": "Berlin", "Name": "Berlin", "title": "City", "part": "Berlin"})");
  EXPECT_EQ(fields.title, "Berlin");
  EXPECT_EQ(fields.rows, (Rows{{"part", "Berlin"}, {"title", "City"}}));
}

TEST(ObjectFields, WithoutANameTheKindIsTheTitle) {
  const ObjectFields fields = object_fields("{}");
  EXPECT_EQ(object_title({.kind = ObjectKind::polygon}, fields), "Area");
  EXPECT_EQ(object_title({.kind = ObjectKind::point}, fields), "Point");
  EXPECT_EQ(object_title({.kind = ObjectKind::line}, object_fields(R"({"title": 7})")), "7");
}

TEST(ObjectFields, NestedValuesAreCompact) {
  const ObjectFields fields = object_fields(R"({"a": {"b": [1, null, "c"]}, "name": {"de": "Rom"}})");
  EXPECT_EQ(fields.title, "");
  EXPECT_EQ(fields.rows, (Rows{{"a", R"({"b":[1,null,"c"]})"}, {"name", R"({"de":"Rom"})"}}));
}

TEST(ObjectFields, WhatIsNoObjectHasNone) {
  for (const char* text : {"", "[1]", "7", "{\"a\":", "null"}) {
    EXPECT_TRUE(object_fields(text).rows.empty()) << text;
    EXPECT_EQ(object_fields(text).title, "") << text;
  }
}

std::string shown(const std::string& description) {
  const ObjectFields fields = object_fields("{\"description\": \"" + description + "\"}");
  return fields.rows.empty() ? "" : fields.rows.front().value;
}

TEST(ObjectFields, MarkupIsLeftOut) {
  EXPECT_EQ(shown("<p>One <b>bold</b> &amp; two</p><p>three<br>four</p>five"), "One bold & two\nthree\nfour\nfive");
  EXPECT_EQ(shown("<table><tr><td>high</td><td>12</td></tr><tr><td>wide</td></tr></table>"), "high 12\n wide");
}

TEST(ObjectFields, TextsThatAreNotWellFormedMarkupStayAsTheyAre) {
  for (const char* text : {"a < b", "<p>open", "1 <2> 3 </4>", "Tom &amp; Jerry", "<3"}) EXPECT_EQ(shown(text), text);
}

TEST(ObjectFields, DeepMarkupAndLongTextsAreCut) {
  std::string deep;
  for (int k = 0; k < 8000; ++k) deep += "<i>";
  EXPECT_LT(shown(deep + "x").size(), 1010U);
  std::string closed = deep + "x";
  for (int k = 0; k < 8000; ++k) closed += "</i>";
  EXPECT_EQ(shown(closed), "x");
  EXPECT_EQ(shown(closed + closed).size(), 1004U) << "more markup than a description has";
  std::string greek = "x";
  for (int k = 0; k < 600; ++k) greek += "α";
  EXPECT_EQ(shown(greek), greek.substr(0, 999) + " ...") << "in whole letters";
}

TEST(ObjectFields, AfterAHundredRowsTheOthersAreCounted) {
  std::string text = "{\"k\": 0";
  for (int k = 0; k < 120; ++k) text += ", \"k" + std::to_string(k) + "\": 1";
  const ObjectFields fields = object_fields(text + "}");
  ASSERT_EQ(fields.rows.size(), 101U);
  EXPECT_EQ(fields.rows.back(), (ObjectField{"...", "21 more fields"}));
}

TEST(Links, AreWholeAddressesOfHttpAndHttps) {
  for (const char* text :
       {"http://a", "https://example.org/a?b=c#d", "HTTPS://example.org", "https://el.example/Αθήνα"})
    EXPECT_TRUE(is_link(text)) << text;
  for (const char* text :
       {"", "http://", "https://", "ftp://a", "file:///etc/passwd", "javascript:alert(1)", "see https://a",
        "https://a b", "https://a\n", "https://a\"b", "https://a\\b", "https://`a`", "--help", "httpx://a"})
    EXPECT_FALSE(is_link(text)) << text;
}

}  // namespace
}  // namespace terrella
