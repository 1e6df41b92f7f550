#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/viewer/panels/ui.h"
#include "geo/camera.h"
#include "globe/globe.h"

struct ImDrawList;
struct ImVec2;

namespace terrella {

inline constexpr unsigned kRedChannel = 1, kGreenChannel = 2, kBlueChannel = 4, kAllChannels = 7;

/// Part of the picture in framebuffer pixels, to which lines and labels over the globe are clipped.
struct PicturePart {
  int left_px = 0;
  Viewport size;
  unsigned channels = kAllChannels;  ///< those that the eye sees; in anaglyph not all
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
/// Boxes of the objects' labels that no panel of this frame so far covers. Names over the globe keep off them.
[[nodiscard]] std::vector<UiBox> object_labels(const Globe& globe, double unit_px);
/// True if the globe hides a place. Only its far side is hidden while the surface is translucent.
[[nodiscard]] bool is_hidden(const Globe& globe, const View& view, const Ecef& at);
[[nodiscard]] ImVec2 to_ui(glm::dvec2 px, double unit_px);
/// Returns ImGui's form of `color`, 0 to 255.
[[nodiscard]] unsigned ink(const glm::vec3& color, int alpha);
/// Draws a text with a dark edge, which is legible on snow too.
void shaded_text(ImDrawList* list, ImVec2 at, const char* text, unsigned ink);
/// Limits drawing to a part of the picture and to its channels, until end_part().
void begin_part(ImDrawList* list, const PicturePart& part, double unit_px);
void end_part(ImDrawList* list);

}  // namespace terrella
