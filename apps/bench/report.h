#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace terrella::bench {

/// A column of a table. `name` is a word as a program reads it, for example "rms_pole"; `unit` is for people ("8-bit
/// levels", "ms"; empty: none).
struct Column {
  std::string name;
  std::string unit;
  int decimals = 2;  ///< of printed numbers, negative: three digits; the CSV and the JSON have them in full
};

/// A NaN is a figure that there is not: an empty field, JSON's null.
using Cell = std::variant<std::string, std::int64_t, double>;
inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// A figure that is held to a bound, or, without one, that a reader should not have to look for in the table.
struct Finding {
  std::string what;
  double value = 0.0;
  double limit = kNoFigure;  ///< the value should be at most this; NaN: no bound
  std::string unit = {};
  [[nodiscard]] bool holds() const { return !(value > limit); }
};

/// Rows whose text in a column is one of these.
struct RowFilter {
  std::string column;
  std::vector<std::string> values;
};

/// One curve a distinct value of `series`; rows without a number in x or y are left out.
struct Plot {
  std::string title;
  std::string x, y, series;  ///< names of columns; `series` may be empty: one curve
  bool log_x = false, log_y = false;
  std::vector<RowFilter> only = {};  ///< rows that pass all of them
  bool lines = true;                 ///< false: points alone
};

/// What a benchmark has measured.
struct Report {
  std::string name;  ///< "polar": the files' names start with it
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< what it was measured on: renderer, picture, grid …
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows = {};  ///< a cell a column each
  std::vector<Finding> findings = {};
  std::vector<Plot> plots = {};  ///< in one picture, two side by side; at least one
  bool failed = false;           ///< a self-test that is not passed: exit code 1

  [[nodiscard]] std::size_t column(const std::string& column_name) const;  ///< its index; misuse if there is none
};

/// A table for people: facts, columns with units under their names, rows, findings.
[[nodiscard]] std::string as_text(const Report& report);
/// RFC 4180: one header line of column names, then the rows; numbers in the shortest form that reads back the same.
[[nodiscard]] std::string as_csv(const Report& report);
/// {"bench", "title", "facts": {…}, "columns": [{"name", "unit"}], "rows": [{column: value}], "findings": [{"what",
/// "value", "limit", "unit", "holds"}], "failed"}
[[nodiscard]] std::string as_json(const Report& report);

}  // namespace terrella::bench
