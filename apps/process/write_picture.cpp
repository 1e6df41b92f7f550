#include "apps/process/write_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>

#include "apps/process/write_file.h"
#include "codecs/png_codec.h"
#include "streaming/file_bytes.h"

namespace terrella {

Status check_picture_name(const std::filesystem::path& path) {
  constexpr std::array kOthers = {".tif", ".tiff", ".webp", ".gif", ".bmp", ".svg", ".pdf", ".jp2", ".avif", ".heic"};
  const std::string extension = lower_extension(path);
  if (std::ranges::find(kOthers, extension) == kOthers.end()) return Done{};
  return Error{
      fmt::format("{}: pictures are written as PNG or JPEG; name a file that ends in .png or .jpg", path.string())};
}

Status write_picture(const std::filesystem::path& path, const Image& image) {
  const std::string extension = lower_extension(path);
  const bool jpeg = extension == ".jpg" || extension == ".jpeg";
  const auto bytes = jpeg ? encode_jpeg(image, kWrittenJpegQuality) : encode_png_quickly(image);
  if (!bytes) return Error{path.string() + ": " + bytes.error().message};
  return write_file(path, *bytes);
}

}  // namespace terrella
