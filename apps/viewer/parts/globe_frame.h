#pragma once

#include <optional>

#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella {

/// The last frame of the globe, so that new panels need no new frame of the globe. thread: main, with the context
/// current
class GlobeFrame {
 public:
  /// Draws the globe if it changed, and copies the frame to the window's framebuffer.
  void draw(Globe& globe, Viewport framebuffer);
  /// Drops the frame; the next one is drawn anew.
  void drop() { target_.reset(); }
  [[nodiscard]] const FrameStats& stats() const { return stats_; }

 private:
  std::optional<OffscreenTarget> target_;
  Viewport size_;
  FrameStats stats_;
};

}  // namespace terrella
