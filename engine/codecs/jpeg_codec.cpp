#include "codecs/jpeg_codec.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

#include "codecs/image_limits.h"

namespace terrella {
namespace {

struct DestroyHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, DestroyHandle>;

struct FreeBuffer {
  void operator()(unsigned char* buffer) const { tjFree(buffer); }
};

Error jpeg_error(const Handle& handle) { return Error{fmt::format("JPEG: {}", tjGetErrorStr2(handle.get()))}; }

std::size_t rgba_size(int width_px, int height_px) {
  return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4;
}

}  // namespace

Result<Image> decode_jpeg(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  const Handle handle(tjInitDecompress());
  if (!handle) return Error{"JPEG: out of memory"};
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const unsigned long size = bytes.size();
  Image image;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(handle.get(), data, size, &image.width_px, &image.height_px, &subsampling, &color_space) !=
      0) {
    return jpeg_error(handle);
  }
  if (color_space == TJCS_CMYK || color_space == TJCS_YCCK)
    return Error{"JPEG: CMYK is not supported, convert it to RGB"};
  if (Status fits =
          check_size(static_cast<std::uint64_t>(image.width_px), static_cast<std::uint64_t>(image.height_px), limits);
      !fits) {
    return Error{"JPEG: " + fits.error().message};
  }
  image.rgba.resize(rgba_size(image.width_px, image.height_px));
  // Without a limit on scans, a progressive file of a few kilobytes can keep the decoder busy for minutes.
  constexpr int kFlags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
  if (tjDecompress2(handle.get(), data, size, image.rgba.data(), image.width_px, 0, image.height_px, TJPF_RGBA,
                    kFlags) != 0) {
    return jpeg_error(handle);
  }
  return image;
}

Result<PictureSize> jpeg_size(std::span<const std::byte> bytes) {
  const Handle handle(tjInitDecompress());
  if (!handle) return Error{"JPEG: out of memory"};
  PictureSize size;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(handle.get(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                          &size.width_px, &size.height_px, &subsampling, &color_space) != 0) {
    return jpeg_error(handle);
  }
  return size;
}

Result<std::vector<std::byte>> encode_jpeg(const Image& image, int quality) {
  if (Status good = check_encoding(image, quality); !good) return Error{"JPEG: " + good.error().message};
  const Handle handle(tjInitCompress());
  if (!handle) return Error{"JPEG: out of memory"};
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(handle.get(), image.rgba.data(), image.width_px, 0, image.height_px, TJPF_RGBA,
                                 &buffer, &size, TJSAMP_420, quality, 0);
  const std::unique_ptr<unsigned char, FreeBuffer> owner(buffer);
  if (failed != 0) return jpeg_error(handle);
  const auto* first = reinterpret_cast<const std::byte*>(buffer);
  return std::vector<std::byte>(first, first + size);
}

}  // namespace terrella
