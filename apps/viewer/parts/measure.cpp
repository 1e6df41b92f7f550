#include "apps/viewer/parts/measure.h"

#include <chrono>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "apps/process/write_file.h"
#include "apps/viewer/panels/measure_row.h"
#include "apps/viewer/tools/measure_export.h"
#include "apps/viewer/tools/screenshot.h"

namespace terrella {

void Measure::toggle() {
  on_ = !on_;
  path_.restart(true);
}

void Measure::start_from(glm::dvec2 at_px) {
  on_ = true;
  path_.restart(true);
  add(at_px);
}

bool Measure::close() {
  if (!on_) return false;
  toggle();
  return true;
}

void Measure::add(glm::dvec2 at_px) {
  if (on_) path_.add(at_px);
}

void Measure::take_back() { path_.take_back(); }

bool Measure::has_places() const {
  if (!on_ || path_.places().empty()) say("Nothing is measured yet. Press M to start.");
  return on_ && !path_.places().empty();
}

void Measure::copy() const {
  if (!has_places()) return;
  context_.window.copy(measurement_text(context_.globe.options().body.ellipsoid, path_.places()));
  say("Measurement copied");
}

void Measure::save() const {
  if (!has_places()) return;
  std::error_code unknown;
  const auto file = new_file_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now(), ".geojson");
  const std::string text = measurement_geojson(context_.globe.options().body.ellipsoid, path_.places());
  const Status saved = write_file(file, std::as_bytes(std::span(text)));
  saved ? say("Saved " + file.string()) : say(saved.error());
}

void Measure::keep() {
  if (!has_places()) return;
  keep_(path_.places());
  toggle();
}

void Measure::draw_over(const View& view, std::optional<glm::dvec2> cursor_px, float foot) {
  if (on_) draw_row(path_.draw_to(view, cursor_px), foot);
}

void Measure::draw_row(const std::string& text, float foot) {
  switch (draw_measure_row(text, foot)) {
    case MeasureAsk::none:
      return;
    case MeasureAsk::undo:
      return take_back();
    case MeasureAsk::copy:
      return copy();
    case MeasureAsk::save:
      return save();
    case MeasureAsk::keep:
      return keep();
    case MeasureAsk::profile:
      return profile_();
    case MeasureAsk::end:
      return toggle();
  }
}

}  // namespace terrella
