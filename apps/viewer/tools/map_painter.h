#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/panels/ui.h"
#include "apps/viewer/tools/map_data.h"
#include "apps/viewer/tools/map_texts.h"
#include "globe/globe.h"

namespace terrella {

/// The effort of drawing. A picture in motion has coarser lines without edges, which costs a third of the time.
enum class MapDetail { full, in_motion };

/// Draws a map over the globe, under the panels, within a frame of Dear ImGui. `unit_px`: framebuffer pixels per unit
/// of the window. thread: any for the constructor, main for every call
class MapPainter {
 public:
  /// Prepares the lines, which takes about 0.1 s.
  MapPainter(MapData data, const Ellipsoid& ellipsoid);

  void draw_lines(const Globe& globe, const View& view, double unit_px, MapDetail detail) const;
  /// Draws the names around the boxes of `taken`, in units of the window, and returns the boxes of the names.
  std::vector<UiBox> draw_names(const Globe& globe, const View& view, double unit_px, MapDetail detail,
                                const std::vector<UiBox>& taken);
  /// The same in a picture of its own (MapLabels::apart()), in pixels.
  void draw_names_apart(const Globe& globe, const View& view, const std::vector<UiBox>& taken) {
    labels_.apart([&] { static_cast<void>(draw_names(globe, view, 1.0, MapDetail::full, taken)); });
  }
  [[nodiscard]] const std::vector<std::string>& attributions() const { return attributions_; }

 private:
  Ellipsoid ellipsoid_;
  MapLines lines_;
  MapLabels labels_;
  std::vector<std::byte> font_;      ///< until the first names are drawn
  std::unique_ptr<MapTexts> texts_;  ///< null without a font
  std::vector<std::string> attributions_;
};

}  // namespace terrella
