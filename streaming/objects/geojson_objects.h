#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"

namespace terrella {

/// A longer file is refused before it is read.
inline constexpr std::size_t kMaxObjectFileBytes = 1UL << 30;
/// Numbers, texts, lists and objects that one feature may hold; it is the one thing that is held in memory as JSON.
inline constexpr std::size_t kMaxFeatureValues = 6'000'000;
/// Complaints kept; of the others only the number is told.
inline constexpr std::size_t kMostComplaints = 100;

/// What is good in a file, and what is not.
struct ObjectFile {
  ObjectScene scene;
  std::vector<std::string> complaints;  ///< each names the file and the feature, counted from 1, and what was done
  std::size_t complaints_left_out = 0;
};

/// The objects of GeoJSON (RFC 7946): all its geometries; longitude, latitude, and metres over the ellipsoid, negative
/// under it. Properties: those of simplestyle 1.1.0 with its defaults, but for description, which is not kept, and
/// icons as marker-symbol; radius_m makes a Point a sphere, model a glTF model; through_surface. See
/// streaming/objects/README.md, also for catalogues of earthquakes, whose third coordinate is a depth in kilometres.
///
/// A geometry that is wrong is left out with a complaint; a property that is wrong is as if it were not there, with a
/// complaint. Where the text ends being JSON, what came before stays. It is an error if nothing was read at all.
/// `where` (a path) begins each message; models are looked for in `folder`, and not read if it is empty. thread: any
[[nodiscard]] Result<ObjectFile> parse_geojson_objects(std::istream& text, const std::string& where,
                                                       const std::filesystem::path& folder = {});
/// The same from a file.
[[nodiscard]] Result<ObjectFile> read_geojson_objects(const std::filesystem::path& path);

}  // namespace terrella
