#include "apps/viewer/draw/draw_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kDrawWidth = 19.0F;    // in text heights
constexpr float kMostMarkRows = 5.0F;  // rows of the list of marks that are seen at once
constexpr float kMostWidth_px = 20.0F;
constexpr std::size_t kNameBytes = 1000, kPathBytes = 2048;

/// A button that also takes Enter. `after`: beside the last button, if it has room.
bool button(const char* name, const char* why, bool after = true) {
  if (after) beside_if_room(name);
  const bool clicked = ImGui::Button(name) || entered();
  tip(why);
  return clicked;
}

void draw_kinds(DrawWish& wish) {
  constexpr std::array<std::pair<MarkKind, const char*>, 3> kKinds{
      {{MarkKind::place, "Draws a place mark: click the globe, or press Enter for the middle of the view."},
       {MarkKind::line, "Draws a line through the places that you click."},
       {MarkKind::area, "Draws an area with corners at the places that you click."}}};
  for (const auto& [kind, why] : kKinds) {
    if (!button(kind_name(kind), why, kind != MarkKind::place)) continue;
    wish.ask = DrawAsk::sketch;
    wish.kind = kind;
  }
}

void draw_sketch(const DrawPanelState& state, DrawWish& wish) {
  const bool is_place = state.sketch == MarkKind::place;
  write_wrapped(is_place ? "Click the place, or press Enter for the middle of the view."
                         : "Click places, or press Enter for the middle of the view. Backspace removes the last one. "
                           "A double click, a right click or a second Enter ends the mark.");
  if (!state.sketched.empty()) write_wrapped(state.sketched, true);
  if (!is_place && button("Finish", "Ends the mark.", false)) wish.ask = DrawAsk::finish;
  if (button("Cancel", "Esc: drops the mark.", !is_place)) wish.ask = DrawAsk::cancel;
}

void draw_history(const DrawPanelState& state, DrawWish& wish) {
  ImGui::BeginDisabled(!state.can_undo);
  if (button("Undo", "Ctrl + Z: takes back the last change.", false)) wish.ask = DrawAsk::undo;
  ImGui::EndDisabled();
  beside_if_room("Redo");
  ImGui::BeginDisabled(!state.can_redo);
  if (button("Redo", "Ctrl + Y or Ctrl + Shift + Z: makes the change again.", false)) wish.ask = DrawAsk::redo;
  ImGui::EndDisabled();
}

std::string row_text(const DrawnMark& mark) {
  return panel_text(mark.name.empty() ? kind_name(mark.kind) : mark.name.substr(0, mark.name.find('\n')));
}

// Only the rows in view cost time.
void draw_list(const DrawPanelState& state, DrawWish& wish) {
  const auto& marks = state.drawing.marks;
  if (marks.empty()) return write_wrapped("Nothing is drawn yet.", true);
  const float rows = std::min(kMostMarkRows, float(marks.size()));
  ImGui::BeginChild("##marks", {0.0F, rows * ImGui::GetTextLineHeightWithSpacing()}, false,
                    ImGuiWindowFlags_NavFlattened);
  ImGuiListClipper clipper;
  clipper.Begin(int(marks.size()));
  while (clipper.Step()) {
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
      const DrawnMark& mark = marks[std::size_t(k)];
      const std::string text = fmt::format("{}###mark{}", row_text(mark), static_cast<std::uint64_t>(mark.id));
      const bool is_selected = state.selected != nullptr && state.selected->id == mark.id;
      if (!ImGui::Selectable(text.c_str(), is_selected) && !entered()) continue;
      wish.ask = DrawAsk::select;
      wish.id = is_selected ? ObjectId::none : mark.id;
    }
  }
  ImGui::EndChild();
}

bool edit_color(const char* name, ObjectColor& color) {
  std::array<float, 4> parts{float(color.red), float(color.green), float(color.blue), float(color.alpha)};
  for (float& part : parts) part /= 255.0F;
  constexpr ImGuiColorEditFlags kFlags = ImGuiColorEditFlags_DisplayHex | ImGuiColorEditFlags_AlphaBar |
                                         ImGuiColorEditFlags_AlphaPreviewHalf | ImGuiColorEditFlags_NoOptions |
                                         ImGuiColorEditFlags_NoTooltip;
  if (!ImGui::ColorEdit4(name, parts.data(), kFlags)) return false;
  const auto byte = [](float part) { return std::uint8_t(std::lround(255.0F * std::clamp(part, 0.0F, 1.0F))); };
  color = {byte(parts[0]), byte(parts[1]), byte(parts[2]), byte(parts[3])};
  return true;
}

