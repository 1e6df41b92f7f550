#include "text/visual_text.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

TEST(VisualText, TextFromLeftToRightIsReturnedAsItIs) {
  for (const char* text : {"", "Zürich (8000)", "Ελλάς", "Русь", "中文字", "कि", "\xc3("}) {
    EXPECT_EQ(visual_text(text), text);
  }
}

TEST(VisualText, HebrewIsReversedAndNumbersAreNot) {
  EXPECT_EQ(visual_text("\u05D0\u05D1\u05D2"), "\u05D2\u05D1\u05D0");
  EXPECT_EQ(visual_text("a \u05D0\u05D1 12 (\u05D2\u05D3) b"), "a (\u05D3\u05D2) 12 \u05D1\u05D0 b")
      << "brackets are mirrored";
}

TEST(VisualText, ArabicLettersHaveTheFormsThatTheyTakeBesideTheirNeighbours) {
  // Beh three times: final, medial and initial form, from left to right.
  EXPECT_EQ(visual_text("\u0628\u0628\u0628"), "\uFE90\uFE92\uFE91");
  EXPECT_EQ(visual_text("\u0628 \u0628"), "\uFE8F \uFE8F") << "isolated forms";
  EXPECT_EQ(visual_text("\u0644\u0627"), "\uFEFB") << "lam and alef are one letter, with no mark of the second";
}

TEST(VisualText, SignsOfDirectionHaveNoPicture) {
  EXPECT_EQ(visual_text("\u2067\u05D0\u05D1\u2069\u200E1"), "\u05D1\u05D01");
}

TEST(VisualText, EachByteThatIsNoTextIsAMark) {
  EXPECT_EQ(visual_text("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD") << "half of a pair of UTF-16";
  EXPECT_EQ(visual_text("\xf7\xbf\xbf\xbf"), "\uFFFD\uFFFD\uFFFD\uFFFD") << "beyond U+10FFFF";
  EXPECT_EQ(visual_text("\xff\u05D0\u05D1\xe2\x80"), "\uFFFD\uFFFD\u05D1\u05D0\uFFFD");
}

}  // namespace
}  // namespace terrella
