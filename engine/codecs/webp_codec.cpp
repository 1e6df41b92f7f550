#include "codecs/webp_codec.h"

#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <cassert>
#include <memory>

#include "codecs/image_limits.h"

namespace terrella {
namespace {

constexpr std::size_t kHeadBytes = 12;  // "RIFF", length, "WEBP"

struct FreeBytes {
  void operator()(std::uint8_t* bytes) const { WebPFree(bytes); }
};

const std::uint8_t* data_of(std::span<const std::byte> bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

Error webp_error(VP8StatusCode code) {
  switch (code) {
    case VP8_STATUS_OUT_OF_MEMORY:
      return Error{"WebP: out of memory"};
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED:
      return Error{"WebP: the data ends too early"};
    case VP8_STATUS_UNSUPPORTED_FEATURE:
      return Error{"WebP: it uses a feature that libwebp does not know"};
    default:
      return Error{"WebP: the data is damaged"};
  }
}

}  // namespace

std::uint64_t webp_length(std::span<const std::byte> bytes) {
  assert(bytes.size() >= kHeadBytes);
  std::uint64_t length = 0;
  for (std::size_t i = 8; i-- > 4;) length = length << 8 | std::to_integer<std::uint64_t>(bytes[i]);
  return length + 8;
}

Result<WebpHeader> webp_header(std::span<const std::byte> bytes) {
  WebPBitstreamFeatures features{};
  const VP8StatusCode code = WebPGetFeatures(data_of(bytes), bytes.size(), &features);
  if (code != VP8_STATUS_OK) return webp_error(code);
  if (features.has_animation != 0) return Error{"WebP: an animation; save one picture of it"};
  return WebpHeader{.size = {.width_px = features.width, .height_px = features.height},
                    .has_alpha = features.has_alpha != 0};
}

Result<PictureSize> webp_size(std::span<const std::byte> bytes) {
  const Result<WebpHeader> header = webp_header(bytes);
  if (!header) return header.error();
  return header->size;
}

Result<Image> decode_webp(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  const Result<PictureSize> size = webp_size(bytes);
  if (!size) return size.error();
  const auto width = static_cast<std::uint64_t>(size->width_px), height = static_cast<std::uint64_t>(size->height_px);
  if (Status fits = check_size(width, height, limits); !fits) return Error{"WebP: " + fits.error().message};
  WebPDecoderConfig config;
  if (WebPInitDecoderConfig(&config) == 0) return Error{"WebP: libwebp is of another version"};
  Image image{.width_px = size->width_px, .height_px = size->height_px, .rgba = {}};
  image.rgba.resize(width * height * 4);
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA.rgba = image.rgba.data();
  config.output.u.RGBA.stride = image.width_px * 4;
  config.output.u.RGBA.size = image.rgba.size();
  const VP8StatusCode code = WebPDecode(data_of(bytes), bytes.size(), &config);
  if (code != VP8_STATUS_OK) return webp_error(code);
  return image;
}

Result<std::vector<std::byte>> encode_webp(const Image& image, int quality) {
  if (Status good = check_encoding(image, quality); !good) return Error{"WebP: " + good.error().message};
  if (image.width_px > kMaxWebpSide_px || image.height_px > kMaxWebpSide_px) {
    return Error{fmt::format("WebP: a picture of {}×{} pixels; a side has at most {}, so use PNG", image.width_px,
                             image.height_px, kMaxWebpSide_px)};
  }
  std::uint8_t* buffer = nullptr;
  const std::size_t size = WebPEncodeRGBA(image.rgba.data(), image.width_px, image.height_px, image.width_px * 4,
                                          static_cast<float>(quality), &buffer);
  const std::unique_ptr<std::uint8_t, FreeBytes> owner(buffer);
  if (size == 0) return Error{"WebP: the picture cannot be encoded: out of memory"};
  const auto* first = reinterpret_cast<const std::byte*>(buffer);
  return std::vector<std::byte>(first, first + size);
}

}  // namespace terrella
