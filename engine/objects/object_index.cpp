#include "objects/object_index.h"

#include <glm/common.hpp>
#include <utility>

namespace terrella {
namespace {

constexpr double kRootHalf_m = 1.0e9;
constexpr double kSmallestHalf_m = 0.5;
constexpr std::size_t kMostItems = 16;
constexpr double kRootThree = 1.7320508075688773;

}  // namespace

ObjectIndex::ObjectIndex() { nodes_.push_back({glm::dvec3(0.0), kRootHalf_m}); }

bool ObjectIndex::holds(const Node& node, const Ball& ball) {
  const glm::dvec3 off = glm::abs(ball.center_m - node.center_m);
  return off.x <= node.half_m && off.y <= node.half_m && off.z <= node.half_m && ball.radius_m <= node.half_m;
}

std::uint32_t ObjectIndex::node_for(const Ball& ball) const {
  std::uint32_t at = 0;
  if (!holds(nodes_[0], ball)) return at;
  while (nodes_[at].first_child != kNone && ball.radius_m <= 0.5 * nodes_[at].half_m) {
    const glm::dvec3 off = ball.center_m - nodes_[at].center_m;
    at = nodes_[at].first_child + (off.x >= 0.0 ? 1U : 0U) + (off.y >= 0.0 ? 2U : 0U) + (off.z >= 0.0 ? 4U : 0U);
  }
  return at;
}

void ObjectIndex::take_out(const Entry& entry) {
  std::vector<std::uint32_t>& items = nodes_[entry.node].items;
  const std::uint32_t last = items.back();
  items[entry.at] = last;
  entries_[last].at = entry.at;
  items.pop_back();
}

void ObjectIndex::put(std::uint32_t item, const Ball& ball) {
  if (item >= entries_.size()) entries_.resize(item + std::size_t{1});
  Entry& entry = entries_[item];
  entry.ball = ball;
  if (entry.node != kNone) {
    const Node& node = nodes_[entry.node];
    if (entry.node != 0 && node.first_child == kNone && holds(node, ball)) return;
    take_out(entry);
  }
  entry.node = node_for(ball);
  std::vector<std::uint32_t>& items = nodes_[entry.node].items;
  entry.at = static_cast<std::uint32_t>(items.size());
  items.push_back(item);
  if (items.size() > kMostItems && nodes_[entry.node].first_child == kNone) divide(entry.node);
}

void ObjectIndex::remove(std::uint32_t item) {
  if (item >= entries_.size() || entries_[item].node == kNone) return;
  take_out(entries_[item]);
  entries_[item].node = kNone;
}

void ObjectIndex::divide(std::uint32_t node) {
  const double half_m = 0.5 * nodes_[node].half_m;
  if (half_m < kSmallestHalf_m) return;
  nodes_[node].first_child = static_cast<std::uint32_t>(nodes_.size());
  const glm::dvec3 center = nodes_[node].center_m;
  for (unsigned k = 0; k < 8; ++k) {
    const glm::dvec3 side((k & 1U) != 0 ? 1.0 : -1.0, (k & 2U) != 0 ? 1.0 : -1.0, (k & 4U) != 0 ? 1.0 : -1.0);
    nodes_.push_back({center + half_m * side, half_m});
  }
  const std::vector<std::uint32_t> items = std::exchange(nodes_[node].items, {});
  for (const std::uint32_t item : items) {
    Entry& entry = entries_[item];
    entry.node = node_for(entry.ball);
    entry.at = static_cast<std::uint32_t>(nodes_[entry.node].items.size());
    nodes_[entry.node].items.push_back(item);
  }
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t child = nodes_[node].first_child + k;
    if (nodes_[child].items.size() > kMostItems) divide(child);
  }
}

void ObjectIndex::find(const PickCone& cone, std::vector<std::uint32_t>& items) const {
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    const Node& node = nodes_[at];
    open.pop_back();
    if (at != 0 && !cone.meets(node.center_m, (1.0 + kRootThree) * node.half_m)) continue;
    for (const std::uint32_t item : node.items) {
      const Ball& ball = entries_[item].ball;
      if (cone.meets(ball.center_m, ball.radius_m)) items.push_back(item);
    }
    for (std::uint32_t k = 0; node.first_child != kNone && k < 8; ++k) open.push_back(node.first_child + k);
  }
}

}  // namespace terrella
