#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella {

/// The largest side that OpenGL takes here, and the program. thread: main, with the context current
[[nodiscard]] int largest_picture_side_px();

/// A picture of its own size that is drawn frame by frame until all of it is there, and then written.
/// thread: main, with the context current
class PictureJob {
 public:
  /// Fails if the picture is larger than kMostPicturePixels or there is no memory for it.
  [[nodiscard]] static Result<std::unique_ptr<PictureJob>> start(const Globe& globe, const std::filesystem::path& file,
                                                                 Viewport size);

  /// Draws a frame; true once the picture is whole and being written. Shows it in the window's framebuffer, small.
  bool draw(Globe& globe, Viewport window);
  [[nodiscard]] bool drawn() const { return written_.valid(); }
  [[nodiscard]] bool ready() const;  ///< draw() or result() has something to do
  /// What came of it, once it is written.
  [[nodiscard]] std::optional<Status> result();
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::string text() const;  ///< how far it is

 private:
  PictureJob(const Globe& globe, std::filesystem::path file, Viewport size)
      : globe_(globe), file_(std::move(file)), size_(size) {}
  void show(Viewport window) const;

  const Globe& globe_;
  std::filesystem::path file_;
  Viewport size_;
  std::optional<OffscreenTarget> target_;
  FrameStats stats_;
  std::future<Status> written_;
};

/// Such a picture takes about 3 GB while it is drawn.
inline constexpr long kMostPicturePixels = 16384L * 8192L;

}  // namespace terrella
