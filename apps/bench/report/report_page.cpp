#include "apps/bench/report/report_page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <pugixml.hpp>
#include <sstream>
#include <thread>

namespace terrella::bench {
namespace {

constexpr const char* kStyle =
    "body{font:14px sans-serif;margin:2em auto;max-width:1300px}table{border-collapse:collapse}"
    "th,td{padding:2px 8px;text-align:right;border-bottom:1px solid #ddd}th:first-child,td:first-child{text-align:left}"
    "th small{font-weight:normal;color:#666}.broken{color:#b00;font-weight:bold}";

pugi::xml_node add_text(pugi::xml_node& parent, const char* tag, const std::string& text) {
  pugi::xml_node node = parent.append_child(tag);
  node.text().set(text.c_str());
  return node;
}

void add_facts(pugi::xml_node& parent, const std::vector<std::pair<std::string, std::string>>& facts) {
  pugi::xml_node table = parent.append_child("table");
  for (const auto& [what, value] : facts) {
    pugi::xml_node row = table.append_child("tr");
    add_text(row, "td", what);
    add_text(row, "td", value);
  }
}

void add_findings(pugi::xml_node& parent, const std::vector<Finding>& findings) {
  if (findings.empty()) return;
  pugi::xml_node list = parent.append_child("ul");
  for (const Finding& finding : findings) {
    std::string line = fmt::format("{}: {:.4g} {}", finding.what, finding.value, finding.unit);
    if (!std::isnan(finding.limit)) line += fmt::format(" (at most {:.4g})", finding.limit);
    pugi::xml_node item = add_text(list, "li", line);
    if (!finding.holds()) item.append_attribute("class") = "broken";
  }
}

void add_table(pugi::xml_node& parent, const Report& report) {
  pugi::xml_node details = parent.append_child("details");
  add_text(details, "summary", fmt::format("table of {} rows", report.rows.size()));
  pugi::xml_node table = details.append_child("table");
  pugi::xml_node head = table.append_child("tr");
  for (const Column& column : report.columns) {
    pugi::xml_node cell = add_text(head, "th", column.name + ' ');
    add_text(cell, "small", column.unit);
  }
  for (const std::vector<Cell>& row : report.rows) {
    pugi::xml_node line = table.append_child("tr");
    for (std::size_t k = 0; k < row.size(); ++k) add_text(line, "td", printed(row[k], report.columns[k]));
  }
}

void add_plots(pugi::xml_node& parent, const std::string& svg) {
  pugi::xml_document plots;
  if (plots.load_buffer(svg.data(), svg.size())) parent.append_copy(plots.document_element());
}

void add_entry(pugi::xml_node& body, const PageEntry& entry) {
  pugi::xml_node section = body.append_child("section");
  add_text(section, "h2", entry.report.name);
  if (!entry.failure.empty()) {
    add_text(section, "p", entry.failure).append_attribute("class") = "broken";
    return;
  }
  add_text(section, "p", entry.report.title);
  add_facts(section, entry.report.facts);
  add_findings(section, entry.report.findings);
  add_plots(section, entry.svg);
  add_table(section, entry.report);
}

std::string processor_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  }
  return "unknown";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> machine_facts() {
  utsname system{};
  uname(&system);
  return {{"processor", processor_model()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
          {"program", std::string("terrella ") + TERRELLA_VERSION},
          {"time", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))}};
}

std::string as_page(const std::vector<std::pair<std::string, std::string>>& machine,
                    const std::vector<PageEntry>& entries) {
  pugi::xml_document page;
  page.append_child(pugi::node_doctype).set_value("html");
  pugi::xml_node html = page.append_child("html");
  pugi::xml_node head = html.append_child("head"), body = html.append_child("body");
  head.append_child("meta").append_attribute("charset") = "utf-8";
  add_text(head, "title", "terrella bench");
  add_text(head, "style", kStyle);
  add_text(body, "h1", "terrella bench");
  add_facts(body, machine);
  for (const PageEntry& entry : entries) add_entry(body, entry);
  std::ostringstream text;
  page.save(text, "", pugi::format_raw | pugi::format_no_declaration | pugi::format_no_empty_element_tags);
  return text.str();
}

}  // namespace terrella::bench
