#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "apps/viewer/draw/drawing.h"
#include "globe/globe.h"

// thread: main, for all of this header
namespace terrella {

/// A handle of the selected mark over the globe, by which the user drags a place, or the whole mark.
struct MarkHandle {
  std::optional<std::size_t> place;  ///< index in DrawnMark::places; nullopt: the whole mark
  Geodetic at;
  glm::dvec2 at_px;  ///< framebuffer pixels
};

/// The handles that are in the picture and not hidden by the globe, at most 500. A mark with several places also has
/// one in its middle.
[[nodiscard]] std::vector<MarkHandle> mark_handles(const Globe& globe, const View& view, const DrawnMark& mark);

/// The nearest handle within `reach_px` of a pixel; null if there is none.
[[nodiscard]] const MarkHandle* handle_at(std::span<const MarkHandle> handles, glm::dvec2 at_px, double reach_px);

/// Draws handles under the panels: squares, and a diamond for the whole mark. The chosen place is filled. `unit_px`:
/// framebuffer pixels per unit of the window.
void draw_handles(std::span<const MarkHandle> handles, std::size_t chosen, double unit_px);

}  // namespace terrella
