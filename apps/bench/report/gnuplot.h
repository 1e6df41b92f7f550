#pragma once

#include <filesystem>
#include <string>

#include "apps/bench/report/report.h"

namespace terrella::bench {

/// Returns a script that draws the report's plots side by side into `picture`, a PNG or, if the name ends in .svg, an
/// SVG beside the script. The script contains the data.
[[nodiscard]] std::string gnuplot_script(const Report& report, const std::string& picture);

enum class Drawn { yes, no_gnuplot, failed };
/// Runs `gnuplot SCRIPT` in the script's folder.
[[nodiscard]] Drawn run_gnuplot(const std::filesystem::path& script);

}  // namespace terrella::bench
