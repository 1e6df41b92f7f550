#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/draw/place_path.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// Measures lengths and areas on the globe. Owns the measured places and a row with the result and buttons.
/// thread: main
class Measure : public Part {
 public:
  /// `keep` makes a drawing of the measured places. `profile` opens or closes their profile.
  Measure(const ViewerContext& context, std::function<void(std::vector<Geodetic>)> keep, std::function<void()> profile)
      : Part(context), keep_(std::move(keep)), profile_(std::move(profile)) {}

  void toggle();                      ///< starts, or ends and removes the measurement
  void start_from(glm::dvec2 at_px);  ///< starts anew with the place under a pixel of the framebuffer
  [[nodiscard]] bool is_on() const { return on_; }
  [[nodiscard]] const std::vector<Geodetic>& places() const { return path_.places(); }  ///< empty unless on
  /// Adds the place under a pixel of the framebuffer. No effect unless on.
  void add(glm::dvec2 at_px);
  void take_back();   ///< removes the last place
  void copy() const;  ///< puts the measurement into the clipboard
  void save() const;  ///< writes the measurement to a new GeoJSON file in the working folder
  void keep();        ///< ends the measurement, which becomes a drawing
  /// Draws the row, where no panel of this frame is, and the line from the last place to the cursor. Call this after
  /// the frame's panels. `cursor_px`: pixel of the framebuffer; nullopt beside the globe.
  void draw_over(const View& view, std::optional<glm::dvec2> cursor_px, float foot);
  bool close() override;

 private:
  void draw_row(const std::string& text, float foot);
  [[nodiscard]] bool has_places() const;

  bool on_ = false;
  PlacePath path_{context_};
  std::function<void(std::vector<Geodetic>)> keep_;
  std::function<void()> profile_;
};

}  // namespace terrella
