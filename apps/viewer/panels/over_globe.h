#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "geo/camera.h"
#include "globe/globe.h"

struct ImDrawList;
struct ImVec2;

namespace terrella {

/// Part of the picture in framebuffer pixels, to which lines and labels over the globe are clipped.
struct PicturePart {
  int left_px = 0;
  Viewport size;
  glm::vec3 tint{1.0F};  ///< colour of lines and labels
};

/// One eye's picture.
struct EyePart {
  View view;
  PicturePart part;
};

// Drawing over the globe and under the panels, within a frame of Dear ImGui. `unit_px`: framebuffer pixels per unit of
// the window. thread: main

/// The pictures of both eyes in stereo, else one. Interlaced pictures have too few rows for two sets of lines.
[[nodiscard]] std::vector<EyePart> eye_parts(const Globe& globe, const View& view);
[[nodiscard]] ImVec2 to_ui(glm::dvec2 px, double unit_px);
/// Returns ImGui's form of `color`, 0 to 255, multiplied by `tint`.
[[nodiscard]] unsigned tinted(glm::vec3 color, const glm::vec3& tint, int alpha);
/// Draws a text with a dark edge, which is legible on snow too. A thin edge costs half.
void shaded_text(ImDrawList* list, ImVec2 at, const char* text, unsigned ink, bool thin = false);
/// Limits drawing to a part of the picture, until ImDrawList::PopClipRect().
void push_clip(ImDrawList* list, const PicturePart& part, double unit_px);

}  // namespace terrella
