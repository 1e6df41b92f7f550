#include "streaming/url.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

TEST(Url, ShowsWhatIsNoSecret) {
  const auto shown = [](const char* text) { return Url(text).redacted(); };
  EXPECT_EQ(shown("https://a.org:8443/t/{z}/{x}/{y}@2x.png"), "https://a.org:8443/t/{z}/{x}/{y}@2x.png");
  EXPECT_EQ(shown("http://[::1]:80/a"), "http://[::1]:80/a");
  EXPECT_EQ(shown("https://a.org/w?Service=WMTS&LAYER=a;b=c"), "https://a.org/w?Service=WMTS&LAYER=a;b=***");
  EXPECT_EQ(shown("https://a.org/w?level={z}&k=1{z}"), "https://a.org/w?level={z}&k=***");
  EXPECT_EQ(shown("https://me:word@a.org/x?hush#hush"), "https://a.org/x?***");
  EXPECT_EQ(shown("https://hush@a.org?key=hush"), "https://a.org?key=***");
  EXPECT_EQ(shown("https://me:w@rd@a.org/"), "https://a.org/");
  EXPECT_EQ(shown("maps/what?.gpkg"), "maps/what?.gpkg");
  EXPECT_EQ(shown("C:/maps/a@b.gpkg"), "C:/maps/a@b.gpkg");
  EXPECT_EQ(shown(""), "");
}

// A password that is not percent-encoded makes an address that cannot be read, and is told in the message about it.
TEST(Url, ShowsNoPartOfAPasswordThatBreaksTheAddress) {
  for (const char* text : {"https://me:hu/sh@a.org/x", "https://me:hu?sh@a.org/x", "https://me:hu#sh@a.org/x",
                           "https://hush:12/sh@a.org/x", "https:/me:hush@a.org/x", "HTTP:me:hush@a.org/x",
                           R"({"url": "https://me:hush@a.org/x"})"}) {
    EXPECT_EQ(Url(text).redacted().find("hu"), std::string::npos) << Url(text).redacted();
    EXPECT_EQ(Url(text).without_query().find("sh"), std::string::npos) << Url(text).without_query();
  }
}

TEST(Url, IsRedactedInsideASentence) {
  EXPECT_EQ(redact_addresses("is \"https://me:hush@a.org/x?key=hush\", or http://b.org/y?k=hush: right?"),
            "is \"https://a.org/x?key=***\", or http://b.org/y?k=***: right?");
  EXPECT_EQ(redact_addresses("http, https and file can; http"), "http, https and file can; http");
}

TEST(Url, IsRedactedIfItIsTakenForAPath) {
  EXPECT_EQ(redact_addresses("ftp://me:hush@h/x.tif?token=hush: no such file"),
            "ftp://h/x.tif?token=***: no such file");
  EXPECT_EQ(redact_addresses("/home/ftp:/me:hush@h/x.tif?token=hush"), "/home/ftp:/h/x.tif?token=***");
  EXPECT_EQ(redact_addresses("http://me:hush@h/x y.tif?LAYER=a&token=hush is no cache"),
            "http://h/x y.tif?LAYER=a&token=*** is no cache");
  EXPECT_EQ(redact_addresses("me:hush@h:80/x: cannot be opened"), "h:80/x: cannot be opened");
  EXPECT_EQ(redact_addresses("ftp://me:hu/sh@h/x.tif, me:hu/sh@h/x"), "ftp://h/x.tif, h/x");
  EXPECT_EQ(redact_addresses("/home/s3:/me:hu/s@h@h/x.tif"), "/home/s3:/h/x.tif");
  EXPECT_EQ(redact_addresses("(http://localhost:80/{y}@2x.png)."), "(http://localhost:80/{y}@2x.png).");
  for (const char* same : {"a.tif: what?", "map@2x.png: 12:30 of 4/5/6: x=1", "C:/maps/a@b.gpkg", "is it a=b? yes"}) {
    EXPECT_EQ(redact_addresses(same), same);
  }
}

}  // namespace
}  // namespace terrella
