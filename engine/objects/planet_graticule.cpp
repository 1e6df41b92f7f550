#include <algorithm>
#include <cmath>

#include "objects/degree_name.h"
#include "objects/graticule.h"

// The graticule of a whole planet, as objects.
namespace terrella {
namespace {

// Error is at most step² · sin(latitude) · cos(latitude) / 8.
constexpr double kParallelStep_deg = 0.5;

/// Makes the lines of a planet, one degree of latitude or longitude at a time.
class PlanetNet {
 public:
  explicit PlanetNet(const GraticuleLook& look)
      : look_(look),
        each_quarter_(std::max(1, static_cast<int>(std::lround(90.0 / std::clamp(look.spacing_deg, 1.0, 90.0))))) {
    while (90 % each_quarter_ != 0) --each_quarter_;
    spacing_deg_ = 90.0 / each_quarter_;
  }

  ObjectScene build() {
    for (int k = 1 - each_quarter_; k < each_quarter_; ++k) add_parallel(k * spacing_deg_);
    for (int k = -2 * each_quarter_; k < 2 * each_quarter_; ++k) add_meridian(k * spacing_deg_, k % each_quarter_ == 0);
    return std::move(scene_);
  }

 private:
  [[nodiscard]] Geodetic place(double lat_deg, double lon_deg) const {
    return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = look_.height_m};
  }

  void add_parallel(double lat_deg) {
    const int steps = static_cast<int>(std::lround(360.0 / kParallelStep_deg));
    std::vector<Geodetic> places;
    for (int k = 0; k <= steps; ++k) places.push_back(place(lat_deg, k * kParallelStep_deg - 180.0));
    add_line(std::move(places));
    if (lat_deg != 0.0) add_label(lat_deg, 0.0, degree_name(lat_deg, spacing_deg_, "N", "S"));
  }

  // Goes through a place on the equator: from pole to pole there is more than one shortest way.
  void add_meridian(double lon_deg, bool to_poles) {
    const double end_deg = to_poles ? 90.0 : 90.0 - spacing_deg_;
    add_line({place(-end_deg, lon_deg), place(0.0, lon_deg), place(end_deg, lon_deg)});
    add_label(0.0, lon_deg, degree_name(lon_deg, spacing_deg_, "E", "W"));
  }

  void add_line(std::vector<Geodetic> places) {
    scene_.lines.push_back({.places = std::move(places), .width_px = look_.width_px, .color = look_.color});
  }

  void add_label(double lat_deg, double lon_deg, std::string text) {
    constexpr double kAfterOthers = -1.0e6;
    if (!look_.labels) return;
    scene_.labels.push_back(
        {.text = std::move(text), .place = place(lat_deg, lon_deg), .size_px = 0.0F, .priority = kAfterOthers});
  }

  GraticuleLook look_;
  int each_quarter_;
  double spacing_deg_ = 0.0;
  ObjectScene scene_;
};

}  // namespace

ObjectScene graticule_objects(const GraticuleLook& look) { return PlanetNet(look).build(); }

}  // namespace terrella
