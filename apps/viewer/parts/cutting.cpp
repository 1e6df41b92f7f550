#include "apps/viewer/parts/cutting.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kBarWidth = 24.0F;  // in text heights

int percent_of(const GrowingCut::State& state) { return static_cast<int>(100.0 * state.share); }

}  // namespace

Cutting::Cutting(const ViewerContext& context, std::vector<std::shared_ptr<GrowingCut>> cuts) : Part(context) {
  add(std::move(cuts));
}

void Cutting::add(std::vector<std::shared_ptr<GrowingCut>> cuts) {
  for (std::shared_ptr<GrowingCut>& cut : cuts) rows_.push_back({.cut = std::move(cut)});
}

bool Cutting::changed() const {
  return std::ranges::any_of(rows_, [](const Row& row) {
    const GrowingCut::State state = row.cut->state();
    return state.ended || percent_of(state) != row.percent;
  });
}

void Cutting::draw(float) {
  std::erase_if(rows_, [this](const Row& row) {
    const GrowingCut::State state = row.cut->state();
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
    row.percent = percent_of(row.cut->state());
    const std::string name = row.cut->picture().filename().string();
    const std::string text = fmt::format("Cutting {}: {} %", name, row.percent);
    ImGui::ProgressBar(static_cast<float>(row.percent) / 100.0F, {-1.0F, 0.0F}, text.c_str());
  }
  ImGui::End();
}

}  // namespace terrella
