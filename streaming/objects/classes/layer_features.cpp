#include "streaming/objects/classes/layer_features.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace terrella {
namespace {

/// True if one edit cannot give all objects of a feature their own colours.
bool is_mixed(const FeatureParts& feature) { return feature.has_point + feature.has_line + feature.has_area > 1; }

/// Finds features by their ids.
class Features {
 public:
  explicit Features(const std::vector<FeatureParts>& parts) : parts_(parts) {}

  /// The number of a feature; that of all features if no feature has the id.
  [[nodiscard]] std::size_t find(ObjectId id) const {
    const auto at = std::ranges::lower_bound(parts_, id, {}, [](const FeatureParts& one) { return one.of.id; });
    return at != parts_.end() && at->of.id == id ? static_cast<std::size_t>(at - parts_.begin()) : parts_.size();
  }
  [[nodiscard]] bool is_mixed(ObjectId id) const {
    const std::size_t k = find(id);
    return k < parts_.size() && terrella::is_mixed(parts_[k]);
  }

 private:
  const std::vector<FeatureParts>& parts_;
};

/// A size of 0, which an edit cannot give, hides the line.
void set_size(ObjectChange& change, float size_px) {
  if (size_px > 0.0F) change.size_px = size_px;
  if (size_px <= 0.0F && change.color) change.color->alpha = 0;
}

void keep(ObjectChange& change, const PointObject& point) {
  change.color = point.icon.image ? point.icon.tint : point.color;
  set_size(change, point.size_px);
}

void keep(ObjectChange& change, const LineObject& line) {
  change.color = line.color;
  set_size(change, line.width_px);
}

void keep(ObjectChange& change, const PolygonObject& area) {
  change.color = area.stroke;
  change.fill = area.fill;
  set_size(change, area.stroke_width_px);
}

void keep(ObjectChange& change, const LabelObject& label) {
  change.label = label.color;
  change.look = label.look;
}

template <class Object>
void keep_all(const Features& features, const std::vector<Object>& objects, std::vector<ObjectChange>& changes) {
  for (const Object& object : objects) {
    const std::size_t k = features.find(object.of.id);
    if (k < changes.size()) keep(changes[k], object);
  }
}

template <class Object>
void copy_mixed(const Features& features, const std::vector<Object>& from, std::vector<Object>& to) {
  std::ranges::copy_if(from, std::back_inserter(to),
                       [&features](const Object& object) { return features.is_mixed(object.of.id); });
}

}  // namespace

LayerFeatures layer_features(const ObjectScene& scene, FeatureStyle style) {
  LayerFeatures all{.parts = features_of(scene), .style = std::move(style)};
  const Features features(all.parts);
  std::vector<ObjectChange> changes;
  changes.reserve(all.parts.size());
  for (const FeatureParts& feature : all.parts) changes.push_back({.id = feature.of.id});
  keep_all(features, scene.points, changes);
  keep_all(features, scene.lines, changes);
  keep_all(features, scene.polygons, changes);
  keep_all(features, scene.labels, changes);
  std::erase_if(changes, [&features](const ObjectChange& change) { return features.is_mixed(change.id); });
  all.own.changes = std::move(changes);
  for (const FeatureParts& feature : all.parts) {
    if (is_mixed(feature)) all.own.remove.push_back(feature.of.id);
  }
  copy_mixed(features, scene.points, all.own.add.points);
  copy_mixed(features, scene.lines, all.own.add.lines);
  copy_mixed(features, scene.polygons, all.own.add.polygons);
  copy_mixed(features, scene.labels, all.own.add.labels);
  copy_mixed(features, scene.meshes, all.own.add.meshes);
  return all;
}

}  // namespace terrella
