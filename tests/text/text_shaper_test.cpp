// Lines of text, judged by their glyphs. Letters that DejaVu lacks come from the fonts that the tests install.
#include "text/text_shaper.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/support/label_font.h"

// Fontconfig loses 288 bytes when it reads its configuration, once in a process. LeakSanitizer asks this function.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace terrella {
namespace {

constexpr int kSize_px = 15;             // size of labels
constexpr char32_t kPrivate = 0x10FFFD;  // the last character for private use: no font has it

class TextShaperTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = TextShaper::create(test::label_font(), kSize_px);
    ASSERT_TRUE(made) << made.error().message;
    shaper_ = std::move(*made);
  }
  [[nodiscard]] ShapedText shape(std::u32string_view text) { return shaper_->shape(text); }
  [[nodiscard]] float width(std::u32string_view text) { return shape(text).width_px; }
  /// The glyph that a font has for a letter that stands alone.
  [[nodiscard]] std::uint32_t plain_glyph(std::uint32_t font, char32_t letter) const {
    return FT_Get_Char_Index(shaper_->face(font), letter);
  }

  std::unique_ptr<TextShaper> shaper_;
};

std::vector<std::uint32_t> indices(const ShapedText& text) {
  std::vector<std::uint32_t> found;
  for (const ShapedGlyph& glyph : text.glyphs) found.push_back(glyph.index);
  return found;
}

TEST_F(TextShaperTest, LatinLettersAreKerned) {
  EXPECT_LT(width(U"AV"), width(U"A") + width(U"V") - 0.5F);
  EXPECT_EQ(width(U"HH"), 2.0F * width(U"H"));
  EXPECT_EQ(shape(U"e\u0301").glyphs.size(), 1U) << "letter and accent are the letter with an accent";
}

TEST_F(TextShaperTest, ArabicLettersJoinFromRightToLeft) {
  const std::u32string word = U"\u0633\u0644\u0627\u0645";  // seen, lam, alef, meem
  const ShapedText line = shape(word);
  ASSERT_EQ(line.glyphs.size(), 3U) << "lam and alef are one glyph";
  EXPECT_EQ(line.glyphs.front().index, plain_glyph(0, word.back())) << "after an alef, the last letter stands alone";
  EXPECT_EQ(line.glyphs.back().index, plain_glyph(0, 0xFEB3))
      << "the first letter is the rightmost, in its initial form";
  EXPECT_NE(line.glyphs.back().index, plain_glyph(0, word.front()));
  EXPECT_TRUE(std::ranges::is_sorted(line.glyphs, {}, &ShapedGlyph::x_px));
  float alone_px = 0.0F;
  for (const char32_t& letter : word) alone_px += width({&letter, 1});
  EXPECT_LT(line.width_px, alone_px - 5.0F);
}

TEST_F(TextShaperTest, MarksStandAtTheirLetter) {
  const ShapedText line = shape(U"\u0645\u064F");  // meem and damma
  ASSERT_EQ(line.glyphs.size(), 2U);
  const auto& mark = *std::ranges::find(line.glyphs, plain_glyph(0, 0x64F), &ShapedGlyph::index);
  EXPECT_GT(mark.x_px, 0.0F);
  EXPECT_LT(mark.x_px, line.width_px);
  EXPECT_LT(mark.y_px, -1.0F) << "meem is lower than the letters that the mark is drawn for";
  EXPECT_EQ(line.width_px, width(U"\u0645"));
}

TEST_F(TextShaperTest, HebrewWithinLatin) {
  const std::vector<std::uint32_t> seen = indices(shape(U"a \u05D0\u05D1 12 (\u05D2\u05D3) b"));
  std::vector<std::uint32_t> truth;
  for (const char32_t letter : U"a (\u05D3\u05D2) 12 \u05D1\u05D0 b") {
    if (letter != 0) truth.push_back(plain_glyph(0, letter));
  }
  EXPECT_EQ(seen, truth) << "UAX 9, with brackets that are mirrored";
}

