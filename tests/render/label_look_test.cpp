// Looks of labels: sizes, halos, anchors and room between letters, judged by their pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "object_canvas.h"
#include "tests/support/label_font.h"

namespace terrella::test {
namespace {

constexpr ObjectColor kLemon{250, 250, 0};
constexpr int kMiddle_px = 100;       // middle of the picture, where the label's place is
constexpr double kBearing_em = 0.1;   // room that DejaVu Sans leaves on both sides of an H
constexpr double kCapital_em = 0.73;  // height of its capitals

/// The pixels of letters, or of letters and halos. `right` and `bottom` are the first beyond them.
struct Ink {
  int left = 1 << 20, top = 1 << 20, right = 0, bottom = 0, pixels = 0;
  [[nodiscard]] glm::dvec2 middle() const { return {0.5 * (left + right), 0.5 * (top + bottom)}; }
};

template <class IsInk>
Ink find(const ObjectPicture& picture, const IsInk& is_ink) {
  Ink ink;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      if (!is_ink(picture.at(x, y))) continue;
      ink.left = std::min(ink.left, x), ink.right = std::max(ink.right, x + 1);
      ink.top = std::min(ink.top, y), ink.bottom = std::max(ink.bottom, y + 1);
      ++ink.pixels;
    }
  }
  return ink;
}

Ink letters(const ObjectPicture& picture) {
  return find(picture, [](const ObjectColor& c) { return c.red > 120; });
}

class LabelLookTest : public ObjectCanvas {
 protected:
  void SetUp() override {
    ObjectCanvas::SetUp();
    font_ = label_font();
    use(DepthMode::reversed, {2 * kMiddle_px, 2 * kMiddle_px});
  }
  ObjectPicture draw_labels(std::vector<LabelObject> labels) {
    return draw({.labels = std::move(labels)}, over(0.0, 0.0, 1.0e6));
  }
  ObjectPicture draw_label(const std::string& text, const LabelLook& look) {
    return draw_labels({{.text = text, .color = kLemon, .look = look}});
  }
};

TEST_F(LabelLookTest, TheAnchorIsThePartOfTheTextAtTheMarker) {
  struct Row {
    TextAnchor anchor;
    int right, down;  // the side of the marker on which the text stands
  };
  constexpr std::array<Row, 9> kRows{{{TextAnchor::center, 0, 0},
                                      {TextAnchor::left, 1, 0},
                                      {TextAnchor::right, -1, 0},
                                      {TextAnchor::top, 0, 1},
                                      {TextAnchor::bottom, 0, -1},
                                      {TextAnchor::top_left, 1, 1},
                                      {TextAnchor::top_right, -1, 1},
                                      {TextAnchor::bottom_left, 1, -1},
                                      {TextAnchor::bottom_right, -1, -1}}};
  constexpr float kText_px = 30.0F;
  constexpr double kHalfLine_px = 18.0;  // rise and depth of DejaVu Sans at 30 px: 28 and 8
  for (const float marker_px : {10.0F, 40.0F}) {
    for (const Row& row : kRows) {
      const LabelObject label{
          .text = "HH", .color = kLemon, .size_px = marker_px, .look = {.text_px = kText_px, .anchor = row.anchor}};
      const Ink ink = letters(draw_labels({label}));
      const bool is_corner = row.right != 0 && row.down != 0;
      const double reach_px = std::round((is_corner ? std::sqrt(0.5) : 1.0) * 0.5 * double(marker_px));
      const double half_px = 0.5 * (ink.right - ink.left);
      const glm::dvec2 truth(row.right * (reach_px + 4.0 + kBearing_em * kText_px + half_px),
                             row.down * (reach_px + 1.0 + kHalfLine_px));
      EXPECT_NEAR(ink.middle().x - kMiddle_px, truth.x, 1.0) << int(row.anchor) << " at " << marker_px;
      EXPECT_NEAR(ink.middle().y - kMiddle_px, truth.y, 1.0) << int(row.anchor) << " at " << marker_px;
      ASSERT_EQ(shown_labels_.labels.size(), 1U);
      const LabelBox& box = shown_labels_.labels[0].box;  // a pick finds the label in it
      EXPECT_LE(box.low_px.x, float(ink.left));
      EXPECT_LE(box.low_px.y, float(ink.top));
      EXPECT_GE(box.high_px.x, float(ink.right));
      EXPECT_GE(box.high_px.y, float(ink.bottom));
      EXPECT_LT(box.high_px.y - box.low_px.y, 2.0 * kHalfLine_px + 1.0);
    }
  }
}

