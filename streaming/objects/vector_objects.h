#pragma once

#include <cstddef>
#include <filesystem>

#include "streaming/objects/geojson_objects.h"

namespace terrella {

/// Most features that are read from one vector file.
inline constexpr std::size_t kMaxVectorFeatures = 2'000'000;
/// Most bytes of KML, and of all files in a KMZ or ZIP file together, uncompressed. GDAL keeps such files in memory.
inline constexpr std::size_t kMaxVectorUnpackedBytes = 256UL << 20;

/// True for the name of a file that GDAL reads: KML and KMZ, GPX, shapefiles (also in a ZIP file, or a folder that
/// holds one), FlatGeobuf, GeoPackage, CSV, MapInfo and Mapbox Vector Tiles. Looks at the name, and into folders.
/// thread: any
[[nodiscard]] bool is_vector_file(const std::filesystem::path& path);

/// Reads the objects of a vector file by GDAL, with the fields of features as their properties. Positions become
/// longitude and latitude on WGS84, or on the file's own body if that is not the Earth. A layer without a coordinate
/// system must be in degrees. The third coordinate is metres over the ellipsoid. KML's altitudeMode counts, with
/// clampToGround as its default. Colours and widths of the file's styles count like those of simplestyle. Pictures of
/// KML (GroundOverlay) are only counted: open_mosaic() opens them.
///
/// Faulty features are skipped with a complaint. Fails if the file is too long, no vector file, or without anything.
/// Blocks. thread: any
[[nodiscard]] Result<ObjectFile> read_vector_objects(const std::filesystem::path& path, ObjectId first = ObjectId{1},
                                                     const FeatureStyle& style = {});

/// Reads a vector file or, for any other name, a GeoJSON file; with a style, in place of what the properties of its
/// features say. Blocks. thread: any
[[nodiscard]] Result<ObjectFile> read_objects(const std::filesystem::path& path, ObjectId first = ObjectId{1},
                                              const FeatureStyle& style = {});

}  // namespace terrella
