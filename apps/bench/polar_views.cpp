#include "apps/bench/polar_views.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace terrella::bench {
namespace {

constexpr double kRadius_m = 6371008.8;
constexpr double kFov_deg = 40.0;
constexpr double kToMidLatitudes_deg = -55.0;
constexpr double kTwinLon_deg = 20.0;

PolarView over_pole(std::string name, truth::TruthCamera camera) {
  PolarView view{.name = std::move(name), .camera = camera, .twin = camera};
  view.twin->eye.lat_deg += kToMidLatitudes_deg;
  view.twin->eye.lon_deg = kTwinLon_deg;
  return view;
}

PolarView straight_down(std::string name, double lat_deg, double lon_deg, double height_m) {
  return over_pole(std::move(name), {.eye = {lat_deg, lon_deg, height_m}, .fov_deg = kFov_deg});
}

PolarView tilted(std::string name, double lat_deg, double height_m, double pitch_deg) {
  return over_pole(std::move(name), {{lat_deg, 180.0, height_m}, 0.0, pitch_deg, kFov_deg});
}

}  // namespace

truth::Spheroid polar_body() { return {kRadius_m, 0.0}; }

double inscribed_height_m() { return kRadius_m * (1.0 / std::sin(0.5 * kFov_deg * std::numbers::pi / 180.0) - 1.0); }

std::vector<PolarView> polar_views(Effort effort) {
  PolarView side = straight_down("inscribed, side", 0.0, 20.0, inscribed_height_m());
  side.twin.reset();  // the poles are behind the limb
  PolarView pole = straight_down("inscribed, pole", 90.0, 0.0, inscribed_height_m());
  PolarView zoomed = straight_down("1500 km, beside the pole", 88.0, 10.0, 1.5e6);
  pole.swept = zoomed.swept = true;
  if (effort == Effort::quick) return {side, pole};
  std::vector<PolarView> views = {side,
                                  straight_down("inscribed, 45°", 45.0, 20.0, inscribed_height_m()),
                                  pole,
                                  straight_down("6000 km", 90.0, 0.0, 6.0e6),
                                  zoomed,
                                  straight_down("400 km", 90.0, 0.0, 4.0e5),
                                  straight_down("100 km", 90.0, 0.0, 1.0e5),
                                  tilted("1200 km, tilted 45°", 80.0, 1.2e6, -45.0)};
  if (effort == Effort::full) {
    views.push_back(straight_down("3000 km", 90.0, 0.0, 3.0e6));
    views.push_back(straight_down("200 km", 89.5, 0.0, 2.0e5));
    views.push_back(tilted("300 km, tilted 70°", 87.0, 3.0e5, -20.0));
  }
  return views;
}

}  // namespace terrella::bench
