#include "apps/viewer/panels/panel_items.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/viewer/panels/panel_fonts.h"
#include "base/code_points.h"

namespace terrella {
namespace {

constexpr float kLeastPanel = 4.0F;     // in text heights
constexpr float kNarrowWindow = 18.0F;  // in text heights; panels of a narrower window also scroll sideways
constexpr float kTipWidth = 18.0F;      // in text heights
constexpr float kPlainText_px = 15.0F;  // text height at 96 dots per inch
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;

}  // namespace

void begin_fixed(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 inner) {
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImGui::SetNextWindowSize({std::ceil(inner.x + 2.0F * padding.x), std::ceil(inner.y + 2.0F * padding.y)});
  ImGui::Begin(name, nullptr, kFixed);
}

namespace {

bool cross_clicked = false;  // by the cross of the panel that is being drawn; there is one mouse

bool pressed_enter() {
  const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false); };
  return pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter);
}

}  // namespace

void begin_panel(const char* title, ImGuiWindowFlags more) {
  bool open = true;
  const bool narrow = ImGui::GetIO().DisplaySize.x < kNarrowWindow * ImGui::GetFontSize();
  ImGui::Begin(title, &open, kPanelWindow | more | (narrow ? int(ImGuiWindowFlags_HorizontalScrollbar) : 0));
  if (!open) cross_clicked = true;
}

void begin_left_panel(const char* title, float width, float foot, bool just_opened) {
  const float unit = ImGui::GetFontSize(), left = 0.8F * unit;
  const float right = std::min(left + width * unit, ImGui::GetIO().DisplaySize.x - left);
  place_panel(Ui::panel_room(left, right, foot));
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(title);
}

bool take_panel_closed() { return std::exchange(cross_clicked, false); }

float line_width(float width_px) { return width_px * ImGui::GetFontSize() / kPlainText_px; }

void place_panel(const UiBox& room) {
  const ImVec2 at{static_cast<float>(room.left), static_cast<float>(room.top)};
  const float width = static_cast<float>(room.right) - at.x;
  const float most = std::max(static_cast<float>(room.bottom) - at.y, kLeastPanel * ImGui::GetFontSize());
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize({width, 0.0F});
  ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, most});
}

std::string wrapped(const std::string& text, float widest) {
  want_letters(text);
  const ImFont& font = *ImGui::GetFont();
  const char *from = text.data(), *end = from + text.size();
  std::string lines;
  while (from < end) {
    const char* to = font.CalcWordWrapPositionA(ImGui::GetFontSize() / font.FontSize, from, end, widest);
    to = std::max(to, std::find_if_not(from + 1, end, is_within_character));
    lines.append(lines.empty() ? "" : "\n").append(from, to);
    from = std::find_if(to, end, [](char c) { return c != ' '; });
  }
  return panel_text(lines);
}

void write_wrapped(const std::string& text, bool quiet) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(quiet ? ImGuiCol_TextDisabled : ImGuiCol_Text));
  ImGui::TextUnformatted(wrapped(text, ImGui::GetContentRegionAvail().x).c_str());
  ImGui::PopStyleColor();
}

std::string end_of(const std::string& text, float widest) {
  const auto fits = [widest](const std::string& one) { return ImGui::CalcTextSize(one.c_str()).x <= widest; };
  if (fits(text)) return text;
  for (std::size_t from = 1; from < text.size(); ++from) {
    if (is_within_character(text[from])) continue;
    if (std::string end = "..." + text.substr(from); fits(end)) return end;
  }
  return "...";
}

void beside_if_room(const char* text) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float wide = ImGui::CalcTextSize(text).x + 2.0F * style.FramePadding.x;
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + wide <= right) ImGui::SameLine();
}

void tip(const std::string& text) {
  const bool chosen = ImGui::IsItemFocused() && ImGui::GetIO().NavVisible;
  if (!ImGui::IsItemHovered() && !chosen) return;
  // Beside the panel, where the tip does not hide the next items, if there is room.
  const ImVec2 panel = ImGui::GetWindowPos();
  const bool left = panel.x + 0.5F * ImGui::GetWindowWidth() < 0.5F * ImGui::GetIO().DisplaySize.x;
  const float side = left ? panel.x + ImGui::GetWindowWidth() : panel.x;
  const float room = left ? ImGui::GetIO().DisplaySize.x - side : side;
  const bool beside = room > kTipWidth * ImGui::GetFontSize() + 2.0F * ImGui::GetStyle().WindowPadding.x;
  const ImVec2 window = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const std::string lines = wrapped(text, std::min(kTipWidth * ImGui::GetFontSize(), window.x - 2.0F * padding.x));
  if (!beside) {
    const ImVec2 words = ImGui::CalcTextSize(lines.c_str());
    const ImVec2 size{words.x + 2.0F * padding.x, words.y + 2.0F * padding.y};
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float under = high.y + size.y <= window.y ? high.y : low.y - size.y;
    if (under < 0.0F) return;  // no room under the item or above it
    ImGui::SetNextWindowPos({std::clamp(low.x, 0.0F, std::max(0.0F, window.x - size.x)), under});
  }
  if (beside) ImGui::SetNextWindowPos({side, ImGui::GetItemRectMin().y}, ImGuiCond_Always, {left ? 0.0F : 1.0F, 0.0F});
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(lines.c_str());
  ImGui::EndTooltip();
}

bool entered() { return ImGui::IsItemFocused() && ImGui::GetIO().NavVisible && pressed_enter(); }

bool entered_panel() { return ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows) && pressed_enter(); }

FilterTyped filter_field(const char* hint, std::string& filter, bool takes_keyboard) {
  const auto take_arrow = [](ImGuiInputTextCallbackData* data) {
    int& step = *static_cast<int*>(data->UserData);
    if (data->EventKey == ImGuiKey_UpArrow) --step;
    if (data->EventKey == ImGuiKey_DownArrow) ++step;
    return 0;
  };
  constexpr int kFlags = int(ImGuiInputTextFlags_EnterReturnsTrue) | int(ImGuiInputTextFlags_CallbackHistory);
  FilterTyped typed;
  std::array<char, 200> text{};
  filter.copy(text.data(), text.size() - 1);
  if (takes_keyboard) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0F);
  typed.entered = ImGui::InputTextWithHint("##filter", hint, text.data(), text.size(), kFlags, take_arrow, &typed.step);
  typed.has_keyboard = ImGui::IsItemActive();
  typed.edited = filter != text.data();
  filter = text.data();
  want_letters(filter);
  return typed;
}

void group(const char* name) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", name);
  ImGui::Separator();
}

void slide(const char* name, double& value, double from, double to, const char* format, ImGuiSliderFlags flags) {
  ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &from, &to, format, flags);
}

}  // namespace terrella
