#pragma once

#include <span>

#include "apps/viewer/action.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// The list of shortcuts. It hides the other panels while it is open. thread: main
class Help : public Panel {
 public:
  Help(const ViewerContext& context, std::span<const Action> actions) : Panel(context, nullptr), actions_(actions) {}

 private:
  void draw_open(float foot) override;

  std::span<const Action> actions_;
};

}  // namespace terrella
