#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codecs/image.h"
#include "tests/support/scratch_folder.h"
#include "tiles/tile_source.h"

namespace terrella::test {

[[nodiscard]] std::vector<std::byte> bytes_of(std::string_view text);
void write_bytes(const std::filesystem::path& path, const std::vector<std::byte>& bytes);
void write_text(const std::filesystem::path& path, std::string_view text);

/// Smooth colours, which JPEG keeps; alpha 255.
[[nodiscard]] Image gradient(int width_px, int height_px);
/// A 2:1 picture of a whole planet that says where each pixel is: red grows from west to east, green from north to
/// south.
[[nodiscard]] Image place_picture(int width_px);
/// The tile of place_picture() for a place of a grid, as it should be.
[[nodiscard]] Image place_tile(const TileGrid& grid, const TileId& id);

/// The greatest difference of the colours of a tile from those of the places that it covers, in levels of 8 bits.
/// Points near ±180° and the poles, where pictures wrap or end, are left out.
[[nodiscard]] double worst_misplacement(const TileGrid& grid, const TileId& id, const Image& tile);

/// Reads and decodes a tile; an empty picture if there is none.
[[nodiscard]] Image load_tile(TileSource& source, const TileId& id);

/// Runs SQL on a database file that is made if need be; fails the test if the SQL does.
void run_sql(const std::filesystem::path& path, const std::string& sql);
/// Puts a blob as a tile into the table `tiles`.
void insert_tile(const std::filesystem::path& path, std::int64_t zoom, std::int64_t column, std::int64_t row,
                 const std::vector<std::byte>& bytes);

}  // namespace terrella::test
