#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/height_samples.h"
#include "streaming/cut/input/row_reader.h"

namespace terrella {

struct HeightPlan {
  HeightCoding coding;
  ElevationInfo elevation;  ///< what the tiles' numbers mean
};

/// How the pictures' heights are kept in tiles. Reads all their pixels once if they are 32-bit floats and the options
/// do not say. All pictures have one kind of sample. thread: any
[[nodiscard]] Result<HeightPlan> plan_heights(const std::vector<std::filesystem::path>& images,
                                              const CutElevation& options);

/// Whether a picture of these sides is a whole planet by nodes: columns from -180° on and rows from pole to pole, both
/// included.
[[nodiscard]] bool is_node_planet(std::int64_t width, std::int64_t height);

/// The pixels between the nodes of such a planet: each the mean of its four corners that are known, one row less.
[[nodiscard]] std::unique_ptr<RowReader> between_nodes(std::unique_ptr<RowReader> nodes);

}  // namespace terrella
