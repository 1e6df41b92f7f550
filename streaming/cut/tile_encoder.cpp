#include "streaming/cut/tile_encoder.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <cstring>

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

}  // namespace

void TileEncoder::DestroyHandle::operator()(void* handle) const { tjDestroy(handle); }

TileEncoder::TileEncoder(ImageFormat format, int quality) : format_(format), quality_(quality) {
  if (format == ImageFormat::jpeg) jpeg_.reset(tjInitCompress());
}

Result<std::vector<std::byte>> TileEncoder::encode(const Strip& strip, std::int64_t index) {
  return format_ == ImageFormat::jpeg ? encode_jpeg_tile(strip, index) : encode_png(copy_of_tile(strip, index));
}

Result<std::vector<std::byte>> TileEncoder::encode_jpeg_tile(const Strip& strip, std::int64_t index) {
  if (!jpeg_) return Error{"JPEG: out of memory"};
  const int side = strip.tile_px;
  buffer_.resize(tjBufSize(side, side, TJSAMP_420));
  unsigned char* bytes = buffer_.data();
  unsigned long size = buffer_.size();
  const int failed = tjCompress2(jpeg_.get(), strip.tile(index), side, static_cast<int>(strip.stride_bytes()), side,
                                 TJPF_RGBX, &bytes, &size, TJSAMP_420, quality_, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
  if (failed != 0) return Error{fmt::format("JPEG: {}", tjGetErrorStr2(jpeg_.get()))};
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  return std::vector<std::byte>(first, first + size);
}

}  // namespace terrella
