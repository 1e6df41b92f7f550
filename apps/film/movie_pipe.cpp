#include "apps/film/movie_pipe.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/process/child_process.h"

namespace terrella {
namespace {

constexpr const char* kNoFfmpeg =
    "the program ffmpeg, which writes *.mp4, is not on PATH: install the package ffmpeg, or write frames with -o "
    "frames/%05d.png";

/// Arguments of ffmpeg. Colours are those of sRGB pictures; without a statement, players guess by the size.
std::vector<std::string> arguments_of(const std::string& output, Viewport size, double fps) {
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgba",
          "-video_size",
          fmt::format("{}x{}", size.width_px, size.height_px),
          "-framerate",
          fmt::format("{}", fps),
          "-i",
          "pipe:0",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "iec61966-2-1",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + output};
}

}  // namespace

MoviePipe::MoviePipe(std::filesystem::path path)
    : path_(std::move(path)), part_(path_.string() + "." + std::to_string(getpid()) + ".part") {
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignored, &before_);
}

MoviePipe::~MoviePipe() {
  if (pid_ != 0) {
    kill(pid_, SIGTERM);
    static_cast<void>(ending());
    std::error_code failed;
    std::filesystem::remove(part_, failed);
  }
  sigaction(SIGPIPE, &before_, nullptr);
}

Result<std::unique_ptr<MoviePipe>> MoviePipe::start(const std::filesystem::path& path, Viewport size, double fps) {
  if (size.width_px % 2 != 0 || size.height_px % 2 != 0) {
    return Error{fmt::format("{}: a film in MP4 has even sides, not {}x{}; give another --size, or write frames",
                             path.string(), size.width_px, size.height_px)};
  }
  std::unique_ptr<MoviePipe> pipe(new MoviePipe(path));
  const int refused = pipe->spawn(size, fps);
  if (refused == ENOENT) return Error{fmt::format("{}: {}", path.string(), kNoFfmpeg)};
  if (refused != 0)
    return Error{fmt::format("ffmpeg: cannot be started: {}", std::generic_category().message(refused))};
  return pipe;
}

int MoviePipe::spawn(Viewport size, double fps) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return errno;
  const int refused = start_child({.program = "ffmpeg",
                                   .words = arguments_of(part_.string(), size, fps),
                                   .input = ends[0],
                                   .output = STDERR_FILENO,
                                   .errors = STDERR_FILENO},
                                  pid_);
  close(ends[0]);
  input_ = ends[1];
  if (refused != 0) {
    pid_ = 0;
    close(std::exchange(input_, -1));
  }
  return refused;
}

Status MoviePipe::write(const Image& image) {
  std::size_t written = 0;
  while (written < image.rgba.size()) {
    const ssize_t count = ::write(input_, image.rgba.data() + written, image.rgba.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const std::string how = ending();
      std::error_code failed;
      std::filesystem::remove(part_, failed);
      return Error{
          fmt::format("{}: ffmpeg takes no more frames: it {}", path_.string(), how.empty() ? "has ended" : how)};
    }
    written += static_cast<std::size_t>(count);
  }
  return Done{};
}

std::string MoviePipe::ending() {
  close(std::exchange(input_, -1));
  const int state = wait_for_child(std::exchange(pid_, 0));
  if (WIFSIGNALED(state)) return fmt::format("ended by signal {}", WTERMSIG(state));
  return WEXITSTATUS(state) == 0 ? std::string() : fmt::format("ended with code {}", WEXITSTATUS(state));
}

Status MoviePipe::finish() {
  const std::string how = ending();
  std::error_code failed;
  if (how.empty()) std::filesystem::rename(part_, path_, failed);
  if (how.empty() && !failed) return Done{};
  const std::string why = how.empty() ? failed.message() : "ffmpeg " + how;
  std::filesystem::remove(part_, failed);
  return Error{fmt::format("{}: cannot be written: {}", path_.string(), why)};
}

}  // namespace terrella
