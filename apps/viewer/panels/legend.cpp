#include "apps/viewer/panels/legend.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "base/code_points.h"

namespace terrella {
namespace {

constexpr float kBarWidth = 17.0F;  // in text heights
constexpr float kBarHeight = 0.9F;
constexpr float kTickHeight = 0.3F;
constexpr float kTitleHeight = 1.25F;
constexpr float kItemHeight = kTitleHeight + kBarHeight + kTickHeight + 1.15F;
constexpr float kClassHeight = 1.25F, kSwatchWidth = 1.6F, kAfterClasses = 0.25F;
constexpr int kSlices = 256;
constexpr int kMostTicks = 6;
const ImU32 kInk = IM_COL32(232, 240, 248, 255);
const ImU32 kChecker = IM_COL32(110, 116, 124, 255);  // under transparent colours

ImU32 packed(const Rgba8& c) { return IM_COL32(c.r, c.g, c.b, c.a); }

void draw_bar(ImDrawList* list, const NumberLook& look, ImVec2 at, ImVec2 size) {
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, kChecker);
  for (int i = 0; i < kSlices; ++i) {
    const double share = (i + 0.5) / kSlices;
    const float left = at.x + size.x * static_cast<float>(i) / kSlices;
    const float right = at.x + size.x * static_cast<float>(i + 1) / kSlices;
    list->AddRectFilled({left, at.y}, {right, at.y + size.y},
                        packed(color_of(look, look.low + share * (look.high - look.low))));
  }
}

/// Texts stay within the bar and do not touch each other.
void draw_ticks(ImDrawList* list, const NumberLook& look, ImVec2 at, float width) {
  const std::vector<double> ticks = legend_ticks(look.low, look.high, kMostTicks);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : look.high - look.low;
  const float unit = ImGui::GetFontSize();
  float free_from = at.x - unit;
  for (const double tick : ticks) {
    const auto x = at.x + width * static_cast<float>((tick - look.low) / (look.high - look.low));
    list->AddLine({x, at.y}, {x, at.y + kTickHeight * unit}, kInk, line_width(1.2F));
    const std::string text = tick_text(tick, step);
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    const float left = std::clamp(x - 0.5F * wide, at.x, at.x + width - wide);
    if (left < free_from) continue;
    list->AddText({left, at.y + kTickHeight * unit}, kInk, text.c_str());
    free_from = left + wide + 0.5F * unit;
  }
}

std::string shortened(std::string text, float most) {
  if (ImGui::CalcTextSize(text.c_str()).x <= most) return text;
  while (!text.empty() && ImGui::CalcTextSize((text + "...").c_str()).x > most) {
    do {
      text.pop_back();
    } while (!text.empty() && is_within_character(text.back()));
  }
  return text + "...";
}

float height_of(const LegendItem& item) {
  if (item.classes.empty()) return kItemHeight;
  return kTitleHeight + kClassHeight * static_cast<float>(item.classes.size()) + kAfterClasses;
}

void draw_classes(ImDrawList* list, const std::vector<LegendClass>& classes, ImVec2 at, float width) {
  const float unit = ImGui::GetFontSize(), from = (kSwatchWidth + 0.5F) * unit;
  for (const LegendClass& one : classes) {
    list->AddRectFilled(at, {at.x + kSwatchWidth * unit, at.y + unit}, packed(one.color));
    list->AddText({at.x + from, at.y}, kInk, panel_text(shortened(one.text, width - from)).c_str());
    at.y += kClassHeight * unit;
  }
}

}  // namespace

std::vector<double> legend_ticks(double low, double high, int most) {
  std::vector<double> ticks;
  if (!(low < high) || !std::isfinite(high - low) || most < 1) return ticks;
  const double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));
  double step = power;
  for (const double times : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    step = times * power;
    if (std::floor(high / step) - std::ceil(low / step) + 1.0 <= most) break;
  }
  const double first = std::ceil(low / step);
  const double last = std::floor(high / step);
  for (double i = first; i <= last; i += 1.0) ticks.push_back(i * step + 0.0);
  return ticks;
}

std::string tick_text(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (size >= 1e7 || step < 1e-6) return fmt::format("{:.6g}", value);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  return text.find_first_not_of("-0.") == std::string::npos ? "0" : text;
}

double window_height() { return static_cast<double>(ImGui::GetIO().DisplaySize.y); }

UiBox legend_box(const std::vector<LegendItem>& items, double left, double bottom) {
  const double unit = Ui::text_height();
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const double most = double(ImGui::GetIO().DisplaySize.x) - 2.0 * left;
  const double width = std::min(double(kBarWidth) * unit + 2.0 * double(padding.x), most);
  double height = 2.0 * double(padding.y);
  for (const LegendItem& item : items) height += double(height_of(item)) * unit;
  return {left, bottom - height, left + width, bottom};
}

std::vector<LegendItem> legend_with_room(std::vector<LegendItem> items, double left, double bottom) {
  while (!items.empty() && legend_box(items, left, bottom).top < 0.0) items.pop_back();
  return items;
}

void draw_legend(const std::vector<LegendItem>& items, double left, double bottom) {
  if (items.empty()) return;
  const float unit = ImGui::GetFontSize();
  const UiBox box = legend_box(items, left, bottom);
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const ImVec2 inner{static_cast<float>(box.right - box.left) - 2.0F * padding.x,
                     static_cast<float>(box.bottom - box.top) - 2.0F * padding.y};
  begin_fixed("##legend", {static_cast<float>(left), static_cast<float>(bottom)}, {0.0F, 1.0F}, inner);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImVec2 at = ImGui::GetCursorScreenPos();
  for (const LegendItem& item : items) {
    const std::string said = item.unit.empty() ? item.title : item.title + ", " + item.unit;
    list->AddText(at, kInk, panel_text(shortened(said, inner.x)).c_str());
    const ImVec2 under{at.x, at.y + kTitleHeight * unit};
    draw_classes(list, item.classes, under, inner.x);
    if (item.classes.empty()) {
      draw_bar(list, item.look, under, {inner.x, kBarHeight * unit});
      draw_ticks(list, item.look, {under.x, under.y + kBarHeight * unit}, inner.x);
    }
    at.y += height_of(item) * unit;
  }
  ImGui::End();
}

}  // namespace terrella
