#include "apps/viewer/undo/layer_steps.h"

#include <algorithm>
#include <utility>

namespace terrella {

bool LayerState::operator==(const LayerState& other) const {
  const auto number = [](const LayerState& state) { return state.style ? state.style->number : 0; };
  return key == other.key && look == other.look && colormap == other.colormap && cluster_px == other.cluster_px &&
         number(*this) == number(other);
}

LayerState state_of(const LayerRow& row) {
  LayerState state{.key = row.key, .name = row.name, .look = row.look};
  state.cluster_px = row.objects.cluster_px;
  if (row.numbers) state.colormap = row.numbers->colormap;
  if (row.style) state.style = row.style->drawn();
  return state;
}

std::optional<LookStep> step_between(const std::vector<LayerState>& before, const std::vector<LayerState>& after) {
  LookStep step;
  for (const LayerState& now : after) {
    const auto then = std::ranges::find(before, now.key, &LayerState::key);
    if (then == before.end() || *then == now) continue;
    step.before.push_back(*then);
    step.after.push_back(now);
  }
  if (step.after.empty()) return {};
  return step;
}

std::string step_text(const LayerStep& step) {
  if (const auto* look = std::get_if<LookStep>(&step)) return "look of " + look->after.front().name;
  if (const auto* move = std::get_if<MoveStep>(&step)) return "order of " + move->name;
  return "removal of " + std::get<RemoveStep>(step).row.name;
}

}  // namespace terrella
