#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "streaming/mosaic/mosaic_place.h"

namespace terrella {

/// A file of a mosaic with its place.
struct PlacedFile {
  MosaicFile file;
  MosaicPlace place;
  std::uint64_t mark = 0;  ///< hash of path, size, time of change and of what the description says
  double order = 0.0;      ///< MosaicEntry::order
};

/// Corner of a file on a sheet's pixels.
struct SheetPart {
  int file = 0;  ///< index in the mosaic's files
  std::int64_t column = 0, row = 0;
};

/// Files whose pixels lie on one lattice: one raster, through which the filter goes on from file to file.
struct MosaicSheet {
  std::string crs;
  Affine to_crs;  ///< pixels of the lattice to coordinates, pixel-is-area
  std::int64_t width_px = 0, height_px = 0;
  int block_width_px = 256, block_height_px = 256;  ///< a file's size if that is small, so that a block needs few files
  int levels = 1;                ///< the lattice itself, and each with half the pixels of the one before
  std::vector<SheetPart> parts;  ///< the lowest first
};

/// Puts files, the lowest first, onto as few sheets as keep that order; sheets are the lowest first. A file joins a
/// sheet if its pixels lie on the lattice within 0.02 pixels, and no file of a higher sheet lies under it. Pure.
/// thread: any
[[nodiscard]] std::vector<MosaicSheet> make_sheets(const std::vector<PlacedFile>& files);

/// Sorts files by their order, then the coarsest first, so that the finest lie on top; files of one order and one
/// resolution within 5 % stay as given. Pure. thread: any
void sort_files(std::vector<PlacedFile>& files);

}  // namespace terrella
