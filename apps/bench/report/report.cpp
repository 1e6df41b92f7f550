#include "apps/bench/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

namespace terrella::bench {
namespace {

bool is_number(const Cell& cell) { return !std::holds_alternative<std::string>(cell); }

std::string csv_field(const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&cell)) return std::isnan(*number) ? "" : fmt::format("{}", *number);
  const std::string& text = std::get<std::string>(cell);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

nlohmann::ordered_json json_value(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return *whole;
  return std::get<double>(cell);  // NaN becomes null
}

/// Width of a text in characters; "µs" has three bytes.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, letters(text)), ' ');
  return right ? space + text : text + space;
}

std::string line_of(const std::vector<std::string>& fields, const std::vector<std::size_t>& widths,
                    const std::vector<bool>& right) {
  std::string line;
  for (std::size_t k = 0; k < fields.size(); ++k) line += (k == 0 ? "" : "  ") + padded(fields[k], widths[k], right[k]);
  return line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
}

std::string table_of(const Report& report) {
  std::vector<std::vector<std::string>> lines(2);
  std::vector<std::size_t> widths;
  std::vector<bool> right;
  for (const Column& column : report.columns) {
    lines[0].push_back(column.name);
    lines[1].push_back(column.unit);
    widths.push_back(std::max(letters(column.name), letters(column.unit)));
    right.push_back(report.rows.empty() || is_number(report.rows.front()[right.size()]));
  }
  for (const std::vector<Cell>& row : report.rows) {
    lines.emplace_back();
    for (std::size_t k = 0; k < row.size(); ++k) {
      lines.back().push_back(printed(row[k], report.columns[k]));
      widths[k] = std::max(widths[k], letters(lines.back().back()));
    }
  }
  std::string table;
  for (const auto& fields : lines) table += line_of(fields, widths, right);
  return table;
}

std::string line_of(const Finding& finding) {
  const std::string unit = finding.unit.empty() ? "" : " " + finding.unit;
  if (std::isnan(finding.limit)) return fmt::format("{}: {:.4g}{}\n", finding.what, finding.value, unit);
  return fmt::format("{}: {:.4g}{} (at most {:.4g}: {})\n", finding.what, finding.value, unit, finding.limit,
                     finding.holds() ? "holds" : "does not hold");
}

std::string verdict_of(const std::vector<Finding>& findings) {
  const auto held = std::ranges::count_if(findings, [](const Finding& f) { return !std::isnan(f.limit); });
  if (held == 0) return "";
  const auto broken = std::ranges::count_if(findings, [](const Finding& f) { return !f.holds(); });
  return fmt::format("finding: {}, {} of {} figures are within their limits\n", broken == 0 ? "pass" : "fail",
                     held - broken, held);
}

}  // namespace

std::string printed(const Cell& cell, const Column& column) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
  const double number = std::get<double>(cell);
  if (std::isnan(number)) return "";
  return column.decimals < 0 ? fmt::format("{:.3g}", number) : fmt::format("{:.{}f}", number, column.decimals);
}

std::size_t Report::column(const std::string& column_name) const {
  const auto found = std::ranges::find(columns, column_name, &Column::name);
  assert(found != columns.end());
  return static_cast<std::size_t>(found - columns.begin());
}

std::string as_text(const Report& report) {
  std::string text = report.title + '\n';
  for (const auto& [what, value] : report.facts) text += fmt::format("{}: {}\n", what, value);
  text += '\n' + table_of(report);
  if (!report.findings.empty()) text += '\n';
  for (const Finding& finding : report.findings) text += line_of(finding);
  return text + verdict_of(report.findings);
}

std::string as_csv(const Report& report) {
  std::string csv;
  for (std::size_t k = 0; k < report.columns.size(); ++k) {
    csv += (k == 0 ? "" : ",") + csv_field(report.columns[k].name);
  }
  csv += "\r\n";
  for (const std::vector<Cell>& row : report.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) csv += (k == 0 ? "" : ",") + csv_field(row[k]);
    csv += "\r\n";
  }
  return csv;
}

std::string as_json(const Report& report) {
  nlohmann::ordered_json json = {{"bench", report.name}, {"title", report.title}};
  json["facts"] = nlohmann::ordered_json::object();
  for (const auto& [what, value] : report.facts) json["facts"][what] = value;
  json["columns"] = nlohmann::ordered_json::array();
  for (const Column& column : report.columns) json["columns"].push_back({{"name", column.name}, {"unit", column.unit}});
  json["rows"] = nlohmann::ordered_json::array();
  for (const std::vector<Cell>& row : report.rows) {
    nlohmann::ordered_json object;
    for (std::size_t k = 0; k < row.size(); ++k) object[report.columns[k].name] = json_value(row[k]);
    json["rows"].push_back(std::move(object));
  }
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : report.findings) {
    json["findings"].push_back({{"what", finding.what},
                                {"value", finding.value},
                                {"limit", finding.limit},
                                {"unit", finding.unit},
                                {"holds", finding.holds()}});
  }
  json["failed"] = report.failed;
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace terrella::bench
