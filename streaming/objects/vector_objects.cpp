#include "streaming/objects/vector_objects.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "streaming/objects/feature_taker.h"
#include "streaming/objects/vector/kml_file.h"
#include "streaming/objects/vector/vector_feature.h"
#include "streaming/objects/vector/vector_file.h"
#include "streaming/objects/vector/ways_to_degrees.h"

namespace terrella {
namespace {

using nlohmann::json;

struct DestroyFeature {
  void operator()(OGRFeatureH feature) const { gdal().OGR_F_Destroy(feature); }
};

/// Reads the layers of a file, one feature at a time.
class LayerReader {
 public:
  LayerReader(const VectorFile& file, FeatureTaker& taker) : file_(file), is_kml_(file.is_kml), taker_(taker) {}

  /// The number of GroundOverlay elements.
  [[nodiscard]] std::size_t overlays() const { return overlays_; }

  void read_all() {
    const int layers = gdal().GDALDatasetGetLayerCount(file_.dataset.get());
    for (int i = 0; i < layers && count_ < kMaxVectorFeatures; ++i) {
      OGRLayerH layer = gdal().GDALDatasetGetLayer(file_.dataset.get(), i);
      if (layer != nullptr && !repeats_lines(gdal().OGR_L_GetName(layer))) read(layer);
    }
    if (file_.has_links) taker_.complain_of("its files of NetworkLink elements are not read; open them one by one");
    if (above_sea_) {
      taker_.complain_of(
          "its heights over the sea are taken as heights over the ellipsoid, which differ by up to 110 m, as PROJ's "
          "grid "
          "of the geoid is missing; install the package proj-data");
    }
  }

 private:
  /// GPX states the places of tracks and routes again, as points.
  [[nodiscard]] bool repeats_lines(std::string_view layer) const {
    return file_.driver == "GPX" && (layer == "track_points" || layer == "route_points");
  }

  /// Finds the way to degrees; null if the layer is in degrees.
  static Status find_way(OGRLayerH layer, Transformation& way) {
    const GdalMessages messages;
    OGRSpatialReferenceH system = gdal().OGR_L_GetSpatialRef(layer);
    if (system == nullptr) {
      OGREnvelope box{};
      const bool is_known = gdal().OGR_L_GetExtent(layer, &box, 1) == OGRERR_NONE;
      const bool is_far = box.MinX < -540.0 || box.MaxX > 540.0 || box.MinY < -90.0 || box.MaxY > 90.0;
      if (is_known && is_far) {
        return Error{
            "its coordinates are no degrees, and it names no coordinate system; give it one, as by a .prj file"};
      }
      return Done{};
    }
    way = way_to_degrees(system);
    return way ? Status(Done{}) : Error{"no way from its coordinate system to degrees: " + messages.error()};
  }

  void read(OGRLayerH layer) {
    const GdalMessages messages;
    const std::string name = gdal().OGR_L_GetName(layer);
    Transformation way;
    if (const Status found = find_way(layer, way); !found) {
      return taker_.complain_of(fmt::format("layer {}: {}; it is left out", name, found.error().message));
    }
    gdal().OGR_L_ResetReading(layer);
    OGRFeatureDefnH definition = gdal().OGR_L_GetLayerDefn(layer);
    while (const std::unique_ptr<void, DestroyFeature> feature{gdal().OGR_L_GetNextFeature(layer)}) {
      if (count_ == kMaxVectorFeatures) {
        return taker_.complain_of(fmt::format("its features after the first {} are left out; divide it", count_));
      }
      take(feature.get(), definition, way.get());
    }
    if (!messages.error().empty()) taker_.complain_of(fmt::format("layer {}: {}", name, messages.error()));
  }

