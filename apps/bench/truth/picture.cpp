#include "apps/bench/truth/picture.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

// jpeglib.h needs size_t and FILE before it.
#include <jpeglib.h>

namespace terrella::truth {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

Picture blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

Picture read_png(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) fail(file, image.message);
  image.format = PNG_FORMAT_RGB;
  Picture picture = blank(static_cast<int>(image.width), static_cast<int>(image.height));
  const png_color black{};
  if (png_image_finish_read(&image, &black, picture.rgb.data(), 0, nullptr) == 0) fail(file, image.message);
  return picture;
}

struct JpegErrors {
  jpeg_error_mgr base;  // first member, so that libjpeg's pointer to the base is a pointer to this struct
  std::jmp_buf back;
  std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void leave_libjpeg(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  errors->base.format_message(info, errors->message.data());
  std::longjmp(errors->back, 1);
}

// Decodes without any object that has a destructor, because longjmp skips destructors. Returns false with the reason in
// `errors`.
bool decode_jpeg(std::FILE* in, Picture& picture, JpegErrors& errors) {
  jpeg_decompress_struct info{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = leave_libjpeg;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_stdio_src(&info, in);
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  picture.width = static_cast<int>(info.output_width);
  picture.height = static_cast<int>(info.output_height);
  const std::size_t stride = 3 * static_cast<std::size_t>(info.output_width);
  picture.rgb.resize(stride * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = picture.rgb.data() + stride * info.output_scanline;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return true;
}

Picture read_jpeg(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in) fail(file, "cannot be opened");
  Picture picture;
  JpegErrors errors{};
  if (!decode_jpeg(in.get(), picture, errors)) fail(file, errors.message.data());
  return picture;
}

}  // namespace

Picture read_picture(const std::filesystem::path& file) {
  std::array<char, 2> magic{};
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, "cannot be opened");
  in.read(magic.data(), magic.size());
  if (magic == std::array<char, 2>{'\xff', '\xd8'}) return read_jpeg(file);
  return read_png(file);
}

void write_png(const Picture& picture, const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  if (png_image_write_to_file(&image, file.c_str(), 0, picture.rgb.data(), 0, nullptr) == 0) fail(file, image.message);
}

std::uint64_t fingerprint(const Picture& picture) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&hash](std::uint64_t word) { hash = (hash ^ word) * kPrime; };
  mix(static_cast<std::uint64_t>(picture.width));
  mix(static_cast<std::uint64_t>(picture.height));
  std::size_t at = 0;
  for (; at + 8 <= picture.rgb.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, picture.rgb.data() + at, 8);
    mix(word);
    hash ^= hash >> 29;  // FNV over words carries upwards only; this mixes in the high bits
  }
  for (; at < picture.rgb.size(); ++at) mix(picture.rgb[at]);
  return hash;
}

}  // namespace terrella::truth
