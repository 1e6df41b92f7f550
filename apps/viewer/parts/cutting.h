#pragma once

#include <memory>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "streaming/cut/growing/growing_cut.h"

namespace terrella {

/// Shows how far the cuts in the background are, and how each ended. The layers own the cuts: a cut whose layer is
/// removed stops, and its row goes. thread: main for every call
class Cutting : public Part {
 public:
  Cutting(const ViewerContext& context, const std::vector<std::weak_ptr<GrowingCut>>& cuts);

  /// Adds the cuts of pictures that were opened later.
  void add(const std::vector<std::shared_ptr<GrowingCut>>& cuts);
  void draw(float foot) override;
  [[nodiscard]] bool changed() const override;

 private:
  struct Row {
    std::weak_ptr<GrowingCut> cut;
    int percent = -1;  ///< as drawn
  };
  std::vector<Row> rows_;  ///< cuts that have neither ended nor gone
};

}  // namespace terrella
