#include "globe/features/shown_features.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "base/range_check.h"

namespace terrella {
namespace {

/// A part of an axis, zoom levels or milliseconds of UTC, in which no feature comes or goes.
struct Calm {
  double from = -std::numeric_limits<double>::infinity(), before = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool has(double place) const { return from <= place && place < before; }
  /// Ends the part around a place at a bound.
  void end_at(double bound, double place) {
    if (bound <= place) from = std::max(from, bound);
    if (bound > place) before = std::min(before, bound);
  }
};

double place_of(UtcTime time) { return double(time.time_since_epoch().count()); }

bool is_hidden(const ShownWhen& when, double zoom, const std::optional<UtcTime>& time) {
  if (zoom < when.from_zoom || (zoom >= when.before_zoom && when.before_zoom < kMostZoom)) return true;
  return time && ((when.from && *time < *when.from) || (when.before && *time >= *when.before));
}

}  // namespace

double zoom_of(const Globe& globe, Viewport picture) {
  constexpr double kTile_px = 512.0, kLeastHeight_m = 1e-3;
  const Geodetic& eye = globe.camera().eye;
  const double height_m = std::max(std::abs(eye.height_m - globe.ground_height_m(eye.lat, eye.lon)), kLeastHeight_m);
  const double pixels_per_m = globe.view(picture).pixels_per_radian() / height_m;
  const double equator_m = 2.0 * std::numbers::pi * globe.options().body.ellipsoid.a_m();
  return std::clamp(std::log2(equator_m * pixels_per_m / kTile_px), kLeastZoom, kMostZoom);
}

struct ShownFeatures::State {
  LayerId layer;
  std::vector<ShownWhen> features;
  std::vector<bool> hidden;
  bool is_new = true;  ///< no update yet
  bool has_time = false;
  Calm zooms{}, instants{};

  [[nodiscard]] bool is_calm(double zoom, const std::optional<UtcTime>& time) const {
    if (is_new || !zooms.has(zoom) || has_time != time.has_value()) return false;
    return !time || instants.has(place_of(*time));
  }

  void look_at(double zoom, const std::optional<UtcTime>& time, ObjectEdits& edits) {
    is_new = false;
    has_time = time.has_value();
    zooms = instants = {};
    for (std::size_t k = 0; k < features.size(); ++k) {
      const ShownWhen& when = features[k];
      zooms.end_at(when.from_zoom, zoom);
      if (when.before_zoom < kMostZoom) zooms.end_at(when.before_zoom, zoom);
      if (time && when.from) instants.end_at(place_of(*when.from), place_of(*time));
      if (time && when.before) instants.end_at(place_of(*when.before), place_of(*time));
      hide(k, is_hidden(when, zoom, time), edits);
    }
  }

  void hide(std::size_t feature, bool hides, ObjectEdits& edits) {
    if (hidden[feature] == hides) return;
    hidden[feature] = hides;
    edits.changes.push_back({.id = features[feature].id, .filtered = hides});
  }

  Status edit(Globe& globe, ObjectEdits edits) const {
    return edits.changes.empty() ? Status(Done{}) : globe.edit_objects(layer, std::move(edits));
  }
};

ShownFeatures::ShownFeatures(std::unique_ptr<State> state) : state_(std::move(state)) {}
ShownFeatures::ShownFeatures(ShownFeatures&&) noexcept = default;
ShownFeatures& ShownFeatures::operator=(ShownFeatures&&) noexcept = default;
ShownFeatures::~ShownFeatures() = default;

Result<ShownFeatures> ShownFeatures::make(LayerId layer, std::vector<ShownWhen> features) {
  RangeCheck check;
  for (const ShownWhen& when : features) {
    check.in("the zoom level from which a feature is shown", when.from_zoom, kLeastZoom, kMostZoom)
        .in("the zoom level below which a feature is shown", when.before_zoom, kLeastZoom, kMostZoom);
  }
  if (Status good = check.result(); !good) return Error{"ShownFeatures::make: " + good.error().message};
  const std::size_t count = features.size();
  return ShownFeatures(std::make_unique<State>(
      State{.layer = layer, .features = std::move(features), .hidden = std::vector<bool>(count)}));
}

Status ShownFeatures::update(Globe& globe, Viewport picture) {
  const double zoom = zoom_of(globe, picture);
  const std::optional<UtcTime>& time = globe.options().time;
  if (state_->is_calm(zoom, time)) return Done{};
  ObjectEdits edits;
  state_->look_at(zoom, time, edits);
  return state_->edit(globe, std::move(edits));
}

Status ShownFeatures::end(Globe& globe) {
  ObjectEdits edits;
  for (std::size_t k = 0; k < state_->features.size(); ++k) state_->hide(k, false, edits);
  state_->is_new = true;
  return state_->edit(globe, std::move(edits));
}

}  // namespace terrella
