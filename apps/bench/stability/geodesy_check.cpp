#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <random>

#include "apps/bench/stability/check.h"
#include "geo/body.h"
#include "geo/camera.h"

namespace terrella::bench {
namespace {

// Bound promised by Ellipsoid's header within 5000 km of the surface.
constexpr double kMostRoundTrip_m = 1.0e-8;
constexpr double kReach_m = 5.0e6;
constexpr double kMostPick_px = 0.1;
constexpr double kUlp = 0x1p-52;

/// Random places with a fixed seed, so that every run measures the same.
class Places {
 public:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Geodetic place(double lowest_m, double highest_m) {
    return {.lat = Angle::degrees(between(-90.0, 90.0)),
            .lon = Angle::degrees(between(-180.0, 180.0)),
            .height_m = between(lowest_m, highest_m)};
  }

 private:
  std::mt19937_64 random_{20261};
};

glm::dvec3 by_geographiclib(const Geodetic& place) {
  const GeographicLib::Geocentric& earth_of = GeographicLib::Geocentric::WGS84();
  glm::dvec3 p;
  earth_of.Forward(place.lat.deg(), place.lon.deg(), place.height_m, p.x, p.y, p.z);
  return p;
}

double worst_forward_m(int count) {
  Places places;
  double worst = 0.0;
  for (int k = 0; k < count; ++k) {
    const Geodetic place = places.place(-kReach_m, kReach_m);
    worst = std::max(worst, glm::distance(earth().ellipsoid.to_ecef(place).xyz_m, by_geographiclib(place)));
  }
  return worst;
}

double worst_round_trip_m(int count) {
  Places places;
  double worst = 0.0;
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 p = by_geographiclib(places.place(-kReach_m, kReach_m));
    worst = std::max(worst, glm::distance(by_geographiclib(earth().ellipsoid.to_geodetic(Ecef{p})), p));
  }
  return worst;
}

// On the axis latitude and height are known exactly; at the centre the height is minus the polar radius.
double worst_on_axis_ulps() {
  const Ellipsoid& e = earth().ellipsoid;
  double worst = 0.0;
  for (const double height_m : {-e.b_m(), -1.0e6, -1.0, 0.0, 1.0, 1.0e6, 4.0e8}) {
    for (const double side : {1.0, -1.0}) {
      const double z = side * (e.b_m() + height_m);
      const Geodetic place = e.to_geodetic(Ecef{{0.0, 0.0, z}});
      const double lat_deg = height_m == -e.b_m() ? 90.0 : side * 90.0;
      const double scale_m = std::max(e.b_m(), std::abs(height_m));
      worst = std::max({worst, std::abs(place.lat.deg() - lat_deg) / (90.0 * kUlp), std::abs(place.lon.deg()),
                        std::abs(place.height_m - height_m) / (scale_m * kUlp)});
    }
  }
  return worst;
}

/// Distance between the pixel and the place picked there, in pixels; 0 if the pixel shows no ground.
double pick_error_px(const View& view, glm::dvec2 pixel_px) {
  const auto place = pick(view, earth().ellipsoid, pixel_px);
  if (!place) return 0.0;
  const auto back = project(view, Ecef{by_geographiclib(*place)});
  return back ? glm::distance(*back, pixel_px) : HUGE_VAL;
}

// Angle from the horizontal down to the horizon.
double dip_deg(double height_m) {
  return Angle::radians(std::acos(1.0 / (1.0 + height_m / earth().ellipsoid.a_m()))).deg();
}

View view_from(Places& places, double height_m, double pitch_deg) {
  const Camera camera{.eye = places.place(height_m, height_m),
                      .heading = Angle::degrees(places.between(0.0, 360.0)),
                      .pitch = Angle::degrees(std::max(-90.0, pitch_deg))};
  return make_view(camera, earth().ellipsoid, {1024, 1024});
}

// Picks places in the picture's middle, which shows ground even from afar.
double worst_pick_px(double height_m, int count) {
  Places places;
  double worst = 0.0;
  for (int k = 0; k < count; ++k) {
    const View view = view_from(places, height_m, places.between(-90.0, -dip_deg(height_m)));
    const double disc_px = earth().ellipsoid.b_m() / height_m * view.pixels_per_radian();
    const double reach_px = std::min(512.0, disc_px);
    worst = std::max(worst, pick_error_px(view, {512.0 + places.between(-reach_px, reach_px),
                                                 512.0 + places.between(-reach_px, reach_px)}));
  }
  return worst;
}

/// Finds the last pixel before the sky, upwards from a ground pixel, to a thousandth. Returns nullopt without ground or
/// without sky.
std::optional<glm::dvec2> last_on_ground(const View& view, double x_px) {
  const auto middle_px = project(view, Ecef{});  // the planet's middle, from afar
  double ground = view.viewport.height_px, sky = 0.0;
  if (middle_px) ground = std::min(ground, middle_px->y);
  const auto hits = [&](double y) { return pick(view, earth().ellipsoid, {x_px, y}).has_value(); };
  if (!hits(ground) || hits(sky)) return std::nullopt;
  while (ground - sky > 1e-3) {
    const double middle = 0.5 * (ground + sky);
    (hits(middle) ? ground : sky) = middle;
  }
  return glm::dvec2(x_px, ground);
}

double worst_grazing_px(double height_m, int count) {
  Places places;
  double worst = 0.0;
  int judged = 0;
  for (int k = 0; k < count; ++k) {
    const View view = view_from(places, height_m, -dip_deg(height_m));
    const auto pixel = last_on_ground(view, places.between(508.0, 516.0));  // from afar the globe is 18 px wide
    if (!pixel) continue;
    ++judged;
    worst = std::max(worst, pick_error_px(view, *pixel));
  }
  return judged > 0 ? worst : HUGE_VAL;
}

}  // namespace

Status check_geodesy(const StabilityOptions& options, Checks& checks) {
  const int count = options.quick ? 200 : 20000;
  Check geodetic{.test = "geodetic", .subject = "forward", .unit = "m", .limit = kMostRoundTrip_m};
  checks.push_back(timed(geodetic, [&] { return worst_forward_m(count); }));
  geodetic.subject = "there and back";
  checks.push_back(timed(geodetic, [&] { return worst_round_trip_m(count); }));
  const Check axis{.test = "geodetic", .subject = "on the axis and at the centre", .unit = "ulp", .limit = 1.0};
  checks.push_back(timed(axis, worst_on_axis_ulps));
  for (double height_m = 1.0; height_m < 2e9; height_m *= 1000.0) {
    Check picked{.test = "pick", .at = height_m, .at_unit = "m", .unit = "px", .limit = kMostPick_px};
    picked.subject = "anywhere";
    checks.push_back(timed(picked, [&] { return worst_pick_px(height_m, count / 10); }));
    picked.subject = "grazing";
    checks.push_back(timed(picked, [&] { return worst_grazing_px(height_m, count / 100); }));
  }
  return Done{};
}

}  // namespace terrella::bench
