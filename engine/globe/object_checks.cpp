#include "globe/object_checks.h"

#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

#include "globe/object_ranges.h"
#include "objects/layer_objects.h"

namespace terrella {
namespace {

Status count_icons(const std::vector<PointObject>& points, const LayerObjects* there) {
  std::unordered_set<const IconImage*> icons;
  if (there != nullptr) {
    for (const auto& image : there->batches().icon_images) icons.insert(image.get());
  }
  for (const PointObject& point : points) {
    if (point.icon.image) icons.insert(point.icon.image.get());
  }
  if (icons.size() <= kMostIcons) return Done{};
  return Error{
      fmt::format("{} different icons in a layer are more than {}; let points share an IconImage, or divide the "
                  "layer",
                  icons.size(), kMostIcons)};
}

/// The features that ids name. An id may have parts with the same data, and parts without data.
class FeatureNames {
 public:
  FeatureNames(const LayerObjects* there, std::span<const ObjectId> removed) : there_(there) {
    for (const ObjectId id : removed) names_[static_cast<std::uint64_t>(id)] = nullptr;
  }
  /// False if the id already names another feature.
  bool take(const ObjectIdentity& of) {
    if (!of.feature || of.id == ObjectId::none) return true;
    const auto [found, is_new] = names_.try_emplace(static_cast<std::uint64_t>(of.id), nullptr);
    if (is_new && there_ != nullptr) found->second = there_->feature(of.id);
    const ObjectFeature* before = found->second;
    if (before == nullptr) found->second = of.feature.get();
    return before == nullptr || before == of.feature.get() ||
           (before->user == of.feature->user && before->properties == of.feature->properties);
  }

 private:
  const LayerObjects* there_;
  std::unordered_map<std::uint64_t, const ObjectFeature*> names_;
};

template <class Objects>
Status check_ids(const Objects& objects, FeatureNames& names) {
  for (const auto& object : objects) {
    if (names.take(object.of)) continue;
    return Error{
        fmt::format("the id {} names two features with different data; give one of them another id, such as by "
                    "`first` of read_geojson_objects()",
                    static_cast<std::uint64_t>(object.of.id))};
  }
  return Done{};
}

}  // namespace

Status check_objects(const ObjectScene& added, const LayerObjects* there, std::span<const ObjectId> removed) {
  if (Status good = check_values(added); !good) return good;
  if (Status good = count_icons(added.points, there); !good) return good;
  FeatureNames names(there, removed);
  if (Status good = check_ids(added.points, names); !good) return good;
  if (Status good = check_ids(added.lines, names); !good) return good;
  if (Status good = check_ids(added.polygons, names); !good) return good;
  if (Status good = check_ids(added.meshes, names); !good) return good;
  return check_ids(added.labels, names);
}

}  // namespace terrella
