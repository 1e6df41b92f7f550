#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "objects/ground/ground_shape.h"

namespace terrella {

/// A line or an area on the ground as it is drawn. Alpha 0: a part that is not drawn.
struct GroundObject {
  std::shared_ptr<const GroundShape> shape = {};  ///< null: none
  ObjectColor fill{0, 0, 0, 0}, line{0, 0, 0, 0};
  float width_px = 0.0F;
  LineDashes dashes = {};
  ObjectColor casing{0, 0, 0, 0};
  float casing_px = 0.0F;  ///< beyond each side of the line
};

/// Some objects that follow each other, and where they lie on each face. thread: any
struct GroundChunk {
  static constexpr std::size_t kMost = 64;
  std::array<FaceBox, kCubeFaces> boxes;  ///< empty: none lies on the face
  std::vector<GroundObject> objects;
  bool lent = false;  ///< a worker may read the rest. thread: main
  void add_box(const GroundShape& shape) {
    for (const GroundPart& part : shape.parts) boxes[static_cast<std::size_t>(part.face)].add(part.box);
  }
};

/// The objects of a layer that lie on the ground, in the layer's order. A change of a chunk that was lent to workers
/// makes another. thread: any, but one call at a time
class GroundBatch {
 public:
  static constexpr std::uint32_t kNone = ~0U;

  std::uint32_t add(GroundObject object) {
    const auto place = static_cast<std::uint32_t>(size_++);
    if (place / GroundChunk::kMost == chunks_.size()) chunks_.push_back(std::make_shared<GroundChunk>());
    own(place).objects.emplace_back();
    change(place, std::move(object));
    return place;
  }
  [[nodiscard]] const GroundObject& at(std::uint32_t place) const {
    return chunks_[place / GroundChunk::kMost]->objects[place % GroundChunk::kMost];
  }
  void change(std::uint32_t place, GroundObject object) {
    GroundChunk& chunk = own(place);
    GroundObject& at = chunk.objects[place % GroundChunk::kMost];
    note(at);
    if (object.shape && object.shape != at.shape) chunk.add_box(*object.shape);
    live_ = live_ + (object.shape ? 1U : 0U) - (at.shape ? 1U : 0U);
    at = std::move(object);
    note(at);
  }
  [[nodiscard]] bool empty() const { return live_ == 0; }
  [[nodiscard]] const std::vector<std::shared_ptr<GroundChunk>>& chunks() const { return chunks_; }
  /// Returns where something has changed since the last call, and forgets it.
  [[nodiscard]] std::vector<std::pair<CubeFace, FaceBox>> take_changes() { return std::exchange(changes_, {}); }

  void note(std::vector<std::pair<CubeFace, FaceBox>> changes) {
    changes_.insert(changes_.end(), changes.begin(), changes.end());
  }

 private:
  GroundChunk& own(std::uint32_t place) {
    std::shared_ptr<GroundChunk>& chunk = chunks_[place / GroundChunk::kMost];
    if (!chunk->lent) return *chunk;
    auto copy = std::make_shared<GroundChunk>();
    copy->objects = chunk->objects;
    for (const GroundObject& object : copy->objects) {
      if (object.shape) copy->add_box(*object.shape);
    }
    chunk = std::move(copy);
    return *chunk;
  }
  void note(const GroundObject& object) {
    if (!object.shape) return;
    for (const GroundPart& part : object.shape->parts) changes_.emplace_back(part.face, part.box);
  }

  std::vector<std::shared_ptr<GroundChunk>> chunks_;
  std::vector<std::pair<CubeFace, FaceBox>> changes_;
  std::size_t size_ = 0, live_ = 0;
};

}  // namespace terrella
