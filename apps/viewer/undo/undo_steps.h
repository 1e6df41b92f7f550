#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace terrella {

/// Steps that the user takes back and makes again, at most kMostSteps of them. thread: any, but one call at a time
template <class Step>
class UndoSteps {
 public:
  static constexpr std::size_t kMostSteps = 100;

  /// Adds a step that was made, and forgets the steps that were taken back.
  void add(Step step) {
    steps_.resize(made_);
    steps_.push_back(std::move(step));
    if (steps_.size() > kMostSteps) steps_.erase(steps_.begin());
    made_ = steps_.size();
  }
  /// Returns the step to take back; null if there is none.
  [[nodiscard]] Step* undo() { return made_ > 0 ? &steps_[--made_] : nullptr; }
  /// Returns the step to make again; null if there is none.
  [[nodiscard]] Step* redo() { return made_ < steps_.size() ? &steps_[made_++] : nullptr; }

 private:
  std::vector<Step> steps_;
  std::size_t made_ = 0;  ///< the steps after them were taken back
};

}  // namespace terrella