TEST_F(TextShaperTest, DevanagariIsReorderedAndMakesConjuncts) {
  const ShapedText ki = shape(U"\u0915\u093F");
  ASSERT_EQ(ki.glyphs.size(), 2U);
  const std::uint32_t font = ki.glyphs.front().font;
  EXPECT_NE(font, 0U);
  EXPECT_EQ(ki.glyphs.back().index, plain_glyph(font, 0x915)) << "the vowel sign stands left of its consonant";
  EXPECT_GT(ki.glyphs.back().x_px, ki.glyphs.front().x_px + 1.0F);
  EXPECT_EQ(shape(U"\u0915\u094D\u0937").glyphs.size(), 1U) << "ka, virama and ssa are one glyph";
  const ShapedText half = shape(U"\u0915\u094D\u200D\u0937");
  EXPECT_NE(half.glyphs.front().index, plain_glyph(font, 0x915)) << "a joiner, which DejaVu has too, makes a half ka";
  for (const ShapedGlyph& glyph : half.glyphs) EXPECT_EQ(glyph.font, font);
}

TEST_F(TextShaperTest, ThaiMarksStandOverTheirLetter) {
  const ShapedText line = shape(U"\u0E17\u0E35\u0E48");  // a consonant, a vowel and a tone
  EXPECT_EQ(line.glyphs.size(), 3U);
  EXPECT_EQ(line.width_px, width(U"\u0E17"));
  EXPECT_GT(line.width_px, 5.0F);
}

TEST_F(TextShaperTest, ChineseComesFromAFontOfTheSystem) {
  const ShapedText line = shape(U"中文字");
  ASSERT_EQ(line.glyphs.size(), 3U);
  for (const ShapedGlyph& glyph : line.glyphs) {
    EXPECT_NE(glyph.font, 0U);
    EXPECT_EQ(glyph.font, line.glyphs.front().font) << "one font for a word";
    EXPECT_NE(glyph.index, 0U);
  }
  EXPECT_EQ(line.width_px, 3.0F * kSize_px);
  EXPECT_TRUE(shaper_->without_font().empty());
  EXPECT_EQ(shape(U"a中").glyphs.front().font, 0U) << "the given font is asked first";
}

TEST_F(TextShaperTest, LettersWithoutAnyFontAreNamed) {
  const ShapedText line = shape({&kPrivate, 1});
  ASSERT_EQ(line.glyphs.size(), 1U);
  EXPECT_EQ(line.glyphs.front().font, 0U);
  EXPECT_EQ(line.glyphs.front().index, 0U) << "the mark of the given font for what it lacks";
  EXPECT_GT(line.width_px, 0.0F);
  EXPECT_EQ(shaper_->without_font(), std::set<char32_t>{kPrivate});
}

TEST_F(TextShaperTest, SpacesComeFromTheFontOfTheLettersBeforeThem) {
  const ShapedText line = shape(U"中 文");
  ASSERT_EQ(line.glyphs.size(), 3U);
  EXPECT_EQ(line.glyphs[1].font, line.glyphs[0].font);
  EXPECT_EQ(shape(U"a 中").glyphs[1].font, 0U);
}

// File names of macOS are decomposed, and fonts have the syllables of Korean alone.
TEST_F(TextShaperTest, LettersInPartsAreJoined) {
  EXPECT_EQ(indices(shape(U"\u1112\u1161\u11AB\u1100\u116E\u11A8")), indices(shape(U"한국")));
  EXPECT_EQ(indices(shape(U"u\u0308o\u0302\u0301")), indices(shape(U"üố")));
  EXPECT_TRUE(shaper_->without_font().empty());
}

TEST_F(TextShaperTest, CharactersWithoutAPictureNeedNoFont) {
  EXPECT_EQ(width(U"葛\U000E0100"), width(U"葛")) << "a selector of a variant";
  EXPECT_EQ(width(U"a\u200E\u2067b\u2069\u200D"), width(U"ab")) << "signs of direction, a joiner";
  EXPECT_TRUE(shaper_->without_font().empty());
}

TEST_F(TextShaperTest, ControlCharactersAreSpaces) {
  EXPECT_EQ(indices(shape(U"a\tb\nc\x7f")), indices(shape(U"a b c ")));
  EXPECT_EQ(indices(shape({U"\0", 1})), indices(shape(U" ")));
  EXPECT_TRUE(shaper_->without_font().empty());
}

