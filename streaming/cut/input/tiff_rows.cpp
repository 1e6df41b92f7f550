#include <tiffio.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "streaming/cut/input/row_formats.h"
#include "streaming/cut/input/tiff_samples.h"
#include "streaming/tiff_open.h"

namespace terrella {
namespace {

/// Most memory for a row of tiles, bytes. If a whole row needs more, only a part of its pixel rows is held at a time.
/// The tiles are then decoded again for each part, down to the part's last row. 86400 pixels of RGB with tiles of 256
/// rows fit.
constexpr std::uint64_t kTileRowBytes = 64ULL << 20;

template <class T>
T tag_or(TIFF* tiff, ttag_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

class TiffRows : public RowReader {
 public:
  TiffRows(std::string name, const std::optional<HeightCoding>& heights) : name_(std::move(name)), heights_(heights) {}

  [[nodiscard]] Status open() {
    tiff_ = open_tiff(name_, message_);
    if (!tiff_) return Error{fmt::format("{}: is not a TIFF that can be read: {}", name_, message_)};
    info_.width_px = tag_or<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0);
    info_.height_px = tag_or<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0);
    if (Status fits = check_picture_size(name_, info_.width_px, info_.height_px); !fits) return fits;
    if (Status can = heights_ ? read_height_samples() : read_samples(); !can) return can;
    info_.has_alpha = samples_.alpha != TiffAlpha::none;
    return TIFFIsTiled(tiff_.get()) != 0 ? open_tiles() : open_strips();
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    const std::uint8_t* row = tile_height_ > 0 ? row_of_tiles() : row_of_strip();
    if (row == nullptr) return row_error(name_, row_, info_.height_px, message_);
    const auto pixels = static_cast<std::size_t>(info_.width_px);
    if (heights_) {
      to_numbers(*heights_, row, samples_.pixel_bytes(), pixels, rgba.data());
    } else {
      to_rgba(samples_, row, pixels, rgba.data());
    }
    ++row_;
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    row_ += rows;
    return Done{};
  }

 private:
  [[nodiscard]] Error refuse(const std::string& what) const {
    return Error{
        fmt::format("{}: {}; save it as 8-bit or 16-bit RGB, gray or palette, samples of a pixel together "
                    "(gdal_translate -of GTiff -co INTERLEAVE=PIXEL)",
                    name_, what)};
  }

