#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/report.h"
#include "base/result.h"

namespace terrella::bench {

/// What was written, and what to say about it.
struct ReportFiles {
  std::vector<std::filesystem::path> written;
  std::string remark;  ///< why there is no picture, and what to do; empty: there is one
};

/// Makes a folder for reports, if it is not there.
[[nodiscard]] Status make_folder(const std::filesystem::path& folder);

/// Writes NAME.csv, NAME.json and NAME.gnuplot into a folder, and lets the program `gnuplot` draw
/// NAME.png if there is one.
[[nodiscard]] Result<ReportFiles> write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace terrella::bench