bool edit_name(std::string& name) {
  std::array<char, kNameBytes> text{};
  name.copy(text.data(), text.size() - 1);
  const bool edited = ImGui::InputTextWithHint("Name", "none", text.data(), text.size());
  want_letters(text.data());
  if (edited) name = text.data();
  return edited;
}

void draw_look(const DrawnMark& selected, DrawWish& wish) {
  DrawnMark mark = selected;
  ImGui::PushItemWidth(-4.0F * ImGui::GetFontSize());
  bool edited = edit_name(mark.name);
  edited |= edit_color("Colour", mark.look.color);
  tip("Red, green, blue and opacity. The square opens a picker.");
  if (mark.kind != MarkKind::place) {
    edited |= ImGui::SliderFloat("Width", &mark.look.width_px, 0.0F, kMostWidth_px, "%.1f px");
    tip("Width of the line. Ctrl + click types a number.");
  }
  if (mark.kind == MarkKind::area) edited |= edit_color("Fill", mark.look.fill);
  ImGui::PopItemWidth();
  if (!edited) return;
  wish.ask = DrawAsk::change;
  wish.changed = std::move(mark);
}

void draw_places(const DrawnMark& mark, std::size_t chosen, DrawWish& wish) {
  const std::size_t count = mark.places.size();
  if (count > 1) {
    ImGui::AlignTextToFramePadding();
    ImGui::Text("Place %zu of %zu", chosen + 1, count);
    for (const auto& [name, step] : {std::pair{"Previous", count - 1}, std::pair{"Next", std::size_t{1}}}) {
      if (!button(name, "Chooses a place of the mark, for the buttons below.")) continue;
      wish.ask = DrawAsk::choose;
      wish.place = (chosen + step) % count;
    }
  }
  if (button("Move here", "Moves this place to the middle of the view. The mouse drags its square.", false))
    wish.ask = DrawAsk::move_place;
  if (count < 2) return;
  if (button("Insert here", "Adds a place after this one, in the middle of the view.")) wish.ask = DrawAsk::insert;
  if (button("Remove place", "Removes this place.")) wish.ask = DrawAsk::remove_place;
  if (button("Move all here",
             "Moves the mark until this place is in the middle of the view. The mouse drags the "
             "diamond in the middle of the mark."))
    wish.ask = DrawAsk::move_mark;
}

void draw_mark_buttons(const DrawnMark& mark, DrawWish& wish) {
  if (button("Fly there", "Flies to the mark.", false)) wish.ask = DrawAsk::fly;
  if (mark.kind != MarkKind::place && mark.places.size() > 2) {
    const bool is_line = mark.kind == MarkKind::line;
    if (button(is_line ? "Make an area" : "Make a line", "The places stay.")) {
      wish.ask = DrawAsk::change;
      wish.changed = mark;
      wish.changed->kind = is_line ? MarkKind::area : MarkKind::line;
    }
  }
  if (button("Delete", "Deletes the mark. Undo brings it back.")) wish.ask = DrawAsk::remove;
}

void draw_file(std::string& path, DrawWish& wish) {
  group("File");
  std::array<char, kPathBytes> text{};
  path.copy(text.data(), text.size() - 1);
  ImGui::SetNextItemWidth(-1.0F);
  const char* hint = "name.geojson or name.kml";
  if (ImGui::InputTextWithHint("##path", hint, text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue))
    wish.ask = DrawAsk::save;
  path = text.data();
  want_letters(path);
  if (button("Save",
             "Ctrl + S: saves all marks, as GeoJSON or KML by the end of the name. Without a name: a new GeoJSON "
             "file in the folder where the program was started.",
             false))
    wish.ask = DrawAsk::save;
  if (button("Add from file", "Adds the places, lines and areas of the file to the marks.")) wish.ask = DrawAsk::open;
}

}  // namespace

DrawWish draw_drawing(const char* title, const DrawPanelState& state, std::string& path, float foot, bool just_opened) {
  begin_left_panel(title, kDrawWidth, foot, just_opened);
  DrawWish wish;
  state.sketch ? draw_sketch(state, wish) : draw_kinds(wish);
  draw_history(state, wish);
  group("Marks");
  draw_list(state, wish);
  if (state.selected != nullptr && !state.sketch) {
    group(kind_name(state.selected->kind));
    draw_look(*state.selected, wish);
    draw_places(*state.selected, state.place, wish);
    draw_mark_buttons(*state.selected, wish);
  }
  draw_file(path, wish);
  ImGui::End();
  return wish;
}

}  // namespace terrella
