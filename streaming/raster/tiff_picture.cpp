#include "streaming/raster/tiff_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace terrella {
namespace {

/// Longest side of a picture, pixels.
constexpr std::int64_t kMaxTiffSide_px = 1 << 20;

template <class T>
T tiff_tag(TIFF* tiff, ttag_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

std::optional<SampleType> type_of(int format, int bits) {
  const bool is_signed = format == SAMPLEFORMAT_INT;
  if (format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 16 || bits == 32) return SampleType::float32;
    return bits == 64 ? std::optional(SampleType::float64) : std::nullopt;
  }
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID && !is_signed) return {};
  if (bits == 8 && is_signed) return SampleType::int8;
  if (bits == 16 && is_signed) return SampleType::int16;
  if (bits == 32 && is_signed) return SampleType::int32;
  if (bits == 64) return is_signed ? SampleType::int64 : SampleType::uint64;
  if (bits < 1 || bits > 32 || is_signed) return {};
  return bits <= 8 ? SampleType::uint8 : bits <= 16 ? SampleType::uint16 : SampleType::uint32;
}

/// Fills a TiffPicture from the current directory of a reader.
class PictureTags {
 public:
  explicit PictureTags(TiffReader& reader) : reader_(reader), tiff_(reader.get()) {}

  Result<TiffPicture> read() {
    for (const auto step : {&PictureTags::read_size, &PictureTags::read_type, &PictureTags::read_colour,
                            &PictureTags::read_compression, &PictureTags::read_blocks}) {
      if (Status can = (this->*step)(); !can) return can.error();
    }
    read_alpha();
    return picture_;
  }

 private:
  [[nodiscard]] Error refuse(const std::string& what) const { return refuse_tiff(reader_.bytes().name(), what); }

  Status read_size() {
    picture_.directory = TIFFCurrentDirOffset(tiff_);
    picture_.width_px = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_IMAGEWIDTH, 0);
    picture_.height_px = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_IMAGELENGTH, 0);
    const auto kind = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_SUBFILETYPE, 0);
    picture_.reduced = (kind & FILETYPE_REDUCEDIMAGE) != 0;
    picture_.mask = (kind & FILETYPE_MASK) != 0;
    picture_.orientation = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    const std::string& name = reader_.bytes().name();
    if (picture_.width_px < 1 || picture_.height_px < 1)
      return Error{fmt::format("{}: the picture has no pixels", name)};
    if (picture_.width_px <= kMaxTiffSide_px && picture_.height_px <= kMaxTiffSide_px) return Done{};
    return Error{fmt::format("{}: {}x{} pixels are too many; a side may have at most {}", name, picture_.width_px,
                             picture_.height_px, kMaxTiffSide_px)};
  }

  Status read_type() {
    TiffSamples& samples = picture_.samples;
    samples.stored_bits = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_BITSPERSAMPLE, 1);
    samples.per_pixel = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_SAMPLESPERPIXEL, 1);
    const int format = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const int planes = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    picture_.separate = planes == PLANARCONFIG_SEPARATE && samples.per_pixel > 1;
    if (format == SAMPLEFORMAT_COMPLEXIEEEFP || format == SAMPLEFORMAT_COMPLEXINT) return refuse("complex numbers");
    const auto type = type_of(format, samples.stored_bits);
    if (!type) {
      return refuse(
          fmt::format("samples of {} bits{}", samples.stored_bits, format == SAMPLEFORMAT_IEEEFP ? " (floats)" : ""));
    }
    samples.type = *type;
    if (samples.per_pixel < 1) return refuse("no sample a pixel");
    return Done{};
  }

  Status read_colour() {
    TiffSamples& samples = picture_.samples;
    switch (tiff_tag<std::uint16_t>(tiff_, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK)) {
      case PHOTOMETRIC_MINISBLACK:
      case PHOTOMETRIC_MASK:
        samples.colour = TiffColour::gray;
        break;
      case PHOTOMETRIC_MINISWHITE:
        samples.colour = TiffColour::gray_inverted;
        break;
      case PHOTOMETRIC_RGB:
        samples.colour = TiffColour::rgb;
        break;
      case PHOTOMETRIC_PALETTE:
        samples.colour = TiffColour::palette;
        if (Status read = read_palette(); !read) return read;
        break;
      case PHOTOMETRIC_YCBCR:
        samples.colour = TiffColour::rgb;
        if (tiff_tag<std::uint16_t>(tiff_, TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_JPEG) {
          return refuse("YCbCr colours without JPEG compression");
        }
        break;
      default:
        return refuse("a colour space that is not supported");
    }
    if (samples.per_pixel < samples.colours()) return refuse("fewer samples a pixel than its colours need");
    return Done{};
  }

  Status read_palette() {
    TiffSamples& samples = picture_.samples;
    std::array<std::uint16_t*, 3> maps{};
    if (samples.type != SampleType::uint8 && samples.type != SampleType::uint16) {
      return refuse(fmt::format("a palette for {}", samples.title()));
    }
    if (TIFFGetField(tiff_, TIFFTAG_COLORMAP, &maps[0], &maps[1], &maps[2]) != 1) return refuse("no palette");
    samples.palette.resize(std::size_t{1} << samples.stored_bits);
    for (std::size_t i = 0; i < samples.palette.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        samples.palette[i][c] = static_cast<std::uint8_t>((maps[c][i] + 128U) / 257U);
      }
    }
    return Done{};
  }

  /// Extra samples without a stated kind do not count as alpha, as in GDAL.
  void read_alpha() {
    TiffSamples& samples = picture_.samples;
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    if (samples.per_pixel == samples.colours()) return;
    if (TIFFGetFieldDefaulted(tiff_, TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || count == 0) return;
    if (kinds[0] == EXTRASAMPLE_UNASSALPHA) samples.alpha = TiffAlpha::straight;
    if (kinds[0] == EXTRASAMPLE_ASSOCALPHA) samples.alpha = TiffAlpha::premultiplied;
  }

  Status read_compression() {
    picture_.compression = tiff_tag<std::uint16_t>(tiff_, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    const auto scheme = static_cast<std::uint16_t>(picture_.compression);
    if (scheme == COMPRESSION_JPEG && picture_.samples.stored_bits != 8) {
      return refuse(fmt::format("JPEG compression of {}", picture_.samples.title()));
    }
    if (scheme != COMPRESSION_OJPEG && TIFFIsCODECConfigured(scheme) != 0) return Done{};
    return refuse(fmt::format("compression {} is not supported", picture_.compression));
  }

  Status read_blocks() {
    if (Status fits = check_memory("rows", static_cast<std::uint64_t>(picture_.width_px)); !fits) return fits;
    picture_.tiled = TIFFIsTiled(tiff_) != 0;
    if (!picture_.tiled) {
      const std::int64_t rows = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_ROWSPERSTRIP, 0);
      picture_.rows_per_strip = std::clamp<std::int64_t>(rows, 1, picture_.height_px);
      const tmsize_t row = TIFFScanlineSize(tiff_);
      picture_.even_strips = row > 0 && static_cast<std::size_t>(row) == picture_.packed_bytes(picture_.width_px);
      const bool fits = row > 0 && static_cast<std::size_t>(row) >= picture_.packed_bytes(picture_.width_px);
      return fits ? Status(Done{}) : refuse("rows of an unexpected size");
    }
    picture_.tile_width_px = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_TILEWIDTH, 0);
    picture_.tile_height_px = tiff_tag<std::uint32_t>(tiff_, TIFFTAG_TILELENGTH, 0);
    const tmsize_t row = TIFFTileRowSize(tiff_);
    const tmsize_t tile = TIFFTileSize(tiff_);
    if (picture_.tile_width_px < 1 || picture_.tile_height_px < 1 || row <= 0 || tile <= 0 ||
        static_cast<std::size_t>(row) != picture_.packed_bytes(picture_.tile_width_px) ||
        tile / row != picture_.tile_height_px) {
      return refuse("tiles of an unexpected size");
    }
    return check_memory("tiles", static_cast<std::uint64_t>(picture_.tile_width_px * picture_.tile_height_px));
  }

  /// Fails if tiles or rows of that many pixels need too much memory.
  [[nodiscard]] Status check_memory(const char* what, std::uint64_t pixels) const {
    const std::uint64_t held = std::max<std::uint64_t>(4, picture_.samples.pixel_bytes()) * pixels;
    if (held <= kMaxTiffTileBytes) return Done{};
    return Error{
        fmt::format("{}: one of its {} needs {} MiB of memory; save it with smaller ones, or fewer bands "
                    "(gdal_translate -co TILED=YES -b 1 -b 2 -b 3)",
                    reader_.bytes().name(), what, held >> 20)};
  }

  TiffReader& reader_;
  TIFF* tiff_;
  TiffPicture picture_;
};

}  // namespace

