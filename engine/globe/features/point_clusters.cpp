#include "globe/features/point_clusters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/range_check.h"
#include "geo/ellipsoid.h"
#include "objects/cluster/point_tree.h"

namespace terrella {
namespace {

/// The id of a cluster is this and the index of its node.
constexpr std::uint64_t kFirstId = std::uint64_t{1} << 62;

ObjectId id_of(std::uint32_t node) { return ObjectId{kFirstId + node}; }

/// "7", "1.2k", "35k".
std::string short_number(std::uint32_t count) {
  constexpr std::uint32_t kThousand = 1000;
  if (count < kThousand) return std::to_string(count);
  const double thousands = double(count) / kThousand;
  return thousands < 10.0 ? fmt::format("{:.1f}k", thousands) : fmt::format("{:.0f}k", thousands);
}

/// Adds the disc and the number of a cluster.
void add_disc(ObjectScene& scene, ObjectId id, const Geodetic& place, std::uint32_t count) {
  constexpr float kLeast_px = 22.0F, kTenfold_px = 7.0F;
  constexpr ObjectColor kDisc{38, 92, 150, 235}, kNumber{255, 255, 255};
  constexpr double kPriority = 1e12;  // over the names of places
  auto feature = std::make_shared<ObjectFeature>();
  feature->properties = fmt::format(R"({{"name":"{0} places","point_count":{0}}})", count);
  const ObjectIdentity of{.id = id, .feature = std::move(feature)};
  const float size_px = kLeast_px + kTenfold_px * std::log10(float(count));
  scene.points.push_back(
      {.place = place, .size_px = size_px, .color = kDisc, .of = of, .heights = HeightMode::clamp_to_ground});
  scene.labels.push_back({.text = short_number(count),
                          .place = place,
                          .color = kNumber,
                          .size_px = size_px,
                          .priority = kPriority,
                          .of = of,
                          .heights = HeightMode::clamp_to_ground,
                          .look = {.text_px = 13.0F, .halo_px = 0.0F, .anchor = TextAnchor::center}});
}

/// The numbers of `all` that `some` lacks; each in ascending order.
std::vector<std::uint32_t> missing_in(const std::vector<std::uint32_t>& some, const std::vector<std::uint32_t>& all) {
  std::vector<std::uint32_t> missing;
  std::ranges::set_difference(all, some, std::back_inserter(missing));
  return missing;
}

/// 0, 1, …
std::vector<std::uint32_t> numbers_to(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

}  // namespace

std::vector<ClusterPoint> cluster_points(const ObjectScene& scene) {
  std::map<ObjectId, const PointObject*> points;  // null: it has another part
  const auto leave_out = [&points](const auto& objects) {
    for (const auto& object : objects) points[object.of.id] = nullptr;
  };
  for (const PointObject& point : scene.points) {
    const bool is_first = points.emplace(point.of.id, &point).second;
    if (!is_first || point.radius_m > 0.0) points[point.of.id] = nullptr;
  }
  leave_out(scene.lines);
  leave_out(scene.polygons);
  leave_out(scene.meshes);
  points.erase(ObjectId::none);
  std::vector<ClusterPoint> found;
  for (const auto& [id, point] : points) {
    if (point != nullptr && static_cast<std::uint64_t>(id) < kFirstId) found.push_back({id, point->place});
  }
  return found;
}

struct PointClusters::State {
  LayerId layer;
  double radius_px;
  std::vector<ObjectId> ids;  ///< features of the tree's points
  PointTree tree;
  std::vector<std::uint32_t> singles = {};  ///< points that are shown, in ascending order
  std::vector<std::uint32_t> discs = {};    ///< nodes that are drawn, in ascending order
  std::optional<Camera> camera = {};        ///< camera of the last update
  Viewport picture = {};                    ///< picture of the last update

  /// Shows these nodes, in ascending order, instead of the present ones.
  void show(std::vector<std::uint32_t> points, std::vector<std::uint32_t> groups, ObjectEdits& edits) {
    for (const std::uint32_t point : missing_in(points, singles)) {
      edits.changes.push_back({.id = ids[point], .visible = false});
    }
    for (const std::uint32_t point : missing_in(singles, points)) {
      edits.changes.push_back({.id = ids[point], .visible = true});
    }
    for (const std::uint32_t node : missing_in(groups, discs)) edits.remove.push_back(id_of(node));
    for (const std::uint32_t node : missing_in(discs, groups)) {
      const PointTree::Node& group = tree.nodes()[node];
      add_disc(edits.add, id_of(node), Ellipsoid::lat_lon(EcefDir{group.normal}), group.count);
    }
    singles = std::move(points);
    discs = std::move(groups);
  }
};

PointClusters::PointClusters(std::unique_ptr<State> state) : state_(std::move(state)) {}
PointClusters::PointClusters(PointClusters&&) noexcept = default;
PointClusters& PointClusters::operator=(PointClusters&&) noexcept = default;
PointClusters::~PointClusters() = default;

Result<PointClusters> PointClusters::make(LayerId layer, std::span<const ClusterPoint> points, double radius_px) {
  if (Status good = RangeCheck().in("the radius", radius_px, kLeastRadius_px, kMostRadius_px).result(); !good) {
    return Error{"PointClusters::make: " + good.error().message};
  }
  std::vector<ObjectId> ids;
  std::vector<Geodetic> places;
  ids.reserve(points.size());
  places.reserve(points.size());
  for (const ClusterPoint& point : points) {
    ids.push_back(point.id);
    places.push_back(point.place);
  }
  std::vector<std::uint32_t> all = numbers_to(ids.size());
  return PointClusters(std::make_unique<State>(State{.layer = layer,
                                                     .radius_px = radius_px,
                                                     .ids = std::move(ids),
                                                     .tree = PointTree(places),
                                                     .singles = std::move(all)}));
}

Status PointClusters::update(Globe& globe, Viewport picture) {
  if (state_->camera == globe.camera() && state_->picture == picture) return Done{};
  state_->camera = globe.camera();
  state_->picture = picture;
  const View view = globe.view(picture);
  std::vector<std::uint32_t> nodes = state_->tree.cut(view, globe.options().body.ellipsoid, state_->radius_px);
  std::ranges::sort(nodes);  // points come before groups
  const auto first = std::ranges::lower_bound(nodes, state_->tree.points());
  ObjectEdits edits;
  state_->show({nodes.begin(), first}, {first, nodes.end()}, edits);
  const bool is_same = edits.remove.empty() && edits.add.empty() && edits.changes.empty();
  return is_same ? Status(Done{}) : globe.edit_objects(state_->layer, std::move(edits));
}

Status PointClusters::end(Globe& globe) {
  ObjectEdits edits;
  state_->show(numbers_to(state_->ids.size()), {}, edits);
  state_->camera.reset();
  return globe.edit_objects(state_->layer, std::move(edits));
}

std::vector<ObjectId> PointClusters::features_of(ObjectId cluster) const {
  std::vector<ObjectId> ids;
  const std::uint64_t node = static_cast<std::uint64_t>(cluster) - kFirstId;
  if (static_cast<std::uint64_t>(cluster) < kFirstId || node >= state_->tree.nodes().size()) return ids;
  for (const std::uint32_t point : state_->tree.points_of(static_cast<std::uint32_t>(node))) {
    ids.push_back(state_->ids[point]);
  }
  return ids;
}

}  // namespace terrella
