#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/measure_tool.h"

namespace terrella {

/// Measures lengths and areas on the globe. Owns the measured places and the layer that shows them. thread: main
class Measure : public Part {
 public:
  explicit Measure(const ViewerContext& context) : Part(context) {}

  void toggle();  ///< starts, or ends and removes the measurement
  [[nodiscard]] bool is_on() const { return on_; }
  /// Adds the place under a pixel of the framebuffer. No effect unless on.
  void add(glm::dvec2 at_px);
  void take_back();  ///< removes the last place
  /// Instruction or result; empty unless on.
  [[nodiscard]] std::string text() const;
  bool close() override;

 private:
  void show();

  bool on_ = false;
  MeasureTool places_;
  std::optional<LayerId> layer_;
};

}  // namespace terrella
