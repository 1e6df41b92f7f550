#include "apps/viewer/panels/layer_panel.h"

#include <algorithm>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kLayersWidth = 21.0F;  // in text heights

const char* word_of(LayerKind kind) {
  switch (kind) {
    case LayerKind::imagery:
      return "pictures";
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
    tip("Where the view asks for coarser tiles than the first, the layer is not drawn; finer ones than the second are "
        "not asked for.");
    return;
  }
  row.look.min_level = levels[0];
  row.look.max_level = levels[1] == row.finest_level ? kMaxTileLevel : std::max(levels[0], levels[1]);
}

void draw_opacity(LayerRow& row) {
  slide("Opacity", row.look.opacity, 0.0, 1.0, "%.2f");
  tip("How much of what lies under this layer it covers.");
}

void draw_look(LayerRow& row) {
  choose("Shows", row.look.daylight, std::array{"by day and night", "by day", "by night"});
  tip("By day or by night: on that side of the terminator only, once a time is set (P).");
  bool clouds = row.look.alpha == AlphaFrom::brightness;
  if (ImGui::Checkbox("Black is clear", &clouds)) row.look.alpha = clouds ? AlphaFrom::brightness : AlphaFrom::own;
  tip("For pictures of clouds, white on black.");
  if (row.finest_level > 0) draw_levels(row);
}

LayerAsk draw_buttons(const LayerRow& row) {
  LayerAsk ask = LayerAsk::none;
  const auto button = [&ask](const char* name, LayerAsk what, const char* why) {
    if (ImGui::Button(name)) ask = what;
    tip(why);
    ImGui::SameLine();
  };
  if (row.kind != LayerKind::heights) {
    button("Up", LayerAsk::raise, "Over the next layer of its kind.");
    button("Down", LayerAsk::lower, "Under the next layer of its kind.");
  }
  if (row.bounds) button("Go there", LayerAsk::look_at, "Flies to where the layer is.");
  button("Remove", LayerAsk::remove, "Takes it off the globe; the file stays as it is.");
  ImGui::NewLine();
  return ask;
}

LayerAsk draw_row(LayerRow& row) {
  ImGui::Checkbox("##shown", &row.look.shown);
  tip("Shows or hides the layer.");
  ImGui::SameLine();
  const bool open = ImGui::TreeNodeEx(row.name.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
  if (!open) tip((row.name + " (" + word_of(row.kind) + "): opens what can be done with it.").c_str());
  if (!open) return LayerAsk::none;
  if (row.kind != LayerKind::heights) draw_opacity(row);
  if (row.kind == LayerKind::imagery) draw_look(row);
  const LayerAsk ask = draw_buttons(row);
  ImGui::TreePop();
  return ask;
}

}  // namespace

LayerWish draw_layers(std::vector<LayerRow>& rows, bool& graticule, bool just_opened) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x - 0.8F * unit, 3.6F * unit}, ImGuiCond_Always, {1.0F, 0.0F});
  const float width = std::min(kLayersWidth * unit, size.x - 1.6F * unit);
  ImGui::SetNextWindowSize({width, 0.0F});
  ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, size.y - 9.0F * unit});
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin(kLayersTitle, nullptr, kPanelWindow);
  ImGui::PushItemWidth(0.45F * kLayersWidth * unit);
  LayerWish wish;
  ImGui::Checkbox("Graticule", &graticule);
  tip("G: lines of latitude and longitude.");
  for (std::size_t i = rows.size(); i-- > 0;) {
    ImGui::PushID(static_cast<int>(rows[i].id) * 4 + static_cast<int>(rows[i].kind));
    const LayerAsk ask = draw_row(rows[i]);
    if (ask != LayerAsk::none) wish = {ask, i};
    ImGui::PopID();
  }
  ImGui::Separator();
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextDisabled("Drop a file onto the window to add it: a picture, a tile set, GeoJSON or a glTF model.");
  ImGui::PopTextWrapPos();
  ImGui::PopItemWidth();
  ImGui::End();
  return wish;
}

}  // namespace terrella
