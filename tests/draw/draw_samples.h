#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "geo/coordinates.h"

namespace terrella::test {

inline Geodetic place_at(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)};
}

/// The bytes of a file.
inline std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace terrella::test
