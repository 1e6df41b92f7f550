#include "apps/viewer/panels/bookmark_panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kBookmarksWidth = 21.0F;  // in text heights
constexpr double kNameStep_deg = 0.01;

void open_edit(BookmarkEdit& edit, int number, const Bookmark& bookmark) {
  edit = {.number = number, .just_opened = true};
  bookmark.name.copy(edit.name.data(), edit.name.size() - 1);
}

/// The line under a row: its name, its place in the list.
BookmarkWish draw_edit(BookmarkEdit& edit) {
  BookmarkWish wish{.number = edit.number};
  if (edit.just_opened) ImGui::SetKeyboardFocusHere();
  edit.just_opened = false;
  ImGui::SetNextItemWidth(-1.0F);
  if (ImGui::InputTextWithHint("##name", "Name, then Enter", edit.name.data(), edit.name.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue)) {
    wish.ask = BookmarkAsk::rename;
    wish.name = edit.name.data();
    edit.number = 0;
  }
  want_letters(edit.name.data());
  if (ImGui::SmallButton("Up")) wish.ask = BookmarkAsk::raise;
  tip("Moves the bookmark up, to a lower number. Keys 1 to 9 fly to the first nine.");
  beside_if_room("Down");
  if (ImGui::SmallButton("Down")) wish.ask = BookmarkAsk::lower;
  tip("Moves the bookmark down, to a higher number.");
  beside_if_room("Delete");
  if (ImGui::SmallButton("Delete")) wish.ask = BookmarkAsk::remove;
  tip("Deletes the bookmark. A button then restores it.");
  return wish;
}

BookmarkWish draw_row(int number, const Bookmark& bookmark, BookmarkEdit& edit, LengthUnits units) {
  BookmarkWish wish{.number = number};
  const float edit_width = ImGui::CalcTextSize("Edit").x + 2.0F * ImGui::GetStyle().FramePadding.x;
  const float width = ImGui::GetContentRegionAvail().x - edit_width - ImGui::GetStyle().ItemSpacing.x;
  const std::string text = fmt::format("{}   {}###row", number, panel_text(shown_name(bookmark, units)));
  if (ImGui::Selectable(text.c_str(), false, 0, {width, 0.0F}) || entered()) wish.ask = BookmarkAsk::fly_to;
  tip(number <= Bookmarks::kKeys ? fmt::format("{}: flies there.", number) : "Flies there.");
  ImGui::SameLine();
  if (ImGui::SmallButton("Edit")) {
    const bool open = edit.number == number;
    open_edit(edit, number, bookmark);
    if (open) edit.number = 0;
  }
  tip("Shows or hides the name, the order and Delete.");
  if (edit.number != number) return wish;
  BookmarkWish more = draw_edit(edit);
  return more.ask == BookmarkAsk::none ? wish : more;
}

}  // namespace

std::string shown_name(const Bookmark& bookmark, LengthUnits units) {
  if (!bookmark.name.empty()) return bookmark.name;
  if (!bookmark.place.empty()) return bookmark.place;
  return place_text(bookmark.camera.eye, kNameStep_deg) + "   " + length_text(bookmark.camera.eye.height_m, units);
}

BookmarkWish draw_bookmarks(const char* title, const Bookmarks& bookmarks, BookmarkEdit& edit, LengthUnits units,
                            bool removed, float foot, bool just_opened) {
  begin_left_panel(title, kBookmarksWidth, foot, just_opened);
  BookmarkWish wish;
  if (ImGui::Button("Save this view")) wish.ask = BookmarkAsk::save;
  tip("Saves the view under the lowest free number. Ctrl + 1 to 9 saves it under that number.");
  if (removed) beside_if_room("Restore");
  if (removed && ImGui::Button("Restore")) wish.ask = BookmarkAsk::restore;
  for (const auto& [number, bookmark] : bookmarks.all()) {
    ImGui::PushID(number);
    const BookmarkWish asked = draw_row(number, bookmark, edit, units);
    if (asked.ask != BookmarkAsk::none) wish = asked;
    ImGui::PopID();
  }
  ImGui::End();
  return wish;
}

}  // namespace terrella
