#pragma once

#include <optional>
#include <string>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/gazetteer.h"

namespace terrella {

/// Finds a place by name and flies there. Owns the list of places and the typed text. thread: main
class Search : public Panel {
 public:
  explicit Search(const ViewerContext& context) : Panel(context, "Search") {}

  void take_keyboard() override;

 private:
  bool can_open() override;
  void toggled() override;
  void draw_open(float foot) override;
  [[nodiscard]] std::optional<NamedPlace> draw_field();
  void fly_to(const NamedPlace& place);

  std::optional<Gazetteer> places_;  ///< loaded at the first search
  std::string text_;
};

}  // namespace terrella
