#include "streaming/remote/bulk_terms.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

struct Terms {
  std::string_view domain;
  std::string_view whose;
};

// Only hosts dedicated to maps and imagery. On storage.googleapis.com or tiles.arcgis.com anybody may publish.
constexpr std::array kTerms = {
    Terms{"tile.openstreetmap.org", "OpenStreetMap's tile usage policy"},
    Terms{"google.com", "Google Maps Platform's terms of service"},
    Terms{"maps.googleapis.com", "Google Maps Platform's terms of service"},
    Terms{"tile.googleapis.com", "Google Maps Platform's terms of service"},
    Terms{"virtualearth.net", "Bing Maps' terms of use"},
    Terms{"bing.com", "Bing Maps' terms of use"},
    Terms{"arcgisonline.com", "Esri's terms for its basemaps"},
    Terms{"basemaps.arcgis.com", "Esri's terms for its basemaps"},
    Terms{"basemaps-api.arcgis.com", "Esri's terms for its basemaps"},
    Terms{"ibasemaps-api.arcgis.com", "Esri's terms for its basemaps"},
};

bool belongs_to(std::string_view host, std::string_view domain) {
  if (!host.ends_with(domain)) return false;
  return host.size() == domain.size() || host[host.size() - domain.size() - 1] == '.';
}

}  // namespace

std::string bulk_refusal(const Url& url) {
  const auto address = parse_address(url);
  if (!address) return {};
  for (const Terms& terms : kTerms) {
    if (!belongs_to(address->host, terms.domain)) continue;
    return fmt::format("{} forbids bulk download from {}; look at it with `view`, or use a source that allows it",
                       terms.whose, address->host);
  }
  return {};
}

}  // namespace terrella
