#include <imgui.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "apps/open_scene/scene_objects.h"
#include "apps/viewer/parts/layers.h"
#include "streaming/cut/growing/growing_cut.h"

// Undo and redo of what the user does to layers.
namespace terrella {
namespace {

/// True while a picture is being cut: its cut stops if the layer is removed.
bool is_growing(const LayerRow& row) {
  const auto* cut = dynamic_cast<const GrowingCut*>(row.tiles.get());
  return cut != nullptr && !cut->state().ended;
}

}  // namespace

ObjectsOption Layers::described_objects(const LayerRow& row) {
  ObjectsOption objects = row.objects;
  objects.shown = row.look.shown;
  objects.opacity = row.look.opacity;
  objects.style_over = row.style && !row.style->is_own() ? row.style->text() : std::string();
  return objects;
}

std::vector<LayerRow>::iterator Layers::row_of(unsigned key) { return std::ranges::find(rows_, key, &LayerRow::key); }

// A drag is one step: while the mouse or a text field holds an item, the change goes on.
void Layers::note_looks() {
  if (!ImGui::IsAnyItemActive()) note_looks_now();
}

void Layers::note_looks_now() {
  std::vector<LayerState> now;
  now.reserve(rows_.size());
  std::ranges::transform(rows_, std::back_inserter(now), state_of);
  if (now == steps_.seen) return;
  if (auto step = step_between(steps_.seen, now)) steps_.steps.add(*std::move(step));
  steps_.seen = std::move(now);
}

/// Takes the present looks without a step.
void Layers::forget_looks() {
  steps_.seen.clear();
  std::ranges::transform(rows_, std::back_inserter(steps_.seen), state_of);
}

// Keeps no more than the layer needs to return.
RemoveStep Layers::removal_of(const LayerRow& row) const {
  RemoveStep step{.row = row};
  step.row.objects = described_objects(row);
  step.row.objects.style_over.clear();
  if (row.style) step.style = row.style->drawn();
  step.row.style.reset();
  step.row.features.reset();
  step.row.clusters.reset();
  const LayerKind kind = step.row.kind;
  const Globe& globe = context_.globe;
  const auto ids = kind == LayerKind::objects ? globe.objects() : globe.imagery();
  step.place = std::size_t(std::ranges::find(ids, step.row.id) - ids.begin());
  if (kind == LayerKind::heights) step.heights = heights_;
  if (is_growing(step.row)) step.row.tiles.reset();
  if (kind == LayerKind::imagery && step.row.tiles) {
    const auto shown = globe.source(row.id);
    step.shown = shown ? *shown : step.row.tiles;
  }
  return step;
}

void Layers::undo() {
  note_looks_now();
  LayerStep* step = steps_.steps.undo();
  if (step == nullptr) return say("There is no change of a layer to undo; D opens the drawing");
  say("Undone: " + step_text(*step));
  if (auto* look = std::get_if<LookStep>(step)) show_states(look->before);
  if (auto* move = std::get_if<MoveStep>(step)) move_back(*move, !move->up);
  if (auto* removed = std::get_if<RemoveStep>(step)) {
    if (const Status returned = bring_back(*removed); !returned) say(returned.error());
  }
  forget_looks();
}

void Layers::redo() {
  note_looks_now();
  LayerStep* step = steps_.steps.redo();
  if (step == nullptr) return say("There is no change of a layer to redo; D opens the drawing");
  if (auto* look = std::get_if<LookStep>(step)) show_states(look->after);
  if (auto* move = std::get_if<MoveStep>(step)) move_back(*move, move->up);
  if (auto* removed = std::get_if<RemoveStep>(step)) {
    const auto row = row_of(removed->row.key);
    if (row != rows_.end()) (void)remove_row(std::size_t(row - rows_.begin()));
  }
  say("Redone: " + step_text(*step));
  forget_looks();
}

void Layers::show_states(const std::vector<LayerState>& states) {
  for (const LayerState& state : states) {
    const auto row = row_of(state.key);
    if (row == rows_.end()) continue;
    take_look(*row, state.look);
    row->objects.cluster_px = state.cluster_px;
    if (row->numbers) row->numbers->colormap = state.colormap;
    if (!row->style || !state.style || row->style->drawn().number == state.style->number) continue;
    const Status restored = row->style->restore(context_.globe, row->id, *state.style);
    if (!restored) say(restored.error());
  }
}

void Layers::move_back(const MoveStep& step, bool up) {
  const auto row = row_of(step.key);
  if (row != rows_.end()) (void)move_row(std::size_t(row - rows_.begin()), up);
}

Status Layers::bring_back(RemoveStep& step) {
  LayerRow row = step.row;
  if (row.kind == LayerKind::heights) return bring_heights_back(std::move(row), step.heights);
  if (row.kind == LayerKind::imagery && !row.tiles) return Error{row.name + " was not cut to the end: open it again"};
  Globe& globe = context_.globe;
  if (row.kind == LayerKind::imagery) {
    const auto added = globe.add_imagery(step.shown, row.look);
    if (!added) return added.error();
    row.id = *added;
  } else if (Status read = read_again(row, step.style); !read) {
    return read;
  }
  if (Status moved = globe.move(row.id, step.place); !moved) return moved;
  insert(std::move(row));
  sort_rows();
  return Done{};
}

Status Layers::bring_heights_back(LayerRow row, const std::optional<ElevationSource>& heights) {
  if (Status used = use_heights(row.look.shown ? heights : std::nullopt); !used) return used;
  heights_ = heights;
  std::erase_if(rows_, [](const LayerRow& layer) { return layer.kind == LayerKind::heights; });
  insert(std::move(row));
  return Done{};
}

/// Reads the file of a layer of objects again, and draws it in the style that it had.
Status Layers::read_again(LayerRow& row, const std::optional<LayerStyle::Drawn>& style) {
  auto added = terrella::add_objects(context_.globe, row.objects, true);
  if (!added) return added.error();
  row.id = added->id;
  row.style = style_of_layer(std::move(added->features), added->style);
  row.features = std::make_shared<const std::vector<ListedFeature>>(std::move(added->list));
  row.take_points(std::move(added->points));
  if (row.style && style) {
    if (Status restored = row.style->restore(context_.globe, row.id, *style); !restored) return restored;
  }
  return context_.globe.set_attribution(row.id, row.attribution);
}

/// Gives the rows of each kind the globe's order.
void Layers::sort_rows() {
  const Globe& globe = context_.globe;
  std::vector<LayerId> order = globe.imagery();
  std::ranges::copy(globe.objects(), std::back_inserter(order));
  const auto place = [&order](const LayerRow& row) {
    return row.kind == LayerKind::heights ? -1 : std::ranges::find(order, row.id) - order.begin();
  };
  std::ranges::stable_sort(rows_, [&place](const LayerRow& a, const LayerRow& b) { return place(a) < place(b); });
}

}  // namespace terrella
