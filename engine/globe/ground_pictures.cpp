#include "globe/ground_pictures.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "surface/view_planes.h"

namespace terrella {
namespace {

/// A frame asks for this many pictures at once.
constexpr std::size_t kMostJobs = 48;
constexpr std::size_t kManyEntries = 4096, kManyAnswers = 65536;
/// A patch is shown by at most 2^this pictures a side.
constexpr int kMostDepth = 6;
/// Slopes of relief stretch pixels further.
constexpr double kLeastStretch = 2.0, kLeastStretchOnRelief = 8.0, kMostStretch = 64.0;
/// Pixels of ground whose normal has a smaller cosine towards the eye are clearly longer than wide.
constexpr double kSlanted = 0.55;
/// Texels may be this many pixels wide.
constexpr double kMostTexel_px = 1.4;
constexpr double kMostCoarser = 1e3;
constexpr std::size_t kManyChanges = 4096;
constexpr int kMostHalvings = 12;  // GroundFrame::cells

}  // namespace

void GroundPictures::mark(CubeFace face, const FaceBox& box) {
  if (box.empty()) return;
  for (auto& [id, entry] : entries_) {
    if (id.face == face && box_of(square_of(id), GroundPicture::kMostReach_px).meets(box)) entry.changed = revision_;
  }
}

void GroundPictures::mark(const Boxes& boxes) {
  for (int f = 0; f < kCubeFaces; ++f) mark(static_cast<CubeFace>(f), boxes[static_cast<std::size_t>(f)]);
}

bool GroundPictures::follow(const std::vector<DrawnLayer>& layers) {
  const std::vector<Layer> before = std::exchange(layers_, {});
  ++revision_;
  bool any = false;
  for (const DrawnLayer& drawn : layers) {
    GroundBatch& batch = drawn.objects->batches().ground;
    std::vector<std::pair<CubeFace, FaceBox>> changes = batch.take_changes();
    if (batch.empty() && changes.empty()) continue;
    Layer layer{drawn.objects->serial(), {}, &batch};
    const auto old = std::ranges::find(before, layer.serial, &Layer::serial);
    if (!changes.empty() || old == before.end()) {
      for (const auto& chunk : batch.chunks()) {
        for (std::size_t f = 0; f < kCubeFaces; ++f) layer.boxes[f].add(chunk->boxes[f]);
      }
      Boxes changed;
      for (const auto& [face, box] : changes) changed[static_cast<std::size_t>(face)].add(box);
      if (changes.size() > kManyChanges || old == before.end()) mark(changed), changes.clear();
      for (const auto& [face, box] : changes) mark(face, box);
      any = true;
    } else {
      layer.boxes = old->boxes;
    }
    layers_.push_back(layer);
  }
  if (!std::ranges::equal(before, layers_, {}, &Layer::serial, &Layer::serial)) {
    for (const Layer& layer : before) mark(layer.boxes);
    for (const Layer& layer : layers_) mark(layer.boxes);
    any = true;
  }
  if (any) meets_.clear();
  return any;
}

bool GroundPictures::meets(const PatchId& id) {
  if (meets_.size() > kManyAnswers) meets_.clear();
  const auto [at, is_new] = meets_.try_emplace(id, false);
  if (!is_new) return at->second;
  const FaceBox box = box_of(square_of(id), GroundPicture::kMostReach_px);
  const auto f = static_cast<std::size_t>(id.face);
  for (const Layer& layer : layers_) {
    if (!layer.boxes[f].meets(box)) continue;
    at->second =
        std::ranges::any_of(layer.batch->chunks(), [&](const auto& chunk) { return chunk->boxes[f].meets(box); });
    if (at->second) return true;
  }
  return false;
}

bool GroundPictures::evict(std::uint64_t frame) {
  auto oldest = entries_.end();
  for (auto it = entries_.begin(); it != entries_.end(); ++it) {
    const Entry& entry = it->second;
    if (entry.slots.fill < 0 && entry.slots.line < 0) continue;
    if (oldest == entries_.end() || entry.needed < oldest->second.needed) oldest = it;
  }
  if (oldest == entries_.end() || oldest->second.needed + 1 >= frame) return false;
  textures_.release(oldest->second.slots);
  entries_.erase(oldest);
  return true;
}

std::size_t GroundPictures::take_painted(std::uint64_t frame) {
  const std::vector<PaintedGround> all = painter_.take();
  for (const PaintedGround& painted : all) {
    if (!painted.is_painted) continue;  // the next frame wants it again
    Entry& entry = entries_[painted.id];
    GroundSlots slots = std::exchange(entry.slots, {});
    bool there = textures_.put(painted.picture, slots);
    while (!there && evict(frame)) there = textures_.put(painted.picture, slots);
    Entry& now = entries_[painted.id];
    now.slots = slots;
    now.made = true;  // without room, parts of it are not drawn
    now.reach_px = painted.picture.reach_px;
    now.stretch = painted.stretch;
    now.revision = painted.revision;
  }
  if (entries_.size() > kManyEntries) {
    std::erase_if(entries_, [&](const auto& one) {
      return one.second.slots.fill < 0 && one.second.slots.line < 0 && one.second.needed + 1 < frame;
    });
  }
  return all.size();
}

GroundJob GroundPictures::job(const ViewGround::Want& want) const {
  GroundJob job{want.id, {}, want.stretch, revision_};
  const FaceBox box = box_of(square_of(want.id), GroundPicture::kMostReach_px);
  const auto f = static_cast<std::size_t>(want.id.face);
  for (const Layer& layer : layers_) {
    GroundChunks& chunks = job.layers.emplace_back();
    for (const auto& chunk : layer.batch->chunks()) {
      if (chunk->boxes[f].meets(box)) chunks.push_back(chunk);
    }
  }
  return job;
}

void GroundPictures::ask(const std::vector<const ViewGround*>& views) {
  std::deque<GroundJob> jobs;
  for (const bool urgent : {true, false}) {
    for (const ViewGround* view : views) {
      for (const ViewGround::Want& want : view->wants) {
        if (want.urgent == urgent && jobs.size() < kMostJobs && !painter_.is_painting(want.id))
          jobs.push_back(job(want));
      }
    }
  }
  painter_.ask(std::move(jobs));
}

/// Plans one view.
class GroundPictures::Planner {
 public:
  Planner(GroundPictures& pictures, const GroundView& view, double coarser)
      : pictures_(pictures),
        view_(view),
        coarser_(coarser),
        room_(static_cast<std::size_t>(pictures.textures_.capacity())),
        planes_(view_planes(view.view)) {}

