#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/flight/flight_path.h"
#include "base/result.h"

namespace terrella {

/// Reads flights from GeoJSON: LineStrings or Features of LineStrings. The third coordinates are heights over the
/// ellipsoid in metres. Each Feature is a separate flight. A Feature's properties set
/// - `pitch`, `heading` and `fov` in degrees, as in --camera. By default the eye looks straight down, with north up and
///   a 40° field of view;
/// - `pitches`, `headings`, `opacities` (as --surface-alpha) and `times` (as --time), arrays with a value for each
///   position; `time`, one value for all;
/// - `times_s`, seconds for each position, ascending; or `duration_s`, the seconds from the first position to the last.
///   By default the pace is even_pace().
/// The error begins with `where`. thread: any
[[nodiscard]] Result<std::vector<FlightPath>> parse_flight(std::string_view text, const std::string& where);

/// The flights of a file, and the text that they are read from.
struct FlightFile {
  std::vector<FlightPath> paths;
  std::string text;
  std::vector<std::string> complaints{};  ///< parts of a tour that a flight has not; each names the file
};
/// Reads a GeoJSON file, or the tours (gx:Tour) of a KML or KMZ file. The error names the file. Blocks. thread: any
[[nodiscard]] Result<FlightFile> read_flight(const std::filesystem::path& path);

}  // namespace terrella
