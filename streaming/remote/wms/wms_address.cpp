#include "streaming/remote/wms/wms_address.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

/// Parameters of GetCapabilities and GetMap, in lower case. Terrella sets them itself.
constexpr std::array kDefined =
    std::to_array<std::string_view>({"service", "request", "version", "layers", "layer", "styles", "style", "crs",
                                     "srs", "bbox", "width", "height", "transparent", "format", "exceptions", "time"});

using Parameters = std::vector<std::pair<std::string, std::string>>;  ///< name in lower case, "Name=value" as written

Parameters parameters_of(std::string_view query) {
  Parameters all;
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view one = query.substr(0, end);
    if (!one.empty()) all.emplace_back(lower_case(one.substr(0, one.find('='))), one);
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return all;
}

std::string_view query_of(std::string_view address) {
  address = address.substr(0, address.find('#'));
  const std::size_t mark = address.find('?');
  return mark == std::string_view::npos ? std::string_view() : address.substr(mark + 1);
}

bool is_defined(const std::string& name) { return std::ranges::find(kDefined, name) != kDefined.end(); }

std::string value_of(const Parameters& all, std::string_view name) {
  for (const auto& [known, written] : all) {
    if (known != name || written.size() <= known.size()) continue;
    return percent_decode(std::string_view(written).substr(known.size() + 1));
  }
  return {};
}

std::string first_of(const Parameters& all, std::string_view name, std::string_view other) {
  std::string value = value_of(all, name);
  return value.empty() ? value_of(all, other) : value;
}

}  // namespace

bool is_wms_address(std::string_view address) {
  const Parameters all = parameters_of(query_of(address));
  return same_letters(value_of(all, "service"), "WMS") || same_letters(value_of(all, "request"), "GetMap");
}

std::string wms_base(std::string_view server, std::string_view extra) {
  std::string base = encode_braces(server.substr(0, server.find_first_of("?#"))) + "?";
  const Parameters own = parameters_of(query_of(server));
  for (const auto& [name, written] : own) {
    if (!is_defined(name)) base += encode_braces(written) + "&";
  }
  for (const auto& other : parameters_of(extra)) {
    const bool known = std::ranges::any_of(own, [&](const auto& one) { return one.first == other.first; });
    if (!known) base += encode_braces(other.second) + "&";
  }
  return base;
}

WmsAddress read_wms_address(const Url& address) {
  const std::string& text = address.with_secrets();
  const Parameters all = parameters_of(query_of(text));
  WmsAddress wms{.layers = first_of(all, "layers", "layer"),
                 .styles = first_of(all, "styles", "style"),
                 .crs = first_of(all, "crs", "srs"),
                 .format = value_of(all, "format"),
                 .time = value_of(all, "time")};
  // Some servers take FORMAT=text/xml as the format of the capabilities.
  if (!wms.format.starts_with("image/")) wms.format.clear();
  for (const auto& [name, written] : all) {
    if (!is_defined(name)) wms.extra += (wms.extra.empty() ? "" : "&") + written;
  }
  const std::string version = value_of(all, "version");
  wms.capabilities = wms_base(text, {}) + "SERVICE=WMS&REQUEST=GetCapabilities&VERSION=" +
                     (version.empty() ? "1.3.0" : percent_encode(version));
  return wms;
}

}  // namespace terrella
