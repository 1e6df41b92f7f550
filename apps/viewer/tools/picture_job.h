#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "apps/viewer/tools/picture_ui.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella {

/// Largest picture side that OpenGL and the program allow. thread: main, with the context current
[[nodiscard]] int largest_picture_side_px();

/// A picture of any size, drawn over several frames until complete and then written. thread: main, with the context
/// current
class PictureJob {
 public:
  /// Fails if the picture exceeds kMostPicturePixels or memory is insufficient.
  [[nodiscard]] static Result<std::unique_ptr<PictureJob>> start(const Globe& globe, const std::filesystem::path& file,
                                                                 Viewport size);

  /// Draws a frame and shows it, reduced, in the window's framebuffer. `overlay` is called once all tiles are there.
  /// Returns true once the complete picture is being written. Not within a frame of Dear ImGui.
  bool draw(Globe& globe, Viewport window, const std::function<PictureOverlay()>& overlay);
  [[nodiscard]] bool drawn() const { return written_.valid(); }
  [[nodiscard]] bool ready() const;  ///< true if draw() or result() has work to do
  /// Result of writing, once finished.
  [[nodiscard]] std::optional<Status> result();
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::string text() const;  ///< progress as text

 private:
  PictureJob(const Globe& globe, std::filesystem::path file, Viewport size)
      : globe_(globe), file_(std::move(file)), size_(size) {}
  void show(Viewport window) const;
  [[nodiscard]] Status finish(const PictureOverlay& overlay);

  const Globe& globe_;
  std::filesystem::path file_;
  Viewport size_;
  std::optional<OffscreenTarget> target_;
  FrameStats stats_;
  std::future<Status> written_;
};

/// A picture of this size needs about 3 GB while it is drawn.
inline constexpr long kMostPicturePixels = 16384L * 8192L;

}  // namespace terrella
