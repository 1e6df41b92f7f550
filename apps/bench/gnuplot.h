#pragma once

#include <filesystem>
#include <string>

#include "apps/bench/report.h"

namespace terrella::bench {

/// A script that draws the report's plots side by side into `picture`, a PNG beside it. The data are in the script.
[[nodiscard]] std::string gnuplot_script(const Report& report, const std::string& picture);

enum class Drawn { yes, no_gnuplot, failed };
/// Runs `gnuplot SCRIPT` in the script's folder.
[[nodiscard]] Drawn run_gnuplot(const std::filesystem::path& script);

}  // namespace terrella::bench
