#pragma once

#include <span>

#include "apps/viewer/action.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// The list of shortcuts. It hides the other panels while it is open. A click on it closes it. thread: main
class Help : public Panel {
 public:
  Help(const ViewerContext& context, std::span<const Action> actions)
      : Panel(context, "Shortcuts"), actions_(actions) {}

 private:
  struct Columns;
  [[nodiscard]] Columns columns() const;
  void draw_open(float foot) override;
  void draw_columns(const Columns& all) const;
  void draw_scrolled(const Columns& all, bool just_opened) const;

  std::span<const Action> actions_;
};

}  // namespace terrella
