#pragma once

#include <vector>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/parts/part.h"
#include "objects/graticule.h"

namespace terrella {

/// Draws lines and labels below the panels, within a frame. Leaves out labels that a box of `taken` would cover, and
/// returns the boxes of the others. `unit_px`: framebuffer pixels per unit of the window. thread: main
std::vector<UiBox> draw_graticule(const Graticule& graticule, const PicturePart& part, double unit_px,
                                  const std::vector<UiBox>& taken);

/// The same for the globe of a view, with labels above `foot` units of the window at the lower edge. In stereo for both
/// eyes. thread: main
std::vector<UiBox> draw_graticule(const Globe& globe, const View& view, double unit_px, double foot,
                                  const std::vector<UiBox>& taken);

/// Lines of latitude and longitude over the globe, with labels. Owns the switch. thread: main for every call
class GraticuleLines : public Part {
 public:
  explicit GraticuleLines(const ViewerContext& context) : Part(context) {}

  [[nodiscard]] bool& is_on() { return on_; }
  [[nodiscard]] bool is_on() const { return on_; }
  /// Draws the lines under the panels, if on, and returns the boxes of their labels. Call this after the frame's
  /// panels. Labels keep off the boxes of `taken`, and `foot` free at the lower edge, in units of the window.
  [[nodiscard]] std::vector<UiBox> draw_over(const View& view, double foot, const std::vector<UiBox>& taken) const;

 private:
  bool on_ = false;
};

}  // namespace terrella
