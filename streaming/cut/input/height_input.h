#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/height_samples.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

struct HeightPictures {
  std::vector<std::filesystem::path> images;
  std::shared_ptr<const RasterFile> remote = {};  ///< the one picture that is no file (CutRaster)
  /// The images are one layer: plan_numbers() leaves out those that cannot be read, and if they differ in kind, scale
  /// or no data, all become floats.
  bool many = false;
};

struct HeightPlan {
  HeightCoding coding;
  NumberInfo numbers;  ///< meaning of the numbers in tiles
};

/// Chooses how tiles store the heights of the pictures. Reads all pixels once if the samples are 32-bit floats and the
/// options do not give the coding. All pictures must have the same kind of sample. thread: any
[[nodiscard]] Result<HeightPlan> plan_heights(const HeightPictures& pictures, const CutElevation& options, int jobs);

/// Chooses how tiles keep the numbers of a band: whole numbers of at most 16 bits as they are, with the metadata's
/// scale and offset; others as 32-bit floats with both applied. Numbers of 16 bits without nodata, of which
/// `may_have_gaps` leaves places without data, become floats too. thread: any
[[nodiscard]] Result<HeightPlan> plan_numbers(const HeightPictures& pictures, const CutNumbers& options,
                                              bool may_have_gaps);

/// Options for reading a picture's heights in metres as a raster. thread: any
[[nodiscard]] RasterOptions raster_of(const HeightPlan& plan);

/// True if a picture of this size is a whole planet sampled at nodes: columns from -180° on, rows from pole to pole,
/// both poles included.
[[nodiscard]] bool is_node_planet(std::int64_t width, std::int64_t height);

/// Converts node samples to pixels between the nodes, with one row less. Each pixel is the mean of its known corners
/// (at most four).
[[nodiscard]] std::unique_ptr<RowReader> between_nodes(std::unique_ptr<RowReader> nodes);

}  // namespace terrella
