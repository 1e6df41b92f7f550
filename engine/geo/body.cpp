#include "geo/body.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "base/number.h"
#include "geo/ranges.h"

namespace terrella {
namespace {

Body from_axes(std::string name, double equatorial_m, double polar_m) {
  return {.name = std::move(name), .ellipsoid = Ellipsoid(equatorial_m, (equatorial_m - polar_m) / equatorial_m)};
}

Body sphere(std::string name, double radius_m) {
  return {.name = std::move(name), .ellipsoid = Ellipsoid(radius_m, 0.0)};
}

/// Source of all figures but Earth's: IAU Working Group on Cartographic Coordinates and Rotational Elements, report of
/// 2015 (Archinal et al. 2018, doi:10.1007/s10569-017-9805-5). They were compared with PROJ 9.1 (authority IAU_2015)
/// for the bodies in its database. A spheroid has its equatorial and polar radius. A triaxial body is a sphere of its
/// mean radius. Titan has the radius that the report prescribes for maps.
std::array<Body, 25> make_presets() {
  return {
      // WGS 84: NGA.STND.0036, defining parameters.
      Body{.name = "earth", .ellipsoid = Ellipsoid(6378137.0, 1.0 / 298.257223563)},
      sphere("moon", 1737400.0),
      from_axes("mars", 3396190.0, 3376200.0),
      // Earth's mean radius R1 = (2a + b) / 3 of WGS 84, rounded to 0.1 m.
      sphere("sphere", 6371008.8),
      from_axes("mercury", 2440530.0, 2438260.0),
      sphere("venus", 6051800.0),
      from_axes("jupiter", 71492000.0, 66854000.0),
      from_axes("saturn", 60268000.0, 54364000.0),
      from_axes("uranus", 25559000.0, 24973000.0),
      from_axes("neptune", 24764000.0, 24341000.0),
      sphere("pluto", 1188300.0),
      sphere("charon", 606000.0),
      from_axes("ceres", 487300.0, 446000.0),
      sphere("vesta", 255000.0),
      sphere("phobos", 11080.0),
      sphere("deimos", 6200.0),
      sphere("io", 1821490.0),
      sphere("europa", 1560800.0),
      sphere("ganymede", 2631200.0),
      sphere("callisto", 2410300.0),
      sphere("enceladus", 252100.0),
      sphere("titan", 2575000.0),
      from_axes("iapetus", 745700.0, 712100.0),
      sphere("triton", 1352600.0),
      sphere("sun", 695700000.0),
  };
}

char lower_ascii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower_ascii, lower_ascii);
}

std::string preset_names() {
  std::string names;
  for (const Body& body : body_presets()) names += (names.empty() ? "" : ", ") + body.name;
  return names;
}

Error bad_body(std::string_view text, std::string_view reason) {
  return {"body " + in_quotes(text) + ": " + std::string(reason) +
          "; give A,F (semi-major axis in metres, flattening) or one of " + preset_names()};
}

Result<Body> parse_figure(std::string_view text, std::string_view axis, std::string_view flattening) {
  const std::optional<double> a_m = read_number(axis);
  const std::optional<double> f = read_number(flattening);
  if (!a_m) return bad_body(text, "A, " + in_quotes(axis) + ", is not a number");
  if (!f) return bad_body(text, "F, " + in_quotes(flattening) + ", is not a number");
  const Ellipsoid figure(*a_m, *f);
  if (const Status good = check_ellipsoid(figure); !good) return bad_body(text, good.error().message);
  return Body{.name = std::string(text), .ellipsoid = figure};
}

}  // namespace

std::span<const Body> body_presets() {
  static const std::array<Body, 25> presets = make_presets();
  return presets;
}

const Body& earth() { return body_presets().front(); }

Result<Body> parse_body(std::string_view text) {
  const std::vector<std::string_view> fields = split_at_commas(text);
  if (fields.size() == 2) return parse_figure(text, fields[0], fields[1]);
  if (fields.size() > 2) return bad_body(text, "more than two numbers");
  const auto preset = std::ranges::find_if(body_presets(), [&](const Body& b) { return same_name(b.name, fields[0]); });
  if (preset == body_presets().end()) return bad_body(text, "no such body");
  return *preset;
}

}  // namespace terrella
