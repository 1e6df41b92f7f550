#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/affine.h"
#include "streaming/numbers/coding_options.h"
#include "streaming/numbers/number_statistics.h"
#include "streaming/raster/raster_source.h"

namespace terrella {

struct TiffPyramid;

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

/// Opens a TIFF or BigTIFF as a raster, with its overviews (in the file, or FILE.ovr) and masks. Tiles are decoded from
/// the file by themselves. Striped pictures are decoded once, when blocks are asked for and then kept. For other
/// picture files see streaming/cut.h. The error names the file, the fault and a cure. Blocks.
/// thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> open_raster(const std::filesystem::path& path,
                                                                const CrsPlace& place,
                                                                const RasterOptions& options = {});

/// Facts about a TIFF for a person.
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

/// Choice of the numbers of a TIFF that are described.
struct DescribedBand {
  int band = 0;                       ///< counted from 1; 0: the only one
  std::optional<double> nodata = {};  ///< instead of the file's
};

/// Describes a pyramid. `with_values` reads at most 64 tiles or rows of the coarsest level, for the statistics and for
/// notes about them. Blocks. thread: any
[[nodiscard]] Result<RasterFacts> describe_raster(const TiffPyramid& pyramid, const DescribedBand& wanted,
                                                  bool with_values);
/// Reads the facts of a file, with its values; none if the file is no TIFF. Blocks. thread: any
[[nodiscard]] Result<std::optional<RasterFacts>> describe_raster(const std::filesystem::path& path,
                                                                 const DescribedBand& wanted = {});

/// True for a TIFF that is shown as numbers unless the user says otherwise: gray, and not of 8 bits or fewer. thread:
/// any
[[nodiscard]] bool holds_numbers(const TiffPyramid& pyramid);
/// The same for a file; false for a file that cannot be read. Blocks. thread: any
[[nodiscard]] bool holds_numbers(const std::filesystem::path& path);

}  // namespace terrella
