#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/gazetteer.h"

namespace terrella {

/// Finds a place by name or by coordinates and flies there. Owns the list of places and the typed text. thread: main
class Search : public Panel {
 public:
  /// `places`: GeoJSON file of named places; empty: the program's cities, which are on the Earth.
  Search(const ViewerContext& context, std::filesystem::path places)
      : Panel(context, "Search"), file_(std::move(places)) {}

  void take_keyboard() override;
  /// Name of the place in the middle of the view, with its country; empty if none is known. Loads the list of places.
  [[nodiscard]] std::string place_shown();

 private:
  bool can_open() override;
  void toggled() override;
  void draw_open(float foot) override;
  [[nodiscard]] Result<Gazetteer> load() const;
  [[nodiscard]] std::optional<NamedPlace> draw_field();
  [[nodiscard]] std::optional<NamedPlace> draw_found(bool entered) const;
  void fly_to(const NamedPlace& place);

  std::filesystem::path file_;
  std::optional<Gazetteer> places_;  ///< loaded at the first search
  std::string text_;
};

}  // namespace terrella
