#include "streaming/objects/feature_taker.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/objects/feature_objects.h"
#include "streaming/objects/model_folder.h"
#include "streaming/objects/quake_catalogue.h"
#include "streaming/objects/style_rules.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

/// Reads icons in or below a folder.
IconShelf::ReadPicture reader_in(const std::filesystem::path& folder) {
  return [folder](const std::string& name) -> Result<std::vector<std::byte>> {
    const auto path = path_in_folder(folder, name);
    if (!path) return path.error();
    auto bytes = read_file(*path, kMostIconBytes);
    if (!bytes) return Error{bytes.error().message};
    return *std::move(bytes);
  };
}

/// Names the objects of a feature, and gives them its properties.
void name_feature(ObjectStyle& style, ObjectId id, const json& properties) {
  auto feature = std::make_shared<ObjectFeature>();
  feature->properties = properties.dump(-1, ' ', false, json::error_handler_t::replace);
  style.point.of = style.line.of = style.polygon.of = style.label.of =
      style.mesh.of = {.id = id, .feature = std::move(feature)};
}

}  // namespace

FeatureTaker::FeatureTaker(std::string where, const std::filesystem::path& folder, ObjectId first, ObjectFile& file)
    : where_(std::move(where)), models_(folder), icons_(reader_in(folder)), first_(first), file_(file) {
  file_.next = first;
}

void FeatureTaker::take(const json& feature, std::size_t index) {
  const Complain complain = [&](const std::string& what) {
    complain_of(fmt::format("{}: {}", feature_name(feature, index), what));
  };
  if (geojson_type(feature) != "Feature") return complain("not a Feature; it is left out");
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end()) return complain("it has no \"geometry\"");
  if (geometry->is_null()) return;
  const auto properties = feature.find("properties");
  const json none = json::object();
  const json& fields = properties == feature.end() ? none : *properties;
  ObjectStyle style =
      style_.is_none() ? read_object_style(fields, complain) : read_object_style(applied(style_, fields), complain);
  if (quakes_ && style_.is_none()) style_quake(feature, style);
  const ObjectId id{static_cast<std::uint64_t>(first_) + index};
  file_.next = ObjectId{static_cast<std::uint64_t>(id) + 1};
  name_feature(style, id, fields);
  style.shown.id = id;
  if (!is_always_shown(style.shown)) file_.shown_when.push_back(style.shown);
  if (!style.icon.empty()) set_icon(style, complain);
  if (!style.model.empty()) style.mesh.model = models_.get(style.model, complain);
  add_geometry(*geometry, style, quakes_ ? ThirdCoordinate::depth_km : ThirdCoordinate::height_m, file_.scene,
               complain);
}

void FeatureTaker::complain_of(const std::string& what) {
  if (file_.complaints.size() < kMostComplaints) {
    file_.complaints.push_back(fmt::format("{}: {}", where_, what));
  } else {
    ++file_.complaints_left_out;
  }
}

void FeatureTaker::set_icon(ObjectStyle& style, const Complain& complain) {
  PointObject& point = style.point;
  point.icon.image = icons_.get(style.icon, complain);
  if (!point.icon.image) return;
  const int side_px = std::max(point.icon.image->width_px, point.icon.image->height_px);
  point.size_px = style.icon_size_px.value_or(static_cast<float>(side_px));
}

}  // namespace terrella
