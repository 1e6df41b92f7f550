#include "streaming/objects/geojson_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/json_text.h"
#include "streaming/objects/feature_objects.h"
#include "streaming/objects/icon_shelf.h"
#include "streaming/objects/model_shelf.h"
#include "streaming/objects/quake_catalogue.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

/// Names the objects of a feature, and gives them its properties.
void name_feature(ObjectStyle& style, ObjectId id, const json& properties) {
  auto feature = std::make_shared<ObjectFeature>();
  feature->properties = properties.dump(-1, ' ', false, json::error_handler_t::replace);
  style.point.of = style.line.of = style.polygon.of = style.label.of =
      style.mesh.of = {.id = id, .feature = std::move(feature)};
}

/// Takes each feature out of the document as soon as it is complete. No more than one feature is held as JSON.
class FeatureTaker {
 public:
  FeatureTaker(std::string where, const std::filesystem::path& folder, ObjectId first, ObjectFile& file)
      : where_(std::move(where)), models_(folder), icons_(folder), first_(first), file_(file) {
    file_.next = first;
  }

  /// For JsonBuilder: keeps everything except features.
  bool keep(std::size_t depth, const std::string& member, const json& value) {
    if (depth == 1 && member == "attribution") credit(value);
    if (depth == 1 && member == "metadata" && is_quake_catalogue(value)) quakes_ = true;
    if (depth != 2 || member != "features") return true;
    take(value, count_++);
    return false;
  }

  void take(const json& feature, std::size_t index) {
    const Complain complain = [&](const std::string& what) {
      complain_of(fmt::format("{}: {}", feature_name(feature, index), what));
    };
    if (geojson_type(feature) != "Feature") return complain("not a Feature; it is left out");
    const auto geometry = feature.find("geometry");
    if (geometry == feature.end()) return complain("it has no \"geometry\"");
    if (geometry->is_null()) return;
    const auto properties = feature.find("properties");
    ObjectStyle style = read_object_style(properties == feature.end() ? json() : *properties, complain);
    if (quakes_) style_quake(feature, style);
    const ObjectId id{static_cast<std::uint64_t>(first_) + index};
    file_.next = ObjectId{static_cast<std::uint64_t>(id) + 1};
    name_feature(style, id, properties == feature.end() ? json::object() : *properties);
    if (!style.icon.empty()) set_icon(style, complain);
    if (!style.model.empty()) style.mesh.model = models_.get(style.model, complain);
    add_geometry(*geometry, style, quakes_ ? ThirdCoordinate::depth_km : ThirdCoordinate::height_m, file_.scene,
                 complain);
  }

  /// Takes a bare geometry: a feature without properties.
  void take_geometry(const json& geometry) { take({{"type", "Feature"}, {"geometry", geometry}}, 0); }

  void complain_of(const std::string& what) {
    if (file_.complaints.size() < kMostComplaints) {
      file_.complaints.push_back(fmt::format("{}: {}", where_, what));
    } else {
      ++file_.complaints_left_out;
    }
  }

  void credit(const json& text) {
    if (!text.is_string()) return complain_of("its \"attribution\" is not a text; it is left out");
    file_.attribution = text.get<std::string>();
  }

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  void set_icon(ObjectStyle& style, const Complain& complain) {
    PointObject& point = style.point;
    point.icon.image = icons_.get(style.icon, complain);
    if (!point.icon.image) return;
    const int side_px = std::max(point.icon.image->width_px, point.icon.image->height_px);
    point.size_px = style.icon_size_px.value_or(static_cast<float>(side_px));
  }

  std::string where_;
  ModelShelf models_;
  IconShelf icons_;
  ObjectId first_;
  ObjectFile& file_;
  std::size_t count_ = 0;
  bool quakes_ = false;
};

/// Checks the rest of a document after its features were taken.
Status take_rest(const json& document, FeatureTaker& taker) {
  const std::string type = geojson_type(document);
  if (type.empty()) return Error{"JSON, but no GeoJSON: it has no \"type\"; see RFC 7946"};
  if (type == "FeatureCollection") {
    const auto features = document.find("features");
    if (features == document.end() || !features->is_array()) return Error{"a FeatureCollection without \"features\""};
    return Done{};
  }
  if (type == "Feature") return taker.take(document, 0), Done{};
  taker.take_geometry(document);
  return Done{};
}

}  // namespace

Result<ObjectFile> parse_geojson_objects(std::istream& text, const std::string& where,
                                         const std::filesystem::path& folder, ObjectId first) {
  ObjectFile file;
  FeatureTaker taker(where, folder, first, file);
  const auto broken = [&](const std::string& what) -> Result<ObjectFile> {
    if (file.scene.empty()) return Error{fmt::format("{}: {}", where, what)};
    taker.complain_of(fmt::format("{}; the {} features before are drawn", what, taker.count()));
    return std::move(file);
  };
  const Result<json> document = parse_json(
      text, {.depth = kJsonLimits.depth, .pieces = kMaxFeatureValues},
      [&taker](std::size_t depth, const std::string& member, json& value) { return taker.keep(depth, member, value); });
  if (!document) return broken(document.error().message + "; a GeoJSON file (RFC 7946) is needed");
  if (const Status rest = take_rest(*document, taker); !rest) return broken(rest.error().message);
  return file;
}

Result<ObjectFile> read_geojson_objects(const std::filesystem::path& path, ObjectId first) {
  std::error_code problem;
  const auto bytes = std::filesystem::file_size(path, problem);
  if (problem) return Error{fmt::format("{}: {}", path.string(), problem.message())};
  if (bytes > kMaxObjectFileBytes) {
    return Error{fmt::format("{}: {} bytes are more than the {} that are read; divide it", path.string(), bytes,
                             kMaxObjectFileBytes)};
  }
  std::ifstream text(path, std::ios::binary);
  if (!text) return Error{fmt::format("{}: it cannot be opened", path.string())};
  return parse_geojson_objects(text, path.string(), path.has_parent_path() ? path.parent_path() : ".", first);
}

}  // namespace terrella
