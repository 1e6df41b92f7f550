#include "streaming/sets/tile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "codecs/image.h"
#include "codecs/webp_codec.h"

namespace terrella {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kJpegEnd = "\xFF\xD9"sv;
constexpr std::string_view kPngEnd = "\0\0\0\0IEND\xAE\x42\x60\x82"sv;
/// Some encoders pad the file after its end. An end mark further back belongs to a picture inside the picture.
constexpr std::size_t kMostPadding = 16;

bool ends_with(std::string_view bytes, std::string_view end) {
  const std::size_t from = bytes.size() - std::min(bytes.size(), end.size() + kMostPadding);
  return bytes.find(end, from) != std::string_view::npos;
}

Error not_a_picture(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && bytes[first] == '<')
    return Error{"a page of HTML or XML instead of a picture"};
  if (bytes.starts_with("GIF8")) return Error{"GIF, which is not read; JPEG, PNG or WebP is needed"};
  return Error{"not a JPEG, PNG or WebP picture"};
}

bool is_complete(std::string_view text, std::span<const std::byte> bytes, ImageFormat format) {
  if (format == ImageFormat::webp) return webp_length(bytes) <= bytes.size();
  return ends_with(text, format == ImageFormat::jpeg ? kJpegEnd : kPngEnd);
}

}  // namespace

Status check_tile(std::span<const std::byte> bytes, int tile_px) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const ImageFormat format = sniff_format(bytes);
  if (format == ImageFormat::unknown) return not_a_picture(text);
  const Result<PictureSize> size = picture_size(bytes);
  if (!size) return size.error();
  if (size->width_px != tile_px || size->height_px != tile_px) {
    return Error{fmt::format("a picture of another size than the set's {}×{} pixels", tile_px, tile_px)};
  }
  if (!is_complete(text, bytes, format)) return Error{"a picture that ends too early"};
  return Done{};
}

}  // namespace terrella
