#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/gazetteer.h"

namespace terrella {

/// Finds a place by name or by coordinates, flies there and marks it, until Esc or the next search. The flight ends
/// where the imagery's texels are not yet large. Owns the list of places, the typed text and the mark. thread: main
class Search : public Panel {
 public:
  /// Returns the side of the finest texels of the images at a place, metres; none without an image there.
  using FinestTexel = std::function<std::optional<double>(const Geodetic& place)>;

  /// `places`: GeoJSON file of named places; empty: the program's cities, which are on the Earth.
  Search(const ViewerContext& context, std::filesystem::path places, FinestTexel finest_texel_m)
      : Panel(context, "Search"), file_(std::move(places)), finest_texel_m_(std::move(finest_texel_m)) {}

  void take_keyboard() override;
  bool remove_mark();  ///< false if no place is marked
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
  Status mark(const NamedPlace& place);

  std::filesystem::path file_;
  FinestTexel finest_texel_m_;
  std::optional<LayerId> mark_;
  std::optional<Gazetteer> places_;  ///< loaded at the first search
  std::string text_;
};

}  // namespace terrella
