#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "geo/shown_when.h"
#include "streaming/objects/feature_style.h"

namespace terrella {

/// A longer file is refused before it is read.
inline constexpr std::size_t kMaxObjectFileBytes = 1UL << 30;
/// Most numbers, texts, lists and objects in one feature. Only one feature at a time is held in memory as JSON.
inline constexpr std::size_t kMaxFeatureValues = 6'000'000;
/// Most complaints kept; further ones are only counted.
inline constexpr std::size_t kMostComplaints = 100;

/// Objects read from a file, and complaints about the rest.
struct ObjectFile {
  ObjectScene scene;
  ObjectId next{1};                     ///< the id after that of the last feature
  std::string attribution = {};         ///< the document's "attribution"; may be empty
  std::vector<std::string> complaints;  ///< each names the file, the feature counted from 1, and the action taken
  std::size_t complaints_left_out = 0;
  std::vector<ShownWhen> shown_when = {};  ///< features that are not always shown (globe/features/shown_features.h)
  std::size_t ground_overlays = 0;         ///< pictures of a KML file, which the file gives as imagery
};

/// Reads the objects of GeoJSON (RFC 7946): all its geometries. Positions are longitude, latitude, and metres over the
/// ellipsoid, negative below it.
/// Properties are those of simplestyle 1.1.0 with its defaults. Further properties: icon is a Point's
/// picture, radius_m makes a Point a sphere, model a glTF model; through_surface. See streaming/objects/README.md,
/// also for catalogues of earthquakes, whose third coordinate is a depth in kilometres.
///
/// Each object has the id of its feature, counted from `first` in the order of the file, and the feature's properties
/// as JSON text. Give the `next` of one file as `first` of another if both go into one layer.
///
/// A faulty geometry is skipped with a complaint. A faulty property counts as missing, with a complaint. If the text
/// stops being valid JSON, the features before that point stay. Fails if nothing was read at all. `where` (a path)
/// begins each message. A style takes the place of what the properties say. Models and icons are read from `folder`, or
/// not at all if it is empty. thread: any
[[nodiscard]] Result<ObjectFile> parse_geojson_objects(std::istream& text, const std::string& where,
                                                       const std::filesystem::path& folder = {},
                                                       ObjectId first = ObjectId{1}, const FeatureStyle& style = {});
/// Reads objects from a file.
[[nodiscard]] Result<ObjectFile> read_geojson_objects(const std::filesystem::path& path, ObjectId first = ObjectId{1},
                                                      const FeatureStyle& style = {});

}  // namespace terrella
