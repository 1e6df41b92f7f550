#include "apps/viewer/profile/profile_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geo/measure.h"

namespace terrella {
namespace {

/// Shortest text that is read back as the same number.
std::string field(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : std::string(); }

}  // namespace

std::vector<ProfileSample> profile_samples(const Ellipsoid& ellipsoid, std::span<const Geodetic> path, int count) {
  const double whole_m = path_m(ellipsoid, path);
  if (!(whole_m > 0.0)) return {};
  std::vector<ProfileSample> samples{{.along_m = 0.0, .place = path.front(), .height_m = {}, .value = {}}};
  double before_m = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double length_m = geodesic_m(ellipsoid, path[k - 1], path[k]);
    if (!(length_m > 0.0)) continue;
    const int pieces = std::max(1, static_cast<int>(std::lround(count * length_m / whole_m)));
    const std::vector<Geodetic> places = geodesic_places(ellipsoid, path[k - 1], path[k], pieces + 1);
    for (int i = 1; i <= pieces; ++i) {
      samples.push_back({.along_m = before_m + length_m * i / pieces,
                         .place = places[static_cast<std::size_t>(i)],
                         .height_m = {},
                         .value = {}});
    }
    before_m += length_m;
  }
  return samples;
}

std::string profile_csv(std::span<const ProfileSample> samples) {
  std::string text = "distance_m,latitude,longitude,height_m,value\n";
  for (const ProfileSample& sample : samples) {
    text += fmt::format("{:.3f},{:.9f},{:.9f},{},{}\n", sample.along_m, sample.place.lat.deg(), sample.place.lon.deg(),
                        field(sample.height_m), field(sample.value));
  }
  return text;
}

}  // namespace terrella
