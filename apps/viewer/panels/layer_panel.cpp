#include "apps/viewer/panels/layer_panel.h"

#include <algorithm>
#include <utility>

#include "apps/viewer/panels/number_panel.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/styles/style_panel.h"
#include "streaming/remote/describe_remote.h"

namespace terrella {
namespace {

constexpr float kLayersWidth = 21.0F;  // in text heights
const ImVec4 kProblemInk(1.0F, 0.66F, 0.45F, 1.0F);

const char* word_of(LayerKind kind) {
  switch (kind) {
    case LayerKind::imagery:
      return "imagery";
    case LayerKind::objects:
      return "objects";
    case LayerKind::heights:
      return "heights";
  }
  return "";
}

void draw_levels(LayerRow& row) {
  int levels[2] = {row.look.min_level, std::min(row.look.max_level, row.finest_level)};
  if (!ImGui::SliderInt2("Levels", levels, 0, row.finest_level, "%d", ImGuiSliderFlags_AlwaysClamp)) {
    tip("First and last tile level. Views that need coarser tiles hide the layer; views that need finer tiles "
        "magnify it.");
    return;
  }
  row.look.min_level = levels[0];
  row.look.max_level = levels[1] == row.finest_level ? kMaxTileLevel : std::max(levels[0], levels[1]);
}

void draw_opacity(LayerRow& row) {
  slide("Opacity", row.look.opacity, 0.0, 1.0, "%.2f");
  tip("0 is invisible, 1 hides the layers below.");
}

void draw_look(LayerRow& row) {
  choose("Show on", row.look.daylight, std::array{"day and night", "day side", "night side"});
  tip("Shows the layer only on the day or night side, if a time is set (P).");
  if (!row.numbers) {
    bool clouds = row.look.alpha == AlphaFrom::brightness;
    if (ImGui::Checkbox("Black is transparent", &clouds))
      row.look.alpha = clouds ? AlphaFrom::brightness : AlphaFrom::own;
    tip("For white-on-black pictures of clouds.");
  }
  if (row.finest_level > 0) draw_levels(row);
  if (!row.tiles || !row.tiles->info().steps) return;
  choose("Dates", row.look.clock, std::array{"own", "globe's time", "globe's time, fading"});
  tip("own: A chooses the date. globe's time: the last date at or before the time of Sun and stars, which T plays; "
      "fading: the next date fades in over it.");
}

/// Side of a swipe, blend, and tone, which a click opens.
void draw_comparison(LayerRow& row) {
  const bool open = ImGui::TreeNode(row.numbers ? "Swipe, blend" : "Swipe, blend, tone");
  tip("Side of the swipe's line (V); blend; brightness, contrast and gamma.");
  if (!open) return;
  choose("Side", row.look.swipe, std::array{"both", "left", "right"});
  tip("Shows the layer only to the left or right of the swipe's line (V).");
  if (row.look.height_m == 0.0) {
    choose("Blend", row.look.blend, std::array{"normal", "multiply", "screen", "difference"});
    tip("Multiply darkens, and screen brightens, the layers below. Difference shows where two layers differ.");
  }
  if (!row.numbers) {
    ImageTone& tone = row.look.tone;
    slide("Brightness", tone.brightness, -1.0, 1.0, "%.2f");
    slide("Contrast", tone.contrast, 0.0, 4.0, "%.2f");
    slide("Gamma", tone.gamma, 0.1, 10.0, "%.2f");
    tip("More than 1 brightens dark parts.");
    if (ImGui::Button("Reset tone") || entered()) tone = {};
  }
  ImGui::TreePop();
}

/// Draws the facts of the raster itself, instead of those of the tiles' grid.
void draw_facts(LayerRow& row) {
  if (!row.read_facts) return;
  if (!row.facts.valid()) row.facts = std::async(std::launch::async, row.read_facts).share();
  if (!row.has_facts() || row.facts.get().empty()) return;
  for (const std::string& line : row.facts.get()) write_wrapped(line, true);
}

LayerAsk draw_buttons(const LayerRow& row) {
  LayerAsk ask = LayerAsk::none;
  bool first = true;
  const auto button = [&ask, &first](const char* name, LayerAsk what, const char* why) {
    if (!std::exchange(first, false)) beside_if_room(name);
    if (ImGui::Button(name)) ask = what;
    tip(why);
  };
  if (row.kind != LayerKind::heights) {
    button("Up", LayerAsk::raise, "Moves the layer above the next layer of its kind.");
    button("Down", LayerAsk::lower, "Moves the layer below the next layer of its kind.");
  }
  if (row.bounds) button("Zoom to", LayerAsk::look_at, "Flies to the layer.");
  if (row.features && !row.features->empty()) button("List", LayerAsk::list, "Lists the objects, with a filter.");
  if (row.tiles && is_remote(row.source.address) && row.source.place.crs.empty()) {
    button("Keep offline", LayerAsk::keep, "Stores the view's tiles, for use without a network.");
  }
  button("Remove", LayerAsk::remove, "Removes the layer from the globe; the file stays unchanged.");
  return ask;
}

void draw_attribution(const LayerRow& row) {
  if (!row.attribution.empty()) write_wrapped("Source: " + row.attribution, true);
}

void draw_problem(const LayerRow& row) {
  if (row.problem.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kProblemInk);
  write_wrapped("Last failure: " + row.problem);
  ImGui::PopStyleColor();
}

void draw_clusters(double& radius_px) {
  bool on = radius_px > 0.0;
  if (ImGui::Checkbox("Clusters", &on)) radius_px = on ? kClusterRadius_px : 0.0;
  tip("Draws points close to one another as one disc with their number.");
}

LayerAsk draw_row(LayerRow& row) {
  ImGui::Checkbox("##shown", &row.look.shown);
  tip("Shows or hides the layer.");
  ImGui::SameLine();
  const bool open = ImGui::TreeNodeEx("row", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", panel_text(row.name).c_str());
  if (!open) tip(row.name + " (" + word_of(row.kind) + "): click for options.");
  draw_problem(row);
  if (!open) return LayerAsk::none;
  if (row.kind != LayerKind::heights) draw_opacity(row);
  if (row.numbers && row.read_facts) row.numbers->lines.clear();
  if (row.numbers && row.look.numbers) draw_numbers(*row.numbers, *row.look.numbers);
  if (row.kind == LayerKind::imagery) draw_look(row);
  if (row.style) draw_style(*row.style);
  draw_attribution(row);
  const LayerAsk ask = draw_buttons(row);
  if (row.kind == LayerKind::imagery) draw_comparison(row);
  if (row.clusters) draw_clusters(row.objects.cluster_px);
  draw_facts(row);
  ImGui::TreePop();
  return ask;
}

}  // namespace

LayerWish draw_layers(const char* title, std::vector<LayerRow>& rows, const std::vector<LayerSwitch>& switches,
                      float foot, bool just_opened) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float right = size.x - 0.8F * unit, left = std::max(0.8F * unit, right - kLayersWidth * unit);
  place_panel(Ui::panel_room(left, right, foot));
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(title);
  ImGui::PushItemWidth(0.45F * kLayersWidth * unit);
  LayerWish wish;
  for (const LayerSwitch& more : switches) {
    if (&more != &switches.front()) ImGui::SameLine();
    ImGui::Checkbox(more.name, &more.on);
    tip(more.tip);
  }
  for (std::size_t i = rows.size(); i-- > 0;) {
    ImGui::PushID(static_cast<int>(rows[i].key));
    const LayerAsk ask = draw_row(rows[i]);
    if (ask != LayerAsk::none) wish = {ask, i};
    ImGui::PopID();
  }
  ImGui::Separator();
  ImGui::PushTextWrapPos(0.0F);
  if (ImGui::Button("Add a layer")) wish.ask = LayerAsk::open;
  tip("Ctrl + O: opens a file, a folder or an address. Dropping a file onto the window does the same.");
  ImGui::SameLine();
  if (ImGui::Button("Undo")) wish.ask = LayerAsk::undo;
  tip("Ctrl + Z: takes back the last change of a layer's look, order or removal.");
  ImGui::SameLine();
  if (ImGui::Button("Redo")) wish.ask = LayerAsk::redo;
  tip("Ctrl + Y: makes the change again.");
  ImGui::TextDisabled("The highest layer is first.");
  ImGui::PopTextWrapPos();
  ImGui::PopItemWidth();
  ImGui::End();
  return wish;
}

}  // namespace terrella
