#include "apps/flight/flight_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geo/body.h"
#include "geo/ellipsoid.h"

namespace terrella {
namespace {

constexpr double kLowest_m = 0.1;         // heights are interpolated by their logarithm
constexpr double kPace_s = 4.0;           // see even_pace()
constexpr double kPolarTurn_deg = 150.0;  // a course that turns further passes a pole

double shorter_turn_deg(double turn_deg) { return std::remainder(turn_deg, 360.0); }

template <class Value>
MonotoneCurve curve_of(const std::vector<double>& times, const std::vector<FlightMoment>& keyframes,
                       const Value& value) {
  std::vector<double> values;
  values.reserve(keyframes.size());
  for (const FlightMoment& keyframe : keyframes) values.push_back(value(keyframe));
  return {times, std::move(values)};
}

/// Effort of a section, see even_pace().
double effort(const Camera& a, const Camera& b) {
  const double way_m = earth().ellipsoid.a_m() * angle_between(eye_normal(a), eye_normal(b)).rad();
  const double climb = log_height(b) - log_height(a);
  const double height_a_m = std::exp(log_height(a)), height_b_m = std::exp(log_height(b));
  // The mean of 1 / height along the section.
  const double thinness = std::abs(climb) < 1e-6 ? 1.0 / height_a_m : (1.0 / height_a_m - 1.0 / height_b_m) / climb;
  const double heading = Angle::degrees(shorter_turn_deg(b.heading.deg() - a.heading.deg())).rad();
  return std::hypot(way_m * thinness, climb, std::hypot(heading, (b.pitch - a.pitch).rad()));
}

}  // namespace

double log_height(const Camera& camera) { return std::log(std::max(camera.eye.height_m, kLowest_m)); }

glm::dvec3 eye_normal(const Camera& camera) { return Ellipsoid::normal(camera.eye.lat, camera.eye.lon).xyz; }

double duration_s(std::span<const FlightPath> flights) {
  double sum_s = 0.0;
  for (const FlightPath& flight : flights) sum_s += flight.duration_s();
  return sum_s;
}

FlightMoment moment_at(std::span<const FlightPath> flights, double time_s, double later_s) {
  for (const FlightPath& flight : flights.first(flights.size() - 1)) {
    if (time_s < flight.duration_s()) return flight.at(time_s + later_s);
    time_s -= flight.duration_s();
  }
  return flights.back().at(time_s + later_s);
}

std::vector<double> even_pace(const std::vector<FlightMoment>& keyframes) {
  std::vector<double> times{0.0};
  times.reserve(keyframes.size());
  for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
    const double length_s = kPace_s * effort(keyframes[i].camera, keyframes[i + 1].camera);
    times.push_back(times.back() + std::max(length_s, 1e-3));
  }
  return times;
}

Camera camera_between(const Camera& a, const Camera& b, double t) {
  Camera camera = a;
  camera.eye = Ellipsoid::lat_lon(EcefDir{EyeWay({0.0, 1.0}, {eye_normal(a), eye_normal(b)}).at(t)});
  camera.eye.height_m = std::exp((1.0 - t) * log_height(a) + t * log_height(b));
  return camera;
}

FlightPath::FlightPath(std::vector<double> times, const std::vector<FlightMoment>& keyframes)
    : times_(std::move(times)), fov_y_(keyframes.front().camera.fov_y) {
  std::vector<glm::dvec3> normals;
  normals.reserve(keyframes.size());
  for (const FlightMoment& keyframe : keyframes) normals.push_back(eye_normal(keyframe.camera));
  way_ = EyeWay(times_, normals);
  log_height_ = curve_of(times_, keyframes, [](const FlightMoment& k) { return log_height(k.camera); });
  pitch_deg_ = curve_of(times_, keyframes, [](const FlightMoment& k) { return k.camera.pitch.deg(); });
  if (keyframes.front().surface_alpha) {
    surface_alpha_ = curve_of(times_, keyframes, [](const FlightMoment& k) { return k.surface_alpha.value_or(1.0); });
  }
  if (keyframes.front().sun) {
    first_sun_ = *keyframes.front().sun;
    sun_ms_ = curve_of(times_, keyframes, [this](const FlightMoment& k) {
      return static_cast<double>((k.sun.value_or(first_sun_) - first_sun_).count());
    });
  }
  set_headings(keyframes);
}

void FlightPath::set_headings(const std::vector<FlightMoment>& keyframes) {
  std::vector<double> headings{keyframes.front().camera.heading.deg()};
  headings.reserve(keyframes.size());
  polar_.resize(keyframes.size() - 1);
  for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
    const double begin = keyframes[i].camera.heading.deg();
    const double turn = keyframes[i + 1].camera.heading.deg() - begin;
    const double course = way_.course_deg(times_[i], i);
    const double course_turn = shorter_turn_deg(way_.course_deg(times_[i + 1], i) - course);
    if (std::abs(course_turn) > kPolarTurn_deg) {
      polar_[i] = {.begin_deg = begin - course, .change_deg = shorter_turn_deg(turn - course_turn)};
    }
    headings.push_back(headings.back() + shorter_turn_deg(turn));
  }
  heading_deg_ = MonotoneCurve(times_, std::move(headings));
}

Angle FlightPath::heading(double time_s) const {
  const std::size_t i = section_at(times_, time_s);
  if (i >= polar_.size() || !polar_[i]) return Angle::degrees(heading_deg_.at(time_s));
  const double u = (time_s - times_[i]) / (times_[i + 1] - times_[i]);
  return Angle::degrees(way_.course_deg(time_s, i) + polar_[i]->begin_deg + u * polar_[i]->change_deg);
}

FlightMoment FlightPath::at(double time_s) const {
  const double at = std::clamp(time_s, times_.front(), times_.back());
  FlightMoment moment;
  Camera& camera = moment.camera;
  camera.eye = Ellipsoid::lat_lon(EcefDir{way_.at(at)});
  camera.eye.height_m = std::exp(log_height_.at(at));
  camera.heading = heading(at);
  camera.pitch = Angle::degrees(std::clamp(pitch_deg_.at(at), -90.0, 90.0));
  camera.fov_y = fov_y_;
  if (surface_alpha_) moment.surface_alpha = std::clamp(surface_alpha_->at(at), 0.0, 1.0);
  if (sun_ms_) moment.sun = first_sun_ + std::chrono::milliseconds(std::llround(sun_ms_->at(at)));
  return moment;
}

}  // namespace terrella
