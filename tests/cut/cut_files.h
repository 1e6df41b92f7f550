#pragma once

#include <filesystem>
#include <map>

#include "picture_files.h"
#include "streaming/cut.h"

namespace terrella::test {

/// Columns [x0, x0 + width) and rows [y0, y0 + height) of a picture.
[[nodiscard]] Image part_of(const Image& image, int x0, int y0, int width, int height);

/// Every tile of a set, as stored.
[[nodiscard]] std::map<TileId, std::vector<std::byte>> all_tiles(const std::filesystem::path& tile_set);

/// Cuts; a failure of the test if that fails.
bool must_cut(const CutOptions& options);

/// Expects a cut to fail with a message that holds all parts.
void expect_refused(const CutOptions& options, const std::vector<std::string>& parts);

}  // namespace terrella::test
