#pragma once

#include "apps/viewer/input.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// The line of a swipe over the globe, which the mouse drags: layers show on one side of it (SurfaceLook::swipe).
/// thread: main
class Swipe : public Part {
 public:
  explicit Swipe(const ViewerContext& context) : Part(context) {}

  [[nodiscard]] bool is_on() const { return context_.globe.options().surface.swipe.has_value(); }
  /// Shows the line where it was last, at first in the middle; or hides it.
  void show(bool on);
  /// A step of a drag with the left button. True if it moves the line.
  bool drag(DragStep step, glm::dvec2 at_px);
  /// Draws the line and its handle under the panels.
  void draw_over(const View& view) const;

 private:
  void move_to(double place);

  double place_ = 0.5;  ///< place of the line while it is hidden
  bool held_ = false;
};

}  // namespace terrella
