#include "globe/ground_pictures.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

/// A frame asks for this many pictures at once.
constexpr std::size_t kMostJobs = 48;
constexpr std::size_t kManyEntries = 4096, kManyAnswers = 65536;
constexpr std::size_t kManyChanges = 4096;

}  // namespace

void GroundPictures::set_budget(std::size_t bytes) {
  if (!textures_.set_budget(bytes)) forget_all();
}

void GroundPictures::forget_all() {
  for (auto& [id, entry] : entries_) {
    entry.slots = {};
    entry.made = false;
  }
}

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

// Pictures that stand in for others are evicted last, or a view could keep so many that there is no room for its own.
bool GroundPictures::evict() {
  Entry* oldest = nullptr;
  for (auto& [id, entry] : entries_) {
    if (!entry.slots.any() || is_needed(entry)) continue;
    if (oldest == nullptr || entry.shown < oldest->shown) oldest = &entry;
  }
  if (oldest == nullptr) return false;
  textures_.release(oldest->slots);
  oldest->made = false;
  return true;
}

bool GroundPictures::put(const GroundPicture& picture, Entry& entry) {
  if (!textures_.admit(picture)) forget_all();
  GroundSlots slots = std::exchange(entry.slots, {});  // not to be evicted
  bool there = textures_.put(picture, slots);
  while (!there && evict()) there = textures_.put(picture, slots);
  if (!there) textures_.release(slots);
  entry.slots = slots;
  return there;
}

std::size_t GroundPictures::take_painted() {
  const std::vector<PaintedGround> all = painter_.take();
  for (const PaintedGround& painted : all) {
    if (!painted.is_painted) continue;  // the next frame wants it again
    Entry& entry = entries_[painted.id];
    entry.made = put(painted.picture, entry);
    entry.reach_px = painted.picture.reach_px;
    entry.stretch = painted.stretch;
    entry.revision = painted.revision;
  }
  if (entries_.size() > kManyEntries) {
    std::erase_if(entries_, [&](const auto& one) {
      return !one.second.slots.any() && !is_needed(one.second) && !painter_.is_painting(one.first);
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
      if (!chunk->boxes[f].meets(box)) continue;
      chunk->lent = true;
      chunks.push_back(chunk);
    }
  }
  return job;
}

void GroundPictures::ask(const std::vector<const ViewGround*>& views) {
  std::deque<GroundJob> jobs;
  views_ = 0;
  pixels_ = 0.0;
  const auto is_drawn = [&](const ViewGround* view) { return view->planned + turns(views.size()) > plans_; };
  for (const ViewGround* view : views) {
    if (!is_drawn(view)) continue;
    ++views_;
    pixels_ += view->pixels;
  }
  for (const bool urgent : {true, false}) {
    for (const ViewGround* view : views) {
      for (const ViewGround::Want& want : view->wants) {
        if (want.urgent != urgent || jobs.size() == kMostJobs || !is_drawn(view)) continue;
        if (!entries_[want.id].serves(want.stretch) && !painter_.is_painting(want.id)) jobs.push_back(job(want));
      }
    }
  }
  painter_.ask(std::move(jobs));
}

}  // namespace terrella
