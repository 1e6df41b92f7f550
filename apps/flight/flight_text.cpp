#include "apps/flight/flight_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/iso_time.h"

namespace terrella {
namespace {

using nlohmann::ordered_json;

ordered_json feature_of(const FlightPath& flight) {
  ordered_json properties = {{"fov", flight.at(0.0).camera.fov_y.deg()}};
  ordered_json positions;
  for (const double time_s : flight.times()) {
    const FlightMoment moment = flight.at(time_s);
    const Geodetic& eye = moment.camera.eye;
    positions.push_back({eye.lon.deg(), eye.lat.deg(), eye.height_m});
    properties["times_s"].push_back(time_s);
    properties["headings"].push_back(std::remainder(moment.camera.heading.deg(), 360.0));
    properties["pitches"].push_back(moment.camera.pitch.deg());
    if (moment.surface_alpha) properties["opacities"].push_back(*moment.surface_alpha);
    if (moment.sun) properties["times"].push_back(time_text(*moment.sun, TimePrecision::millisecond, true));
  }
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", "LineString"}, {"coordinates", std::move(positions)}}}};
}

}  // namespace

std::string flight_text(std::span<const FlightPath> flights) {
  ordered_json features;
  for (const FlightPath& flight : flights) features.push_back(feature_of(flight));
  return ordered_json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(1) + "\n";
}

}  // namespace terrella