std::size_t TiffPicture::packed_bytes(std::int64_t pixels) const {
  const std::size_t bits =
      static_cast<std::size_t>(pixels) * plane_samples() * static_cast<std::size_t>(samples.stored_bits);
  return (bits + 7) / 8;
}

bool make_strip_blocks(TiffPicture& picture) {
  constexpr std::int64_t kLeastRows = 128;
  // Blocks of such a height can be halved four times, so that a picture without overviews gets reduced levels.
  constexpr std::int64_t kHalved = 16;
  constexpr std::int64_t kMostStrips = 1 << 16;
  if (picture.tiled || !picture.even_strips) return false;
  for (const std::int64_t unit : {std::lcm(picture.rows_per_strip, kHalved), picture.rows_per_strip}) {
    const std::int64_t rows = std::min(picture.height_px, unit * ((kLeastRows + unit - 1) / unit));
    if (static_cast<std::uint64_t>(rows) * picture.row_bytes() > kMostStripBlockBytes) continue;
    if (rows / picture.rows_per_strip * static_cast<std::int64_t>(picture.planes()) > kMostStrips) continue;
    picture.tile_width_px = picture.width_px;
    picture.tile_height_px = rows;
    return true;
  }
  return false;
}

Error refuse_tiff(const std::string& name, const std::string& what) {
  return Error{
      fmt::format("{}: it has {}; save it as RGB, gray or palette, samples of 8 or 16 bits "
                  "(gdal_translate -of COG; for heights add -ot Float32)",
                  name, what)};
}

Result<TiffPicture> read_picture(TiffReader& reader) {
  TIFF* tiff = reader.get();
  std::uint16_t photometric = 0;
  std::uint16_t compression = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetField(tiff, TIFFTAG_COMPRESSION, &compression);
  // The sizes of rows and tiles are those of RGB, as when they are decoded.
  if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }
  return PictureTags(reader).read();
}

}  // namespace terrella
