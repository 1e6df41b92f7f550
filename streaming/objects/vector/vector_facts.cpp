#include "streaming/objects/vector_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/objects/vector/ground_overlays.h"
#include "streaming/objects/vector/vector_file.h"

namespace terrella {
namespace {

std::string text_of(const char* text) { return text == nullptr ? std::string() : std::string(text); }

std::string code_of(OGRSpatialReferenceH system) {
  const std::string authority = text_of(gdal().OSRGetAuthorityName(system, nullptr));
  const std::string code = text_of(gdal().OSRGetAuthorityCode(system, nullptr));
  return authority.empty() || code.empty() ? std::string() : authority + ":" + code;
}

std::optional<std::array<double, 4>> bounds_of(OGRLayerH layer) {
  OGREnvelope box{};
  if (gdal().OGR_L_GetExtent(layer, &box, 1) != OGRERR_NONE) return {};
  const std::array<double, 4> bounds{box.MinX, box.MinY, box.MaxX, box.MaxY};
  if (!std::ranges::all_of(bounds, [](double side) { return std::isfinite(side); })) return {};
  return bounds;
}

VectorLayerFacts facts_of(OGRLayerH layer) {
  VectorLayerFacts facts{.name = text_of(gdal().OGR_L_GetName(layer)),
                         .geometry = text_of(gdal().OGRGeometryTypeToName(gdal().OGR_L_GetGeomType(layer))),
                         .features = std::max<GIntBig>(0, gdal().OGR_L_GetFeatureCount(layer, 1)),
                         .crs = {},
                         .crs_code = {},
                         .bounds = bounds_of(layer),
                         .fields = {}};
  if (OGRSpatialReferenceH system = gdal().OGR_L_GetSpatialRef(layer)) {
    facts.crs = text_of(gdal().OSRGetName(system));
    facts.crs_code = code_of(system);
  }
  OGRFeatureDefnH definition = gdal().OGR_L_GetLayerDefn(layer);
  for (int i = 0; i < gdal().OGR_FD_GetFieldCount(definition); ++i) {
    OGRFieldDefnH field = gdal().OGR_FD_GetFieldDefn(definition, i);
    facts.fields.emplace_back(text_of(gdal().OGR_Fld_GetNameRef(field)),
                              text_of(gdal().OGR_GetFieldTypeName(gdal().OGR_Fld_GetType(field))));
  }
  return facts;
}

std::size_t pictures_of(const std::filesystem::path& kml) {
  const auto file = KmlFile::open(kml);
  if (!file) return 0;
  const auto overlays = read_ground_overlays(*file);
  return overlays ? overlays->pictures.size() : 0;
}

}  // namespace

Result<VectorFacts> describe_vector(const std::filesystem::path& path) {
  const auto file = open_vector_file(path);
  if (!file) return file.error();
  const GdalSettings settings(vector_settings());
  const GdalMessages messages;
  VectorFacts facts{.format = file->driver, .layers = {}, .has_links = file->has_links};
  const int count = gdal().GDALDatasetGetLayerCount(file->dataset.get());
  if (count > kMostVectorLayers) {
    return Error{fmt::format("{}: {} layers are more than the {} that are described; divide it", path.string(), count,
                             kMostVectorLayers)};
  }
  for (int i = 0; i < count; ++i) {
    if (OGRLayerH layer = gdal().GDALDatasetGetLayer(file->dataset.get(), i)) facts.layers.push_back(facts_of(layer));
  }
  if (!messages.error().empty()) return Error{fmt::format("{}: {}", path.string(), messages.error())};
  if (file->is_kml) facts.pictures = pictures_of(path);
  if (facts.layers.empty()) return Error{path.string() + ": it holds no layers of features"};
  return facts;
}

}  // namespace terrella
