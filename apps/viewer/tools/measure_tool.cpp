#include "apps/viewer/tools/measure_tool.h"

#include <fmt/format.h>

#include "geo/measure.h"

namespace terrella {
namespace {

constexpr ObjectColor kMeasureInk{255, 214, 64}, kMeasureWash{255, 214, 64, 60}, kWayBack{255, 214, 64, 150};
constexpr float kMarker_px = 11.0F, kWay_px = 3.0F, kWayBack_px = 1.5F;

}  // namespace

void MeasureTool::take_back() {
  if (!places_.empty()) places_.pop_back();
}

std::string MeasureTool::text(const Ellipsoid& ellipsoid, const std::optional<Geodetic>& next,
                              LengthUnits units) const {
  if (places_.empty()) return "Measuring: click a place, or press Enter for the centre";
  const double next_m = next ? geodesic_m(ellipsoid, places_.back(), *next) : 0.0;
  const bool away = length_text(next_m, units) != length_text(0.0, units);
  if (places_.size() == 1 && !away) return "Measuring: click the next place";
  const double length_m = path_m(ellipsoid, places_);
  const std::string total = length_text(length_m + next_m, units);
  std::string text = "Length ";
  if (away && places_.size() > 1)
    text += fmt::format("{} + {} = ", length_text(length_m, units), length_text(next_m, units));
  text += total;
  if (encloses_ && places_.size() > 2)
    text += "   Area " + area_text(polygon_measure(ellipsoid, places_).area_m2, units);
  return text;
}

ObjectScene MeasureTool::scene(const Ellipsoid& ellipsoid, float scale, LengthUnits units) const {
  ObjectScene scene;
  constexpr HeightMode kOnGround = HeightMode::clamp_to_ground;
  for (const Geodetic& place : places_) {
    scene.points.push_back({.place = place, .size_px = scale * kMarker_px, .color = kMeasureInk, .heights = kOnGround});
  }
  if (places_.size() < 2) return scene;
  scene.lines.push_back({.places = places_, .width_px = scale * kWay_px, .color = kMeasureInk, .heights = kOnGround});
  for (std::size_t k = 1; k < places_.size(); ++k) {
    scene.labels.push_back({.text = length_text(geodesic_m(ellipsoid, places_[k - 1], places_[k]), units),
                            .place = geodesic_places(ellipsoid, places_[k - 1], places_[k], 3)[1],
                            .size_px = scale * kWay_px,
                            .priority = 1.0,
                            .heights = kOnGround});
  }
  if (places_.size() < 3) return scene;
  scene.labels.push_back({.text = "Total " + length_text(path_m(ellipsoid, places_), units),
                          .place = places_.back(),
                          .size_px = scale * kMarker_px,
                          .priority = 2.0,
                          .heights = kOnGround});
  if (!encloses_) return scene;
  scene.polygons.push_back({.rings = {places_}, .fill = kMeasureWash, .stroke = {0, 0, 0, 0}, .heights = kOnGround});
  scene.lines.push_back({.places = {places_.back(), places_.front()},
                         .width_px = scale * kWayBack_px,
                         .color = kWayBack,
                         .heights = kOnGround});
  return scene;
}

}  // namespace terrella
