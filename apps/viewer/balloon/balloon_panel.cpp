#include "apps/viewer/balloon/balloon_panel.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "apps/viewer/panels/free_place.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kBalloonMargin = 0.8F;  // in text heights, to the window's edge and to the place
constexpr float kLeastWidth = 9.0F;     // in text heights, of the contents
constexpr float kMostWidth = 22.0F;
constexpr float kMostBalloon = 20.0F;
constexpr float kLeastBalloon = 5.0F;
constexpr float kNameWidth = 18.0F;                            // in text heights, of the name at the pointer
constexpr std::array<float, 3> kShares = {1.0F, 0.7F, 0.45F};  // shares of the size, if there is little room
const ImVec4 kLinkInk(0.45F, 0.72F, 1.0F, 1.0F);
const ImVec4 kLinkGround(0.45F, 0.72F, 1.0F, 0.1F);  // under the pointer

/// A text of the balloon, wrapped.
struct BalloonItem {
  std::string text;
  ImVec2 size;
  bool quiet = false;
  bool beside = false;         ///< in the line of the item before it
  const char* link = nullptr;  ///< address that a click opens; null: none
};

/// The balloon for a width and a height: its texts as they fit.
struct BalloonContents {
  std::vector<BalloonItem> head, fields;  ///< over and under the button
  ImVec2 size;                            ///< size of the window
};

/// Width of the cross in the bar of the title, with what is around it.
float cross_width() { return ImGui::GetFontSize() + 2.0F * ImGui::GetStyle().FramePadding.x; }

/// The title as the bar shows it: one line. Dear ImGui hides a text after "##".
std::string bar_text(const BalloonTexts& texts) {
  std::string title = panel_text(texts.title.substr(0, texts.title.find('\n')));
  for (auto at = title.find("##"); at != title.npos; at = title.find("##", at)) title.insert(at + 1, " ");
  return title;
}

float width_of(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

/// Width of the contents if no line is wrapped, within limits.
float natural_width(const BalloonTexts& texts) {
  const float unit = ImGui::GetFontSize();
  float width = std::max({kLeastWidth * unit, width_of(bar_text(texts)) + cross_width(), width_of(texts.layer)});
  for (const ObjectField& field : texts.fields) {
    if (width >= kMostWidth * unit) break;
    width = std::max(width, width_of(panel_text(field.name + ": " + field.value)) + unit);
  }
  return std::min(std::ceil(width), kMostWidth * unit);
}

BalloonItem item_of(const std::string& text, float width, bool quiet) {
  BalloonItem item{.text = wrapped(text, width), .size = {}, .quiet = quiet};
  item.size = ImGui::CalcTextSize(item.text.c_str());
  return item;
}

/// `bar_width`: that of the title's bar, which does not scroll.
BalloonContents lines_of(const BalloonTexts& texts, float width, float bar_width) {
  BalloonContents lines;
  const bool fits =
      texts.title.find('\n') == std::string::npos && width_of(bar_text(texts)) <= bar_width - cross_width();
  if (!fits) lines.head.push_back(item_of(texts.title, width, false));
  lines.head.push_back(item_of(texts.layer, width, true));
  for (const ObjectField& field : texts.fields) {
    const BalloonItem& name = lines.fields.emplace_back(item_of(field.name + ":", width, true));
    const float used = name.size.x + ImGui::GetStyle().ItemInnerSpacing.x;
    BalloonItem value = item_of(field.value, width, false);
    value.beside = used + value.size.x <= width && value.text.find('\n') == std::string::npos;
    if (is_link(field.value)) value.link = field.value.c_str();
    lines.fields.push_back(std::move(value));
  }
  return lines;
}

float height_of(const std::vector<BalloonItem>& items) {
  float height = 0.0F;
  for (const BalloonItem& item : items) height += item.beside ? 0.0F : item.size.y + ImGui::GetStyle().ItemSpacing.y;
  return height;
}

/// BalloonContents that are too high scroll.
BalloonContents contents_of(const BalloonTexts& texts, float width, float most_height) {
  const ImGuiStyle& style = ImGui::GetStyle();
  BalloonContents contents = lines_of(texts, width, width);
  const float bar_and_button = 2.0F * (ImGui::GetFrameHeight() + style.WindowPadding.y);
  float height = std::ceil(bar_and_button + height_of(contents.head) + height_of(contents.fields));
  if (height > most_height) {
    height = most_height;
    contents = lines_of(texts, width - style.ScrollbarSize, width);
  }
  contents.size = {width + 2.0F * style.WindowPadding.x, height};
  return contents;
}

/// Boxes of a size beside a place: right, left, under, above. With `corners`: in those of the window and beside panels.
std::vector<UiBox> candidates_of(ImVec2 size, glm::dvec2 at, float foot, std::span<const UiBox> taken, bool corners) {
  const double margin = double(kBalloonMargin * ImGui::GetFontSize()), wide = double(size.x), high = double(size.y);
  const double right = double(ImGui::GetIO().DisplaySize.x) - margin - wide;
  std::vector<UiBox> candidates;
  const auto add = [&](double left, auto top_in) {
    const UiBox room = Ui::panel_room(float(left), float(left + wide), foot);
    const double top = top_in(room);
    if (left < margin || left > right || top < room.top || top + high > room.bottom) return;
    candidates.push_back({std::floor(left), std::floor(top), std::floor(left) + wide, std::floor(top) + high});
  };
  const auto level = [&](const UiBox& room) {
    return std::max(room.top, std::min(at.y - 0.5 * high, room.bottom - high));
  };
  const double centred = std::max(margin, std::min(at.x - 0.5 * wide, right));
  if (corners) {
    std::vector<double> lefts{right, margin};
    for (const UiBox& box : taken)
      lefts.insert(lefts.end(), {box.left - 0.5 * margin - wide, box.right + 0.5 * margin});
    for (const double left : lefts) {
      add(left, [](const UiBox& room) { return room.top; });
      add(left, [high](const UiBox& room) { return room.bottom - high; });
    }
    return candidates;
  }
  add(at.x + margin, level);
  add(at.x - margin - wide, level);
  add(centred, [&](const UiBox&) { return at.y + margin; });
  add(centred, [&](const UiBox&) { return at.y - margin - high; });
  return candidates;
}

struct PlacedBalloon {
  BalloonContents contents;
  UiBox box;
};

/// The largest balloon that has room beside the place, or else elsewhere.
std::optional<PlacedBalloon> placed_balloon(const BalloonTexts& texts, glm::dvec2 at, float foot) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const std::vector<UiBox> taken = Ui::panel_boxes();
  const float most = std::min(natural_width(texts), window.x - 2.0F * (kBalloonMargin * unit + padding.x));
  const float highest = std::min(kMostBalloon * unit, window.y - foot - 2.0F * kBalloonMargin * unit);
  for (const bool corners : {false, true}) {
    for (const float down : kShares) {
      for (const float across : kShares) {
        const float width = std::max(std::min(most, kLeastWidth * unit), std::floor(across * most));
        BalloonContents contents =
            contents_of(texts, width, std::floor(std::max(kLeastBalloon * unit, down * highest)));
        const std::vector<UiBox> candidates = candidates_of(contents.size, at, foot, taken, corners);
        const UiBox* free = first_free(candidates, {0.0, 0.0, double(window.x), double(window.y)}, taken);
        if (free != nullptr) return PlacedBalloon{std::move(contents), *free};
      }
    }
  }
  return std::nullopt;
}

