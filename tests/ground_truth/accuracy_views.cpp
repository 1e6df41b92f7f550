#include "ground_truth/accuracy_views.h"

#include <utility>

namespace terrella::truth {
namespace {

constexpr Spheroid kEarth{};
constexpr Spheroid kSphere{6371000.0, 0.0};
constexpr Spheroid kFlat{60268000.0, 0.098};  // Saturn's flattening
constexpr int kSmall_px = 512;
// From so high the globe is minified: 2.8 texels of the noise planet a pixel.
constexpr double kFourRadii = 3.0;
// The heights of the table below, in radii, for bodies of another size.
constexpr double kHigh = 6.0e6 / 6378137.0;

// Limits that no table sets hold what is reached, with a fifth to spare for other drivers. Rounding leaves 0.29.
constexpr double kHeld6000 = 0.48;
constexpr double kHeld1500 = 0.43;
constexpr double kHeldBodies = 0.46;
// The 40 px around a pole in views from up to 6000 km with 1024 pixels. At 512 pixels 6000 km leave 0.39.
constexpr double kHeldCore = 0.33;

Bound at_most(Zone zone, double rms) { return {.zone = zone, .value = rms}; }

TruthCamera over(double lat_deg, double lon_deg, double height_m) { return {.eye = {lat_deg, lon_deg, height_m}}; }

AccuracyView noise(std::string name, TruthCamera camera, int size_px, std::vector<Bound> bounds) {
  return {std::move(name), "noise", kEarth, {}, camera, size_px, std::move(bounds)};
}

// Errors that CesiumJS reached with the same pyramid of PNG tiles, camera by camera.
void add_table(std::vector<AccuracyView>& views) {
  views.push_back(noise("mid latitude", over(30, 20, 6e6), 1024, {at_most(Zone::all, 1.13)}));
  views.push_back(noise("antimeridian", over(0, 180, 6e6), 1024, {at_most(Zone::antimeridian, 0.61)}));
  // Squeezed tiles against the same view of the equator: less error in the band. The corners of the whole picture see
  // the rows that are squeezed least.
  constexpr double kInBand = 1.0;
  const Bound core = at_most(Zone::pole_core, kHeldCore);
  views.push_back(noise("equator", over(0, 20, 6e6), 1024, {}));
  views.push_back(noise("beside the pole", over(89.9, 0, 6e6), 1024,
                        {at_most(Zone::pole, 0.38),
                         {Zone::pole_clear, Bound::Kind::other_view, kInBand, Zone::all, "equator"},
                         at_most(Zone::all, 0.46),
                         core}));
  views.push_back(noise("pole, near", over(88, 10, 1.5e6), 1024, {at_most(Zone::pole, 0.33), core}));
  views.push_back(noise("pole, tilted", {{80, 180, 1.2e6}, 0, -45, 40}, 1024, {at_most(Zone::pole_clear, 0.41), core}));
  views.push_back(noise("low oblique", {{46, 7, 3e5}, 30, -20, 45}, 1024, {at_most(Zone::clear, 0.32)}));
}

void add_poles(std::vector<AccuracyView>& views) {
  for (const double lat : {90.0, -90.0}) {
    const std::string name = lat > 0 ? "north pole" : "south pole";
    views.push_back(noise(name + ", 6000 km", over(lat, 0, 6e6), kSmall_px, {at_most(Zone::pole, kHeld6000)}));
    views.push_back(noise(name + ", 1500 km", over(lat, 0, 1.5e6), kSmall_px,
                          {at_most(Zone::pole, kHeld1500), at_most(Zone::pole_core, kHeldCore)}));
  }
}

void add_four_radii(std::vector<AccuracyView>& views) {
  const double height_m = kFourRadii * kEarth.a_m;
  const std::string reference = "four radii, 45°";
  views.push_back(noise(reference, over(45, 20, height_m), 1024, {}));
  // By the slant of the middles of patches, the levels of tiles would leave 2.43 and 2.90.
  const Bound facing = at_most(Zone::mid_latitudes, 2.05);
  views.push_back(
      noise("four radii, antimeridian", over(0, 180, height_m), 1024, {facing, at_most(Zone::antimeridian, 1.5)}));
  for (const double lat : {90.0, -90.0}) {
    const Bound bound{Zone::pole, Bound::Kind::other_view, 1.0, Zone::mid_latitudes, reference};
    views.push_back(noise(lat > 0 ? "four radii, north pole" : "four radii, south pole", over(lat, 20, height_m), 1024,
                          {bound, facing}));
  }
}

void add_bodies(std::vector<AccuracyView>& views) {
  for (const auto& [name, body] : {std::pair{"sphere", kSphere}, std::pair{"flattened", kFlat}}) {
    const auto add = [&](const std::string& what, TruthCamera camera, RowRule rows, Zone zone, double rms) {
      views.push_back({std::string(name) + ", " + what, "noise", body, rows, camera, kSmall_px, {at_most(zone, rms)}});
    };
    const double high_m = kHigh * body.a_m;
    add("mid latitude", over(40, -70, 0.5 * high_m), {}, Zone::all, kHeldBodies);
    add("pole", over(89.9, 0, 0.5 * high_m), {}, Zone::pole, kHeldBodies);
    if (body.f == 0.0) continue;
    add("centric rows", over(40, -70, 0.5 * high_m), {.centric = true}, Zone::all, kHeldBodies);
    add("equal-area rows", over(20, -70, 0.5 * high_m), {.equal_area = true}, Zone::all, kHeldBodies);
  }
}

void add_blue_marble(std::vector<AccuracyView>& views) {
  const auto add = [&](const std::string& name, TruthCamera camera, Zone zone, double rms) {
    views.push_back({"Blue Marble, " + name, "blue_marble", kEarth, {}, camera, kSmall_px, {at_most(zone, rms)}});
  };
  add("mid latitude", over(30, 20, 6e6), Zone::all, 0.55);
  add("antimeridian", over(0, 180, 6e6), Zone::antimeridian, 0.35);
  // The picture's rows round the South Pole are not smooth: two by two exact look-ups a pixel leave 1.07.
  add("pole", over(-89.9, 0, 6e6), Zone::pole, 0.95);
}

}  // namespace

std::vector<AccuracyView> accuracy_views() {
  std::vector<AccuracyView> views;
  add_table(views);
  add_poles(views);
  add_four_radii(views);
  add_bodies(views);
  add_blue_marble(views);
  return views;
}

}  // namespace terrella::truth
