#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels/ui.h"
#include "apps/viewer/tools/map_data.h"
#include "globe/globe.h"

namespace terrella {

/// The effort of drawing. A picture in motion has coarser lines without edges, and texts with thinner edges, which
/// costs a third of the time.
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
  /// See MapLabels::forget_shown().
  void forget_shown() {
    if (labels_) labels_->forget_shown();
  }
  [[nodiscard]] const std::vector<std::string>& attributions() const { return attributions_; }

 private:
  void fit_to_fonts();

  Ellipsoid ellipsoid_;
  MapLines lines_;
  std::vector<MapName> names_;       ///< until fit_to_fonts()
  std::optional<MapLabels> labels_;  ///< with texts in letters that fonts have
  std::vector<std::string> attributions_;
};

}  // namespace terrella
