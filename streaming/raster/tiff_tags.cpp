#include "streaming/raster/tiff_tags.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <memory>

namespace terrella {
namespace {

/// Most memory that libtiff may allocate at once for a table with sizes from the file, bytes.
constexpr tmsize_t kMostTableBytes = 64L << 20;

/// Tags of GeoTIFF 1.1.
constexpr ttag_t kPixelScaleTag = 33550, kTiePointTag = 33922, kMatrixTag = 34264, kGeoKeyTag = 34735;

struct FreeOpenOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};
struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

/// The place in a file at which libtiff reads.
struct TiffCursor {
  const ByteFile& file;
  std::uint64_t position = 0;
};

tmsize_t read_tiff(thandle_t handle, void* into, tmsize_t size) {
  auto& cursor = *static_cast<TiffCursor*>(handle);
  const std::span<std::byte> bytes(static_cast<std::byte*>(into),
                                   static_cast<std::size_t>(std::max<tmsize_t>(size, 0)));
  const std::size_t got = cursor.file.read_at(cursor.position, bytes);
  cursor.position += got;
  return static_cast<tmsize_t>(got);
}

toff_t seek_tiff(thandle_t handle, toff_t offset, int whence) {
  auto& cursor = *static_cast<TiffCursor*>(handle);
  const std::uint64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? cursor.position : cursor.file.size();
  return cursor.position = from + offset;
}

toff_t size_of_tiff(thandle_t handle) { return static_cast<TiffCursor*>(handle)->file.size(); }
tmsize_t write_no_tiff(thandle_t, void*, tmsize_t) { return -1; }
int close_no_tiff(thandle_t) { return 0; }
/// GDAL reports the faults of the file.
int say_nothing(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

}  // namespace

TiffTags read_tiff_tags(const ByteFile& file) {
  TiffTags found;
  const std::unique_ptr<TIFFOpenOptions, FreeOpenOptions> options(TIFFOpenOptionsAlloc());
  if (!options) return found;
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), say_nothing, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), say_nothing, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMostTableBytes);
  TiffCursor cursor{file};
  // m: no memory map. O: the tables of blocks are not read.
  const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFClientOpenExt(file.name().c_str(), "rmO", &cursor, read_tiff,
                                                                write_no_tiff, seek_tiff, close_no_tiff, size_of_tiff,
                                                                nullptr, nullptr, options.get()));
  if (!tiff) return found;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK, samples = 1, extra = 0, orientation = ORIENTATION_TOPLEFT;
  const std::uint16_t* kinds = nullptr;
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ORIENTATION, &orientation);
  found.in_strips = TIFFIsTiled(tiff.get()) == 0;
  found.orientation = orientation;
  found.other = photometric > PHOTOMETRIC_YCBCR;
  found.rgb = (photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR) && samples >= 3;
  found.premultiplied = extra > 0 && kinds[0] == EXTRASAMPLE_ASSOCALPHA;
  found.has_alpha = found.premultiplied || (extra > 0 && kinds[0] == EXTRASAMPLE_UNASSALPHA);
  const auto has = [&](ttag_t tag) {
    std::uint32_t count = 0;
    const void* values = nullptr;
    return TIFFGetField(tiff.get(), tag, &count, &values) == 1;
  };
  found.has_place = has(kPixelScaleTag) || has(kTiePointTag) || has(kMatrixTag);
  found.has_system = has(kGeoKeyTag);
  return found;
}

bool begins_as_tiff(std::string_view head) {
  using namespace std::string_view_literals;
  constexpr std::array kHeads = {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};
  return std::ranges::any_of(kHeads, [head](std::string_view start) { return head.starts_with(start); });
}

}  // namespace terrella
