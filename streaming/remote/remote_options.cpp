#include "streaming/remote/remote_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "geo/body.h"
#include "streaming/http/http_headers.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxHeaders = 64;
constexpr std::size_t kMaxSubdomains = 64;

void prefer(std::string& said, const std::string& otherwise) {
  if (said.empty()) said = otherwise;
}

template <class T>
void prefer(std::optional<T>& said, const std::optional<T>& otherwise) {
  if (!said) said = otherwise;
}

bool is_letter_or_digit(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_subdomain(const std::string& name) {
  return !name.empty() && name.size() <= 63 &&
         std::ranges::all_of(name, [](char c) { return is_letter_or_digit(c) || c == '-' || c == '.'; });
}

}  // namespace

RemoteOptions merge(const RemoteOptions& said, const RemoteOptions& otherwise) {
  RemoteOptions merged = said;
  prefer(merged.layer, otherwise.layer);
  prefer(merged.matrix_set, otherwise.matrix_set);
  prefer(merged.style, otherwise.style);
  prefer(merged.time, otherwise.time);
  if (merged.times.empty()) merged.times = otherwise.times;
  prefer(merged.root_span_deg, otherwise.root_span_deg);
  prefer(merged.tile_px, otherwise.tile_px);
  prefer(merged.min_level, otherwise.min_level);
  prefer(merged.max_level, otherwise.max_level);
  prefer(merged.bounds, otherwise.bounds);
  prefer(merged.projection, otherwise.projection);
  prefer(merged.square, otherwise.square);
  prefer(merged.latitude, otherwise.latitude);
  prefer(merged.format, otherwise.format);
  prefer(merged.numbers, otherwise.numbers);
  prefer(merged.name, otherwise.name);
  prefer(merged.attribution, otherwise.attribution);
  prefer(merged.body, otherwise.body);
  if (merged.subdomains.empty()) merged.subdomains = otherwise.subdomains;
  merged.headers.insert(merged.headers.end(), otherwise.headers.begin(), otherwise.headers.end());
  prefer(merged.tile_life, otherwise.tile_life);
  prefer(merged.missing_life, otherwise.missing_life);
  return merged;
}

Status check_projection(const TileGrid& grid, const RemoteOptions& options) {
  if (!options.projection) return Done{};
  if (grid.projection == Projection::projected) {
    return Error{"it is in a coordinate system of its own, not in the projection that was given"};
  }
  const bool said = *options.projection == Projection::web_mercator;
  if (said == (grid.projection == Projection::web_mercator)) return Done{};
  if (said) return Error{"it is in longitude and latitude, not in Web Mercator as was given"};
  return Error{"it is in Web Mercator, not in the projection that was given"};
}

Status narrow_levels(TileGrid& grid, const RemoteOptions& options) {
  const int first = std::max(options.min_level.value_or(grid.min_level), grid.min_level);
  const int last = std::min(options.max_level.value_or(grid.max_level), grid.max_level);
  if (first > last) {
    return Error{fmt::format("it has levels {} to {}, none of those asked for", grid.min_level, grid.max_level)};
  }
  grid.min_level = first;
  grid.max_level = last;
  return Done{};
}

Status check_tile_px(const TileGrid& grid, const RemoteOptions& options) {
  if (!options.tile_px || *options.tile_px == grid.tile_px) return Done{};
  return Error{fmt::format("its tiles have {} pixels, not the {} that were given", grid.tile_px, *options.tile_px)};
}

Status check_options(const RemoteOptions& options, const std::string& where) {
  if (options.headers.size() > kMaxHeaders) {
    return Error{fmt::format("{}: {} headers, at most {} are sent", where, options.headers.size(), kMaxHeaders)};
  }
  for (std::size_t i = 0; i < options.headers.size(); ++i) {
    const Status header = http::check_request_header(options.headers[i]);
    if (!header) return Error{fmt::format("{}: header {}: {}", where, i + 1, header.error().message)};
  }
  if (options.subdomains.size() > kMaxSubdomains) {
    return Error{
        fmt::format("{}: {} sub-domains, at most {} are used", where, options.subdomains.size(), kMaxSubdomains)};
  }
  for (const std::string& name : options.subdomains) {
    if (!is_subdomain(name)) return Error{fmt::format("{}: \"{}\" is not a sub-domain", where, name)};
  }
  if (options.body && !options.body->empty()) {
    if (const auto body = parse_body(*options.body); !body) return Error{where + ": body: " + body.error().message};
  }
  return Done{};
}

}  // namespace terrella
