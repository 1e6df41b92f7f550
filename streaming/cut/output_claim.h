#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A cut or a conversion that wants to write an output name, which may be in use.
struct OutputClaim {
  std::filesystem::path output;
  std::vector<std::filesystem::path> images;  ///< inputs: pictures of a cut, the set of a conversion
  std::string mark;                           ///< cut_mark(), or the mark that all conversions share
  bool force = false;                         ///< CutOptions::force or ConvertOptions::force
};

/// Decides if the claim may replace `there`, which has, or had a moment ago, the output's name. Follows links.
/// thread: any
/// - May be replaced: nothing, an empty file, an empty folder, an earlier output with the same mark, and by force one
///   with another mark.
/// - Must stay: everything else, such as a cache, an input of this claim, or a file or folder with content that
///   neither `cut` nor `convert` wrote. The error says what `there` is and what to do.
[[nodiscard]] Status may_replace(const OutputClaim& claim, const std::filesystem::path& there);

}  // namespace terrella