TEST_F(LabelLookTest, LettersHaveTheSizeOfTheText) {
  for (const float text_px : {8.0F, 15.0F, 20.4F, 40.0F, 64.0F}) {
    const Ink ink = letters(draw_label("H", {.text_px = text_px, .anchor = TextAnchor::center}));
    const double truth_px = kCapital_em * std::round(text_px);
    EXPECT_NEAR(ink.bottom - ink.top, truth_px, std::max(0.1 * truth_px, 0.5)) << text_px;
    EXPECT_NEAR(ink.middle().y, kMiddle_px - (0.5 * kCapital_em - 0.35) * double(text_px), 1.0) << text_px;
  }
}

TEST_F(LabelLookTest, TheHaloHasItsColourAndReach) {
  constexpr ObjectColor kBlue{0, 0, 255};
  const auto look = [&](float halo_px) {
    return LabelLook{.text_px = 40.0F, .halo = kBlue, .halo_px = halo_px, .anchor = TextAnchor::center};
  };
  const Ink ink = letters(draw_label("I", look(0.0F)));
  for (const float halo_px : {1.0F, 3.0F, 8.0F}) {
    const ObjectPicture picture = draw_label("I", look(halo_px));
    const ObjectColor near = picture.at(ink.left - int(halo_px), kMiddle_px);
    EXPECT_GT(near.alpha, 200) << halo_px;
    EXPECT_GT(near.blue, 200) << halo_px;
    EXPECT_LT(near.red, 40) << halo_px;
    EXPECT_EQ(picture.at(ink.left - int(halo_px) - 2, kMiddle_px).alpha, 0) << halo_px;
    EXPECT_EQ(letters(picture).pixels, ink.pixels) << "the letters are the same";
  }
  const ObjectPicture without = draw_label("I", look(0.0F));
  EXPECT_EQ(find(without, [](const ObjectColor& c) { return c.blue > 0; }).pixels, 0);
  const ObjectPicture clear = draw_label("I", {.text_px = 40.0F, .halo = {0, 0, 255, 0}, .anchor = TextAnchor::center});
  EXPECT_EQ(clear.rgba, without.rgba) << "a halo without strength is none";
}

TEST_F(LabelLookTest, HalosLieUnderAllLettersAndAreWholeAroundThinOnes) {
  const auto picture_of = [this](float text_px, float halo_px) {
    return draw_label("illi", {.text_px = text_px, .halo = {0, 0, 255}, .halo_px = halo_px});
  };
  EXPECT_EQ(letters(picture_of(30.0F, 8.0F)).pixels, letters(picture_of(30.0F, 0.0F)).pixels);
  const Ink ink = find(picture_of(9.0F, 0.0F), [](const ObjectColor& c) { return c.alpha > 60; });
  const ObjectPicture thin = picture_of(9.0F, 3.0F);
  for (int x = ink.left - 2; x < ink.right + 2; ++x) {
    EXPECT_GT(thin.at(x, kMiddle_px).alpha, 250) << "stems cover no pixel wholly; at " << x;
  }
}