TEST_F(TextShaperTest, SizesAreOnesOfTheSameFonts) {
  const std::u32string text = U"Hé \u0915\u093F 中";
  const ShapedText first = shape(text);
  shaper_->set_size(3 * kSize_px);
  const ShapedText large = shape(text);
  EXPECT_EQ(indices(large), indices(first));
  EXPECT_NEAR(large.width_px, 3.0F * first.width_px, 0.05F * large.width_px);
  EXPECT_NEAR(float(shaper_->ascent_px()), 3.0F * 0.928F * kSize_px, 1.0F) << "rise of DejaVu Sans: 0.928 em";
  shaper_->set_size(kSize_px);
  EXPECT_EQ(shape(text).width_px, first.width_px);
}

TEST_F(TextShaperTest, LettersHaveRoomBetweenThemUnlessTheirScriptJoinsThem) {
  constexpr float kRoom_px = 5.0F;
  const auto grown_px = [this](std::u32string_view text) {
    return shaper_->shape(text, kRoom_px).width_px - width(text);
  };
  EXPECT_FLOAT_EQ(grown_px(U"H"), 0.0F);
  EXPECT_FLOAT_EQ(grown_px(U"HHHH"), 3.0F * kRoom_px);
  EXPECT_FLOAT_EQ(grown_px(U"中文字"), 2.0F * kRoom_px);
  EXPECT_FLOAT_EQ(grown_px(U"\u05D0\u05D1\u05D2"), 2.0F * kRoom_px) << "Hebrew";
  EXPECT_FLOAT_EQ(grown_px(U"\u0E17\u0E35\u0E48"), 0.0F) << "marks stay with their letter";
  EXPECT_FLOAT_EQ(grown_px(U"\u0633\u0644\u0627\u0645"), 0.0F) << "Arabic";
  EXPECT_FLOAT_EQ(grown_px(U"\u0928\u092E\u0938\u094D\u0924\u0947"), 0.0F) << "Devanagari";
  EXPECT_EQ(shape(U"fi").glyphs.size(), 1U) << "a ligature";
  EXPECT_EQ(shaper_->shape(U"fi", kRoom_px).glyphs.size(), 2U);
}

TEST_F(TextShaperTest, AnEmptyTextHasNoGlyph) {
  EXPECT_TRUE(shape(U"").glyphs.empty());
  EXPECT_EQ(width(U""), 0.0F);
}

TEST_F(TextShaperTest, TheSameTextTwiceIsTheSameLine) {
  const std::u32string text = U"a \u0915\u093F 中 \u0633\u0644\u0627\u0645";
  const ShapedText first = shape(text), again = shape(text);
  EXPECT_EQ(indices(first), indices(again));
  EXPECT_EQ(first.width_px, again.width_px);
}

TEST_F(TextShaperTest, LinesHaveTheHeightOfTheGivenFont) {
  EXPECT_GE(shaper_->ascent_px() + shaper_->descent_px(), kSize_px);
  EXPECT_GT(shaper_->ascent_px(), shaper_->descent_px());
  EXPECT_GT(shaper_->descent_px(), 0);
}

TEST(TextShaper, ABrokenFontIsNamed) {
  std::vector<std::byte> cut = test::label_font();
  cut.resize(100);
  for (const std::vector<std::byte>& font : {cut, std::vector<std::byte>{}, std::vector(1000, std::byte{'x'})}) {
    const auto made = TextShaper::create(font, kSize_px);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("labels' font"), std::string::npos) << made.error().message;
  }
}

TEST(FontSearch, FindsTheSameFontForALetterEachTime) {
  const FontSearch fonts;
  const auto font = fonts.find(U'\u4E2D');
  ASSERT_TRUE(font);
  EXPECT_TRUE(std::ifstream(font->path).good()) << font->path;
  EXPECT_EQ(font, fonts.find(U'\u4E2D'));
  EXPECT_FALSE(fonts.find(kPrivate));
}

}  // namespace
}  // namespace terrella
