#include "streaming/numbers/colour_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/number.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxTableBytes = 1U << 20;
constexpr std::size_t kMaxEntries = 65536;

struct NamedColour {
  std::string_view name;
  std::array<std::uint8_t, 3> rgb;
};
/// The names that gdaldem knows.
constexpr std::array<NamedColour, 16> kNames{{{"white", {255, 255, 255}},
                                              {"black", {0, 0, 0}},
                                              {"red", {255, 0, 0}},
                                              {"green", {0, 255, 0}},
                                              {"blue", {0, 0, 255}},
                                              {"yellow", {255, 255, 0}},
                                              {"magenta", {255, 0, 255}},
                                              {"cyan", {0, 255, 255}},
                                              {"aqua", {0, 255, 255}},
                                              {"grey", {128, 128, 128}},
                                              {"gray", {128, 128, 128}},
                                              {"orange", {255, 165, 0}},
                                              {"brown", {150, 75, 0}},
                                              {"purple", {128, 0, 128}},
                                              {"violet", {128, 0, 128}},
                                              {"indigo", {75, 0, 130}}}};

std::string lower(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  constexpr std::string_view kBetween = " \t,:\r";
  while (true) {
    const std::size_t first = line.find_first_not_of(kBetween);
    if (first == std::string_view::npos) return fields;
    const std::size_t end = std::min(line.find_first_of(kBetween, first), line.size());
    fields.push_back(line.substr(first, end - first));
    line.remove_prefix(end);
  }
}

std::optional<std::uint8_t> channel(std::string_view text) {
  const auto number = read_number(text);
  if (!number || *number < 0.0 || *number > 255.0 || *number != std::floor(*number)) return {};
  return static_cast<std::uint8_t>(*number);
}

/// Reads "R G B", "R G B A" or a name. Text behind four numbers, as a label, does not count.
std::optional<TableColour> colour_of(const std::vector<std::string_view>& fields) {
  if (fields.size() < 4) {
    const auto* const named =
        fields.size() < 2 ? kNames.end() : std::ranges::find(kNames, lower(fields[1]), &NamedColour::name);
    if (named == kNames.end()) return {};
    return TableColour{named->rgb[0], named->rgb[1], named->rgb[2], 255};
  }
  TableColour colour{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = channel(fields[1 + c]);
    if (!value) return {};
    colour[c] = *value;
  }
  if (fields.size() == 4) return colour;
  const auto alpha = channel(fields[4]);
  // A fifth field that is no number begins a label.
  if (!alpha && read_number(fields[4])) return {};
  colour[3] = alpha.value_or(255);
  return colour;
}

/// Reads one line with fields into the table. Returns false for a line that is no entry.
bool take_line(const std::vector<std::string_view>& fields, ColourTable& table) {
  const std::string first = lower(fields.front());
  if (first == "interpolation" && fields.size() > 1) {
    const std::string how = lower(fields[1]);
    table.discrete = how == "discrete" || how == "exact";
    return table.discrete || how == "interpolated" || how == "linear";
  }
  const auto colour = colour_of(fields);
  if (!colour) return false;
  if (first == "nv") {
    table.nodata = colour;
    return true;
  }
  if (first == "default") {
    table.other = colour;
    return true;
  }
  const bool percent = first.ends_with('%');
  const auto at = read_number(std::string_view(first).substr(0, first.size() - (percent ? 1 : 0)));
  if (!at || !std::isfinite(*at)) return false;
  table.entries.push_back({.at = *at, .percent = percent, .colour = *colour});
  return true;
}

}  // namespace

Result<ColourTable> parse_colour_table(std::string_view text, const std::string& where) {
  ColourTable table;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view whole = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    whole = whole.substr(0, whole.find('#'));
    const auto fields = fields_of(whole);
    if (fields.empty()) continue;
    if (!take_line(fields, table)) {
      return Error{
          fmt::format("{}: line {}: {} is no entry of a colour table; write VALUE R G B [A] with colours from 0 to "
                      "255, or VALUE and a colour's name, where VALUE is a number, a percentage, nv or default",
                      where, line, in_quotes(trimmed(whole)))};
    }
    if (table.entries.size() > kMaxEntries) {
      return Error{fmt::format("{}: line {}: more than {} entries; thin them out", where, line, kMaxEntries)};
    }
  }
  if (!table.entries.empty()) return table;
  return Error{fmt::format("{}: it has no entry; write lines as in gdaldem color-relief: VALUE R G B [A]", where)};
}

Result<ColourTable> read_colour_table(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxTableBytes);
  if (!bytes) return Error{bytes.error().message};
  return parse_colour_table(as_text(*bytes), path.string());
}

}  // namespace terrella