TEST_F(LabelLookTest, TextsOverlapByTheirAnchors) {
  const double apart_deg = 1.3;  // 40 px
  const auto shown = [&](TextAnchor west, TextAnchor east) {
    draw_labels({{.text = "HHHH", .place = at(0.0, -0.5 * apart_deg), .look = {.anchor = west}},
                 {.text = "HHHH", .place = at(0.0, 0.5 * apart_deg), .look = {.anchor = east}}});
    return shown_labels_.labels.size();
  };
  EXPECT_EQ(shown(TextAnchor::left, TextAnchor::left), 1U);
  EXPECT_EQ(shown(TextAnchor::left, TextAnchor::right), 1U);
  EXPECT_EQ(shown(TextAnchor::center, TextAnchor::center), 1U);
  EXPECT_EQ(shown(TextAnchor::right, TextAnchor::left), 2U);
  EXPECT_EQ(shown(TextAnchor::top, TextAnchor::bottom), 2U);
}

TEST_F(LabelLookTest, LettersHaveRoomBetweenThem) {
  const auto ink_of = [this](float spacing_em) {
    return letters(draw_label("HHH", {.text_px = 20.0F, .letter_spacing_em = spacing_em}));
  };
  const Ink close = ink_of(0.0F), wide = ink_of(0.5F);
  const LabelBox box = shown_labels_.labels.at(0).box;
  EXPECT_NEAR(box.high_px.x, float(wide.right), 3.0) << "the room that the label takes";
  EXPECT_EQ(wide.left, close.left);
  EXPECT_NEAR(wide.right - close.right, 2 * 0.5 * 20.0, 1.0);
  EXPECT_EQ(wide.pixels, close.pixels);
}

/// The opacity of all letters together, in whole pixels.
double ink_of(const ObjectPicture& picture) {
  double sum = 0.0;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) sum += picture.at(x, y).alpha / 255.0;
  }
  return sum;
}

TEST_F(LabelLookTest, WeightsHaveMoreInkInTheSamePlace) {
  for (const std::string text : {"HHH", "illi", "\u0633\u0644\u0627\u0645"}) {
    for (const float text_px : {12.0F, 30.0F}) {
      const auto drawn = [&](TextWeight weight) {
        return draw_label(text, {.text_px = text_px, .halo_px = 0.0F, .anchor = TextAnchor::center, .weight = weight});
      };
      const ObjectPicture light = drawn(TextWeight::light), bold = drawn(TextWeight::bold);
      const ObjectPicture regular = drawn(TextWeight::regular);
      const double truth = ink_of(regular);
      EXPECT_GT(ink_of(bold), 1.3 * truth) << text << " at " << text_px;
      EXPECT_LT(ink_of(bold), 1.9 * truth) << text << " at " << text_px;
      EXPECT_LT(ink_of(light), 0.9 * truth) << text << " at " << text_px;
      EXPECT_GT(ink_of(light), 0.5 * truth) << text << " at " << text_px;
      EXPECT_NEAR(letters(bold).middle().x, letters(regular).middle().x, 1.5) << text << " at " << text_px;
      EXPECT_NEAR(letters(bold).middle().y, letters(regular).middle().y, 1.0) << text << " at " << text_px;
    }
  }
}

TEST_F(LabelLookTest, BoldLettersHaveMoreRoomUnlessTheyAreJoined) {
  const auto width_px = [this](const std::string& text, TextWeight weight) {
    draw_label(text, {.text_px = 40.0F, .anchor = TextAnchor::center, .weight = weight});
    const LabelBox& box = shown_labels_.labels.at(0).box;
    return box.high_px.x - box.low_px.x;
  };
  EXPECT_FLOAT_EQ(width_px("HHHH", TextWeight::bold) - width_px("HHHH", TextWeight::regular), 3.0F * 2.0F);
  const std::string arabic = "\u0633\u0644\u0627\u0645";
  EXPECT_FLOAT_EQ(width_px(arabic, TextWeight::bold), width_px(arabic, TextWeight::regular));
}

TEST_F(LabelLookTest, SlantedLettersLeanToTheRightAroundTheirMiddle) {
  const auto drawn = [this](const std::string& text, bool slanted) {
    return letters(
        draw_label(text, {.text_px = 60.0F, .halo_px = 0.0F, .anchor = TextAnchor::center, .slanted = slanted}));
  };
  const Ink upright = drawn("l", false), leaning = drawn("l", true);
  const double high_px = upright.bottom - upright.top;
  EXPECT_EQ(leaning.bottom - leaning.top, upright.bottom - upright.top);
  EXPECT_NEAR(leaning.right - leaning.left, upright.right - upright.left + high_px * std::tan(0.2094), 1.5);
  EXPECT_NEAR(leaning.middle().x, upright.middle().x, 1.5);
}

