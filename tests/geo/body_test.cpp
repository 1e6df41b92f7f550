#include "geo/body.h"

#include <gtest/gtest.h>

#include <set>

#include "base/number.h"

namespace terrella {
namespace {

TEST(Body, EarthIsWgs84) {
  EXPECT_EQ(earth().ellipsoid.a_m(), 6378137.0);
  EXPECT_EQ(earth().ellipsoid.f(), 1.0 / 298.257223563);
  EXPECT_NEAR(earth().ellipsoid.b_m(), 6356752.3142, 5e-5);  // NGA.STND.0036 prints four digits
}

TEST(Body, PresetsAreDistinctAndInTheEllipsoidsDomain) {
  std::set<std::string> names;
  for (const Body& body : body_presets()) {
    EXPECT_TRUE(names.insert(body.name).second) << body.name;
    EXPECT_TRUE(body.ellipsoid.a_m() >= 1.0 && body.ellipsoid.a_m() <= 1e10) << body.name;
    EXPECT_TRUE(body.ellipsoid.f() >= 0.0 && body.ellipsoid.f() < 0.5) << body.name;
    EXPECT_EQ(parse_body(body.name)->name, body.name);
  }
}

TEST(Body, PublishedFlattenings) {
  const auto f = [](std::string_view name) { return parse_body(name)->ellipsoid.f(); };
  EXPECT_EQ(f("moon"), 0.0);
  EXPECT_EQ(f("sphere"), 0.0);
  EXPECT_NEAR(1.0 / f("mars"), 169.89444722, 5e-9);  // printed to eight decimals
  EXPECT_NEAR(f("saturn"), 0.09796, 5e-6);           // printed to five
  EXPECT_NEAR(f("jupiter"), 0.06487, 5e-6);
  EXPECT_EQ(parse_body("iapetus")->ellipsoid.b_m(), 712100.0);  // 745.7, 745.7 and 712.1 km: a spheroid
  EXPECT_EQ(parse_body("titan")->ellipsoid.a_m(), 2575000.0);   // radius used for maps; the mean radius is 2574.73 km
  // R1 = (2a + b) / 3 of WGS 84, rounded to 0.1 m.
  EXPECT_NEAR(parse_body("sphere")->ellipsoid.a_m(), (2.0 * 6378137.0 + earth().ellipsoid.b_m()) / 3.0, 0.05);
}

TEST(Body, NamesInAnyCase) {
  EXPECT_EQ(parse_body("MARS")->ellipsoid.a_m(), 3396190.0);
  EXPECT_EQ(parse_body(" Moon ")->name, "moon");
}

TEST(Body, AxisAndFlattening) {
  const Result<Body> body = parse_body("60268000, 0.09796");
  ASSERT_TRUE(body.ok());
  EXPECT_EQ(body->ellipsoid.a_m(), 60268000.0);
  EXPECT_EQ(body->ellipsoid.f(), 0.09796);
  EXPECT_TRUE(parse_body("1,0").ok());
  EXPECT_TRUE(parse_body("1e10,0.4999999").ok());
}

TEST(Body, RefusalsNameTheTextAndThePresets) {
  for (const char* text : {"",     "plutoo",     "6378137", "nan,0",       "6378137,nan",  "inf,0",       "0,0",
                           "-1,0", "0.5,0",      "2e10,0",  "6378137,0.5", "6378137,-0.1", "6378137,0,0", "6378137,",
                           ",0",   "6378137m,0", "0x10,0",  "1e999,0",     "earth,0",      "+1,0",        "1 2,0"}) {
    const Result<Body> body = parse_body(text);
    ASSERT_FALSE(body.ok()) << text;
    const std::string& message = body.error().message;
    EXPECT_NE(message.find('"' + std::string(text) + '"'), std::string::npos) << message;
    EXPECT_NE(message.find("earth, moon, mars, sphere"), std::string::npos) << message;
  }
}

TEST(Number, BlanksAtBothEndsAreTrimmed) {
  EXPECT_EQ(trimmed(" \t\r\na  b\r\n"), "a  b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \n"), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(Number, WhatIsReadAndWhatIsNot) {
  EXPECT_EQ(read_number("12.5"), 12.5);
  EXPECT_EQ(read_number("\t-1e3 "), -1000.0);
  EXPECT_EQ(read_number(".5"), 0.5);
  for (const char* text : {"", " ", "-", ".", "e5", "1e", "1,5", "1.5.2", "nan", "-inf", "NaN(1)", "1e400", "1e-400",
                           "0x1p3", "12°", "1_000", "١"}) {
    EXPECT_FALSE(read_number(text).has_value()) << text;
  }
  EXPECT_FALSE(read_number(std::string_view("1\0", 2)).has_value());
}

TEST(Number, QuotedTextIsShortAndPrintable) {
  EXPECT_EQ(in_quotes("a\nb\x1b[1m"), "\"a?b?[1m\"");
  EXPECT_LT(in_quotes(std::string(10000, 'x')).size(), 100U);
}

}  // namespace
}  // namespace terrella