/// Draws a text in the ink of links. True if it was clicked.
bool draw_link(const BalloonItem& item) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushStyleColor(ImGuiCol_HeaderHovered, kLinkGround);
  ImGui::PushStyleColor(ImGuiCol_HeaderActive, kLinkGround);
  const bool clicked = ImGui::Selectable("##link", false, 0, item.size) || entered();
  ImGui::PopStyleColor(2);
  tip("Opens the page in the browser.");
  ImGui::GetWindowDrawList()->AddText(at, ImGui::GetColorU32(kLinkInk), item.text.c_str());
  return clicked;
}

/// Draws texts one under the other. Returns the clicked link; empty: none.
std::string draw_items(const std::vector<BalloonItem>& items) {
  std::string clicked;
  for (std::size_t k = 0; k < items.size(); ++k) {
    const BalloonItem& item = items[k];
    if (item.beside) ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::PushID(int(k));
    if (item.link != nullptr) {
      if (draw_link(item)) clicked = item.link;
    } else {
      const ImGuiCol ink = item.quiet ? ImGuiCol_TextDisabled : ImGuiCol_Text;
      ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ink));
      ImGui::TextUnformatted(item.text.c_str());
      ImGui::PopStyleColor();
    }
    ImGui::PopID();
  }
  return clicked;
}

}  // namespace

std::optional<BalloonWish> draw_balloon(const BalloonTexts& texts, glm::dvec2 at, float foot, bool just_opened,
                                        bool with_keyboard) {
  const auto placed = placed_balloon(texts, at, foot);
  if (!placed) return std::nullopt;
  ImGui::SetNextWindowPos({float(placed->box.left), float(placed->box.top)});
  ImGui::SetNextWindowSize(placed->contents.size);
  ImGui::SetNextWindowBgAlpha(0.9F);
  if (with_keyboard) ImGui::SetNextWindowFocus();
  begin_panel((bar_text(texts) + kBalloon).c_str(), with_keyboard ? 0 : int(ImGuiWindowFlags_NoFocusOnAppearing));
  if (just_opened) ImGui::SetScrollY(0.0F);
  BalloonWish wish{.box = placed->box};
  (void)draw_items(placed->contents.head);
  wish.fly = ImGui::Button("Fly here") || entered();
  if (with_keyboard) {
    ImGui::SetItemDefaultFocus();
    Ui::show_focus();
  }
  wish.link = draw_items(placed->contents.fields);
  ImGui::End();
  return wish;
}

void draw_name_at_pointer(const std::string& name) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(wrapped(name, kNameWidth * ImGui::GetFontSize()).c_str());
  ImGui::EndTooltip();
}

}  // namespace terrella
