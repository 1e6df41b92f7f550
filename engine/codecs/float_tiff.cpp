#include "codecs/float_tiff.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace terrella {
namespace {

/// Limit of a single allocation by libtiff: a strip, or a table with sizes from the file. A tile of 4096² floats is 64
/// MiB.
constexpr tmsize_t kMaxTileAllocation = 80L << 20;

/// A file in memory, which libtiff only reads.
struct MemoryFile {
  std::span<const std::byte> bytes;
  std::uint64_t at = 0;
  std::string message = "the data ends too early";
};

tmsize_t read_memory(thandle_t handle, void* to, tmsize_t size) {
  auto& file = *static_cast<MemoryFile*>(handle);
  // Reading past the end returns 0 bytes, as with a file. An error (-1) would make libtiff 4.5 clear memory before its
  // buffer.
  if (size < 0 || file.at > file.bytes.size()) return 0;
  const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(size), file.bytes.size() - file.at);
  if (count == 0) return 0;  // an empty file has no address to copy from
  std::memcpy(to, file.bytes.data() + file.at, count);
  file.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return 0; }

toff_t seek_memory(thandle_t handle, toff_t to, int whence) {
  auto& file = *static_cast<MemoryFile*>(handle);
  const std::uint64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.bytes.size();
  file.at = from + to;
  return file.at;
}

int keep_open(thandle_t) { return 0; }
toff_t size_of_memory(thandle_t handle) { return static_cast<MemoryFile*>(handle)->bytes.size(); }

int keep_message(TIFF*, void* file, const char*, const char* format, std::va_list arguments) {
  char line[256];
  std::vsnprintf(line, sizeof(line), format, arguments);
  static_cast<MemoryFile*>(file)->message = line;
  return 1;
}
int ignore_warning(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

struct FreeTiffOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};
struct CloseMemoryTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using MemoryTiff = std::unique_ptr<TIFF, CloseMemoryTiff>;

MemoryTiff open_memory(MemoryFile& file) {
  const std::unique_ptr<TIFFOpenOptions, FreeTiffOptions> options(TIFFOpenOptionsAlloc());
  if (!options) return {};
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxTileAllocation);
  // "m" makes libtiff use the read functions, without a memory map.
  return MemoryTiff(TIFFClientOpenExt("tile", "rm", &file, read_memory, write_nothing, seek_memory, keep_open,
                                      size_of_memory, nullptr, nullptr, options.get()));
}

Error tiff_failure(const std::string& why) { return Error{"TIFF: " + why}; }

Status check_tags(TIFF* tiff, int side_px) {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 1;
  std::uint16_t samples = 1;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  if (bits != 32 || samples != 1 || format != SAMPLEFORMAT_IEEEFP) {
    return tiff_failure(fmt::format("{} sample{} of {} bits a pixel{}, heights are one float of 32 bits", samples,
                                    samples == 1 ? "" : "s", bits, format == SAMPLEFORMAT_IEEEFP ? ", floats" : ""));
  }
  if (TIFFIsTiled(tiff) != 0) return tiff_failure("it is tiled, a tile of heights is in strips");
  const auto side = static_cast<std::uint32_t>(side_px);
  if (width != side || height != side) {
    return tiff_failure(fmt::format("{}×{} pixels, the tile set says {}×{}", width, height, side_px, side_px));
  }
  if (TIFFScanlineSize(tiff) != static_cast<tmsize_t>(side) * 4) return tiff_failure("rows of an unexpected size");
  return Done{};
}

/// A file in memory, which libtiff writes.
struct GrowingFile {
  std::vector<std::byte> bytes;
  std::uint64_t at = 0;
};

tmsize_t write_memory(thandle_t handle, void* from, tmsize_t size) {
  auto& file = *static_cast<GrowingFile*>(handle);
  const std::uint64_t end = file.at + static_cast<std::uint64_t>(size);
  if (file.bytes.size() < end) file.bytes.resize(end);
  std::memcpy(file.bytes.data() + file.at, from, static_cast<std::size_t>(size));
  file.at = end;
  return size;
}

/// libtiff reads back what it has written of a directory.
tmsize_t read_written(thandle_t handle, void* to, tmsize_t size) {
  auto& file = *static_cast<GrowingFile*>(handle);
  if (size < 0 || file.at > file.bytes.size()) return 0;
  const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(size), file.bytes.size() - file.at);
  std::copy_n(file.bytes.begin() + static_cast<std::ptrdiff_t>(file.at), count, static_cast<std::byte*>(to));
  file.at += count;
  return static_cast<tmsize_t>(count);
}

toff_t seek_written(thandle_t handle, toff_t to, int whence) {
  auto& file = *static_cast<GrowingFile*>(handle);
  file.at = to + (whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.bytes.size());
  return file.at;
}

toff_t size_written(thandle_t handle) { return static_cast<GrowingFile*>(handle)->bytes.size(); }

}  // namespace

Result<std::vector<std::byte>> encode_float_tiff(std::span<const float> numbers, int side_px) {
  GrowingFile file;
  MemoryTiff tiff(TIFFClientOpen("tile", "wm", &file, read_written, write_memory, seek_written, keep_open, size_written,
                                 nullptr, nullptr));
  if (!tiff) return tiff_failure("out of memory");
  const auto side = static_cast<std::uint32_t>(side_px);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, side);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, side);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, side);
  std::vector<float> copy(numbers.begin(), numbers.end());  // libtiff may change what it is given
  const auto bytes = static_cast<tmsize_t>(copy.size() * sizeof(float));
  if (TIFFWriteEncodedStrip(tiff.get(), 0, copy.data(), bytes) != bytes || TIFFFlush(tiff.get()) != 1) {
    return tiff_failure("a tile of numbers cannot be encoded");
  }
  tiff.reset();
  return std::move(file.bytes);
}

Result<std::vector<float>> decode_float_tiff(std::span<const std::byte> bytes, int side_px) {
  MemoryFile file{.bytes = bytes};
  const MemoryTiff tiff = open_memory(file);
  if (!tiff) return tiff_failure(file.message);
  if (Status fits = check_tags(tiff.get(), side_px); !fits) return fits.error();
  const auto side = static_cast<std::size_t>(side_px);
  std::vector<float> numbers(side * side);
  for (std::size_t row = 0; row < side; ++row) {
    if (TIFFReadScanline(tiff.get(), numbers.data() + row * side, static_cast<std::uint32_t>(row)) != 1) {
      return tiff_failure(fmt::format("row {} of {}: {}", row, side_px, file.message));
    }
  }
  return numbers;
}

}  // namespace terrella
