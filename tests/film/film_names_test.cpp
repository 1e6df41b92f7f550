#include "apps/film/film_names.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

TEST(FrameNames, NumberFrames) {
  const auto names = FrameNames::parse("frames/a%05d.png");
  ASSERT_TRUE(names);
  EXPECT_EQ(names->path(12).string(), "frames/a00012.png");
  EXPECT_EQ(names->frame_of("a00012.png"), 12);
  EXPECT_EQ(names->frame_of("a123456.png"), 123456);
  for (const char* other : {"a12.png", "a00012.jpg", "film.json", "a.png", "a-0001.png", "a00012.png.7.part"}) {
    EXPECT_FALSE(names->frame_of(other)) << other;
  }
  EXPECT_EQ(FrameNames::parse("%d.jpg")->path(7).string(), "7.jpg");
  EXPECT_EQ(FrameNames::parse("%d.jpg")->folder().string(), ".");
}

TEST(FrameNames, RefuseOtherPatterns) {
  for (const char* bad : {"a.png", "%s.png", "%5d.png", "%00d.png", "%d%d.png", "%%d.png", "a%", "%0", "%d/a.png",
                          "%d/%d.png", "%x.png", "%012d.png"}) {
    const auto names = FrameNames::parse(bad);
    ASSERT_FALSE(names) << bad;
    EXPECT_NE(names.error().message.find("frames/%05d.png"), std::string::npos) << names.error().message;
  }
}

}  // namespace
}  // namespace terrella
