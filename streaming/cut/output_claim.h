#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A cut that wants a name for its output, which may be taken.
struct OutputClaim {
  std::filesystem::path output;
  std::vector<std::filesystem::path> images;
  std::string mark;    ///< cut_mark()
  bool force = false;  ///< CutOptions::force
};

/// Decides if the claim may replace what lies at `there`: under the output's name, or a moment ago. Nothing, an empty
/// file and an empty folder may be replaced; so may an earlier output of `cut` with the same mark, or, by force, with
/// another one. Everything else stays: a cache, a GeoPackage or folder with anything that `cut` did not write, a
/// picture of this cut. The error says what lies there and what to do. Follows links. thread: any
[[nodiscard]] Status may_replace(const OutputClaim& claim, const std::filesystem::path& there);

}  // namespace terrella
