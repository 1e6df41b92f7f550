#include "apps/viewer/draw/place_path.h"

#include <imgui.h>

#include <glm/geometric.hpp>
#include <utility>

#include "apps/viewer/panels/panel_items.h"
#include "geo/measure.h"

namespace terrella {
namespace {

constexpr int kBandPoints = 49;
constexpr double kSamePlace_px = 6.0;  // at 96 dots per inch
const ImU32 kBand = IM_COL32(255, 214, 64, 220);

}  // namespace

void PlacePath::restart(bool encloses) {
  tool_ = MeasureTool(encloses);
  show();
}

bool PlacePath::add(glm::dvec2 at_px) {
  const Globe& globe = context_.globe;
  auto place = pick(globe.view(context_.window.framebuffer()), globe.ground(), at_px);
  if (!place) {
    context_.messages.say("There is no ground here");
    return false;
  }
  if (!globe.has_relief()) place->height_m = 0.0;  // rounding could put the place under the ground
  tool_.add(*place);
  show();
  return true;
}

void PlacePath::take_back() {
  tool_.take_back();
  show();
}

bool PlacePath::ends_at(glm::dvec2 at_px) const {
  if (places().empty()) return false;
  const Globe& globe = context_.globe;
  const View view = globe.view(context_.window.framebuffer());
  const auto last_px = project(view, globe.ground(), places().back().lat, places().back().lon);
  return last_px && glm::distance(*last_px, at_px) <= kSamePlace_px * double(context_.window.text_scale());
}

std::string PlacePath::text() const {
  return tool_.text(context_.globe.options().body.ellipsoid, {}, context_.ui.units());
}

std::string PlacePath::draw_to(const View& view, std::optional<glm::dvec2> cursor_px) {
  if (layer_ && shown_units_ != context_.ui.units()) show();
  const auto next = cursor_px && !places().empty() ? pick(view, context_.globe.ground(), *cursor_px) : std::nullopt;
  if (next && context_.globe.options().stereo.mode == Stereo::off) draw_band(view, *next);
  return tool_.text(context_.globe.options().body.ellipsoid, next, context_.ui.units());
}

// Only the part on the near side of the globe.
void PlacePath::draw_band(const View& view, const Geodetic& to) const {
  const Ellipsoid& body = context_.globe.options().body.ellipsoid;
  const Ground ground = context_.globe.ground();
  const double unit_px = context_.window.pixels_per_unit().x;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  std::optional<ImVec2> before;
  for (const Geodetic& place : geodesic_places(body, places().back(), to, kBandPoints)) {
    const Ecef point = body.to_ecef({place.lat, place.lon, ground.height_m(place.lat, place.lon)});
    const bool near = glm::dot(point.xyz_m - view.eye.xyz_m, Ellipsoid::normal(place.lat, place.lon).xyz) < 0.0;
    const auto px = near ? project(view, point) : std::nullopt;
    std::optional<ImVec2> at;
    if (px) at = ImVec2{float(px->x / unit_px), float(px->y / unit_px)};
    if (at && before) list->AddLine(*before, *at, kBand, line_width(2.0F));
    before = at;
  }
}

void PlacePath::show() {
  shown_units_ = context_.ui.units();
  Globe& globe = context_.globe;
  ObjectScene scene = tool_.scene(globe.options().body.ellipsoid, context_.window.text_scale(), context_.ui.units());
  Status shown = Done{};
  if (layer_) {
    shown = globe.set_objects(*layer_, std::move(scene));
  } else if (!scene.empty()) {
    const Result<LayerId> layer = globe.add_objects(std::move(scene));
    if (layer) layer_ = *layer;
    if (!layer) shown = layer.error();
  }
  if (!shown) context_.messages.say(shown.error());
}

}  // namespace terrella
