#pragma once

#include <string_view>

namespace terrella {

class Viewer;

/// An action of the user: its keys, its text and its effect. Keys, buttons and the list of shortcuts all use this
/// table (Viewer::actions). thread: any for the values, main for `run`
struct Action {
  enum Flags : unsigned {
    plain = 0,
    repeats = 1,  ///< a held key repeats the action
    shifted = 2,  ///< only with Shift; such a row stands before the row without Shift
    types = 4,    ///< the characters after the key go to a text field
    ctrl = 8,     ///< `characters` with Ctrl, also while a panel has the keyboard
  };
  const char* keys;                       ///< text for the list of shortcuts; null: an earlier row names the keys
  const char* what;                       ///< effect, for the list of shortcuts and the tip of the button
  void (*run)(Viewer& viewer) = nullptr;  ///< null: the row explains a gesture that is no action
  std::u32string_view characters = {};    ///< characters of the keyboard, letters in lower case
  int key = 0, other_key = 0;             ///< further keys, GLFW's numbers; 0: none
  unsigned flags = plain;
  const char* button = nullptr;  ///< text of the button in the view panel; null: no button
};

}  // namespace terrella
