#pragma once

#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.h"
#include "codecs/image.h"
#include "geo/camera.h"

namespace terrella {

/// Writes a film as an MP4 through the program ffmpeg on PATH, which gets the frames on its standard input. The film
/// appears under its name when it is finished; else nothing is left. SIGPIPE is ignored while the object exists.
/// thread: one at a time
class MoviePipe {
 public:
  /// Starts ffmpeg. Fails without one; the error names the cure. Sides must be even.
  [[nodiscard]] static Result<std::unique_ptr<MoviePipe>> start(const std::filesystem::path& path, Viewport size,
                                                                double fps);
  ~MoviePipe();  ///< ends ffmpeg and removes what it wrote, unless finish() was called
  MoviePipe(const MoviePipe&) = delete;
  MoviePipe& operator=(const MoviePipe&) = delete;

  /// Appends a frame of the size; blocks until ffmpeg has taken it.
  [[nodiscard]] Status write(const Image& image);
  /// Waits for ffmpeg and puts the film in its place.
  [[nodiscard]] Status finish();

 private:
  explicit MoviePipe(std::filesystem::path path);
  [[nodiscard]] int spawn(Viewport size, double fps);
  [[nodiscard]] std::string ending();  ///< closes the pipe, waits for ffmpeg and says how it ended; empty: well

  std::filesystem::path path_, part_;
  pid_t pid_ = 0;   ///< 0: has ended
  int input_ = -1;  ///< -1: closed
  struct sigaction before_ {};
};

}  // namespace terrella
