#include "apps/viewer/tools/screenshot.h"

#include <epoxy/gl.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <fstream>

#include "codecs/image.h"

namespace terrella {
namespace {

Image read_back_buffer(Viewport size) {
  Image image{.width_px = size.width_px, .height_px = size.height_px, .rgba = {}};
  const std::size_t row_bytes = 4U * static_cast<std::size_t>(size.width_px);
  const std::size_t rows = static_cast<std::size_t>(size.height_px);
  image.rgba.resize(row_bytes * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, size.width_px, size.height_px, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  for (std::size_t y = 0; y < rows / 2; ++y) {  // GL's rows go up, a picture's down
    const auto upper = image.rgba.begin() + static_cast<std::ptrdiff_t>(y * row_bytes);
    const auto lower = image.rgba.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row_bytes);
    std::swap_ranges(upper, upper + static_cast<std::ptrdiff_t>(row_bytes), lower);
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

}  // namespace

std::filesystem::path new_file_name(const std::filesystem::path& folder, std::chrono::system_clock::time_point when,
                                    std::string_view ending) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(when);
  std::tm local{};
  localtime_r(&seconds, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
  std::filesystem::path path = folder / fmt::format("terrella-{}{}", text, ending);
  std::error_code unreadable;
  for (int i = 2; std::filesystem::exists(path, unreadable); ++i)
    path = folder / fmt::format("terrella-{}-{}{}", text, i, ending);
  return path;
}

Status save_back_buffer(const std::filesystem::path& file, Viewport framebuffer) {
  const auto png = encode_png(read_back_buffer(framebuffer));
  if (!png) return Error{file.string() + ": " + png.error().message};
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png->data()), static_cast<std::streamsize>(png->size()));
  out.close();
  if (!out) return Error{file.string() + " cannot be written: start the program in a folder that can be written"};
  return Done{};
}

}  // namespace terrella
