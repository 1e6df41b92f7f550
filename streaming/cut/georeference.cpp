#include "streaming/cut/georeference.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <fstream>
#include <memory>
#include <string>

#include "geo/number.h"
#include "streaming/cut/tiff_open.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Tags and keys of GeoTIFF, OGC 19-008r4.
constexpr ttag_t kModelPixelScale = 33550;
constexpr ttag_t kModelTiepoint = 33922;
constexpr ttag_t kGeoKeyDirectory = 34735;
constexpr int kModelType = 1024;
constexpr int kModelGeographic = 2;
constexpr int kRasterType = 1025;
constexpr int kPixelIsPoint = 2;
constexpr double kSlack_px = 0.01;

/// The value of a short key; 0 if there is none.
int geo_key(TIFF* tiff, int wanted) {
  std::uint32_t count = 0;
  const std::uint16_t* keys = nullptr;
  if (TIFFGetField(tiff, kGeoKeyDirectory, &count, &keys) != 1) return 0;
  for (std::uint32_t i = 4; i + 3 < count; i += 4) {
    if (keys[i] == wanted && keys[i + 1] == 0) return keys[i + 3];
  }
  return 0;
}

std::optional<Georeference> from_tags(const fs::path& picture) {
  std::string message;
  const TiffHandle tiff = open_tiff(picture.string(), message);
  if (!tiff || geo_key(tiff.get(), kModelType) != kModelGeographic) return {};
  std::uint32_t scales = 0;
  std::uint32_t ties = 0;
  const double* scale = nullptr;
  const double* tie = nullptr;
  if (TIFFGetField(tiff.get(), kModelPixelScale, &scales, &scale) != 1 || scales < 2) return {};
  if (TIFFGetField(tiff.get(), kModelTiepoint, &ties, &tie) != 1 || ties != 6) return {};
  // The tie point's pixel counts from the corner, or from the middle of the first pixel.
  const double to_edge = geo_key(tiff.get(), kRasterType) == kPixelIsPoint ? 0.5 : 0.0;
  return Georeference{.west_deg = tie[3] - (tie[0] + to_edge) * scale[0],
                      .north_deg = tie[4] + (tie[1] + to_edge) * scale[1],
                      .pixel_width_deg = scale[0],
                      .pixel_height_deg = scale[1]};
}

std::optional<Georeference> from_world_file(const fs::path& file) {
  std::ifstream text(file);
  std::array<double, 6> values{};
  for (double& value : values) {
    std::string word;
    if (!(text >> word)) return {};
    const auto number = read_number(word);
    if (!number) return {};
    value = *number;
  }
  const auto& [width, turn_a, turn_b, minus_height, x, y] = values;
  if (turn_a != 0.0 || turn_b != 0.0) return {};
  return Georeference{.west_deg = x - 0.5 * width,
                      .north_deg = y - 0.5 * minus_height,
                      .pixel_width_deg = width,
                      .pixel_height_deg = -minus_height};
}

std::optional<Georeference> from_world_files(const fs::path& picture) {
  for (const char* ending : {".jgw", ".pgw", ".tfw", ".wld", ".JGW", ".PGW", ".TFW"}) {
    fs::path file = picture;
    file.replace_extension(ending);
    if (auto found = from_world_file(file)) return found;
  }
  return {};
}

bool in_degrees(const Georeference& place) {
  return place.pixel_width_deg > 0.0 && place.pixel_height_deg > 0.0 && std::abs(place.west_deg) <= 361.0 &&
         std::abs(place.north_deg) <= 91.0;
}

}  // namespace

std::optional<Georeference> read_georeference(const fs::path& picture) {
  auto found = from_tags(picture);
  if (!found) found = from_world_files(picture);
  return found && in_degrees(*found) ? found : std::nullopt;
}

std::optional<GeoRect> covered_by(const Georeference& place, std::int64_t width, std::int64_t height) {
  const double wide = static_cast<double>(width) * place.pixel_width_deg;
  const double south = place.north_deg - static_cast<double>(height) * place.pixel_height_deg;
  const double slack = kSlack_px * place.pixel_width_deg;
  const auto snapped = [&](double value, double to) { return std::abs(value - to) <= slack ? to : value; };
  double west = snapped(place.west_deg, -180.0);
  if (west >= 180.0) west -= 360.0;
  if (west < -180.0) west += 360.0;
  double east = snapped(snapped(west + wide, 180.0), west + 360.0);
  if (east >= west + 360.0 && west != -180.0) return {};
  if (east > 180.0) east -= 360.0;
  return GeoRect{.west = Angle::degrees(west),
                 .south = Angle::degrees(snapped(south, -90.0)),
                 .east = Angle::degrees(east),
                 .north = Angle::degrees(snapped(place.north_deg, 90.0))};
}

}  // namespace terrella
