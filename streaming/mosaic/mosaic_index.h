#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/mosaic/mosaic_list.h"
#include "streaming/mosaic/mosaic_sheet.h"
#include "streaming/mosaic/mosaic_store.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Pixels of the files as colours or as numbers.
enum class MosaicPixels {
  as_stored,  ///< numbers if the files have one band of other than 8 bits, else colours
  colours,
  heights  ///< numbers, in metres
};

struct MosaicIndexOptions {
  MosaicPixels pixels = MosaicPixels::as_stored;
  MosaicFigure figure{};
  MosaicReading reading{};
  int jobs = 0;  ///< threads that read headers; 0: one for each core
};

/// Footprints of a mosaic's files, read from their headers alone.
struct MosaicIndex {
  std::vector<PlacedFile> files;    ///< the lowest first
  std::vector<MosaicSheet> sheets;  ///< the lowest first
  std::vector<int> sheet_of;        ///< index in `sheets` for each file
  bool numbers = false;
  LatitudeKind latitude = LatitudeKind::graphic;
  std::vector<std::string> left_out;  ///< reasons, each with the file's name
  int headers_read = 0;               ///< files that were opened; the others' headers were in the store

  /// The files that overlap a box, the lowest first. A scan: 4,000 boxes take 20 µs, less than a hundredth of what a
  /// tile takes, so there is no tree.
  [[nodiscard]] std::vector<int> files_in(const MosaicBox& box) const;
};

/// Reads the headers that are new or changed since the store kept them, and arranges the files. Files that cannot be
/// read are left out. Fails if no file can be read. Also fails if some are pictures and others numbers: the error names
/// one of each. `store` may be null. Blocks. thread: any
[[nodiscard]] Result<MosaicIndex> index_mosaic(const MosaicList& list, const std::string& where,
                                               const MosaicIndexOptions& options, MosaicStore* store);

/// The area of all files: the smallest range of longitudes that has them. Pure. thread: any
[[nodiscard]] MosaicBox area_of(const std::vector<PlacedFile>& files);

/// Facts about a mosaic for a person.
struct MosaicFacts {
  int files = 0;                       ///< files that are shown
  int left_out = 0;                    ///< files that could not be read, so far
  int headers_read = 0;                ///< files whose headers were not in the store
  int sheets = 0;                      ///< groups of files with pixels on one lattice
  std::vector<std::string> systems{};  ///< coordinate systems of the files, for Crs::open(), each once
  MosaicBox area{};                    ///< box around all files
  double finest_m = 0.0;               ///< side of the smallest pixel on the ground, metres
  double coarsest_m = 0.0;             ///< side of the largest pixel on the ground, metres
  double pixels = 0.0;                 ///< pixels of all files
  bool numbers = false;                ///< shown as numbers
  std::string unit{};                  ///< unit of the numbers as stored; empty: unknown
  std::vector<double> nodata{};        ///< values that mean no data, each once
  int without_nodata = 0;              ///< files of numbers that state no such value
};

/// The facts that the headers tell. Pure. thread: any
[[nodiscard]] MosaicFacts facts_of(const MosaicIndex& index);

}  // namespace terrella