  /// The kind of sample was checked before (probe_heights()).
  [[nodiscard]] Status read_height_samples() {
    samples_.bits = heights_->kind == HeightKind::float32 ? 32 : 16;
    samples_.per_pixel = tag_or<std::uint16_t>(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto bits = tag_or<std::uint16_t>(tiff_.get(), TIFFTAG_BITSPERSAMPLE, 1);
    if (samples_.bits == bits && samples_.per_pixel == 1) return Done{};
    return refuse_heights(name_);
  }

  [[nodiscard]] Status read_samples() {
    TIFF* tiff = tiff_.get();
    samples_.bits = tag_or<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
    samples_.per_pixel = tag_or<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto kind = tag_or<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const auto planes = tag_or<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    if (samples_.bits != 8 && samples_.bits != 16) return refuse(fmt::format("{} bits a sample", samples_.bits));
    if (kind != SAMPLEFORMAT_UINT && kind != SAMPLEFORMAT_VOID) return refuse("samples that are no unsigned integers");
    if (planes != PLANARCONFIG_CONTIG && samples_.per_pixel > 1) return refuse("each colour in a plane of its own");
    if (Status known = read_colour(); !known) return known;
    if (samples_.per_pixel < samples_.colours()) return refuse("fewer samples a pixel than its colours need");
    read_alpha();
    return Done{};
  }

  [[nodiscard]] Status read_colour() {
    switch (tag_or<std::uint16_t>(tiff_.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK)) {
      case PHOTOMETRIC_MINISBLACK:
        samples_.colour = TiffColour::gray;
        return Done{};
      case PHOTOMETRIC_MINISWHITE:
        samples_.colour = TiffColour::gray_inverted;
        return Done{};
      case PHOTOMETRIC_RGB:
        samples_.colour = TiffColour::rgb;
        return Done{};
      case PHOTOMETRIC_PALETTE:
        samples_.colour = TiffColour::palette;
        return read_palette();
      case PHOTOMETRIC_YCBCR:
        samples_.colour = TiffColour::rgb;
        if (tag_or<std::uint16_t>(tiff_.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_JPEG) break;
        // libtiff then makes libjpeg return RGB.
        TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        return Done{};
      default:
        break;
    }
    return refuse("a colour space that is not supported");
  }

  [[nodiscard]] Status read_palette() {
    std::array<std::uint16_t*, 3> maps{};
    if (TIFFGetField(tiff_.get(), TIFFTAG_COLORMAP, &maps[0], &maps[1], &maps[2]) != 1) return refuse("no palette");
    samples_.palette.resize(std::size_t{1} << samples_.bits);
    for (std::size_t i = 0; i < samples_.palette.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        samples_.palette[i][c] = static_cast<std::uint8_t>((maps[c][i] + 128U) / 257U);
      }
    }
    return Done{};
  }

  /// Extra samples without a stated kind do not count as alpha, as in GDAL.
  void read_alpha() {
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    if (samples_.per_pixel == samples_.colours()) return;
    if (TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || count == 0) return;
    if (kinds[0] == EXTRASAMPLE_UNASSALPHA) samples_.alpha = TiffAlpha::straight;
    if (kinds[0] == EXTRASAMPLE_ASSOCALPHA) samples_.alpha = TiffAlpha::premultiplied;
  }

  [[nodiscard]] std::size_t row_bytes() const {
    return static_cast<std::size_t>(info_.width_px) * samples_.pixel_bytes();
  }

  [[nodiscard]] Status open_strips() {
    const tmsize_t said = TIFFScanlineSize(tiff_.get());
    if (said <= 0 || static_cast<std::size_t>(said) < row_bytes()) return refuse("rows of an unexpected size");
    held_.resize(static_cast<std::size_t>(said));
    return Done{};
  }

  [[nodiscard]] Status open_tiles() {
    const auto width = tag_or<std::uint32_t>(tiff_.get(), TIFFTAG_TILEWIDTH, 0);
    const auto height = tag_or<std::uint32_t>(tiff_.get(), TIFFTAG_TILELENGTH, 0);
    const tmsize_t tile_bytes = TIFFTileSize(tiff_.get());
    const std::uint64_t needed = std::uint64_t{width} * height * samples_.pixel_bytes();
    if (width == 0 || height == 0 || tile_bytes <= 0 || static_cast<std::uint64_t>(tile_bytes) < needed) {
      return refuse("tiles of an unexpected size");
    }
    if (static_cast<std::uint64_t>(tile_bytes) > kMaxHeldBytes) {
      return Error{
          fmt::format("{}: one of its tiles needs {} MiB of memory; save it with smaller ones "
                      "(gdal_translate -co TILED=YES)",
                      name_, static_cast<std::uint64_t>(tile_bytes) >> 20)};
    }
    tile_width_ = width;
    tile_height_ = height;
    tile_.resize(static_cast<std::size_t>(tile_bytes));
    hold_part_of_tiles();
    return Done{};
  }

  /// Divides a row of tiles into as few parts of equal height as possible.
  void hold_part_of_tiles() {
    const std::int64_t rows = std::min(tile_height_, info_.height_px);
    const auto fit = std::max<std::int64_t>(1, static_cast<std::int64_t>(kTileRowBytes / row_bytes()));
    const std::int64_t parts = (rows + fit - 1) / fit;
    held_rows_ = (rows + parts - 1) / parts;
    held_.resize(row_bytes() * static_cast<std::size_t>(held_rows_));
  }

  const std::uint8_t* row_of_strip() {
    return TIFFReadScanline(tiff_.get(), held_.data(), static_cast<std::uint32_t>(row_)) == 1 ? held_.data() : nullptr;
  }

  const std::uint8_t* row_of_tiles() {
    const std::int64_t tile_top = row_ - row_ % tile_height_;
    const std::int64_t first = row_ - (row_ - tile_top) % held_rows_;
    if (first != held_first_ && !read_tiles(tile_top, first)) return nullptr;
    held_first_ = first;
    return held_.data() + static_cast<std::size_t>(row_ - first) * row_bytes();
  }

  /// Reads the rows held at a time, from `first_row` on, of the tiles at `tile_top`.
  bool read_tiles(std::int64_t tile_top, std::int64_t first_row) {
    const auto y = static_cast<std::uint32_t>(tile_top);
    const auto above = static_cast<std::size_t>(first_row - tile_top);
    const auto rows = static_cast<std::size_t>(
        std::min({first_row + held_rows_, tile_top + tile_height_, info_.height_px}) - first_row);
    for (std::int64_t x = 0; x < info_.width_px; x += tile_width_) {
      if (!decode_tile(static_cast<std::uint32_t>(x), y, above + rows)) return false;
      const auto columns = static_cast<std::size_t>(std::min(tile_width_, info_.width_px - x));
      for (std::size_t row = 0; row < rows; ++row) {
        std::copy_n(tile_.data() + (above + row) * tile_row_bytes(), columns * samples_.pixel_bytes(),
                    held_.data() + row * row_bytes() + static_cast<std::size_t>(x) * samples_.pixel_bytes());
      }
    }
    return true;
  }

  /// Decodes the first `rows` rows of a tile into tile_.
  bool decode_tile(std::uint32_t x, std::uint32_t y, std::size_t rows) {
    const std::uint32_t tile = TIFFComputeTile(tiff_.get(), x, y, 0, 0);
    const auto bytes = static_cast<tmsize_t>(rows * tile_row_bytes());
    return TIFFReadEncodedTile(tiff_.get(), tile, tile_.data(), bytes) == bytes;
  }

  [[nodiscard]] std::size_t tile_row_bytes() const {
    return static_cast<std::size_t>(tile_width_) * samples_.pixel_bytes();
  }

  std::string name_;
  std::string message_ = "the data ends too early";
  PictureInfo info_;
  TiffSamples samples_;
  std::int64_t row_ = 0;
  std::int64_t held_first_ = -1;  ///< first row of tiles that is held
  std::int64_t tile_width_ = 0;
  std::int64_t tile_height_ = 0;  ///< 0: strips
  std::int64_t held_rows_ = 0;    ///< rows of a row of tiles held at a time
  std::vector<std::uint8_t> tile_;
  std::vector<std::uint8_t> held_;  ///< samples of one row, or of a part of a row of tiles
  std::optional<HeightCoding> heights_;
  TiffHandle tiff_;
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_tiff_rows(const std::string& name, const std::optional<HeightCoding>& heights) {
  auto rows = std::make_unique<TiffRows>(name, heights);
  if (Status opened = rows->open(); !opened) return opened.error();
  return std::unique_ptr<RowReader>(std::move(rows));
}

}  // namespace terrella
