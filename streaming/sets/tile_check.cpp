#include "streaming/sets/tile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <pugixml.hpp>
#include <string_view>

#include "codecs/image.h"
#include "codecs/webp_codec.h"
#include "streaming/url.h"

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

constexpr std::size_t kMaxExceptionBytes = 64UL << 10;
constexpr std::size_t kMaxShownBytes = 300;

bool begins_as_markup(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && bytes[first] == '<';
}

std::string_view without_prefix(std::string_view name) { return name.substr(name.rfind(':') + 1); }

/// Finds the first text of an exception; the document may be cut short.
struct ExceptionText : pugi::xml_tree_walker {
  std::string text;
  bool for_each(pugi::xml_node& node) override {
    const std::string_view around = without_prefix(node.parent().name());
    if (node.type() != pugi::node_pcdata && node.type() != pugi::node_cdata) return true;
    if (around != "ServiceException" && around != "ExceptionText") return true;
    text = node.value();
    return false;
  }
};

Error not_a_picture(std::string_view bytes) {
  if (const std::string told = server_exception(bytes); !told.empty()) {
    return Error{"the server answers with an exception: " + told};
  }
  if (begins_as_markup(bytes)) return Error{"a page of HTML or XML instead of a picture"};
  if (bytes.starts_with("GIF8")) return Error{"GIF, which is not read; JPEG, PNG or WebP is needed"};
  return Error{"not a JPEG, PNG or WebP picture"};
}

bool is_complete(std::string_view text, std::span<const std::byte> bytes, ImageFormat format) {
  if (format == ImageFormat::webp) return webp_length(bytes) <= bytes.size();
  return ends_with(text, format == ImageFormat::jpeg ? kJpegEnd : kPngEnd);
}

}  // namespace

std::string server_exception(std::string_view text) {
  if (!begins_as_markup(text) || text.substr(0, kMaxExceptionBytes).find("Exception") == std::string_view::npos)
    return {};
  pugi::xml_document document;
  static_cast<void>(document.load_buffer(text.data(), std::min(text.size(), kMaxExceptionBytes)));
  if (without_prefix(document.document_element().name()).find("Exception") == std::string_view::npos) return {};
  ExceptionText found;
  document.traverse(found);
  std::string line;
  for (const char c : found.text) {
    const bool gap = static_cast<unsigned char>(c) <= ' ';
    if (!gap) line += c;
    if (gap && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (line.ends_with(' ')) line.pop_back();
  if (line.empty()) return "without a text";
  return redact_addresses(line).substr(0, kMaxShownBytes);
}

Status check_tile(std::span<const std::byte> bytes, int tile_px) {
  return check_tile(bytes, TileSides{.least_width_px = tile_px, .least_height_px = tile_px, .most_px = tile_px});
}

Status check_tile(std::span<const std::byte> bytes, const TileSides& sides) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (sides.floats && (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv))) return Done{};
  if (sides.floats)
    return Error{text.starts_with("CntZImage") || text.starts_with("Lerc2 ")
                     ? "LERC, which is not read; a TIFF of floats is needed"
                     : "no TIFF of floats"};
  const ImageFormat format = sniff_format(bytes);
  if (format == ImageFormat::unknown) return not_a_picture(text);
  const Result<PictureSize> size = picture_size(bytes);
  if (!size) return size.error();
  const bool fits = size->width_px >= sides.least_width_px && size->width_px <= sides.most_px &&
                    size->height_px >= sides.least_height_px && size->height_px <= sides.most_px;
  if (!fits) {
    return Error{fmt::format("a picture of another size than the set's {0}×{0} pixels", sides.most_px)};
  }
  if (!is_complete(text, bytes, format)) return Error{"a picture that ends too early"};
  return Done{};
}

}  // namespace terrella
