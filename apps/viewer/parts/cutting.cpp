#include "apps/viewer/parts/cutting.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kBarWidth = 24.0F;  // in text heights

int percent_of(const GrowingCut::State& state) { return static_cast<int>(100.0 * state.share); }

}  // namespace

Cutting::Cutting(const ViewerContext& context, const std::vector<std::weak_ptr<GrowingCut>>& cuts) : Part(context) {
  for (const auto& cut : cuts) rows_.push_back({.cut = cut});
}

void Cutting::add(const std::vector<std::shared_ptr<GrowingCut>>& cuts) {
  for (const auto& cut : cuts) rows_.push_back({.cut = cut});
}

bool Cutting::changed() const {
  return std::ranges::any_of(rows_, [](const Row& row) {
    const auto cut = row.cut.lock();
    if (!cut) return true;
    const GrowingCut::State state = cut->state();
    return state.ended || percent_of(state) != row.percent;
  });
}

void Cutting::draw(float) {
  std::erase_if(rows_, [this](const Row& row) {
    const auto cut = row.cut.lock();
    if (!cut) return true;
    const GrowingCut::State state = cut->state();
    if (state.error) context_.messages.report(state.error->message);
    return state.ended;
  });
  if (rows_.empty()) return;
  const float unit = ImGui::GetFontSize(), line = ImGui::GetFrameHeightWithSpacing();
  const float middle = 0.5F * ImGui::GetIO().DisplaySize.x,
              half = std::min(0.5F * kBarWidth * unit, middle - 2.0F * unit);
  begin_fixed("##cutting",
              {middle, static_cast<float>(Ui::panel_room(middle - half - unit, middle + half + unit, 0.0F).top)},
              {0.5F, 0.0F}, {2.0F * half, static_cast<float>(rows_.size()) * line});
  for (Row& row : rows_) {
    const auto cut = row.cut.lock();
    if (!cut) continue;
    row.percent = percent_of(cut->state());
    const std::string name = cut->picture().filename().string();
    const std::string text = panel_text(fmt::format("Cutting {}: {} %", name, row.percent));
    ImGui::ProgressBar(static_cast<float>(row.percent) / 100.0F, {-1.0F, 0.0F}, text.c_str());
  }
  ImGui::End();
}

}  // namespace terrella
