// Letters of the panels: one beyond Latin is loaded once a panel has written it, and lines run as their scripts do.

#include <gtest/gtest.h>
#include <imgui.h>

#include <string>
#include <string_view>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/panels/ui.h"
#include "base/code_points.h"

namespace terrella {
namespace {

/// Panels without a window and without OpenGL. All tests of a process share the letters, so each wants its own.
class PanelFonts : public testing::Test {
 protected:
  void SetUp() override { context_ = new_context(); }
  void TearDown() override { ImGui::DestroyContext(context_); }

  /// Makes a context with the fonts of that moment the current one.
  static ImGuiContext* new_context() {
    ImGuiContext* context = ImGui::CreateContext();
    ImGui::SetCurrentContext(context);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {640.0F, 480.0F};
    Ui::use_text(1.0F);
    return context;
  }

  static bool has_all(std::string_view utf8) {
    for (const char32_t letter : code_points(utf8)) {
      if (letter <= ' ') continue;
      if (ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(static_cast<ImWchar>(letter)) == nullptr) return false;
    }
    return true;
  }

 private:
  ImGuiContext* context_ = nullptr;
};

TEST_F(PanelFonts, LettersOfEachScriptAreThereOncePanelsWroteThem) {
  for (const char* text : {"Αθήνα", "Москва", "ירושלים", "القاهرة", "北京", "東京", "กรุงเทพ", "दिल्ली"}) {
    const std::string seen = panel_text(text);
    EXPECT_FALSE(has_all(seen)) << text << " is there before it is wanted";
    EXPECT_TRUE(letters_wait()) << text;
    Ui::use_text(1.0F);
    EXPECT_FALSE(letters_wait()) << text;
    EXPECT_TRUE(has_all(seen)) << text;
    EXPECT_FALSE((static_cast<void>(panel_text(text)), letters_wait())) << text << " is loaded already";
  }
  Ui::use_text(2.0F);
  EXPECT_TRUE(has_all("Αθήνα北京")) << "another scale has the same letters";
}

TEST_F(PanelFonts, LatinTextWaitsForNothing) {
  want_letters("São Paulo – Łódź, 5 km²");
  EXPECT_FALSE(letters_wait());
}

TEST_F(PanelFonts, ALetterThatNoFontHasIsSearchedOnce) {
  const char* none = "\uFDD0";  // never a character
  want_letters(none);
  EXPECT_TRUE(letters_wait());
  Ui::use_text(1.0F);
  EXPECT_FALSE(letters_wait());
  want_letters(none);
  EXPECT_FALSE(letters_wait()) << "the panels would load their fonts in each frame";
}

TEST_F(PanelFonts, LettersBeyond16BitsAndBrokenTextAreNotWanted) {
  want_letters("\U00020021 \U0001F600 \xFF\xC3");
  EXPECT_FALSE(letters_wait());
}

TEST_F(PanelFonts, AContextWithOlderFontsWaitsForTheLettersOfAnother) {
  ImGuiContext* before = ImGui::GetCurrentContext();
  ImGuiContext* other = new_context();
  want_letters("釜山");
  Ui::use_text(1.0F);
  EXPECT_FALSE(letters_wait());
  ImGui::DestroyContext(other);
  ImGui::SetCurrentContext(before);
  EXPECT_TRUE(letters_wait());
  Ui::use_text(1.0F);
  EXPECT_FALSE(letters_wait());
  EXPECT_TRUE(has_all("釜山"));
}

TEST_F(PanelFonts, EachLineRunsAsItsScriptDoes) {
  EXPECT_EQ(panel_text("Zürich"), "Zürich");
  EXPECT_EQ(panel_text("חיפה"), "הפיח");
  EXPECT_EQ(panel_text("Added חיפה.tif\nעכו"), "Added הפיח.tif\nוכע");
  EXPECT_EQ(panel_text("a\n\nb\n"), "a\n\nb\n");
  EXPECT_EQ(panel_text(""), "");
}

TEST_F(PanelFonts, LinesAreCutBeforeTheyAreTurned) {
  const std::string text = "אחת שתים שלוש";
  want_letters(text);
  Ui::use_text(1.0F);
  ImGui::NewFrame();
  EXPECT_EQ(wrapped(text, 1.1F * ImGui::CalcTextSize("אחת שתים").x), "םיתש תחא\nשולש");
  EXPECT_EQ(wrapped("ער", 0.5F), "ע\nר") << "no letter is cut";
  ImGui::EndFrame();
}

}  // namespace
}  // namespace terrella
