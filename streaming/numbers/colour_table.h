#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

// thread: any, for all of this header
namespace terrella {

using TableColour = std::array<std::uint8_t, 4>;  ///< red, green, blue, alpha

/// A colour table in the text form of GDAL (gdaldem color-relief) and of QGIS's export.
struct ColourTable {
  struct Entry {
    double at = 0.0;
    bool percent = false;  ///< `at` is a share of the shown range in percent; else a value
    TableColour colour{};
  };
  std::vector<Entry> entries;         ///< as in the file; at least one
  std::optional<TableColour> nodata;  ///< "nv": colour of no data; none: transparent
  std::optional<TableColour> other;   ///< "default": colour of values beyond the entries; none: the nearest entry's
  bool discrete = false;              ///< an entry's colour holds up to the next one; false: colours in between
};

/// Reads lines "VALUE R G B [A]" or "VALUE NAME". VALUE is a number, a percentage, "nv" or "default". Blanks, commas
/// and colons separate the fields; "#" begins a comment; "INTERPOLATION:DISCRETE" makes steps. The error begins with
/// `where`, names the line, and says what a line takes.
[[nodiscard]] Result<ColourTable> parse_colour_table(std::string_view text, const std::string& where);

/// Reads a file of at most 1 MiB.
[[nodiscard]] Result<ColourTable> read_colour_table(const std::filesystem::path& path);

}  // namespace terrella