  /// True if the pictures that the view needs are not more than there is room for.
  [[nodiscard]] bool has_room() {
    for (const SelectedPatch& patch : view_.patches) {
      patch_ = &patch;
      visit(patch.node->id, 0, nullptr);
    }
    return std::exchange(needs_, 0) <= room_;
  }

  void add(const SelectedPatch& patch, ViewGround& out) {
    leaves_.clear();
    deepest_ = 0;
    slanted_ = false;
    patch_ = &patch;
    visit(patch.node->id, 0, &out);
    glm::uvec4 window(0);
    if (!leaves_.empty()) {
      window = {out.frame.cells.size(), deepest_, 0, 0};
      const auto side = std::size_t{1} << static_cast<unsigned>(deepest_);
      out.frame.cells.resize(out.frame.cells.size() + side * side, {0xFFFFFFFFU, 0U});
      for (const Leaf& leaf : leaves_) put(leaf, window, side, out.frame.cells.data() + window.x);
      if (window.z != 0 && slanted_) window.z |= 4U;
    }
    out.frame.windows.push_back(window);
  }

 private:
  /// A part of the patch, and the picture that shows it.
  struct Leaf {
    PatchId id;
    int depth = 0;
    const Entry* entry = nullptr;
    int up = 0;  ///< levels from `id` up to the picture's square
  };

  // The ground of a square: the middle, and the distance of its farthest corner.
  BoundingSphere sphere_of(const PatchId& id, glm::dvec3& up) const {
    const PatchRelief& relief = patch_->node->relief;
    const Ellipsoid& e = view_.tree.ellipsoid();
    std::array<glm::dvec3, 4> corners;
    BoundingSphere sphere;
    up = patch_point(id, 1, 1, 2).xyz;
    for (int k = 0; k < 4; ++k) {
      corners[static_cast<std::size_t>(k)] = e.position(patch_point(id, k % 2, k / 2, 1), relief.middle_m).xyz_m;
    }
    sphere.center_m = e.position(EcefDir{up}, relief.middle_m).xyz_m;
    for (const glm::dvec3& p : corners) sphere.radius_m = std::max(sphere.radius_m, glm::distance(p, sphere.center_m));
    sphere.radius_m += relief.half_m;
    return sphere;
  }

  void visit(const PatchId& id, int depth, ViewGround* out) {
    if (needs_ > room_ || !pictures_.meets(id)) return;
    glm::dvec3 up;
    const BoundingSphere sphere = sphere_of(id, up);
    if (depth > 0 && classify(planes_, view_.view, sphere) < 0) return;
    const glm::dvec3 to_eye = view_.view.eye.xyz_m - sphere.center_m;
    const double away_m = glm::length(to_eye), per_px = 1.0 / view_.view.pixels_per_radian();
    // An eye among the heights of relief is in the spheres of many squares.
    const double half_m = patch_->node->relief.half_m, flat_m = sphere.radius_m - half_m;
    const double least_m = away_m > 1.5 * flat_m ? 0.2 * away_m : view_.clearance_m;
    const double pixel_m = std::max(away_m - flat_m - std::min(half_m, 0.5 * away_m), least_m) * per_px * coarser_;
    const double side_m = std::sqrt(2.0) * flat_m;
    if (side_m > kMostTexel_px * GroundPicture::kInner_px * pixel_m && depth < kMostDepth &&
        id.level < kMaxPatchLevel) {
      for (const PatchId& child : children(id)) visit(child, depth + 1, out);
      return;
    }
    ++needs_;
    if (out == nullptr) return;
    const double cosine = std::abs(glm::dot(up, to_eye)) / away_m;
    slanted_ = slanted_ || cosine < kSlanted || view_.has_relief;
    // Texels under a pixel, where it is longest.
    const double texels = GroundPicture::kInner_px * pixel_m / side_m;
    need(id, depth, 1.25 * std::max(texels, 1.0) / std::max(cosine, 1e-3), *out);
  }

