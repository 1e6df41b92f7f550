#pragma once

#include <string>
#include <string_view>

namespace terrella {

// Fonts of the panels: DejaVu Sans, and for letters that it lacks, fonts of the system. A letter beyond Latin is loaded
// once a panel has written it, and is seen in the next frame. All contexts of Dear ImGui share the letters. Letters
// beyond U+FFFF, and letters that no font has, stay question marks. thread: main

/// Replaces the fonts of the current context, with all letters wanted so far. A texture of the old fonts is the
/// caller's to replace. Not within a frame.
void load_panel_fonts(float scale);

/// Returns a text as panels write it, each line from left to right, and wants its letters. Wrap the text before.
[[nodiscard]] std::string panel_text(std::string_view utf8);

/// Remembers the letters of a text that are not loaded yet, for the next load_panel_fonts().
void want_letters(std::string_view utf8);

/// True if load_panel_fonts() would bring wanted letters that the current context's fonts do not have.
[[nodiscard]] bool letters_wait();

}  // namespace terrella
