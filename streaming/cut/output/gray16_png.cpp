#include "streaming/cut/output/gray16_png.h"

#include <png.h>

#include <bit>
#include <csetjmp>

namespace terrella {
namespace {

/// longjmp jumps over the C frames of libpng's callbacks. Only on_write() grows the vector, and throws only if memory
/// runs out.
void on_write(png_structp png, png_bytep bytes, std::size_t size) {
  auto* out = static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  out->insert(out->end(), first, first + size);
}
void on_flush(png_structp) {}
[[noreturn]] void on_write_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore_write_warning(png_structp, png_const_charp) {}

struct Encoder {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_write_error, ignore_write_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }
};

// Contains no objects with destructors, because libpng may jump out of the function.
bool write_all(Encoder& encoder, std::vector<std::byte>& out, const std::uint16_t* values, png_uint_32 side) {
  png_structp png = encoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &out, on_write, on_flush);
  png_set_IHDR(png, encoder.info, side, side, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, encoder.info);
  // PNG is big-endian.
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  for (png_uint_32 y = 0; y < side; ++y) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(values + std::size_t{y} * side));
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

Result<std::vector<std::byte>> encode_gray16_png(std::span<const std::uint16_t> values, int side_px) {
  Encoder encoder;
  std::vector<std::byte> out;
  if (encoder.info == nullptr || !write_all(encoder, out, values.data(), static_cast<png_uint_32>(side_px))) {
    return Error{"PNG: a tile of heights cannot be encoded"};
  }
  return out;
}

}  // namespace terrella
