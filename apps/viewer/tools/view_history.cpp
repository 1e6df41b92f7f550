#include "apps/viewer/tools/view_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geo/measure.h"

namespace terrella {
namespace {

constexpr Seconds kLeastRest(0.7);
constexpr double kMoved = 0.25;          // least distance to another view, as a share of the height
constexpr double kHigher = 1.3;          // factor of the height
constexpr double kTurned_deg = 15.0;     // least change of heading or pitch
constexpr std::size_t kMostStops = 100;  // more would only cost memory

bool turned(Angle from, Angle to) { return std::abs(std::remainder(to.deg() - from.deg(), 360.0)) > kTurned_deg; }

}  // namespace

bool is_other_view(const Camera& from, const Camera& to, const Ellipsoid& body) {
  const double from_m = from.eye.height_m, to_m = to.eye.height_m;
  if (std::max(from_m, to_m) > kHigher * std::min(from_m, to_m) && from_m > 0.0) return true;
  if (turned(from.heading, to.heading) || turned(from.pitch, to.pitch) || from_m * to_m < 0.0) return true;
  return geodesic_m(body, from.eye, to.eye) > kMoved * std::abs(from_m);
}

void ViewHistory::follow(const Camera& camera, bool at_rest, Seconds now) {
  if (stops_.empty()) enter(camera);
  if (rest_ && at_rest && rest_->camera == camera) return;
  if (rest_ && now - rest_->since >= kLeastRest) enter(rest_->camera);
  rest_.reset();
  if (at_rest) rest_ = Rest{camera, now};
}

std::optional<Camera> ViewHistory::step(int by) {
  if (const auto rest = std::exchange(rest_, {})) enter(rest->camera);
  if (by < 0 ? current_ == 0 : current_ + 1 >= stops_.size()) return {};
  current_ = by < 0 ? current_ - 1 : current_ + 1;
  return stops_[current_].latest;
}

void ViewHistory::enter(const Camera& camera) {
  if (!stops_.empty() && !is_other_view(stops_[current_].first, camera, body_)) {
    stops_[current_].latest = camera;
    return;
  }
  if (!stops_.empty()) stops_.resize(current_ + 1);
  stops_.push_back({camera, camera});
  if (stops_.size() > kMostStops) stops_.erase(stops_.begin());
  current_ = stops_.size() - 1;
}

}  // namespace terrella