  void need(const PatchId& id, int depth, double stretch, ViewGround& out) {
    double least = view_.has_relief ? kLeastStretchOnRelief : kLeastStretch;
    const double wish = std::min(kMostStretch, stretch);
    while (least < wish) least *= 2.0;
    Entry& entry = pictures_.entries_[id];
    entry.needed = view_.frame;
    bool shown = true;
    if (entry.made) {
      take({id, depth, &entry, 0});
    } else {
      shown = show_finer(id, depth) || show_coarser(id, depth);
    }
    if (!entry.made || entry.is_stale() || entry.stretch < least) out.wants.push_back({id, least, !shown});
  }

  void take(const Leaf& leaf) {
    deepest_ = std::max(deepest_, leaf.depth);
    leaves_.push_back(leaf);
  }

  bool show_finer(const PatchId& id, int depth) {
    if (depth == kMostDepth || id.level == kMaxPatchLevel) return false;
    std::array<Entry*, 4> found{};
    const std::array<PatchId, 4> parts = children(id);
    bool any = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = pictures_.entries_.find(parts[k]);
      if (at != pictures_.entries_.end() && at->second.made) found[k] = &at->second, any = true;
      if (found[k] == nullptr && pictures_.meets(parts[k]) && !any) return false;
    }
    if (!any) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      if (found[k] == nullptr) continue;
      found[k]->needed = view_.frame;
      take({parts[k], depth + 1, found[k], 0});
    }
    return true;
  }

  bool show_coarser(const PatchId& id, int depth) {
    PatchId over = id;
    for (int up = 1; over.level > 0 && up <= kMostHalvings - kMostDepth; ++up) {
      over = parent(over);
      const auto at = pictures_.entries_.find(over);
      if (at == pictures_.entries_.end() || !at->second.made) continue;
      at->second.needed = view_.frame;
      take({id, depth, &at->second, up});
      return true;
    }
    return false;
  }

  void put(const Leaf& leaf, glm::uvec4& window, std::size_t side, glm::uvec2* cells) const {
    const GroundSlots& slots = leaf.entry->slots;
    if (slots.fill < 0 && slots.line < 0) return;
    window.z |= (slots.fill >= 0 ? 1U : 0U) | (slots.line >= 0 ? 2U : 0U);
    const auto more = static_cast<unsigned>(deepest_ - leaf.depth), up = static_cast<unsigned>(leaf.up);
    const std::uint32_t across = 1U << more, below = (1U << up) - 1U;
    const std::uint32_t x0 = (leaf.id.x << more) - (patch_->node->id.x << static_cast<unsigned>(deepest_)),
                        y0 = (leaf.id.y << more) - (patch_->node->id.y << static_cast<unsigned>(deepest_));
    const auto word = static_cast<std::uint32_t>(slots.fill & 0xFFFF) | static_cast<std::uint32_t>(slots.line) << 16U;
    const auto reach = static_cast<std::uint32_t>(std::lround(std::log2(leaf.entry->reach_px))) - 2U;
    for (std::uint32_t y = 0; y < across; ++y) {
      for (std::uint32_t x = 0; x < across; ++x) {
        const std::uint32_t column = ((leaf.id.x & below) << more) + x, row = ((leaf.id.y & below) << more) + y;
        cells[(y0 + y) * side + x0 + x] = {word, (more + up) | column << 4U | row << 16U | reach << 28U};
      }
    }
  }

  GroundPictures& pictures_;
  const GroundView& view_;
  double coarser_;
  std::size_t room_;
  ViewPlanes planes_;
  const SelectedPatch* patch_ = nullptr;
  std::vector<Leaf> leaves_;
  int deepest_ = 0;
  bool slanted_ = false;
  std::size_t needs_ = 0;
};

// A view that needs more pictures than there is room for takes coarser ones.
void GroundPictures::plan(const GroundView& view, ViewGround& out) {
  out.frame.textures = &textures_;
  out.frame.windows.clear();
  out.frame.cells.clear();
  out.wants.clear();
  double coarser = 1.0;
  while (coarser < kMostCoarser && !Planner(*this, view, coarser).has_room()) coarser *= 1.5;
  Planner planner(*this, view, coarser);
  for (const SelectedPatch& patch : view.patches) planner.add(patch, out);
}

}  // namespace terrella
