#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/numbers/coding_options.h"
#include "streaming/numbers/number_statistics.h"
#include "streaming/raster/raster_source.h"

namespace terrella {

class RasterFile;

struct RasterOptions {
  bool heights = false;  ///< blocks are numbers: metres = stored value · scale + offset
  /// Default: the file's own (GDAL_NODATA, GDAL_METADATA). With heights, no data becomes NaN; without, transparent.
  std::optional<double> nodata = {};
  std::optional<double> scale = {};
  std::optional<double> offset = {};
  /// With `heights`: blocks have the stored numbers, and RasterInfo::numbers has scale and offset.
  bool stored = false;
  int band = 0;                                 ///< band that holds the numbers, counted from 1; 0: the only one
  std::optional<BandComposite> composite = {};  ///< a picture of three bands, each stretched
  /// For the temporary file of a large picture that is read row by row; empty: the system's folder (TMPDIR).
  std::filesystem::path work_folder = {};
  int jobs = 0;  ///< threads that decode rows; 0: one for each core. Blocks are decoded by the thread that reads them
};

/// Opens a raster of any format that GDAL reads, with its overviews and masks. Tiles are decoded by themselves. Levels
/// in strips are decoded once, when blocks are asked for and then kept. For JPEG, PNG and WebP see streaming/cut.h. The
/// error names the file, the fault and a cure. Blocks. thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> open_raster(const std::filesystem::path& path,
                                                                const CrsPlace& place,
                                                                const RasterOptions& options = {});

/// The same for a raster whose header is read. thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> raster_source(std::shared_ptr<const RasterFile> file,
                                                                  const CrsPlace& place, const RasterOptions& options);

/// An opened raster as a picture whose place is to be found. thread: any
[[nodiscard]] PictureFile as_picture(const std::shared_ptr<const RasterFile>& file);
/// Opens a raster and measures it; reads the header alone. The error names the file, the fault and a cure. Blocks.
/// thread: any
[[nodiscard]] Result<PictureFile> measure_raster(const std::filesystem::path& path);

/// Facts about a raster for a person.
struct RasterFacts {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  int bands = 0;
  std::string samples;                                           ///< "16-bit signed integers"
  std::string layout;                                            ///< "RGB, tiles of 256x256, bands separate, DEFLATE"
  std::vector<std::pair<std::int64_t, std::int64_t>> overviews;  ///< sizes, pixels, the largest first
  bool has_mask = false;
  std::optional<double> nodata = {};
  double scale = 1.0;  ///< value = stored number · scale + offset
  double offset = 0.0;
  std::string unit;
  std::string quantity;  ///< the band's description
  /// Values of a coarse level of the described band; none for palettes, and for colours without a chosen band.
  std::optional<NumberStatistics> statistics = {};
  /// Facts that change what is shown: "values from 1000 to 3520 are shown from black to white (…)".
  std::vector<std::string> notes;
};

/// Choice of the numbers of a raster that are described.
struct DescribedBand {
  int band = 0;                       ///< counted from 1; 0: the only one
  std::optional<double> nodata = {};  ///< instead of the file's
};

/// Describes a raster. `with_values` reads at most 64 blocks or rows of the coarsest level, for the statistics and for
/// notes about them. Blocks. thread: any
[[nodiscard]] Result<RasterFacts> describe_raster(const RasterFile& file, const DescribedBand& wanted,
                                                  bool with_values);

/// True for a raster that is shown as numbers unless the user says otherwise: gray, and not of 8 bits or fewer. thread:
/// any
[[nodiscard]] bool holds_numbers(const RasterFile& file);
/// The same for a file; false for a file that cannot be read. Blocks. thread: any
[[nodiscard]] bool holds_numbers(const std::filesystem::path& path);

}  // namespace terrella
