#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/viewer/action.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// Requests of the menu to other parts.
struct PlaceMenuCalls {
  std::function<void(const Action&)> run;
  std::function<void(glm::dvec2)> measure_from;  ///< a pixel of the framebuffer
  std::function<void()> bookmark;
};

/// The menu of a place: its coordinates, the view, and all actions of the list, in two columns if they have room. While
/// it is open, a click beside it closes it and does nothing else. thread: main
class PlaceMenu : public Panel {
 public:
  PlaceMenu(const ViewerContext& context, std::span<const Action> actions, PlaceMenuCalls calls)
      : Panel(context, kMenuTitle), actions_(actions), calls_(std::move(calls)) {}

  /// Opens the menu for the place under a pixel of the framebuffer.
  void open_at(glm::dvec2 at_px);

 private:
  void toggled() override;
  void draw_open(float foot) override;
  void draw_place();
  void draw_actions();
  [[nodiscard]] bool item(const std::string& text, bool enabled = true);

  std::span<const Action> actions_;
  PlaceMenuCalls calls_;
  glm::dvec2 at_px_{0.0};
  std::optional<Geodetic> place_;  ///< nullopt beside the globe
  float widest_ = 0.0F;            ///< room for an item's text; a longer text is wrapped
  bool first_item_ = false;        ///< the next item gets the keyboard
  bool chosen_ = false;            ///< an item of this frame was chosen
};

}  // namespace terrella
