#include "streaming/cut/output/tile_encoder.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstring>

#include "codecs/float_tiff.h"
#include "streaming/cut/halve.h"
#include "streaming/cut/input/heights.h"
#include "streaming/cut/output/gray16_png.h"

namespace terrella {
namespace {

Image copy_of_tile(const Strip& strip, std::int64_t index) {
  const auto side = static_cast<std::size_t>(strip.tile_px);
  Image image{.width_px = strip.tile_px, .height_px = strip.tile_px, .rgba = {}};
  image.rgba.resize(side * side * 4);
  for (std::size_t y = 0; y < side; ++y) {
    std::memcpy(image.rgba.data() + y * side * 4, strip.tile(index) + y * strip.stride_bytes(), side * 4);
  }
  return image;
}

bool is_opaque(const Strip& strip, std::int64_t index) {
  const auto side = static_cast<std::size_t>(strip.tile_px);
  for (std::size_t y = 0; y < side; ++y) {
    if (!are_opaque({strip.tile(index) + y * strip.stride_bytes(), side * 4})) return false;
  }
  return true;
}

std::vector<std::uint16_t> heights_of_tile(const Strip& strip, std::int64_t index) {
  const auto side = static_cast<std::size_t>(strip.tile_px);
  std::vector<std::uint16_t> heights;
  heights.reserve(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    const std::uint8_t* row = strip.tile(index) + y * strip.stride_bytes();
    for (std::size_t x = 0; x < side; ++x) heights.push_back(height_at(row + x * 4));
  }
  return heights;
}

/// A known number that equals nodata moves to the next float.
std::vector<float> numbers_of_tile(const Strip& strip, std::int64_t index, std::optional<float> nodata) {
  const auto side = static_cast<std::size_t>(strip.tile_px);
  std::vector<float> numbers;
  numbers.reserve(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    const std::uint8_t* row = strip.tile(index) + y * strip.stride_bytes();
    for (std::size_t x = 0; x < side; ++x) {
      float number = number_at(row + x * 4);
      if (nodata && number == *nodata) number = std::nextafter(number, 0.0F);
      numbers.push_back(nodata && std::isnan(number) ? *nodata : number);
    }
  }
  return numbers;
}

}  // namespace

void TileEncoder::DestroyHandle::operator()(void* handle) const { tjDestroy(handle); }

TileEncoder::TileEncoder(const TileCoding& coding) : coding_(coding) {
  if (coding.format == ImageFormat::jpeg) jpeg_.reset(tjInitCompress());
}

Result<std::vector<std::byte>> TileEncoder::encode(const Strip& strip, std::int64_t index) {
  if (coding_.floats) {
    return encode_float_tiff(numbers_of_tile(strip, index, coding_.nodata), strip.tile_px);
  }
  if (coding_.heights) return encode_gray16_png(heights_of_tile(strip, index), strip.tile_px);
  const bool outline = coding_.png_outline && !is_opaque(strip, index);
  if (coding_.format == ImageFormat::jpeg && !outline) return encode_jpeg_tile(strip, index);
  const Image tile = copy_of_tile(strip, index);
  return coding_.format == ImageFormat::webp ? encode_webp(tile, coding_.quality) : encode_png(tile);
}

Result<std::vector<std::byte>> TileEncoder::encode_jpeg_tile(const Strip& strip, std::int64_t index) {
  if (!jpeg_) return Error{"JPEG: out of memory"};
  const int side = strip.tile_px;
  // A picture itself often has colour of half its size. Means of its pixels have all of it.
  const int sampling = strip.level < coding_.finest ? TJSAMP_444 : TJSAMP_420;
  buffer_.resize(tjBufSize(side, side, sampling));
  unsigned char* bytes = buffer_.data();
  unsigned long size = buffer_.size();
  const int failed =
      tjCompress2(jpeg_.get(), strip.tile(index), side, static_cast<int>(strip.stride_bytes()), side, TJPF_RGBX, &bytes,
                  &size, sampling, coding_.quality, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
  if (failed != 0) return Error{fmt::format("JPEG: {}", tjGetErrorStr2(jpeg_.get()))};
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  return std::vector<std::byte>(first, first + size);
}

}  // namespace terrella
