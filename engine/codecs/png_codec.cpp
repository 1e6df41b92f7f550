#include "codecs/png_codec.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <new>
#include <utility>

#include "codecs/image_limits.h"

namespace terrella {
namespace {

constexpr png_alloc_size_t kMaxChunkBytes = 8UL << 20;

/// The reason of a failure, for libpng's callbacks. longjmp skips their C frames, so no object in them may need a
/// destructor.
struct Failure {
  char message[128] = "unknown failure";
};

struct Decoder : Failure {
  std::span<const std::byte> rest;
  png_structp png = nullptr;
  png_infop info = nullptr;

  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_png_error(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::strncpy(failure->message, message, sizeof(failure->message) - 1);
  png_longjmp(png, 1);
}

void ignore_png_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep target, std::size_t size) {
  auto* decoder = static_cast<Decoder*>(png_get_io_ptr(png));
  if (size > decoder->rest.size()) png_error(png, "the data ends too early");
  std::memcpy(target, decoder->rest.data(), size);
  decoder->rest = decoder->rest.subspan(size);
}

bool set_up(Decoder& decoder) {
  decoder.png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, static_cast<Failure*>(&decoder), on_png_error, ignore_png_warning);
  if (decoder.png == nullptr) return false;
  decoder.info = png_create_info_struct(decoder.png);
  if (decoder.info == nullptr) return false;
  png_set_read_fn(decoder.png, &decoder, on_read);
  png_set_chunk_malloc_max(decoder.png, kMaxChunkBytes);
  // Only chunks that affect pixels are read: profiles and texts can be compression bombs.
  png_set_keep_unknown_chunks(decoder.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_crc_action(decoder.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  return true;
}

/// False on error; decoder.message says why.
bool read_header(Decoder& decoder) {
  if (setjmp(png_jmpbuf(decoder.png)) != 0) return false;
  png_read_info(decoder.png, decoder.info);
  return true;
}

bool read_pixels(Decoder& decoder, std::uint8_t* rgba, std::size_t row_bytes, std::size_t rows) {
  png_structp png = decoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, decoder.info);
  if (png_get_rowbytes(png, decoder.info) != row_bytes) png_error(png, "the rows are of an unexpected size");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < rows; ++row) png_read_row(png, rgba + row * row_bytes, nullptr);
  }
  png_read_end(png, nullptr);
  return true;
}

bool read_values(Decoder& decoder, std::uint16_t* values, std::size_t width, std::size_t rows) {
  png_structp png = decoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  // PNG is big-endian.
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, decoder.info);
  if (png_get_rowbytes(png, decoder.info) != width * 2) png_error(png, "the rows are of an unexpected size");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < rows; ++row) {
      png_read_row(png, reinterpret_cast<png_bytep>(values + row * width), nullptr);
    }
  }
  png_read_end(png, nullptr);
  return true;
}

const char* name_of_colour(int colour_type) {
  switch (colour_type) {
    case PNG_COLOR_TYPE_GRAY:
      return "gray";
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return "gray with alpha";
    case PNG_COLOR_TYPE_PALETTE:
      return "a palette";
    case PNG_COLOR_TYPE_RGB:
      return "RGB";
    default:
      return "RGBA";
  }
}

Error png_failure(const std::string& message) { return Error{"PNG: " + message}; }

// Reads up to the end of the header.
Status begin(Decoder& decoder, std::span<const std::byte> bytes) {
  decoder.rest = bytes;
  if (!set_up(decoder)) return png_failure("out of memory");
  if (!read_header(decoder)) return png_failure(decoder.message);
  return Done{};
}

bool has_no_alpha(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

struct Encoder : Failure {
  std::vector<std::byte> bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;

  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }
};

