#include "apps/viewer/panels/number_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kHistogramHeight = 4.5F;  // in text heights
constexpr float kHandleReach = 0.6F;      // in text heights, from a handle to the mouse
constexpr double kLeastShare = 1e-3;      // least distance between the handles, as a share of the histogram's range
const ImU32 kGround = IM_COL32(8, 12, 18, 200);
const ImU32 kHandle = IM_COL32(245, 200, 66, 255);

struct Range {
  double low, high;
};

/// The values that the histogram spans: all values, and the stretch.
Range span_of(const NumberStatistics& statistics, const NumberLook& look) {
  Range range{std::min(statistics.min, look.low), std::max(statistics.max, look.high)};
  const double beside = 0.02 * (range.high - range.low);
  return {range.low - beside, range.high + beside};
}

void draw_bins(ImDrawList* list, const NumberStatistics& statistics, const NumberLook& look, const Range& range,
               ImVec2 at, ImVec2 size) {
  const auto most = static_cast<double>(*std::ranges::max_element(statistics.bins));
  const double bin = (statistics.max - statistics.min) / static_cast<double>(NumberStatistics::kBins);
  const auto x_of = [&](double value) {
    return at.x + size.x * static_cast<float>((value - range.low) / (range.high - range.low));
  };
  for (std::size_t i = 0; i < statistics.bins.size() && most > 0.0; ++i) {
    if (statistics.bins[i] == 0) continue;
    const double value = statistics.min + bin * static_cast<double>(i);
    // A square root keeps rare values visible.
    const auto high = size.y * static_cast<float>(std::sqrt(static_cast<double>(statistics.bins[i]) / most));
    const Rgba8 c = color_of(look, value + 0.5 * bin);
    list->AddRectFilled({x_of(value), at.y + size.y - high},
                        {std::max(x_of(value + bin), x_of(value) + 1.0F), at.y + size.y},
                        IM_COL32(c.r, c.g, c.b, std::max<int>(c.a, 60)));
  }
}

/// Draws the histogram; the mouse drags the nearer handle.
void draw_histogram(const NumberStatistics& statistics, NumberLook& look) {
  static bool high_end = false;  // the handle that the mouse holds; there is one mouse
  static Range held{};           // the range while it holds one, so that the histogram stands still
  const float unit = ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x - unit, kHistogramHeight * unit};
  ImGui::InvisibleButton("##histogram", size);
  const bool begins = ImGui::IsItemActivated();
  const Range range = ImGui::IsItemActive() && !begins ? held : span_of(statistics, look);
  const auto x_of = [&](double value) {
    return at.x + size.x * static_cast<float>((value - range.low) / (range.high - range.low));
  };
  const float mouse = ImGui::GetIO().MousePos.x;
  if (begins) {
    held = range;
    high_end = std::abs(mouse - x_of(look.high)) < std::abs(mouse - x_of(look.low));
  }
  if (ImGui::IsItemActive() &&
      (!begins || std::abs(mouse - x_of(high_end ? look.high : look.low)) > kHandleReach * unit)) {
    const double share = std::clamp(static_cast<double>((mouse - at.x) / size.x), 0.0, 1.0);
    look = dragged(look, high_end, range.low + share * (range.high - range.low));
  }
  tip("Drag the two lines: values below the first and above the second have the colours of the ends.");
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, kGround);
  draw_bins(list, statistics, look, range, at, size);
  for (const double end : {look.low, look.high}) {
    list->AddLine({x_of(end), at.y}, {x_of(end), at.y + size.y}, kHandle, line_width(2.0F));
    list->AddTriangleFilled({x_of(end) - 0.3F * unit, at.y}, {x_of(end) + 0.3F * unit, at.y},
                            {x_of(end), at.y + 0.45F * unit}, kHandle);
  }
}

void draw_map_choice(NumberFacts& facts, NumberLook& look) {
  if (!ImGui::BeginCombo("Colours", facts.colormap.c_str())) return;
  std::vector<std::string> names(color_map_names().begin(), color_map_names().end());
  if (facts.quantity == "aspect") names.emplace_back("aspect");
  for (const std::string& text : names) {
    if (!ImGui::Selectable(text.c_str(), facts.colormap == text) || facts.colormap == text) continue;
    const auto made = look_of(text, {.low = look.low, .high = look.high}, true, NumberStatistics{});
    if (!made) continue;
    look = *made;
    facts.colormap = text;
  }
  ImGui::EndCombo();
}

/// A field with a number. Returns the finite number that was entered in this frame.
std::optional<double> entered_number(const char* name, double value) {
  const bool done = ImGui::InputDouble(name, &value, 0.0, 0.0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
  return done && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void draw_rules(const NumberStatistics& statistics, NumberLook& look) {
  using Kind = StretchRule::Kind;
  const std::array<std::pair<const char*, StretchRule>, 3> rules{
      {{"All values", {.kind = Kind::min_max, .low = 0.0, .high = 0.0}},
       {"2-98 %", {}},
       {"Mean ± 2 sigma", {.kind = Kind::sigma, .low = 0.0, .high = 2.0}}}};
  for (const auto& [name, rule] : rules) {
    if (ImGui::Button(name)) {
      const Stretch range = stretch_by(rule, statistics);
      look.low = range.low;
      look.high = range.high;
    }
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

}  // namespace

NumberLook dragged(NumberLook look, bool high_end, double value) {
  const double least = kLeastShare * std::max(look.high - look.low, 1e-30);
  if (high_end) {
    look.high = std::max(value, look.low + least);
  } else {
    look.low = std::min(value, look.high - least);
  }
  return look;
}

void draw_numbers(NumberFacts& facts, NumberLook& look) {
  draw_map_choice(facts, look);
  if (facts.statistics && facts.statistics->known > 0) {
    draw_histogram(*facts.statistics, look);
    draw_rules(*facts.statistics, look);
  }
  if (const auto low = entered_number("First value", look.low)) look = dragged(look, false, *low);
  if (const auto high = entered_number("Last value", look.high)) look = dragged(look, true, *high);
  if (const auto step = entered_number("Contours every", look.contour_step)) look.contour_step = std::max(*step, 0.0);
  tip("Draws contour lines at the multiples of this value. 0 draws none.");
  ImGui::Checkbox("Lit", &look.lit);
  tip("Lets Sun, relief and air change the colours. Otherwise they are those of the legend.");
  for (const std::string& line : facts.lines) write_wrapped(line, true);
}

}  // namespace terrella
