#include "apps/viewer/parts/messages.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

TEST(Messages, AnActionWaitsForAFrameWithItsMessage) {
  Messages messages;
  int acted = 0;
  for (int times = 1; times <= 2; ++times) {
    messages.begin_frame();
    messages.say_then("Preparing", [&acted] { ++acted; });  // within a frame, after its texts
    messages.end_frame();
    EXPECT_EQ(acted, times - 1) << "this frame does not show the message";
    EXPECT_TRUE(messages.has_waiting());
    messages.begin_frame();
    EXPECT_EQ(messages.text(), "Preparing");
    messages.end_frame();
    EXPECT_EQ(acted, times);
    EXPECT_FALSE(messages.has_waiting());
  }
}

TEST(Messages, AnActionMayAskForAnother) {
  Messages messages;
  bool second = false;
  messages.say_then("one", [&] { messages.say_then("two", [&second] { second = true; }); });
  messages.begin_frame();
  messages.end_frame();
  EXPECT_EQ(messages.text(), "two");
  EXPECT_FALSE(second);
  messages.begin_frame();
  messages.end_frame();
  EXPECT_TRUE(second);
}

}  // namespace
}  // namespace terrella
