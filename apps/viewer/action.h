#pragma once

#include <string>
#include <string_view>

namespace terrella {

class Viewer;

/// Picture on a button of the control column, from top to bottom.
enum class Icon { none, menu, search, layers, clock, compass, plus, minus, tilted, flat, home, back, forward };

/// An action of the user: its ways by keyboard and by mouse, its text and its effect. Keys, buttons, the menu, the list
/// of shortcuts and the user's page all use this table (Viewer::actions). thread: any for the values, main for `run`
struct Action {
  enum Flags : unsigned {
    plain = 0,
    repeats = 1,    ///< a held key repeats the action
    shifted = 2,    ///< only with Shift
    types = 4,      ///< the characters after the key go to a text field
    alted = 8,      ///< only with Alt
    ctrl = 16,      ///< `characters` with Ctrl, also while a panel has the keyboard
    unlisted = 32,  ///< not in the menu
    passes = 64,    ///< the characters after the key go to the globe, if a panel has the keyboard
    kModifiers = shifted | alted,
  };
  const char* keys;                       ///< way by keyboard, for the list of shortcuts; null: an earlier row names it
  const char* what;                       ///< effect, for the list of shortcuts and the tip of the button
  void (*run)(Viewer& viewer) = nullptr;  ///< null: the row explains a gesture that is no action
  std::u32string_view characters = {};    ///< characters of the keyboard, letters in lower case
  int key = 0, other_key = 0;             ///< further keys, GLFW's numbers; 0: none
  unsigned flags = plain;
  const char* button = nullptr;  ///< text of the button in the view panel; null: no button
  const char* mouse = nullptr;   ///< way by mouse; null: the menu
  Icon icon = Icon::none;        ///< icon of the button in the control column
  int mouse_button = 0;          ///< GLFW's number of a further mouse button; 0: none
};

/// True if the menu lists the action.
[[nodiscard]] bool in_menu(const Action& action);
/// Text of the action in the menu: the effect up to the first colon, with a capital.
[[nodiscard]] std::string menu_text(const Action& action);
/// Way by mouse as text; empty if there is none.
[[nodiscard]] const char* mouse_way(const Action& action);

}  // namespace terrella
