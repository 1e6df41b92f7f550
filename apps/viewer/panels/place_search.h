#pragma once

#include <optional>
#include <string>

#include "apps/viewer/tools/gazetteer.h"

namespace terrella {

inline constexpr const char* kSearchTitle = "Search";

/// State of the search panel between frames.
struct PlaceSearch {
  std::string text;
  bool has_keyboard = false;  ///< true if the text field had the keyboard in the last frame
  bool just_opened = false;   ///< gives the field the keyboard in the next frame
};

/// Draws the search field and its results at the top of the window, between Ui::begin_frame() and Ui::end_frame().
/// Returns the clicked place, or the first result on Enter. thread: main
[[nodiscard]] std::optional<NamedPlace> draw_place_search(PlaceSearch& search, const Gazetteer& places);

}  // namespace terrella
