#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/report/report.h"
#include "base/result.h"

namespace terrella::bench {

/// A benchmark on a page: its report, or the reason why there is none.
struct PageEntry {
  Report report;
  std::string failure = {};  ///< empty: the report is complete
  std::string svg = {};      ///< the plots; empty: no gnuplot
};

/// The machine: processor, cores, system, version of the program, time of the run.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> machine_facts();

/// Formats one HTML page, complete in itself: the machine, then findings, plots and table of each benchmark.
[[nodiscard]] std::string as_page(const std::vector<std::pair<std::string, std::string>>& machine,
                                  const std::vector<PageEntry>& entries);

}  // namespace terrella::bench
