// The order of runs, judged by examples of UAX 9. As there, capitals stand for letters that run from right to left.
#include "text/text_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace terrella {
namespace {

constexpr char32_t kAlef = 0x5D0;  // the first of 27 Hebrew letters

bool is_isolate(char32_t character) { return character >= 0x2066 && character <= 0x2069; }

/// Returns a text with Hebrew letters in place of capitals.
std::u32string with_hebrew(std::u32string text) {
  for (char32_t& character : text) {
    if (character >= U'A' && character <= U'Z') character += kAlef - U'A';
  }
  return text;
}

std::vector<TextRun> runs_of(std::u32string_view text) {
  return text_runs(text, std::vector<std::uint32_t>(text.size()));
}

/// Returns the characters of a text as they are seen from left to right, with capitals again and without isolates.
std::string seen(const std::u32string& text) {
  const std::u32string given = with_hebrew(text);
  std::string line;
  for (const TextRun& run : runs_of(given)) {
    std::u32string part = text.substr(run.first, run.count);
    if (run.right_to_left) std::ranges::reverse(part);
    std::erase_if(part, is_isolate);
    line.append(part.begin(), part.end());
  }
  return line;
}

TEST(TextRuns, AWordFromRightToLeftWithinText) {
  EXPECT_EQ(seen(U"car means CAR."), "car means RAC.") << "UAX 9, L2: the full stop is of the line";
  EXPECT_EQ(seen(U"CAR means car."), ".means car RAC") << "the first letter gives the line its direction";
  EXPECT_EQ(seen(U"plain text (1)"), "plain text (1)");
}

TEST(TextRuns, NumbersAndBrackets) {
  // Glyphs of brackets are mirrored by HarfBuzz, so that here ")" opens what runs from right to left.
  EXPECT_EQ(seen(U"to SHALOM 123 (AB) x"), "to )BA( 123 MOLAHS x") << "a number within Hebrew runs as numbers do";
  EXPECT_EQ(seen(U"to SHALOM (ab) x"), "to MOLAHS (ab) x") << "a pair of brackets with Latin letters is Latin";
  EXPECT_EQ(seen(U"SHALOM 12-34"), "12-34 MOLAHS");
}

TEST(TextRuns, NestedLevels) {
  // UAX 9, L2, the last example: four levels, by isolates (U+2066 left to right, U+2067 right to left, U+2069 end).
  EXPECT_EQ(seen(U"DID YOU SAY '\u2066he said \"\u2067car MEANS CAR\u2069\"\u2069'?"),
            "?'he said \"RAC SNAEM car\"' YAS UOY DID");
}

TEST(TextRuns, EndWhereTheFontOrTheScriptChanges) {
  const std::u32string text = U"ab\u03B1\u03B2 cd";  // Greek between Latin
  const std::vector<std::uint32_t> fonts = {0, 1, 1, 1, 1, 1, 1};
  const std::vector<TextRun> runs = text_runs(text, fonts);
  ASSERT_EQ(runs.size(), 4U);
  const std::vector<std::size_t> firsts = {0, 1, 2, 5};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    EXPECT_EQ(runs[k].first, firsts[k]);
    EXPECT_EQ(runs[k].font, fonts[runs[k].first]);
    EXPECT_FALSE(runs[k].right_to_left);
  }
  EXPECT_EQ(runs[2].count, 3U) << "a space belongs to the script before it";
  EXPECT_EQ(runs[0].script, runs[3].script);
  EXPECT_NE(runs[0].script, runs[2].script);
}

TEST(TextRuns, SignsBeforeTheFirstLetterBelongToItsScript) {
  EXPECT_EQ(runs_of(U"(12) \u03B1").size(), 1U);
  EXPECT_EQ(runs_of(U"12 + 3").size(), 1U) << "signs alone";
  EXPECT_TRUE(runs_of(U"").empty());
}

}  // namespace
}  // namespace terrella
