#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A cut that wants to write an output name, which may be in use.
struct OutputClaim {
  std::filesystem::path output;
  std::vector<std::filesystem::path> images;
  std::string mark;    ///< cut_mark()
  bool force = false;  ///< CutOptions::force
};

/// Decides if the cut may replace `there`, which has, or had a moment ago, the output's name. Follows links.
/// thread: any
/// - May be replaced: nothing, an empty file, an empty folder, an earlier output of `cut` with the same mark, and by
///   force one with another mark.
/// - Must stay: everything else, such as a cache, a picture of this cut, or a GeoPackage or folder with content that
///   `cut` did not write. The error says what `there` is and what to do.
[[nodiscard]] Status may_replace(const OutputClaim& claim, const std::filesystem::path& there);

}  // namespace terrella
