#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/balloon/object_fields.h"
#include "apps/viewer/panels/ui.h"

namespace terrella {

/// Name of the balloon's window. Dear ImGui takes windows with the same text after "###" for one.
inline constexpr const char* kBalloon = "###balloon";

/// Texts of the balloon of an object.
struct BalloonTexts {
  std::string title;
  std::string layer;
  std::vector<ObjectField> fields;
};

/// Request of the user in the balloon, and the balloon's place.
struct BalloonWish {
  UiBox box;
  bool fly = false;
  std::string link = {};  ///< the clicked link; empty: none
};

/// Draws the balloon beside a place, in units of the window, where no panel of this frame is: the title with a cross
/// (take_panel_closed()), the layer, a button, and the fields. Without room beside the place it stands in a corner
/// or beside a panel. Draws nothing and returns nullopt without any room. The status line uses `foot` units at the
/// lower edge. `just_opened`: shows the beginning of the fields. `with_keyboard`: also gives the balloon the keyboard.
/// thread: main
[[nodiscard]] std::optional<BalloonWish> draw_balloon(const BalloonTexts& texts, glm::dvec2 at, float foot,
                                                      bool just_opened, bool with_keyboard);

/// Draws the name of the object under the pointer beside the pointer. thread: main
void draw_name_at_pointer(const std::string& name);

}  // namespace terrella
