#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/mosaic/mosaic_list.h"

namespace terrella {

/// A picture of any projection, resampled to the pixels of a grid from (-180°, 90°).
struct WarpedInput {
  std::unique_ptr<RowReader> rows;  ///< with `heights`, in units of the tiles' numbers
  GeoRect bounds{};
  LatitudeKind latitude = LatitudeKind::graphic;
  std::shared_ptr<const std::atomic<int>> left_out{};  ///< files that could not be read so far; null: none
};

/// Opens a picture by `place.from`. Reads no pixels, except for the values that a TIFF shows as black and white.
/// thread: any
[[nodiscard]] Result<WarpedInput> open_warped(const CutOptions& options, const PictureFile& picture,
                                              const PicturePlace& place, const std::optional<HeightPlan>& heights);

/// Opens a folder, a list or a description of rasters (streaming/mosaic), or the options' pictures as such a list.
/// Reads no pixels. `remarks` receives the reason for each file that is left out. thread: any
[[nodiscard]] Result<WarpedInput> open_many(const CutOptions& options, const std::optional<HeightPlan>& heights,
                                            std::vector<std::string>& remarks);

/// The files that open_many() reads. thread: any
[[nodiscard]] Result<MosaicList> list_of(const CutOptions& options);

}  // namespace terrella
