#include "apps/process/console.h"

#include <gtest/gtest.h>

#include "apps/process/option_names.h"

namespace terrella {
namespace {

TEST(Printable, KeepsWhatPeopleWrite) {
  for (const char* text : {"", "plain\n\ttext", "Zürich, 東京, القاهرة, 🜨", "\u2009\u200F", "\uFFFD"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(printable("a\x1b[2Jb\rc\x07\x7f"), "a\\u001b[2Jb\\u000dc\\u0007\\u007f");
  EXPECT_EQ(printable("\u009b2J\u0085"), "\\u009b2J\\u0085");
  EXPECT_EQ(printable("\u202Egnp.exe\u2066\u2069\u2028"), "\\u202egnp.exe\\u2066\\u2069\\u2028");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
  EXPECT_EQ(one_line("a\nerror: b\tc"), "a\\u000aerror: b\\u0009c");
}

// A terminal of 8 bits obeys 0x9b alone; some decoders take what is longer than it needs to be.
TEST(Printable, ReplacesWhatIsNotUtf8) {
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            "\uFFFD2J");
  EXPECT_EQ(printable("\xc0\x9b[2J"), "\uFFFD[2J");
  EXPECT_EQ(printable("\xe0\x80\x9bx"), "\uFFFDx");
  EXPECT_EQ(printable("\xe2\x80"), "\uFFFD\uFFFD");
}

TEST(Messages, HaveNoTabs) {
  std::string told;
  const CapturedConsole captured(
      {.result = [](const std::string&) {}, .message = [&](const std::string& t) { told = t; }});
  write_message("list.txt: a\tb.tif: no such file\n");
  EXPECT_EQ(told, "list.txt: a\\u0009b.tif: no such file\n");
}

TEST(OptionNames, StandForTheSettingsOfLibraries) {
  EXPECT_EQ(with_option_names("in.tif: say ‹crs› CRS and ‹tile_px›"), "in.tif: say --crs CRS and --tile-size");
  for (const char* text : {"", "a ‹crs", "‹unknown› and ›", "‹‹", "--crs"}) EXPECT_EQ(with_option_names(text), text);
  EXPECT_EQ(with_option_names("‹ ‹crs›"), "‹ --crs");
  EXPECT_EQ(shown_message("http://me:word@host/: say ‹layer›").find("word"), std::string::npos);
}

}  // namespace
}  // namespace terrella
