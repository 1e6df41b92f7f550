#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/map_painter.h"

namespace terrella {

/// Coastlines, borders, and names of countries and places over the globe. Owns the switch. The map is read on a worker
/// after the first pictures are complete, so that it does not delay them. While the camera moves the map has less
/// detail, and on a slow machine no names. thread: main for every call
class MapLayer : public Part {
 public:
  /// `places`: GeoJSON file of named places on the globe's body; empty: the Earth's cities.
  MapLayer(const ViewerContext& context, std::filesystem::path places);

  /// False if there is no map of the globe's body.
  [[nodiscard]] bool exists() const { return exists_; }
  [[nodiscard]] bool& is_on() { return on_; }
  [[nodiscard]] bool is_on() const { return on_; }
  void toggle();
  /// Begins to read the map, or takes it. Call this once per frame, before drawing. `last_frame_ms`: time of the last
  /// frame.
  void update(double last_frame_ms);
  [[nodiscard]] bool changed() const override;
  /// Draws lines and names under the panels, if on. Call these within a frame, after its panels; the names after
  /// everything whose boxes `taken` has, in units of the window. They return their boxes.
  void draw_lines(const View& view) const;
  std::vector<UiBox> draw_names(const View& view, const std::vector<UiBox>& taken) const;
  /// The map for other pictures; null if it is off or not yet read.
  [[nodiscard]] MapPainter* painter() const { return on_ ? painter_.get() : nullptr; }
  /// Texts that credit the drawn map.
  [[nodiscard]] std::vector<std::string> attributions() const;

 private:
  using Loaded = Result<std::unique_ptr<MapPainter>>;
  [[nodiscard]] bool should_load() const;
  [[nodiscard]] MapDetail detail() const { return moves_ ? MapDetail::in_motion : MapDetail::full; }

  std::filesystem::path places_;
  bool exists_;
  bool on_ = false;
  bool tried_ = false;
  bool slow_ = false;   ///< a frame of this motion was slow
  Camera camera_;       ///< camera of the last frame
  bool moves_ = false;  ///< the last frame was drawn in motion, with less detail
  std::optional<std::chrono::steady_clock::time_point> first_frame_;
  std::future<Loaded> loading_;
  std::unique_ptr<MapPainter> painter_;  ///< null until the map is read
};

}  // namespace terrella
