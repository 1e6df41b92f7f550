#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"
#include "surface/layers.h"

// thread: any, for all of this header
namespace terrella {

/// A layer of numbers whose values a profile shows.
struct ProfileNumbers {
  LayerId layer = LayerId::none;
  std::string name, unit;
};

/// A place on a measured path, and what is there.
struct ProfileSample {
  double along_m = 0.0;  ///< way from the path's start
  Geodetic place;
  std::optional<double> height_m;  ///< nothing without heights
  std::optional<double> value;     ///< number of a layer; nothing while it is not known, and where it has no data
};

/// Returns about `count` places along geodesics through the places of a path, all of these among them, at equal
/// distances between two of them. None for a path of fewer than two places, or without a length.
[[nodiscard]] std::vector<ProfileSample> profile_samples(const Ellipsoid& ellipsoid, std::span<const Geodetic> path,
                                                         int count);

/// The samples as a table: distance_m, latitude, longitude, height_m, value. What is not known is an empty field.
[[nodiscard]] std::string profile_csv(std::span<const ProfileSample> samples);

}  // namespace terrella
