#include "apps/viewer/parts/messages.h"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(Messages, ShowNoSecretsOfAddresses) {
  Messages messages;
  for (const char* address : {"http://me:hush@h/x?key=hush", "ftp://me:a/hush@h/x.tif?key=hush", "me:hush@h:80/x"}) {
    messages.say(std::string(address) + ": no answer");
    EXPECT_EQ(messages.text().find("hush"), std::string::npos) << messages.text();
    messages.report(address);
    messages.report(address);
    EXPECT_EQ(messages.text().find("hush"), std::string::npos) << messages.text();
    EXPECT_EQ(std::ranges::count(messages.text(), '\n'), 1) << messages.text();
    messages = {};
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
