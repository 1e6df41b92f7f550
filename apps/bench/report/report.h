#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace terrella::bench {

/// A column of a table. `name` is for programs, for example "rms_pole". `unit` is for people, for example "8-bit
/// levels" or "ms"; empty: none.
struct Column {
  std::string name;
  std::string unit;
  int decimals = 2;  ///< decimals of printed numbers; negative: three digits. CSV and JSON have full precision
};

/// NaN means a missing figure: an empty field, or null in JSON.
using Cell = std::variant<std::string, std::int64_t, double>;
inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// A figure with a limit, or a figure that readers should see without searching the table.
struct Finding {
  std::string what;
  double value = 0.0;
  double limit = kNoFigure;  ///< greatest allowed value; NaN: no limit
  std::string unit = {};
  [[nodiscard]] bool holds() const { return !(value > limit); }
};

/// Selects rows whose text in a column is one of these values.
struct RowFilter {
  std::string column;
  std::vector<std::string> values;
};

/// One curve per distinct value of `series`; rows without a number in x or y are skipped.
struct Plot {
  std::string title;
  std::string x, y, series;  ///< names of columns; `series` may be empty: one curve
  bool log_x = false, log_y = false;
  std::vector<RowFilter> only = {};  ///< rows that pass all of these filters
  bool lines = true;                 ///< false: points only
};

/// Results of a benchmark.
struct Report {
  std::string name;  ///< first part of the files' names, for example "polar"
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< conditions of the measurement: renderer, picture, grid …
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows = {};  ///< one cell per column
  std::vector<Finding> findings = {};
  std::vector<Plot> plots = {};  ///< drawn into one picture, two side by side; at least one
  bool failed = false;           ///< a failed self-test: exit code 1

  [[nodiscard]] std::size_t column(
      const std::string& column_name) const;  ///< the column's index; misuse if no column has the name
};

/// Formats a figure for people, with the column's decimals; a missing one is empty.
[[nodiscard]] std::string printed(const Cell& cell, const Column& column);
/// Formats a table for people: facts, columns with units under their names, rows, findings.
[[nodiscard]] std::string as_text(const Report& report);
/// Formats RFC 4180 CSV: a header line of column names, then the rows. Numbers have the shortest form that reads back
/// the same.
[[nodiscard]] std::string as_csv(const Report& report);
/// Formats {"bench", "title", "facts": {…}, "columns": [{"name", "unit"}], "rows": [{column: value}], "findings":
/// [{"what", "value", "limit", "unit", "holds"}], "failed"}
[[nodiscard]] std::string as_json(const Report& report);

}  // namespace terrella::bench
