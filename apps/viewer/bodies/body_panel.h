#pragma once

#include <functional>
#include <vector>

#include "apps/viewer/parts/part.h"

namespace terrella {

/// Lists the bodies of `--body`, to choose another globe. Owns the panel. thread: main
class BodyPanel : public Panel {
 public:
  /// `choose` is called with the chosen body, another one than the globe's.
  BodyPanel(const ViewerContext& context, std::function<void(const Body&)> choose)
      : Panel(context, "Body"), choose_(std::move(choose)) {}

 private:
  void draw_open(float foot) override;
  /// Draws the row of a body. True if it was chosen.
  [[nodiscard]] bool draw_row(const Body& body, bool first) const;

  std::function<void(const Body&)> choose_;
};

}  // namespace terrella
