#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/measure_tool.h"

namespace terrella {

/// Measures lengths and areas on the globe. Owns the measured places, the layer that shows them, and a row with the
/// result and buttons. thread: main
class Measure : public Part {
 public:
  explicit Measure(const ViewerContext& context) : Part(context) {}

  void toggle();                      ///< starts, or ends and removes the measurement
  void start_from(glm::dvec2 at_px);  ///< starts anew with the place under a pixel of the framebuffer
  [[nodiscard]] bool is_on() const { return on_; }
  /// Adds the place under a pixel of the framebuffer. No effect unless on.
  void add(glm::dvec2 at_px);
  void take_back();   ///< removes the last place
  void copy() const;  ///< puts the measurement into the clipboard
  void save() const;  ///< writes the measurement to a new GeoJSON file in the working folder
  /// Draws the row, where no panel of this frame is, and the line from the last place to the cursor. Call this after
  /// the frame's panels. `cursor_px`: pixel of the framebuffer; nullopt beside the globe.
  void draw_over(const View& view, std::optional<glm::dvec2> cursor_px, float foot);
  bool close() override;

 private:
  void show();
  void draw_row(const std::string& text, float foot);
  void draw_band(const View& view, const Geodetic& to) const;
  [[nodiscard]] bool has_places() const;

  bool on_ = false;
  MeasureTool places_;
  std::optional<LayerId> layer_;
};

}  // namespace terrella
