#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/picture_job.h"

namespace terrella {

/// Saves pictures: of any size without panels, with the map, graticule, legend and sources if wanted, or the window as
/// it is. Owns the panel for the size and the picture in work. thread: main, with the context current
class Pictures : public Panel {
 public:
  /// `overlay` returns what the window shows over the globe, and the sources of the last frame.
  Pictures(const ViewerContext& context, std::function<PictureOverlay()> overlay)
      : Panel(context, "Save picture"), overlay_(std::move(overlay)) {}

  /// True while a picture is drawn in place of the globe.
  [[nodiscard]] bool is_drawing() const { return job_ != nullptr; }
  /// Draws the picture's next frame with the globe's camera, and shows it in the window. Call only while is_drawing().
  void draw_picture(Viewport framebuffer);
  /// Saves the window after a complete frame.
  void want_screenshot() { screenshot_wanted_ = true; }
  /// Saves the window's back buffer, if wanted.
  void after_frame(Viewport framebuffer);

  [[nodiscard]] std::string job() const override { return job_ ? job_->text() : std::string(); }
  [[nodiscard]] bool changed() const override { return screenshot_wanted_ || (job_ && job_->ready()); }
  bool cancel() override;

 private:
  void draw_open(float foot) override;
  void draw_fields(int most_px);
  void start();
  void end(const std::string& message);

  [[nodiscard]] PictureOverlay wanted_overlay() const;

  std::function<PictureOverlay()> overlay_;
  bool with_map_ = true;
  bool with_credits_ = true;
  int width_px_ = 0, height_px_ = 0;  ///< 0: twice the window's size, set when the panel opens
  std::unique_ptr<PictureJob> job_;
  bool screenshot_wanted_ = false;
};

}  // namespace terrella
