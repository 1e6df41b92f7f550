#include "streaming/raster/gdal/dataset_place.h"

#include <array>
#include <string>
#include <string_view>

namespace terrella {
namespace {

std::optional<Affine> transform_of(GDALDatasetH dataset) {
  std::array<double, 6> t{};
  if (gdal().GDALGetGeoTransform(dataset, t.data()) != CE_None) return {};
  return Affine{t[0], t[1], t[2], t[3], t[4], t[5]};
}

/// The system as WKT 2, which keeps units and axes that overrule those of a code.
std::string wkt_of(OGRSpatialReferenceH system) {
  if (system == nullptr) return {};
  const char* const options[] = {"FORMAT=WKT2_2018", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const bool is_written = gdal().OSRExportToWktEx(system, &text, options) == OGRERR_NONE && text != nullptr;
  std::string wkt = is_written ? text : "";
  gdal().VSIFree(text);
  return wkt;
}

/// The name in a citation. GDAL writes systems that GeoTIFF has no keys for, as those of other bodies, by their name,
/// and reads them as local ones.
std::string name_in(std::string_view citation) {
  constexpr std::string_view kBefore = "GCS Name = ";
  if (!citation.starts_with(kBefore)) return {};
  const std::string_view rest = citation.substr(kBefore.size());
  return std::string(rest.substr(0, rest.find('|')));
}

bool has_camera(GDALDatasetH dataset) { return gdal().CSLCount(gdal().GDALGetMetadata(dataset, "RPC")) > 0; }

}  // namespace

PointPlace points_of(GDALDatasetH dataset) {
  if (transform_of(dataset)) return PointPlace::none;
  if (gdal().GDALGetGCPCount(dataset) > 0) return PointPlace::control_points;
  return has_camera(dataset) ? PointPlace::camera : PointPlace::none;
}

std::optional<Georeference> read_place(GDALDatasetH dataset, GDALDatasetH resampled) {
  GDALDatasetH placed = resampled != nullptr ? resampled : dataset;
  Georeference said;
  const std::string_view driver = gdal().GDALGetDescription(gdal().GDALGetDatasetDriver(dataset));
  said.source = driver == "GTiff" ? "GeoTIFF tags" : std::string(driver) + " header";
  said.transform = transform_of(placed);
  if (resampled != nullptr)
    said.points = points_of(dataset) == PointPlace::camera ? "camera model (RPC)" : "ground control points";
  const OGRSpatialReferenceH system = gdal().GDALGetSpatialRef(placed);
  said.crs = wkt_of(system);
  if (system != nullptr) {
    if (const char* title = gdal().OSRGetName(system)) said.crs_title = title;
    const std::string name = name_in(said.crs_title);
    if (!name.empty() && gdal().OSRIsLocal(system) != 0) said.crs = said.crs_title = name;
  }
  const char* pixel = gdal().GDALGetMetadataItem(dataset, GDALMD_AREA_OR_POINT, nullptr);
  said.pixel_is_point = pixel != nullptr && std::string_view(pixel) == GDALMD_AOP_POINT;
  if (!said.transform && said.crs.empty()) return {};
  return said;
}

}  // namespace terrella
