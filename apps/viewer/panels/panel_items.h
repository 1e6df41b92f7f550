#pragma once

#include <imgui.h>

#include <array>
#include <cstddef>
#include <string>

#include "apps/viewer/panels/ui.h"

namespace terrella {

// Parts of panels, for use between Ui::begin_frame() and Ui::end_frame(). thread: main

inline constexpr ImGuiWindowFlags kPanelWindow = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;

/// A panel beside the globe that takes the mouse but never the keyboard.
inline constexpr ImGuiWindowFlags kFloatingWindow =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;

/// Begins a panel with a title and a cross that closes it. End it with ImGui::End(). `more`: further flags.
void begin_panel(const char* title, ImGuiWindowFlags more = 0);
/// Begins a panel at the window's left edge, some text heights wide and as high as its contents, above `foot` units.
void begin_left_panel(const char* title, float width, float foot, bool just_opened);
/// True once after the cross of a panel was clicked.
[[nodiscard]] bool take_panel_closed();

/// Starts a panel of a given inner size at a corner; pivot (0, 1) is the lower left. The panel takes neither mouse nor
/// keyboard. ImGui's own fitting follows the text one frame late, and the viewer may draw only one frame.
void begin_fixed(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 inner);
/// Converts a line width at 96 dots per inch to units of the window.
[[nodiscard]] float line_width(float width_px);

/// Places the next panel at the room's upper edge with the room's width, as high as its contents, and at most as the
/// room.
void place_panel(const UiBox& room);

/// The same text as panels write it (panel_text()), in lines of at most this width.
[[nodiscard]] std::string wrapped(const std::string& text, float widest);
/// Writes a text in lines as wide as the panel has room. Quiet: in the ink of less important texts.
void write_wrapped(const std::string& text, bool quiet = false);
/// The end of a text that has room in this width, after dots; the whole text if it fits. For paths. Not yet as panels
/// write it.
[[nodiscard]] std::string end_of(const std::string& text, float widest);
/// Puts the next button of a row, with this text, beside the last one if it has room; else under it.
void beside_if_room(const char* text);

/// Shows a tip for the preceding item under the cursor, or when a key moved the keyboard focus to the item.
void tip(const std::string& text);
/// True if the Enter key was pressed on the preceding item. ImGui itself takes the space bar alone.
[[nodiscard]] bool entered();
/// True if the Enter key was pressed while the panel that is being drawn has the keyboard.
[[nodiscard]] bool entered_panel();
/// The user's way with a field that filters a list.
struct FilterTyped {
  bool entered = false;       ///< Enter was pressed
  bool edited = false;        ///< the text has changed
  bool has_keyboard = false;  ///< the field has it
  int step = 0;               ///< rows down by the arrows
};
/// Draws a field, as wide as the panel, that filters a list. `takes_keyboard` gives it the keyboard.
[[nodiscard]] FilterTyped filter_field(const char* hint, std::string& filter, bool takes_keyboard);
/// Draws the title of a group and a line below.
void group(const char* name);
void slide(const char* name, double& value, double from, double to, const char* format,
           ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp);

template <class Choice, std::size_t kCount>
void choose(const char* name, Choice& choice, const std::array<const char*, kCount>& words) {
  int index = static_cast<int>(choice);
  if (ImGui::Combo(name, &index, words.data(), static_cast<int>(kCount))) choice = static_cast<Choice>(index);
}

}  // namespace terrella
