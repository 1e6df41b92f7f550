#pragma once

#include <string>
#include <vector>

#include "streaming/mosaic/mosaic_index.h"

namespace terrella {

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
