#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "objects/graticule.h"

namespace terrella {

/// Part of the picture for one graticule, framebuffer pixels; lines and labels are clipped to this part.
struct GraticulePart {
  int left_px = 0;
  Viewport size;
  glm::vec3 tint{1.0F};  ///< colour of lines and labels
};

/// Draws lines and labels below the panels, within a frame. Leaves out labels that a box of `taken` would cover.
/// `unit_px`: framebuffer pixels per unit of the window. thread: main
void draw_graticule(const Graticule& graticule, const GraticulePart& part, double unit_px,
                    const std::vector<UiBox>& taken);

/// Lines of latitude and longitude over the globe, with labels. Owns the switch. thread: main for every call
class GraticuleLines : public Part {
 public:
  explicit GraticuleLines(const ViewerContext& context) : Part(context) {}

  [[nodiscard]] bool& is_on() { return on_; }
  /// Draws the lines under the panels, if on. Call this after the frame's panels. Labels keep `foot` free at the lower
  /// edge, in units of the window.
  void draw_over(const View& view, double foot) const;

 private:
  bool on_ = false;
};

}  // namespace terrella
