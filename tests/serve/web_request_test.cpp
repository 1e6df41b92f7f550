#include "apps/serve/web_request.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

using Kind = AskedRange::Kind;

struct RangeCase {
  const char* header;
  Kind kind;
  ByteRange range{};
};

TEST(AskedRange, FollowsTheStandard) {
  constexpr std::uint64_t kBytes = 1000;
  const RangeCase cases[] = {
      {"", Kind::whole},
      {"bytes=0-0", Kind::part, {0, 1}},
      {"Bytes=10-19", Kind::part, {10, 10}},
      {"bytes=990-", Kind::part, {990, 10}},
      {"bytes=990-99999999999999999999999999", Kind::part, {990, 10}},
      {"bytes=-10", Kind::part, {990, 10}},
      {"bytes=-5000", Kind::part, {0, 1000}},
      {"bytes=-99999999999999999999999999", Kind::part, {0, 1000}},
      {"bytes=-0", Kind::beyond},
      {"bytes=1000-", Kind::beyond},
      {"bytes=1000-1001", Kind::beyond},
      {"bytes=99999999999999999999999999-", Kind::beyond},
      // Wrong or not supported: the header is ignored.
      {"bytes=20-10", Kind::whole},
      {"bytes=0-1,5-9", Kind::whole},
      {"bytes=-", Kind::whole},
      {"bytes=--1", Kind::whole},
      {"bytes=1", Kind::whole},
      {"bytes=a-b", Kind::whole},
      {"bytes=+1-2", Kind::whole},
      {"bytes", Kind::whole},
      {"lines=0-1", Kind::whole},
  };
  for (const RangeCase& one : cases) {
    const AskedRange asked = asked_range(one.header, kBytes);
    EXPECT_EQ(asked.kind, one.kind) << one.header;
    EXPECT_EQ(asked.range, one.range) << one.header;
  }
  EXPECT_EQ(asked_range("bytes=0-", 0).kind, Kind::beyond);
  EXPECT_EQ(asked_range("bytes=-1", 0).kind, Kind::beyond);
}

TEST(NamesEtag, ReadsListsAndWeakTags) {
  EXPECT_TRUE(names_etag("\"a\"", "\"a\""));
  EXPECT_TRUE(names_etag("\"b\" , W/\"a\"", "\"a\""));
  EXPECT_TRUE(names_etag("*", "\"a\""));
  EXPECT_FALSE(names_etag("", "\"a\""));
  EXPECT_FALSE(names_etag("a", "\"a\""));
  EXPECT_FALSE(names_etag("\"ab\",,", "\"a\""));
}

TEST(ReadCount, TakesPlainNumbersAlone) {
  EXPECT_EQ(read_count("0"), 0);
  EXPECT_EQ(read_count("123456789012345"), 123456789012345);
  for (const char* wrong : {"", "-1", "+1", "01", "1e3", "0x1", " 1", "1.0", "9999999999999999999999", "x"}) {
    EXPECT_EQ(read_count(wrong), -1) << wrong;
  }
}

TEST(ReadQuery, DecodesValuesOfTheFirstKeys) {
  const auto query = read_query("A=1&a=2&Format=image%2Fpng&empty=&bare&&=x");
  EXPECT_EQ(query.at("a"), "1");
  EXPECT_EQ(query.at("format"), "image/png");
  EXPECT_EQ(query.at("empty"), "");
  EXPECT_EQ(query.at("bare"), "");
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "k" + std::to_string(i) + "=v&";
  EXPECT_LE(read_query(many).size(), 64U);
}

}  // namespace
}  // namespace terrella
