#include "codecs/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/range_check.h"
#include "codecs/image_limits.h"
#include "codecs/jpeg_codec.h"
#include "codecs/png_codec.h"
#include "codecs/webp_codec.h"

namespace terrella {
namespace {

constexpr std::uint64_t kBytesPerPixel = 4;

template <std::size_t N>
bool begins_with(std::span<const std::byte> bytes, const std::array<unsigned char, N>& magic) {
  return bytes.size() >= N && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                         [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

}  // namespace

ImageFormat sniff_format(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 3> kJpeg{0xFF, 0xD8, 0xFF};
  constexpr std::array<unsigned char, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (begins_with(bytes, kJpeg)) return ImageFormat::jpeg;
  if (begins_with(bytes, kPng)) return ImageFormat::png;
  // "RIFF", the file's length in four bytes, "WEBP".
  constexpr std::array<unsigned char, 4> kRiff{'R', 'I', 'F', 'F'};
  constexpr std::array<unsigned char, 4> kWebp{'W', 'E', 'B', 'P'};
  if (begins_with(bytes, kRiff) && begins_with(bytes.subspan(std::min<std::size_t>(8, bytes.size())), kWebp)) {
    return ImageFormat::webp;
  }
  return ImageFormat::unknown;
}

const char* extension_of(ImageFormat format) {
  return format == ImageFormat::unknown ? kImageFormatNames.front()
                                        : kImageFormatNames.at(static_cast<std::size_t>(format));
}

namespace {

Error no_picture(std::span<const std::byte> bytes) {
  if (bytes.empty()) return Error{"no bytes at all, a JPEG, PNG or WebP picture is expected"};
  return Error{fmt::format("{} bytes that begin like no JPEG, PNG or WebP picture", bytes.size())};
}

}  // namespace

Result<PictureSize> picture_size(std::span<const std::byte> bytes) {
  switch (sniff_format(bytes)) {
    case ImageFormat::jpeg:
      return jpeg_size(bytes);
    case ImageFormat::png:
      return png_size(bytes);
    case ImageFormat::webp:
      return webp_size(bytes);
    case ImageFormat::unknown:
      break;
  }
  return no_picture(bytes);
}

Status check_size(std::uint64_t width_px, std::uint64_t height_px, const DecodeLimits& limits) {
  if (width_px == 0 || height_px == 0) return Error{"the picture has no pixels"};
  const auto max_side = static_cast<std::uint64_t>(std::max(limits.max_side_px, 0));
  if (width_px > max_side || height_px > max_side) {
    return Error{
        fmt::format("the picture is {}×{} pixels, at most {} a side are decoded", width_px, height_px, max_side)};
  }
  const std::uint64_t bytes = width_px * height_px * kBytesPerPixel;
  if (bytes > limits.max_bytes) {
    return Error{fmt::format("the picture is {}×{} pixels, {} bytes; at most {} bytes are decoded", width_px, height_px,
                             bytes, limits.max_bytes)};
  }
  return Done{};
}

Status check_image(const Image& image) {
  if (image.width_px < 1 || image.height_px < 1) {
    return Error{fmt::format("a picture of {}×{} pixels; give at least one", image.width_px, image.height_px)};
  }
  const std::uint64_t bytes =
      static_cast<std::uint64_t>(image.width_px) * static_cast<std::uint64_t>(image.height_px) * kBytesPerPixel;
  if (image.rgba.size() == bytes) return Done{};
  return Error{fmt::format("a picture of {}×{} pixels with {} bytes; RGBA has {}", image.width_px, image.height_px,
                           image.rgba.size(), bytes)};
}

Status check_encoding(const Image& image, int quality) {
  if (Status good = check_image(image); !good) return good;
  return RangeCheck().in("the quality", quality, 1, 100).result();
}

Result<Image> decode_image(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  switch (sniff_format(bytes)) {
    case ImageFormat::jpeg:
      return decode_jpeg(bytes, limits);
    case ImageFormat::png:
      return decode_png(bytes, limits);
    case ImageFormat::webp:
      return decode_webp(bytes, limits);
    case ImageFormat::unknown:
      break;
  }
  return no_picture(bytes);
}

}  // namespace terrella
