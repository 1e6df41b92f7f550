#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "codecs/image.h"
#include "tests/support/scratch_folder.h"
#include "tiles/tile_source.h"

/// Pictures, files and tile sets that the cutter's tests share.
namespace terrella::test {

/// Noise of a fixed seed: neighbours differ as much as they can, so that a wrong weight shows. Alpha too if asked.
[[nodiscard]] Image noise(int width_px, int height_px, bool with_alpha = false);
/// A picture by a function of column, row and channel.
[[nodiscard]] Image painted(int width_px, int height_px, const std::function<int(int, int, int)>& value);

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);
void write_png(const std::filesystem::path& path, const Image& image);
void write_interlaced_png(const std::filesystem::path& path, const Image& image);
/// 16 bits a sample, 257 times the 8-bit ones.
void write_deep_png(const std::filesystem::path& path, const Image& image);
void write_jpeg(const std::filesystem::path& path, const Image& image, bool progressive = false);

/// All rows of a picture by the cutter's reader.
[[nodiscard]] Result<Image> read_all_rows(const std::filesystem::path& path);
/// A tile's pixels; a failure of the test, and an empty picture, if there are none.
[[nodiscard]] Image read_tile(TileSource& source, const TileId& id);
/// The pixels of a whole level, from the grid's origin, tiles that do not exist left 0.
[[nodiscard]] Image read_level(TileSource& source, int level);

}  // namespace terrella::test
