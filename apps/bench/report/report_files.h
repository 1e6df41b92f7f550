#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/report/report.h"
#include "base/result.h"

namespace terrella::bench {

/// Written files, and a remark for the user.
struct ReportFiles {
  std::vector<std::filesystem::path> written;
  std::string remark;  ///< explains a missing picture and the remedy; empty if the picture was drawn
};

/// Creates a folder for reports if needed.
[[nodiscard]] Status make_folder(const std::filesystem::path& folder);

/// Writes NAME.csv, NAME.json and NAME.gnuplot into a folder. Runs the program `gnuplot`, if installed, to draw
/// NAME.png.
[[nodiscard]] Result<ReportFiles> write_report(const Report& report, const std::filesystem::path& folder);

/// Draws NAME.svg into a folder with gnuplot, and returns its text; empty if it could not be drawn.
[[nodiscard]] std::string draw_svg(const Report& report, const std::filesystem::path& folder);

}  // namespace terrella::bench
