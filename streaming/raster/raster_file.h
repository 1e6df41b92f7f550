#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/byte_file.h"
#include "streaming/raster/raster_samples.h"

namespace terrella {

/// Longest side of a raster, pixels.
inline constexpr std::int64_t kMaxRasterSide_px = 1 << 20;
/// Most memory for the samples of a block, bytes. A raster with larger blocks is refused with advice.
inline constexpr std::uint64_t kMaxBlockBytes = 64ULL << 20;
/// Most memory for a block of strips (RasterFile::in_strip_blocks()), bytes.
inline constexpr std::uint64_t kMostStripBlockBytes = 4ULL << 20;
/// The same for a strip, which is decoded as a whole.
inline constexpr std::uint64_t kMaxStripBytes = 1ULL << 30;

/// Meaning of a band in a pixel.
enum class BandColour { none, gray, palette, red, green, blue, alpha, other };

/// One band of a raster: value = number · scale + offset.
struct RasterBand {
  SampleType type = SampleType::uint8;
  int stored_bits = 8;  ///< bits of a sample in the file
  BandColour colour = BandColour::none;
  bool premultiplied = false;  ///< alpha by which the colours are multiplied
  std::optional<double> nodata = {};
  double scale = 1.0;
  double offset = 0.0;
  std::string unit = {};
  std::string description = {};
  std::optional<double> least = {}, most = {};  ///< stated statistics
};

/// Size of one level, and of the blocks that can be read by themselves.
struct RasterShape {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::int64_t block_width_px = 0;   ///< 0: the level is read by rows
  std::int64_t block_height_px = 0;  ///< 0: the level is read by rows
  std::int64_t rows_per_strip = 1;   ///< rows that are decoded together, of a level without tiles
  bool tiled = false;
  [[nodiscard]] bool has_blocks() const { return block_width_px > 0; }
};

/// A raster file as its header describes it. All facts are read once, when the file is opened.
struct RasterHeader {
  std::string name;                 ///< for messages: a path, a redacted address, or the name of a sub-dataset
  std::string driver;               ///< GDAL's name of the format: "GTiff"
  std::vector<RasterShape> levels;  ///< the coarsest first; the last is the raster itself
  std::vector<RasterBand> bands;    ///< at least one
  std::vector<std::array<std::uint8_t, 4>> palette;  ///< colours of the first band's indices
  bool has_mask = false;                             ///< pixels are hidden by a mask of their own
  bool inverted = false;                             ///< gray whose 0 is white
  bool separate = false;                             ///< each band has blocks of its own
  bool is_compressed = false;
  bool is_local_tiff = false;        ///< its place is read from its tags: files beside it make claims of their own
  std::string layout;                ///< "RGB, tiles of 256x256, bands separate, DEFLATE"
  std::optional<Georeference> said;  ///< statement about the place; none: there is none
  std::vector<std::string> remarks;  ///< for the user
  [[nodiscard]] const RasterShape& whole() const { return levels.back(); }
};

/// A rectangle of pixels in a level.
struct PixelWindow {
  std::size_t level = 0;
  std::int64_t x = 0, y = 0;
  std::int64_t width_px = 0, height_px = 0;
};

/// Place of compressed bytes in a file.
struct ByteSpan {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

class DatasetPool;

/// A raster file that GDAL reads, in any format. Each thread that reads has a dataset of its own; a file keeps those
/// that were busy at once, up to a limit. thread: any, several at once
class RasterFile {
 public:
  /// Opens a file, or a sub-dataset by GDAL's name of it (NETCDF:"FILE":NAME). Rasters that state control points or a
  /// camera model instead of a place are resampled by GDAL as they are read. The error names the file, the fault and a
  /// cure. Blocks.
  [[nodiscard]] static Result<std::shared_ptr<const RasterFile>> open(const std::string& name);
  /// Opens a file by its bytes. No files beside it count.
  [[nodiscard]] static Result<std::shared_ptr<const RasterFile>> open(std::shared_ptr<const ByteFile> bytes);
  /// For open() and its like.
  RasterFile(std::shared_ptr<DatasetPool> pool, RasterHeader header, std::vector<int> overviews)
      : pool_(std::move(pool)), header_(std::move(header)), overviews_(std::move(overviews)) {}

  [[nodiscard]] const RasterHeader& header() const { return header_; }
  [[nodiscard]] const std::string& name() const { return header_.name; }
  /// The same raster, read from other bytes of the same file. Opens nothing yet.
  [[nodiscard]] std::shared_ptr<const RasterFile> over(std::shared_ptr<const ByteFile> bytes) const;
  /// The same raster whose levels in small strips are read by blocks of strips. Levels in larger strips, other than the
  /// raster itself, are left out.
  [[nodiscard]] std::shared_ptr<const RasterFile> in_strip_blocks() const;

  /// Reads samples of the given bands, counted from 0, those of a pixel together, as `type` of this machine.
  /// `row_bytes`: distance of two rows in `samples`; 0: they follow each other. Parts that the file does not store have
  /// the no-data value, or 0. The window lies inside the level. The error does not name the file.
  [[nodiscard]] Status read(const PixelWindow& window, std::span<const std::size_t> bands, SampleType type,
                            std::uint8_t* samples, std::size_t row_bytes = 0) const;
  /// Reads the mask: 0 for hidden … 255 for shown. The raster has one.
  [[nodiscard]] Status read_mask(const PixelWindow& window, std::uint8_t* shown) const;
  /// Looks up the bytes from which the pixels of a window in blocks are decoded, the mask's included. Parts that the
  /// file does not store are left out. Only a TIFF knows them. The error does not name the file.
  [[nodiscard]] Result<std::vector<ByteSpan>> spans(const PixelWindow& window,
                                                    std::span<const std::size_t> bands) const;
  /// Decodes one of the spans() of a window. No error for a span of another window. The error does not name the file.
  [[nodiscard]] Status check(const PixelWindow& window, std::span<const std::size_t> bands, const ByteSpan& span) const;

 private:
  const std::shared_ptr<DatasetPool> pool_;
  const RasterHeader header_;
  const std::vector<int> overviews_;  ///< GDAL's index of each level; -1: the raster itself
};

}  // namespace terrella
