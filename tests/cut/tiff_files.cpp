#include "tiff_files.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace terrella::test {
namespace {

int samples_per_pixel(const TiffKind& kind) {
  const bool has_three = kind.photometric == PHOTOMETRIC_RGB || kind.photometric == PHOTOMETRIC_YCBCR;
  return (has_three ? 3 : 1) + (kind.extra >= 0 ? 1 : 0);
}

/// The samples of a rectangle, repeated beyond the picture's edges.
std::vector<std::uint8_t> samples(const Image& image, const TiffKind& kind, int x0, int y0, int width, int height) {
  std::vector<std::uint8_t> bytes;
  const int count = samples_per_pixel(kind);
  for (int y = y0; y < y0 + height; ++y) {
    for (int x = x0; x < x0 + width; ++x) {
      const int at = std::min(y, image.height_px - 1) * image.width_px + std::min(x, image.width_px - 1);
      for (int s = 0; s < count; ++s) {
        const int channel = s == count - 1 && kind.extra >= 0 ? 3 : s;
        bytes.insert(bytes.end(), static_cast<std::size_t>(kind.bits / 8),
                     image.rgba[static_cast<std::size_t>(at * 4 + channel)]);
      }
    }
  }
  return bytes;
}

void set_palette(TIFF* tiff) {
  std::array<std::array<std::uint16_t, 256>, 3> maps{};
  for (std::size_t i = 0; i < 256; ++i) {
    maps[0][i] = static_cast<std::uint16_t>(i * 257);
    maps[1][i] = static_cast<std::uint16_t>((255 - i) * 257);
    maps[2][i] = static_cast<std::uint16_t>(i / 2 * 257);
  }
  TIFFSetField(tiff, TIFFTAG_COLORMAP, maps[0].data(), maps[1].data(), maps[2].data());
}

void set_tags(TIFF* tiff, const Image& image, const TiffKind& kind) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, image.width_px);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image.height_px);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples_per_pixel(kind));
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.photometric);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
  if (kind.compression == COMPRESSION_JPEG) TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  if (kind.photometric == PHOTOMETRIC_PALETTE) set_palette(tiff);
  const auto extra = static_cast<std::uint16_t>(kind.extra);
  if (kind.extra >= 0) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &extra);
}

}  // namespace

void write_tiff(const std::filesystem::path& path, const Image& image, const TiffKind& kind) {
  TIFF* tiff = TIFFOpen(path.c_str(), kind.big ? "w8" : "w");
  set_tags(tiff, image, kind);
  if (kind.tile_px > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kind.tile_px);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, kind.tile_px);
    for (int y = 0; y < image.height_px; y += kind.tile_px) {
      for (int x = 0; x < image.width_px; x += kind.tile_px) {
        auto tile = samples(image, kind, x, y, kind.tile_px, kind.tile_px);
        TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
      }
    }
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kind.rows_per_strip);
    for (int y = 0; y < image.height_px; ++y) {
      auto row = samples(image, kind, 0, y, image.width_px, 1);
      TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
    }
  }
  TIFFClose(tiff);
}

}  // namespace terrella::test
