#include "streaming/georeference/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/georeference/crs_text.h"

namespace terrella {
namespace {

/// Smallest relative difference of radii that makes two bodies.
constexpr double kOtherBody = 0.01;

bool differ(double a, double b) { return std::abs(a - b) > kOtherBody * b; }

/// A sphere stands for a flattened body by its equatorial radius.
bool is_other_body(const CrsFacts& crs, const Body& body) {
  const Ellipsoid& own = body.ellipsoid;
  return differ(crs.a_m, own.a_m()) || (crs.a_m != crs.b_m && differ(crs.b_m, own.a_m() * (1.0 - own.f())));
}

bool is_earth(const Body& body) { return !differ(body.ellipsoid.a_m(), earth().ellipsoid.a_m()); }

}  // namespace

std::string body_name(const CrsFacts& crs) {
  if (!is_other_body(crs, earth())) return earth().name;
  const Body* nearest = nullptr;
  for (const Body& body : body_presets()) {
    const auto off = [&crs](const Body& b) { return std::abs(b.ellipsoid.a_m() - crs.a_m); };
    if (!is_other_body(crs, body) && (nearest == nullptr || off(body) < off(*nearest))) nearest = &body;
  }
  if (nearest != nullptr) return nearest->name;
  return fmt::format("{:.10g},{:.10g}", crs.a_m, std::max(0.0, 1.0 - crs.b_m / crs.a_m));
}

// A sphere stands for an ellipsoid in USGS's maps. On Earth such latitudes count as geodetic, by common practice.
LatitudeKind latitude_of(const CrsFacts& crs, const Body& body) {
  const bool stands_in = crs.a_m == crs.b_m && !is_earth(body);
  const bool centric = body.ellipsoid.f() > 0.0 && (crs.centric || stands_in);
  return centric ? LatitudeKind::centric : LatitudeKind::graphic;
}

bool are_two_bodies(const Body& one, const Body& other) {
  const auto polar_m = [](const Body& body) { return body.ellipsoid.a_m() * (1.0 - body.ellipsoid.f()); };
  const bool spheres = one.ellipsoid.f() == 0.0 || other.ellipsoid.f() == 0.0;
  return differ(one.ellipsoid.a_m(), other.ellipsoid.a_m()) || (!spheres && differ(polar_m(one), polar_m(other)));
}

std::string stated_body(const CrsFacts& crs) { return is_other_body(crs, earth()) ? body_name(crs) : std::string(); }

std::string stated_body(const PictureFile& picture, const PlaceWords& words) {
  const auto named = stated_crs(words.crs);
  std::string text = named ? *named : words.crs;
  if (text.empty()) {
    const auto said = read_georeference(picture);
    if (said && *said) text = (*said)->crs;
  }
  if (text.empty()) return {};
  const auto crs = Crs::open(text);
  return crs ? stated_body(crs->facts()) : std::string();
}

Result<LatitudeKind> check_figure(PlacedPicture& placed, const Body& body, std::optional<LatitudeKind> asked) {
  if (!placed.crs) return asked.value_or(LatitudeKind::graphic);
  const CrsFacts& crs = *placed.crs;
  if (is_other_body(crs, body)) {
    const std::string right = stated_body(crs);
    return Error{
        fmt::format("{}, on a body with radii of {:.9g} and {:.9g} m, and {} has {:.9g} and {:.9g}; say which "
                    "it is: ‹body› {}",
                    placed.claim, crs.a_m, crs.b_m, body.name, body.ellipsoid.a_m(),
                    body.ellipsoid.a_m() * (1.0 - body.ellipsoid.f()), right.empty() ? "earth" : right)};
  }
  const LatitudeKind stated = latitude_of(crs, body);
  // A sphere does not tell which latitudes it means on the Earth.
  const bool tells = crs.a_m != crs.b_m || stated == LatitudeKind::centric;
  if (asked && *asked != stated && tells && body.ellipsoid.f() > 0.0) {
    const bool centric = stated == LatitudeKind::centric;
    placed.remarks.push_back(fmt::format("{}, with {} latitudes; ‹latitude› {} is used instead", placed.claim,
                                         centric ? "planetocentric" : "planetographic",
                                         centric ? "graphic" : "centric"));
  }
  return asked.value_or(stated);
}

}  // namespace terrella
