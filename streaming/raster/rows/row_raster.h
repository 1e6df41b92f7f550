#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "streaming/raster/open_raster.h"
#include "streaming/raster/rows/block_store.h"

namespace terrella {

/// A picture that can only be read row by row from the top.
struct RowPicture {
  std::string name;
  StoredPixels pixels;
  bool is_numbers = false;  ///< rows are floats, NaN for no data; false: RGBA8
  BlockStore::NextRow next_row;
};

/// Makes a raster of a picture without overviews. Reads each row once, when a block needs it (block_store.h). thread:
/// any
[[nodiscard]] std::unique_ptr<RasterSource> make_row_raster(RowPicture picture, const CrsPlace& place,
                                                            const std::filesystem::path& work_folder);

/// Returns a block of a store as a picture or as numbers. The error of a store names its file. thread: any
[[nodiscard]] Result<Image, TileFailure> stored_picture(BlockStore& store, std::int64_t column, std::int64_t row);
[[nodiscard]] Result<Numbers, TileFailure> stored_numbers(BlockStore& store, std::int64_t column, std::int64_t row);

/// True if the raster has the block. thread: any
[[nodiscard]] bool has_block(const RasterInfo& info, const TileId& block);

/// A block whose numbers or colours are made when it is decoded; absent if the raster does not have it. thread: any
[[nodiscard]] Result<EncodedTile, TileFailure> block_tile(const RasterInfo& info, const TileId& block,
                                                          decltype(EncodedTile::make_numbers) numbers,
                                                          decltype(EncodedTile::make_picture) picture);

/// The folder for temporary files: `given`, or the system's if it is empty. thread: any
[[nodiscard]] std::filesystem::path temporary_folder(const std::filesystem::path& given);

}  // namespace terrella
