#include "apps/viewer/bodies/body_panel.h"

#include <algorithm>

#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kBodiesWidth = 15.0F;  // in text heights

}  // namespace

bool BodyPanel::draw_row(const Body& body, bool first) const {
  const bool here = context_.globe.options().body.name == body.name;
  const bool clicked = ImGui::Selectable(body_title(body).c_str(), here);
  if (first && here) {
    ImGui::SetItemDefaultFocus();
    ImGui::SetScrollHereY();
    Ui::show_focus();
  }
  return clicked || entered();
}

void BodyPanel::draw_open(float foot) {
  const bool just_opened = take_just_opened();
  begin_left_panel(panel(), kBodiesWidth, foot, just_opened);
  write_wrapped("Each body keeps its layers and its view.", true);
  const Body* chosen = nullptr;
  for (const Body& body : body_presets()) {
    if (draw_row(body, just_opened)) chosen = &body;
  }
  ImGui::End();
  if (chosen == nullptr) return;
  toggle();
  if (chosen->name != context_.globe.options().body.name) choose_(*chosen);
}

}  // namespace terrella
