#pragma once

#include <array>
#include <cstddef>

#include "apps/viewer/parts/part.h"

namespace terrella {

/// Figures of the drawing for those who tune it: time of the last frames, tiles and memory. thread: main
class FrameGraph : public Part {
 public:
  explicit FrameGraph(const ViewerContext& context) : Part(context) {}

  void toggle() { on_ = !on_; }
  /// Notes the time of a frame.
  void note(double frame_ms);
  [[nodiscard]] double last_ms() const { return double(frames_ms_[(next_ + kFrames - 1) % kFrames]); }
  /// Draws the figures in the lower right corner, above the `foot` units that the status line uses. Returns the units
  /// that are in use then.
  [[nodiscard]] float draw_above(float foot, const FrameStats& stats) const;

 private:
  static constexpr std::size_t kFrames = 120;
  bool on_ = false;
  std::array<float, kFrames> frames_ms_{};  ///< a ring
  std::size_t next_ = 0;
};

}  // namespace terrella
