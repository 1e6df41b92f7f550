#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/measure_tool.h"

namespace terrella {

/// Places that the user sets one after the other on the globe, with the path between them, its lengths, and a line from
/// the last place to the cursor. Owns the layer that shows them. thread: main for every call
class PlacePath {
 public:
  explicit PlacePath(const ViewerContext& context) : context_(context) {}

  [[nodiscard]] const std::vector<Geodetic>& places() const { return tool_.places(); }
  /// Removes all places. `encloses`: from three places on, the next path encloses an area.
  void restart(bool encloses);
  /// Adds the place under a pixel of the framebuffer. False, with a message, if there is no ground.
  bool add(glm::dvec2 at_px);
  void take_back();  ///< removes the last place
  /// True if the last place is at a pixel of the framebuffer, as after a double click.
  [[nodiscard]] bool ends_at(glm::dvec2 at_px) const;
  /// Draws the line from the last place to the cursor under the panels, and returns the text of the path with the way
  /// to it. `cursor_px`: pixel of the framebuffer; nullopt beside the globe.
  [[nodiscard]] std::string draw_to(const View& view, std::optional<glm::dvec2> cursor_px);
  /// The text of the path.
  [[nodiscard]] std::string text() const;

 private:
  void show();
  void draw_band(const View& view, const Geodetic& to) const;

  const ViewerContext context_;
  MeasureTool tool_;
  LengthUnits shown_units_ = LengthUnits::metric;  ///< units of the labels
  std::optional<LayerId> layer_;
};

}  // namespace terrella