  void take(OGRFeatureH feature, OGRFeatureDefnH definition, OGRCoordinateTransformationH way) {
    const std::size_t index = count_++;
    OGRGeometryH geometry = gdal().OGR_F_GetGeometryRef(feature);
    const GdalMessages messages;
    if (geometry != nullptr && way != nullptr && gdal().OGR_G_Transform(geometry, way) != OGRERR_NONE) {
      return taker_.complain_of(
          fmt::format("feature {}: its coordinates have no place in degrees: {}", index + 1, messages.error()));
    }
    json properties = properties_of(feature, definition);
    if (is_kml_) {
      follow_kml(properties, geometry);
      add_times(feature, definition, properties);
    }
    Result<json> shape = geojson_of(geometry);
    if (!shape) return taker_.complain_of(fmt::format("feature {}: {}", index + 1, shape.error().message));
    add_style(feature, is_kml_, properties);
    if (!properties.contains("name") && properties.contains("Name")) properties["name"] = properties["Name"];
    if (is_kml_ && is_overlay(properties, *shape)) {
      ++overlays_;
      return;
    }
    taker_.take({{"type", "Feature"}, {"properties", std::move(properties)}, {"geometry", *std::move(shape)}}, index);
  }

  /// GDAL reads the picture of a GroundOverlay as an area with an icon.
  static bool is_overlay(const json& properties, const json& shape) {
    return properties.contains("icon") && shape.is_object() && shape.at("type") == "Polygon";
  }

  /// Names of GeoJSON's properties for those of KML.
  void follow_kml(json& properties, OGRGeometryH geometry) {
    const auto mode = properties.find("altitudeMode");
    const std::string said = mode != properties.end() && mode->is_string() ? mode->get<std::string>() : "";
    const bool has_heights = said == "absolute" || said == "relativeToGround";
    properties["altitude-mode"] = has_heights ? said : "clampToGround";
    if (said == "absolute" && geometry != nullptr && gdal().OGR_G_Is3D(geometry) != 0) {
      if (!std::exchange(asked_sea_, true)) from_sea_ = way_from_sea_level();
      above_sea_ |= !from_sea_ || gdal().OGR_G_Transform(geometry, from_sea_.get()) != OGRERR_NONE;
    }
    for (const char* name : {"tessellate", "extrude", "visibility", "drawOrder"}) properties.erase(name);
  }

  const VectorFile& file_;
  bool is_kml_;
  FeatureTaker& taker_;
  std::size_t count_ = 0;
  std::size_t overlays_ = 0;
  Transformation from_sea_ = {};  ///< null: not needed so far, or PROJ lacks the grid
  bool asked_sea_ = false;
  bool above_sea_ = false;
};

/// Reads icons beside a KML file or in a KMZ file.
IconShelf::ReadPicture icons_of(const std::filesystem::path& path) {
  auto file = std::make_shared<Result<KmlFile>>(KmlFile::open(path));
  return [file](const std::string& name) -> Result<std::vector<std::byte>> {
    if (!*file) return file->error();
    const auto text = (*file)->read(KmlFile::resolved((*file)->document(), name));
    if (!text) return text.error();
    const auto bytes = std::as_bytes(std::span(*text));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
}

}  // namespace

bool is_vector_file(const std::filesystem::path& path) { return vector_driver_of(path) != nullptr; }

Result<ObjectFile> read_vector_objects(const std::filesystem::path& path, ObjectId first, const FeatureStyle& style) {
  const auto opened = open_vector_file(path);
  if (!opened) return opened.error();
  const GdalSettings settings(vector_settings());
  ObjectFile file;
  FeatureTaker taker(path.string(), path.has_parent_path() ? path.parent_path() : ".", first, file);
  taker.set_style(style);
  if (opened->is_kml) taker.set_icon_reader(icons_of(path));
  LayerReader reader(*opened, taker);
  reader.read_all();
  file.ground_overlays = reader.overlays();
  if (!file.scene.empty() || file.ground_overlays > 0) return file;
  const std::string why =
      file.complaints.empty() ? path.string() + ": it has no features with a place" : file.complaints.front();
  return Error{why};
}

Result<ObjectFile> read_objects(const std::filesystem::path& path, ObjectId first, const FeatureStyle& style) {
  return is_vector_file(path) ? read_vector_objects(path, first, style) : read_geojson_objects(path, first, style);
}

}  // namespace terrella
