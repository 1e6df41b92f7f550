#include "streaming/cut/row_reader.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "streaming/cut/row_formats.h"

namespace terrella {
namespace {

/// TIFF and BigTIFF in either byte order.
bool begins_as_tiff(std::string_view head) {
  using namespace std::string_view_literals;
  constexpr std::array kHeads = {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};
  for (const std::string_view start : kHeads) {
    if (head.starts_with(start)) return true;
  }
  return false;
}

}  // namespace

Status check_picture_size(const std::string& name, std::int64_t width_px, std::int64_t height_px) {
  if (width_px < 1 || height_px < 1) return Error{fmt::format("{}: the picture has no pixels", name)};
  if (width_px > kMaxPictureSide_px || height_px > kMaxPictureSide_px) {
    return Error{fmt::format("{}: {}x{} pixels are too many; a side may have at most {}", name, width_px, height_px,
                             kMaxPictureSide_px)};
  }
  return Done{};
}

Error row_error(const std::string& name, std::int64_t row, std::int64_t rows, std::string_view why) {
  return Error{fmt::format("{}: row {} of {} cannot be read: {}; the file is truncated or damaged, get it again", name,
                           row + 1, rows, why)};
}

Result<std::unique_ptr<RowReader>> open_rows(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return Error{fmt::format("{}: is a folder, not a picture", name)};
  File file(std::fopen(name.c_str(), "rb"));
  if (!file && errno == ENOENT) return Error{fmt::format("{}: no such file", name)};
  if (!file) return Error{fmt::format("{}: cannot be opened: {}", name, std::strerror(errno))};
  std::array<char, 8> bytes{};
  const std::string_view head(bytes.data(), std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (head.empty()) return Error{fmt::format("{}: is empty", name)};
  std::rewind(file.get());
  if (head.starts_with("\xff\xd8\xff")) return open_jpeg_rows(std::move(file), name);
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return open_png_rows(std::move(file), name);
  if (begins_as_tiff(head)) return open_tiff_rows(name);
  return Error{fmt::format("{}: is not a picture that can be cut; it takes JPEG, PNG, TIFF and BigTIFF", name)};
}

}  // namespace terrella
