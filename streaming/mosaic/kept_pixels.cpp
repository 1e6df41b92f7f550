#include "streaming/mosaic/kept_pixels.h"

#include <zlib.h>

#include <utility>

namespace terrella {
namespace {

/// Heights shrink by as much at higher levels, which take three times as long.
constexpr int kFast = 1;

}  // namespace

std::vector<std::byte> pack_pixels(const Block& block) {
  if (const auto* const image = std::get_if<Image>(&block)) {
    auto png = encode_png(*image);
    return png ? *std::move(png) : std::vector<std::byte>();
  }
  const std::vector<float>& values = std::get<Numbers>(block).values;
  const auto size = static_cast<uLong>(values.size() * sizeof(float));
  uLongf packed = compressBound(size);
  std::vector<std::byte> bytes(packed);
  const int done = compress2(reinterpret_cast<Bytef*>(bytes.data()), &packed,
                             reinterpret_cast<const Bytef*>(values.data()), size, kFast);
  bytes.resize(done == Z_OK ? packed : 0);
  return bytes;
}

Result<Block> unpack_pixels(std::span<const std::byte> bytes, int side_px, bool numbers) {
  if (!numbers) {
    auto image = decode_image(bytes);
    if (!image) return image.error();
    if (image->width_px != side_px || image->height_px != side_px) return Error{"a kept tile has another size"};
    return Block(*std::move(image));
  }
  Numbers made{side_px, side_px,
               std::vector<float>(static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px))};
  auto size = static_cast<uLongf>(made.values.size() * sizeof(float));
  const uLongf whole = size;
  const int done = uncompress(reinterpret_cast<Bytef*>(made.values.data()), &size,
                              reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  if (done != Z_OK || size != whole) return Error{"a kept tile is damaged"};
  return Block(std::move(made));
}

}  // namespace terrella
