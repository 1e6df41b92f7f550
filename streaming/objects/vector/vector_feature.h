#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"
#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {

/// Turns a geometry into GeoJSON; null if it is empty. Curves become chains of straight lines. Fails for surfaces of
/// triangles, and for more than kMaxFeatureValues numbers. thread: that of the geometry
[[nodiscard]] Result<nlohmann::json> geojson_of(OGRGeometryH geometry);
/// Turns the fields of a feature into the properties of a GeoJSON feature. Fields without a value are left out.
/// thread: that of the feature
[[nodiscard]] nlohmann::json properties_of(OGRFeatureH feature, OGRFeatureDefnH definition);
/// Adds the colours and widths of a feature's style, under the names of simplestyle, to properties that lack them.
/// `with_icons`: also pictures, as KML names them, that are no addresses. thread: that of the feature
void add_style(OGRFeatureH feature, bool with_icons, nlohmann::json& properties);
/// Adds the times of a KML feature, its "begin" or "timestamp" and its "end", as milliseconds since 1970 under the
/// names of styles, to properties that lack them. thread: that of the feature
void add_times(OGRFeatureH feature, OGRFeatureDefnH definition, nlohmann::json& properties);

}  // namespace terrella