TEST_F(LabelLookTest, ABlurredHaloFadesWithinItsReach) {
  const auto drawn = [this](float blur_px) {
    return draw_label("I", {.text_px = 40.0F,
                            .halo = {0, 0, 255},
                            .halo_px = 6.0F,
                            .anchor = TextAnchor::center,
                            .halo_blur_px = blur_px});
  };
  const ObjectPicture hard = drawn(0.0F), soft = drawn(5.0F);
  const int edge = letters(hard).left;
  EXPECT_GT(soft.at(edge - 1, kMiddle_px).alpha, 200);
  for (int x = edge - 5; x < edge - 1; ++x) {
    EXPECT_GT(hard.at(x, kMiddle_px).alpha, 240) << edge - x;
    EXPECT_LT(soft.at(x, kMiddle_px).alpha, soft.at(x + 1, kMiddle_px).alpha) << edge - x;
  }
  EXPECT_EQ(soft.at(edge - 8, kMiddle_px).alpha, 0);
}

TEST_F(LabelLookTest, TextsTurnAtTheLimbWhereverTheyAreAnchored) {
  use(DepthMode::reversed, {400, 400});
  label_sight_.limb = &ellipsoid();
  const View view = this->view(over(0.0, 0.0, 2.0e7));
  for (const auto& [anchor, lon_deg] : {std::pair{TextAnchor::left, 74.0}, std::pair{TextAnchor::bottom_left, 74.0},
                                        std::pair{TextAnchor::right, -74.0}, std::pair{TextAnchor::top_right, -74.0}}) {
    const LabelObject label{.text = "Island", .place = at(0.0, lon_deg), .color = kLemon, .look = {.anchor = anchor}};
    const Ink ink = letters(draw({.labels = {label}}, view));
    const double place_px = project(view, ellipsoid().to_ecef(label.place))->x;
    EXPECT_LT((ink.middle().x - place_px) * lon_deg, 0.0) << "the text lies beside the planet: " << int(anchor);
    EXPECT_NEAR(std::abs(ink.middle().x - place_px), 9.0 + 0.5 * (ink.right - ink.left), 5.0) << int(anchor);
  }
}

// A picture full of large letters needs more room than the first atlas has, in one frame.
TEST_F(LabelLookTest, NoLetterLacksInAPictureOfManyLargeLetters) {
  constexpr int kRows = 12, kOfRow = 24;
  constexpr double kRow_deg = 0.52;  // 95 px; a row with its halo has 90
  use(DepthMode::reversed, {1800, 1200});
  std::vector<LabelObject> labels;
  char32_t letter = 0x391;  // Greek, then Cyrillic
  for (int row = 0; row < kRows; ++row) {
    std::string text;
    for (int k = 0; k < kOfRow; ++k, ++letter) {
      if (letter == 0x3A2) ++letter;
      text += static_cast<char>(0xC0 + letter / 64);
      text += static_cast<char>(0x80 + letter % 64);
    }
    labels.push_back({.text = text,
                      .place = at(kRow_deg * (0.5 * kRows - row - 0.5), 0.0),
                      .color = kLemon,
                      .look = {.text_px = 64.0F, .halo_px = 7.0F, .anchor = TextAnchor::center}});
  }
  const View view = this->view(over(0.0, 0.0, 1.0e6));
  const int together = letters(draw({.labels = labels}, view)).pixels;
  ASSERT_EQ(shown_labels_.labels.size(), std::size_t(kRows));
  int alone = 0;
  for (const LabelObject& label : labels) alone += letters(draw({.labels = {label}}, view)).pixels;
  EXPECT_EQ(together, alone);
  EXPECT_GT(alone, 100'000);
}

}  // namespace
}  // namespace terrella::test
