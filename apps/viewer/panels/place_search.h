#pragma once

#include <optional>
#include <string>

#include "apps/viewer/tools/gazetteer.h"

namespace terrella {

inline constexpr const char* kSearchTitle = "Find a place";

/// What the search panel holds between frames.
struct PlaceSearch {
  std::string text;
  bool has_keyboard = false;  ///< the field, as drawn last
  bool just_opened = false;   ///< gives the field the keyboard in the next frame
};

/// The field and what it finds, at the top of the window; between Ui::begin_frame() and Ui::end_frame(). Returns the
/// place that was clicked, or the first one at Enter. thread: main
[[nodiscard]] std::optional<NamedPlace> draw_place_search(PlaceSearch& search, const Gazetteer& places);

}  // namespace terrella
