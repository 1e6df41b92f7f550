#include "apps/viewer/parts/place_menu.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/panels/readout.h"

namespace terrella {
namespace {

constexpr float kMenuMargin = 0.8F;      // in text heights, to the window's edge
constexpr double kLeastStep_deg = 1e-5;  // last digit of copied coordinates: a metre

/// The menu's corner is at the pointer, or further in where it would leave the window.
ImVec2 corner_of(const char* title, ImVec2 at) {
  const float margin = kMenuMargin * ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const glm::dvec2 size = Ui::size_of(title);
  return {std::max(margin, std::min(at.x, window.x - margin - float(size.x))),
          std::max(margin, std::min(at.y, window.y - margin - float(size.y)))};
}

/// Width of the widest text; 0 without texts.
float width_of(std::span<const Action* const> rows) {
  float width = 0.0F;
  for (const Action* row : rows) width = std::max(width, ImGui::CalcTextSize(menu_text(*row).c_str()).x);
  return width;
}

}  // namespace

void PlaceMenu::open_at(glm::dvec2 at_px) {
  if (is_open()) toggle();
  const Globe& globe = context_.globe;
  at_px_ = at_px;
  place_ = pick(globe.view(context_.window.framebuffer()), globe.ground(), at_px);
  toggle();
}

void PlaceMenu::toggled() { context_.ui.hold_mouse(is_open()); }

void PlaceMenu::draw_open(float) {
  const glm::dvec2 at = at_px_ / context_.window.pixels_per_unit();
  const float margin = kMenuMargin * ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(corner_of(panel(), {float(at.x), float(at.y)}));
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {size.x - 2.0F * margin, size.y - 2.0F * margin});
  ImGui::SetNextWindowBgAlpha(0.95F);
  const ImGuiStyle& style = ImGui::GetStyle();
  widest_ = size.x - 2.0F * (margin + style.WindowPadding.x) - style.ScrollbarSize;
  const bool just_opened = take_just_opened();
  first_item_ = just_opened;
  if (just_opened) ImGui::SetNextWindowFocus();
  chosen_ = false;
  ImGui::Begin(panel(), nullptr, kPanelWindow | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize);
  draw_place();
  ImGui::Separator();
  draw_actions();
  const bool beside = !ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
  const bool pressed = ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Right);
  ImGui::End();
  // A quick click that opened the menu is still a press in the first frame.
  if (!just_opened && !chosen_ && pressed && beside) close();
}

// A choice closes the menu before it acts, so that the action may open it again.
bool PlaceMenu::item(const std::string& text, bool enabled) {
  const int flags = enabled ? 0 : int(ImGuiSelectableFlags_Disabled);
  const bool clicked = ImGui::Selectable(wrapped(text, widest_).c_str(), false, flags);
  if (enabled && std::exchange(first_item_, false)) {
    ImGui::SetItemDefaultFocus();
    Ui::show_focus();
  }
  if (!enabled || (!clicked && !entered())) return false;
  chosen_ = true;
  close();
  return true;
}

// Beside the globe the items about the place cannot be chosen.
void PlaceMenu::draw_place() {
  Navigator& navigator = context_.navigator;
  const double step_deg = std::max(
      kLeastStep_deg, pixel_step_deg(context_.globe.view(context_.window.framebuffer()), context_.globe.ground()));
  ImGui::TextDisabled("%s", place_ ? place_text(*place_, step_deg).c_str() : "There is no ground here");
  if (item("Copy the coordinates", place_.has_value())) {
    context_.window.copy(fmt::format("{:.6f}, {:.6f}", place_->lat.deg(), place_->lon.deg()));
    say("Coordinates copied");
  }
  if (item("Copy the view as --camera")) {
    context_.window.copy("--camera " + camera_text(navigator.camera()));
    say("View copied. Paste it after terrella view or terrella render.");
  }
  if (item("Save the view as a bookmark")) calls_.bookmark();
  if (item("Measure from here", place_.has_value())) calls_.measure_from(at_px_);
  if (item("Centre here", place_.has_value())) navigator.centre_on(at_px_, Input::now());
  if (item("Fly here", place_.has_value())) navigator.double_click(at_px_, Input::now());
}

void PlaceMenu::draw_actions() {
  std::vector<const Action*> rows;
  for (const Action& action : actions_) {
    if (in_menu(action)) rows.push_back(&action);
  }
  const std::size_t half = (rows.size() + 1) / 2;
  const std::span<const Action* const> all(rows);
  const float both = width_of(all.first(half)) + width_of(all.subspan(half)) + 4.0F * ImGui::GetStyle().CellPadding.x;
  const std::size_t columns = both <= widest_ ? 2 : 1, count = columns == 2 ? half : rows.size();
  if (!ImGui::BeginTable("actions", int(columns))) return;
  for (std::size_t i = 0; i < columns * count; ++i) {
    ImGui::TableNextColumn();
    const std::size_t row = i / columns + (i % columns) * count;
    if (row < rows.size() && item(menu_text(*rows[row]))) calls_.run(*rows[row]);
  }
  ImGui::EndTable();
}

}  // namespace terrella
