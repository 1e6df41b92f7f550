#include "streaming/remote/gdal_wms/gdal_wms.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/remote/gdal_wms/gdal_wms_document.h"
#include "streaming/remote/gdal_wms/gdal_wms_grid.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wms/wms_address.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// Replacement for "${name}"; none if unknown.
std::optional<std::string> value_of_placeholder(std::string_view name, const GdalWmsDocument& said) {
  const bool bing = said.service == GdalWmsDocument::Service::virtual_earth;
  if (bing && name == "quadkey") return "{q}";
  if (bing && name == "server_num") return "{s}";
  if (bing) return std::nullopt;
  if (name == "x") return "{x}";
  if (name == "y") return said.window.rows_from_south ? "{-y}" : "{y}";
  if (name == "z") return "{z}";
  if (name == "version") return percent_encode(said.version);
  if (name == "layer") return encode_braces(said.layer);
  if (name == "format") return encode_braces(said.format);
  return std::nullopt;
}

Result<std::string> tile_template(const GdalWmsDocument& said) {
  std::string whole = said.server_url;
  const bool bing = said.service == GdalWmsDocument::Service::virtual_earth;
  if (!bing && whole.find("${") == std::string::npos) {
    whole += (whole.ends_with('/') ? "" : "/") + std::string("${version}/${layer}/${z}/${x}/${y}.${format}");
  }
  if (bing && whole.find("${quadkey}") == std::string::npos) return Error{"its <ServerUrl> has no ${quadkey}"};
  std::string url;
  std::string_view rest = whole;
  for (std::size_t at = rest.find("${"); at != std::string_view::npos; at = rest.find("${")) {
    const std::size_t end = rest.find('}', at);
    if (end == std::string_view::npos) return Error{"its <ServerUrl> has a \"${\" without a \"}\""};
    const std::string_view name = rest.substr(at + 2, end - at - 2);
    const auto value = value_of_placeholder(name, said);
    if (!value) return Error{fmt::format("its <ServerUrl> has the unknown placeholder ${{{}}}", name.substr(0, 64))};
    url += encode_braces(rest.substr(0, at)) + *value;
    rest.remove_prefix(end + 1);
  }
  return url + encode_braces(rest);
}

std::string map_template(const GdalWmsDocument& said, int tile_px) {
  const bool version_1_3 = said.version.starts_with("1.3");
  std::string url = wms_base(said.server_url, {});
  url += fmt::format("SERVICE=WMS&VERSION={}&REQUEST=GetMap&LAYERS={}&STYLES={}&{}={}&FORMAT={}",
                     percent_encode(said.version), percent_encode(said.layers), percent_encode(said.styles),
                     version_1_3 ? "CRS" : "SRS", percent_encode(said.request_crs), percent_encode(said.image_format));
  if (said.transparent) url += "&TRANSPARENT=TRUE";
  return url + fmt::format("&WIDTH={0}&HEIGHT={0}&BBOX={{bbox}}", tile_px);
}

/// Puts user and password into an address. Only there are they secret by themselves (streaming/url.h).
std::string with_user(const std::string& url, const std::string& user_and_password) {
  const std::size_t host = url.find("://");
  if (user_and_password.empty() || host == std::string::npos) return url;
  const std::size_t colon = std::min(user_and_password.find(':'), user_and_password.size());
  std::string user = percent_encode(user_and_password.substr(0, colon));
  if (colon < user_and_password.size()) {
    std::string password = percent_encode(user_and_password.substr(colon + 1));
    // percent_encode() leaves colons.
    for (std::size_t at = password.find(':'); at != std::string::npos; at = password.find(':')) {
      password.replace(at, 1, "%3A");
    }
    user += ":" + password;
  }
  return url.substr(0, host + 3) + user + "@" + url.substr(host + 3);
}

ImageFormat format_of(const GdalWmsDocument& said, const std::string& url) {
  if (said.numbers) return ImageFormat::png;
  const std::string kind =
      lower_case(said.service == GdalWmsDocument::Service::wms ? said.image_format : url.substr(0, url.find('?')));
  if (kind.ends_with("png")) return ImageFormat::png;
  return kind.ends_with("webp") ? ImageFormat::webp : ImageFormat::jpeg;
}

Status limit(const RemoteOptions& options, TileGrid& grid) {
  if (Status same = check_tile_px(grid, options); !same) return same;
  if (options.root_span_deg) return Error{"its window says what a tile spans; leave the root span out"};
  return narrow_levels(grid, options);
}

RemoteTileSet make_set(const GdalWmsDocument& said, GdalWmsGrid placed, const std::string& url) {
  RemoteTileSet set;
  set.info.format = format_of(said, url);
  set.info.numbers = said.numbers;
  set.url = with_user(url, said.user_and_password);
  set.northing_first = said.northing_first;
  set.info.grid = placed.grid;
  set.info.square = placed.square;
  set.info.body = placed.body;
  set.info.name = Url(url).without_query();
  set.subdomains = said.service == GdalWmsDocument::Service::virtual_earth && url.find("{s}") != std::string::npos
                       ? std::vector<std::string>{"0", "1", "2", "3"}
                       : std::vector<std::string>();
  set.shifts = std::move(placed.shifts);
  set.level_names = std::move(placed.level_names);
  set.missing_statuses = said.missing_statuses;
  set.exception_is_missing = said.exception_is_missing;
  set.timeout = said.timeout;
  set.tile_life = said.tile_life;
  set.connections = said.connections;
  return set;
}

Result<RemoteTileSet> describe_gdal_wms(std::string_view xml, const RemoteOptions& options) {
  const Result<GdalWmsDocument> said = read_gdal_wms(xml);
  if (!said) return said.error();
  Result<GdalWmsGrid> placed = place_gdal_window(*said);
  if (!placed) return placed.error();
  const bool is_wms = said->service == GdalWmsDocument::Service::wms;
  const Result<std::string> url = is_wms ? map_template(*said, placed->grid.tile_px) : tile_template(*said);
  if (!url) return url.error();
  if (url->find("{q}") != std::string::npos && !placed->level_names.empty()) {
    return Error{"its quadkeys need a window of the whole square of Web Mercator"};
  }
  if (placed->square && (options.projection || options.bounds)) {
    return Error{"its tiles lie on a grid of their own; leave projection and bounds out"};
  }
  if (Status same = check_projection(placed->grid, options); !same) return same.error();
  RemoteTileSet set = make_set(*said, *std::move(placed), *url);
  if (Status limited = limit(options, set.info.grid); !limited) return limited.error();
  RemoteOptions all = options;
  if (!said->referer.empty()) all.headers.push_back("Referer: " + said->referer);
  if (Status checked = check_options(all, "<Referer>"); !checked) return checked.error();
  apply_options(set, all);
  return set;
}

}  // namespace

Result<RemoteTileSet> parse_gdal_wms(std::string_view xml, const RemoteOptions& options, const std::string& where) {
  if (Status checked = check_options(options, where); !checked) return checked.error();
  Result<RemoteTileSet> set = describe_gdal_wms(xml, options);
  if (!set) return Error{where + ": " + set.error().message};
  if (Status checked = check_url_template(*set, true, where); !checked) return checked.error();
  if (Status checked = check_grid(set->info.grid, where); !checked) return checked.error();
  return set;
}

}  // namespace terrella
