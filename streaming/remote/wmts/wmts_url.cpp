#include "streaming/remote/wmts/wmts_url.h"

#include <fmt/format.h>

#include <optional>

#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

/// Replacement for a placeholder; nothing if unknown. Ignores case, because writers differ.
std::optional<std::string> value_of(std::string_view name, const WmtsRequest& request) {
  if (same_letters(name, "TileMatrix")) return "{z}";
  if (same_letters(name, "TileRow")) return "{row}";
  if (same_letters(name, "TileCol")) return "{col}";
  if (same_letters(name, "TileMatrixSet")) return percent_encode(request.matrix_set);
  if (same_letters(name, "Style")) return percent_encode(request.style);
  if (same_letters(name, "Layer")) return percent_encode(request.layer);
  for (const auto& [dimension, value] : request.dimensions) {
    if (same_letters(name, dimension)) return percent_encode(value);
  }
  return std::nullopt;
}

}  // namespace

Result<std::string> rest_template(const std::string& wmts_template, const WmtsRequest& request) {
  std::string url;
  std::string_view rest = wmts_template;
  for (std::size_t at = rest.find('{'); at != std::string_view::npos; at = rest.find('{')) {
    const std::size_t end = rest.find('}', at);
    if (end == std::string_view::npos) return Error{"its ResourceURL has a brace without its other half"};
    const std::string_view name = rest.substr(at + 1, end - at - 1);
    const auto value = value_of(name, request);
    if (!value) return Error{fmt::format("its ResourceURL has the unknown placeholder {{{}}}", name.substr(0, 64))};
    url += rest.substr(0, at);
    url += *value;
    rest.remove_prefix(end + 1);
  }
  return url.append(rest);
}

std::string kvp_template(const std::string& address, const WmtsRequest& request) {
  std::string url = encode_braces(address);
  if (url.find('?') == std::string::npos) url += '?';
  if (!url.ends_with('?') && !url.ends_with('&')) url += '&';
  url += fmt::format("SERVICE=WMTS&REQUEST=GetTile&VERSION=1.0.0&LAYER={}&STYLE={}&TILEMATRIXSET={}&FORMAT={}",
                     percent_encode(request.layer), percent_encode(request.style), percent_encode(request.matrix_set),
                     percent_encode(request.media_type));
  url += "&TILEMATRIX={z}&TILEROW={row}&TILECOL={col}";
  for (const auto& [dimension, value] : request.dimensions) {
    url += fmt::format("&{}={}", percent_encode(dimension), percent_encode(value));
  }
  return url;
}

}  // namespace terrella
