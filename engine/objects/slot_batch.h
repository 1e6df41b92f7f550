#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "objects/object_batches.h"

namespace terrella {

/// The parts of a list that changed and are not on the GPU yet. thread: any, but one call at a time
class ChangedRanges {
 public:
  struct Range {
    std::size_t first = 0, end = 0;
  };
  void note(std::size_t first, std::size_t count) {
    if (count == 0) return;
    if (!ranges_.empty() && first >= ranges_.back().first && first <= ranges_.back().end) {
      ranges_.back().end = std::max(ranges_.back().end, first + count);
    } else {
      ranges_.push_back({first, first + count});
    }
  }
  [[nodiscard]] bool empty() const { return ranges_.empty(); }
  void forget() { ranges_.clear(); }
  /// Returns the changed ranges in order, and forgets them. Ranges at most `gap` apart are one range.
  [[nodiscard]] std::vector<Range> take(std::size_t gap) {
    std::ranges::sort(ranges_, {}, &Range::first);
    std::vector<Range> joined;
    for (const Range& range : ranges_) {
      if (!joined.empty() && range.first <= joined.back().end + gap) {
        joined.back().end = std::max(joined.back().end, range.end);
      } else {
        joined.push_back(range);
      }
    }
    ranges_.clear();
    return joined;
  }

 private:
  std::vector<Range> ranges_;
};

/// The items of one object in a SlotBatch. Without items, the object is not drawn.
struct Slot {
  std::uint32_t first = 0, count = 0;
  std::uint8_t bucket = 0;
};

/// Items of one kind in the layout for the GPU, in the buckets of Batch. An object's items are contiguous and keep
/// their place, so that a change of one object is a change of its range. thread: any, but one call at a time
template <class T>
class SlotBatch {
 public:
  struct Bucket {
    std::vector<T> items;
    ChangedRanges changed;
    std::size_t live = 0;  ///< items that are not dropped
  };
  /// Appends an object's items.
  Slot add(std::size_t bucket, std::span<const T> items) {
    Bucket& to = buckets_[bucket];
    const Slot slot{static_cast<std::uint32_t>(to.items.size()), static_cast<std::uint32_t>(items.size()),
                    static_cast<std::uint8_t>(bucket)};
    to.items.insert(to.items.end(), items.begin(), items.end());
    to.changed.note(slot.first, slot.count);
    to.live += slot.count;
    return slot;
  }
  /// Returns an object's items, which the caller changes.
  [[nodiscard]] std::span<T> change(const Slot& slot) {
    Bucket& in = buckets_[slot.bucket];
    in.changed.note(slot.first, slot.count);
    return std::span(in.items).subspan(slot.first, slot.count);
  }
  /// Drops an object's items. They stay where they are, but are not drawn.
  void drop(Slot& slot) {
    for (T& item : change(slot)) {
      if constexpr (requires { item.color.alpha; }) {
        item.color.alpha = 0;
      } else {
        item.ecef_from_model = {};
      }
    }
    buckets_[slot.bucket].live -= slot.count;
    slot = {};
  }
  [[nodiscard]] std::span<const T> at(const Slot& slot) const {
    return std::span(buckets_[slot.bucket].items).subspan(slot.first, slot.count);
  }
  [[nodiscard]] bool has(ObjectPart part) const {
    const std::size_t first = part == ObjectPart::above_ground ? 4 : 0;
    for (std::size_t k = first; k < first + 4; ++k) {
      if (buckets_[k].live > 0) return true;
    }
    return false;
  }
  [[nodiscard]] Bucket& bucket(std::size_t k) { return buckets_[k]; }
  [[nodiscard]] const Bucket& bucket(std::size_t k) const { return buckets_[k]; }

 private:
  std::array<Bucket, Batch<T>::kBuckets> buckets_;
};

/// Buckets that a draw takes, in order: from `first` to before `end`.
struct BucketRange {
  std::size_t first, end;
};
[[nodiscard]] inline BucketRange buckets_of(ObjectPart part, bool opaque, ObjectChoice choice) {
  return {Batch<char>::bucket(part, opaque, choice == ObjectChoice::chosen),
          Batch<char>::bucket(part, opaque, choice != ObjectChoice::others) + 1};
}

}  // namespace terrella