bool append(std::vector<std::byte>& bytes, const png_byte* from, std::size_t size) {
  try {
    const auto* first = reinterpret_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + size);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

void on_write(png_structp png, png_bytep from, std::size_t size) {
  auto* encoder = static_cast<Encoder*>(png_get_io_ptr(png));
  if (!append(encoder->bytes, from, size)) png_error(png, "out of memory");
}

void no_flush(png_structp) {}

bool write_png(Encoder& encoder, const Image& image, bool opaque, int strategy) {
  png_structp png = encoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &encoder, on_write, no_flush);
  png_set_IHDR(png, encoder.info, static_cast<png_uint_32>(image.width_px), static_cast<png_uint_32>(image.height_px),
               8, opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, encoder.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_strategy(png, strategy);
  png_write_info(png, encoder.info);
  if (opaque) png_set_filler(png, 0, PNG_FILLER_AFTER);
  const std::size_t row_bytes = static_cast<std::size_t>(image.width_px) * 4;
  for (std::size_t at = 0; at < image.rgba.size(); at += row_bytes) png_write_row(png, &image.rgba[at]);
  png_write_end(png, encoder.info);
  return true;
}

Result<std::vector<std::byte>> encode(const Image& image, int strategy) {
  if (Status good = check_image(image); !good) return png_failure(good.error().message);
  Encoder encoder;
  encoder.png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, static_cast<Failure*>(&encoder), on_png_error, ignore_png_warning);
  if (encoder.png != nullptr) encoder.info = png_create_info_struct(encoder.png);
  if (encoder.info == nullptr) return png_failure("out of memory");
  if (!write_png(encoder, image, has_no_alpha(image), strategy)) return png_failure(encoder.message);
  return std::move(encoder.bytes);
}

}  // namespace

Result<Image> decode_png(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  Decoder decoder;
  if (Status begun = begin(decoder, bytes); !begun) return begun.error();
  const png_uint_32 width = png_get_image_width(decoder.png, decoder.info);
  const png_uint_32 height = png_get_image_height(decoder.png, decoder.info);
  if (Status fits = check_size(width, height, limits); !fits) return png_failure(fits.error().message);
  Image image{.width_px = static_cast<int>(width), .height_px = static_cast<int>(height), .rgba = {}};
  const std::size_t row_bytes = std::size_t{width} * 4;
  image.rgba.resize(row_bytes * height);
  if (!read_pixels(decoder, image.rgba.data(), row_bytes, height)) return png_failure(decoder.message);
  return image;
}

Result<Gray16> decode_gray16_png(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  Decoder decoder;
  if (Status begun = begin(decoder, bytes); !begun) return begun.error();
  const int colour = png_get_color_type(decoder.png, decoder.info);
  const int bits = png_get_bit_depth(decoder.png, decoder.info);
  if (colour != PNG_COLOR_TYPE_GRAY || bits != 16) {
    return Error{fmt::format("PNG: {} of {} bits, heights are gray of 16 bits", name_of_colour(colour), bits)};
  }
  const png_uint_32 width = png_get_image_width(decoder.png, decoder.info);
  const png_uint_32 height = png_get_image_height(decoder.png, decoder.info);
  if (Status fits = check_size(width, height, limits); !fits) return png_failure(fits.error().message);
  Gray16 gray{.width_px = static_cast<int>(width), .height_px = static_cast<int>(height), .values = {}};
  gray.values.resize(std::size_t{width} * height);
  if (!read_values(decoder, gray.values.data(), width, height)) return png_failure(decoder.message);
  return gray;
}

Result<PictureSize> png_size(std::span<const std::byte> bytes) {
  Decoder decoder;
  if (Status begun = begin(decoder, bytes); !begun) return begun.error();
  return PictureSize{static_cast<int>(png_get_image_width(decoder.png, decoder.info)),
                     static_cast<int>(png_get_image_height(decoder.png, decoder.info))};
}

Result<std::vector<std::byte>> encode_png(const Image& image) { return encode(image, Z_FILTERED); }
Result<std::vector<std::byte>> encode_png_quickly(const Image& image) { return encode(image, Z_RLE); }

}  // namespace terrella
