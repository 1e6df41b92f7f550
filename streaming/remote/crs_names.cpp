#include "streaming/remote/crs_names.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "base/number.h"
#include "geo/body.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

struct NaifBody {
  std::int64_t number;
  const char* name;
};
constexpr std::array kBodies = {NaifBody{199, "mercury"}, NaifBody{299, "venus"},  NaifBody{301, "moon"},
                                NaifBody{399, "earth"},   NaifBody{401, "phobos"}, NaifBody{499, "mars"},
                                NaifBody{599, "jupiter"}, NaifBody{699, "saturn"}};

Error not_geographic(std::string_view name) {
  return Error{fmt::format("its reference system is {}; only longitude and latitude (EPSG:4326, CRS84) can be drawn",
                           name.empty() ? "not said" : name.substr(0, 100))};
}

Result<GeographicCrs> iau_crs(std::int64_t code, bool of_2015, std::string_view name) {
  const std::int64_t kind = code % 100;
  for (const NaifBody& body : kBodies) {
    if (code / 100 != body.number || kind > 2 || !parse_body(body.name)) continue;
    const bool centric = of_2015 && kind == 2;
    return GeographicCrs{.body = body.name, .latitude = centric ? LatitudeKind::centric : LatitudeKind::graphic};
  }
  return not_geographic(name);
}

}  // namespace

bool is_web_mercator(std::string_view name) {
  name = trimmed(name);
  const std::string_view code = name.substr(name.find_last_of(":/") + 1);
  for (const std::string_view one : {"3857", "900913", "3785", "102100", "102113"}) {
    if (code == one) return true;
  }
  return false;
}

std::string geographic_crs_urn(std::string_view body, LatitudeKind latitude) {
  const bool centric = latitude == LatitudeKind::centric;
  if (body.empty() || body == "earth") return centric ? "" : "urn:ogc:def:crs:OGC:1.3:CRS84";
  for (const NaifBody& known : kBodies) {
    if (body != known.name) continue;
    // On a sphere both latitudes are equal, and the IAU has the code 00 alone.
    const auto preset = parse_body(body);
    const bool is_sphere = preset && preset->ellipsoid.f() == 0.0;
    return fmt::format("urn:ogc:def:crs:IAU:2015:{}{}", known.number, centric && !is_sphere ? "02" : "00");
  }
  return {};
}

Result<GeographicCrs> parse_crs(std::string_view name) {
  name = trimmed(name);
  const std::string upper_or_not = lower_case(name);
  const std::string_view lowered = upper_or_not;
  const std::string_view code = lowered.substr(lowered.find_last_of(":/") + 1);
  if (is_web_mercator(name)) {
    return Error{fmt::format("it is in Web Mercator ({}), not in longitude and latitude", name)};
  }
  if (code == "crs84" || (code == "84" && lowered.find("epsg") == std::string_view::npos)) {
    return GeographicCrs{.body = "earth"};
  }
  const auto number = to_integer(code);
  if (!number || *number < 0) return not_geographic(name);
  if (*number == 4326) return GeographicCrs{.latitude_first = true, .body = "earth"};
  if (*number == 104903) return GeographicCrs{.body = "moon"};
  if (*number == 104905) return GeographicCrs{.body = "mars"};
  if (lowered.find("iau") == std::string_view::npos) return not_geographic(name);
  return iau_crs(*number, lowered.find("2015") != std::string_view::npos, name);
}

}  // namespace terrella
