#include "apps/viewer/parts/measure.h"

#include <imgui.h>

#include <chrono>
#include <filesystem>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "apps/process/write_file.h"
#include "apps/viewer/panels/measure_row.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/measure_export.h"
#include "apps/viewer/tools/screenshot.h"
#include "geo/measure.h"

namespace terrella {
namespace {

constexpr int kBandPoints = 49;
const ImU32 kBand = IM_COL32(255, 214, 64, 220);

}  // namespace

void Measure::toggle() {
  on_ = !on_;
  places_.clear();
  show();
}

void Measure::start_from(glm::dvec2 at_px) {
  on_ = true;
  places_.clear();
  add(at_px);
}

bool Measure::close() {
  if (!on_) return false;
  toggle();
  return true;
}

void Measure::add(glm::dvec2 at_px) {
  if (!on_) return;
  const Globe& globe = context_.globe;
  auto place = pick(globe.view(context_.window.framebuffer()), globe.ground(), at_px);
  if (!place) return say("There is no ground to measure from");
  if (!globe.has_relief()) place->height_m = 0.0;  // rounding could put the place under the ground
  places_.add(*place);
  show();
}

void Measure::take_back() {
  places_.take_back();
  show();
}

bool Measure::has_places() const {
  if (!on_ || places_.places().empty()) say("Nothing is measured yet. Press M to start.");
  return on_ && !places_.places().empty();
}

void Measure::copy() const {
  if (!has_places()) return;
  context_.window.copy(measurement_text(context_.globe.options().body.ellipsoid, places_.places()));
  say("Measurement copied");
}

void Measure::save() const {
  if (!has_places()) return;
  std::error_code unknown;
  const auto file = new_file_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now(), ".geojson");
  const std::string text = measurement_geojson(context_.globe.options().body.ellipsoid, places_.places());
  const Status saved = write_file(file, std::as_bytes(std::span(text)));
  say(saved ? "Saved " + file.string() : saved.error().message);
}

void Measure::draw_over(const View& view, std::optional<glm::dvec2> cursor_px, float foot) {
  if (!on_) return;
  const Ground ground = context_.globe.ground();
  const auto next = cursor_px && !places_.places().empty() ? pick(view, ground, *cursor_px) : std::nullopt;
  if (next && context_.globe.options().stereo.mode == Stereo::off) draw_band(view, *next);
  draw_row(places_.text(context_.globe.options().body.ellipsoid, next), foot);
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
    case MeasureAsk::end:
      return toggle();
  }
}

// Only the part on the near side of the globe.
void Measure::draw_band(const View& view, const Geodetic& to) const {
  const Ellipsoid& body = context_.globe.options().body.ellipsoid;
  const Ground ground = context_.globe.ground();
  const double unit_px = context_.window.pixels_per_unit().x;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  std::optional<ImVec2> before;
  for (const Geodetic& place : geodesic_places(body, places_.places().back(), to, kBandPoints)) {
    const Ecef point = body.to_ecef({place.lat, place.lon, ground.height_m(place.lat, place.lon)});
    const bool near = glm::dot(point.xyz_m - view.eye.xyz_m, Ellipsoid::normal(place.lat, place.lon).xyz) < 0.0;
    const auto px = near ? project(view, point) : std::nullopt;
    std::optional<ImVec2> at;
    if (px) at = ImVec2{float(px->x / unit_px), float(px->y / unit_px)};
    if (at && before) list->AddLine(*before, *at, kBand, line_width(2.0F));
    before = at;
  }
}

void Measure::show() {
  Globe& globe = context_.globe;
  ObjectScene scene = places_.scene(globe.options().body.ellipsoid, context_.window.text_scale());
  Status shown = Done{};
  if (layer_) {
    shown = globe.set_objects(*layer_, std::move(scene));
  } else if (!scene.empty()) {
    const Result<LayerId> layer = globe.add_objects(std::move(scene));
    if (layer) layer_ = *layer;
    if (!layer) shown = layer.error();
  }
  if (!shown) say(shown.error().message);
}

}  // namespace terrella
