#include "apps/serve/tile_server.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include "apps/serve/descriptions.h"
#include "codecs/image.h"
#include "streaming/cut/halve.h"
#include "streaming/file_bytes.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/tile_check.h"

namespace terrella {
namespace {

constexpr std::size_t kMostTargetBytes = 4096;
constexpr int kJpegQuality = 85;
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kXml = "text/xml; charset=utf-8";
constexpr const char* kJson = "application/json";
constexpr const char* kCapabilities = "WMTSCapabilities.xml";

WebAnswer content(const char* type, std::string_view text, int status = 200) {
  const auto bytes = std::as_bytes(std::span(text));
  return {.status = status, .type = type, .bytes = {bytes.begin(), bytes.end()}};
}

WebAnswer not_found(const std::string& why) { return content(kText, why + "\n", 404); }
WebAnswer no_such_path() { return not_found("there is nothing at this address; / lists the sets"); }
WebAnswer no_such_tile() { return not_found("the set has no such tile"); }

WebAnswer description(const char* type, const Result<std::string>& text) {
  return text ? content(type, *text) : not_found(text.error().message);
}

/// The answer, or 304 if the client has it already.
WebAnswer unless_known(WebAnswer answer, std::string_view if_none_match) {
  if (!names_etag(if_none_match, answer.etag)) return answer;
  return {.status = 304, .etag = std::move(answer.etag)};
}

std::vector<std::string_view> parts_of(std::string_view path) {
  constexpr std::size_t kMost = 8;  // longer paths lead nowhere
  std::vector<std::string_view> parts;
  parts.reserve(kMost);
  while (!path.empty() && parts.size() < kMost) {
    path.remove_prefix(1);
    parts.push_back(path.substr(0, path.find('/')));
    path.remove_prefix(parts.back().size());
  }
  return parts;
}

bool is_picture_ending(std::string_view ending) {
  constexpr std::array<std::string_view, 5> kEndings = {"jpg", "jpeg", "png", "webp", "tif"};
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

/// Splits "12.png" into its number; empty if the ending is not one of a picture.
std::string_view without_ending(std::string_view name) {
  const std::size_t dot = name.find('.');
  return dot != name.npos && is_picture_ending(name.substr(dot + 1)) ? name.substr(0, dot) : std::string_view();
}

/// Media type by the first bytes, whatever the set states; empty if they are none of a tile.
Result<const char*> type_of(std::span<const std::byte> bytes, const TileSetInfo& info) {
  const bool floats = info.numbers && info.numbers->floats;
  constexpr int kAnySide = std::numeric_limits<int>::max();
  if (Status whole =
          check_tile(bytes, {.least_width_px = 1, .least_height_px = 1, .most_px = kAnySide, .floats = floats});
      !whole) {
    return whole.error();
  }
  return floats ? media_type(info) : media_type(sniff_format(bytes));
}

/// The bytes of a tile, made and encoded where the source stores none.
Result<std::vector<std::byte>, TileFailure> encoded(EncodedTile tile) {
  if (!tile.make_picture) return std::move(tile.bytes);
  const auto picture = tile.make_picture();
  if (!picture) return picture.error();
  auto bytes = are_opaque(picture->rgba) ? encode_jpeg(*picture, kJpegQuality) : encode_png(*picture);
  if (!bytes) return TileFailure{MissingKind::failed, bytes.error().message};
  return *std::move(bytes);
}

/// A hash of 64 bits. Four lanes, each in a register, take a quarter of the time of std::hash, and each request waits
/// for the hash.
std::uint64_t hash_of(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kPrime = 0x9E3779B185EBCA87;
  constexpr std::size_t kWord = sizeof(std::uint64_t), kStride = 4 * kWord;
  const auto mixed = [](std::uint64_t lane, std::uint64_t word) { return std::rotl((lane ^ word) * kPrime, 31); };
  const auto word_at = [&](std::size_t at) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, kWord);
    return word;
  };
  std::uint64_t a = 1, b = 2, c = 3, d = 4;
  const std::size_t whole = bytes.size() - bytes.size() % kStride;
  for (std::size_t at = 0; at < whole; at += kStride) {
    a = mixed(a, word_at(at));
    b = mixed(b, word_at(at + kWord));
    c = mixed(c, word_at(at + 2 * kWord));
    d = mixed(d, word_at(at + 3 * kWord));
  }
  const std::uint64_t rest = std::hash<std::string_view>()(as_text(bytes.subspan(whole)));
  const std::uint64_t hash = mixed(mixed(mixed(mixed(a, b), c), d), rest);
  return hash ^ (hash >> 32);
}

std::string etag_of(std::span<const std::byte> bytes) {
  return fmt::format("\"{:x}-{:x}\"", hash_of(bytes), bytes.size());
}

/// Value of a key; empty if it is missing.
std::string value_of(const std::map<std::string, std::string>& pairs, const char* key) {
  const auto found = pairs.find(key);
  return found == pairs.end() ? std::string() : found->second;
}

}  // namespace

WebAnswer TileServer::answer(const WebRequest& request) const {
  if (request.method == "OPTIONS") return {.status = 204};
  if (request.method != "GET" && request.method != "HEAD") {
    return content(kText, "only GET, HEAD and OPTIONS are answered\n", 405);
  }
  if (request.target.size() > kMostTargetBytes) return content(kText, "the address is too long\n", 414);
  return get(request);
}

WebAnswer TileServer::get(const WebRequest& request) const {
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  if (!path.starts_with('/')) return no_such_path();
  const std::vector<std::string_view> parts = parts_of(path);
  if (path == "/") return content("text/html; charset=utf-8", overview_page(sets_, request.base));
  if (parts.front() == "wmts") {
    if (path == fmt::format("/wmts/1.0.0/{}", kCapabilities)) {
      return description(kXml, wmts_capabilities(sets_, request.base));
    }
    const std::size_t query = std::min(path.size() + 1, request.target.size());
    return parts.size() == 1 ? key_value_pairs(read_query(request.target.substr(query)), request) : no_such_path();
  }
  constexpr std::string_view kArchiveEnding = ".pmtiles";
  if (parts.size() == 1 && path.ends_with(kArchiveEnding)) {
    const ServedSet* const set = find(parts[0].substr(0, parts[0].size() - kArchiveEnding.size()));
    return set != nullptr && set->archive ? archive(*set, request) : no_such_path();
  }
  const ServedSet* const set = find(parts.front());
  return set != nullptr ? get_of_set(*set, Parts(parts).subspan(1), request) : no_such_path();
}

WebAnswer TileServer::get_of_set(const ServedSet& set, Parts parts, const WebRequest& request) const {
  if (parts.size() == 1 && parts[0] == "tilejson.json") return description(kJson, tile_json(set, request.base));
  if (parts.size() > 1 && parts[0] == "wmts") return get_of_wmts(set, parts.subspan(1), request);
  if (parts.size() == 3) return tile(set, {parts[0], parts[1], without_ending(parts[2])}, request);
  if (parts.size() == 4 && parts[0] == "tms") {
    return tile(set, {parts[1], parts[2], without_ending(parts[3]), true}, request);
  }
  return no_such_path();
}

WebAnswer TileServer::get_of_wmts(const ServedSet& set, Parts parts, const WebRequest& request) const {
  if (parts.size() == 2 && parts[0] == "1.0.0" && parts[1] == kCapabilities) {
    return description(kXml, wmts_capabilities({&set, 1}, request.base));
  }
  if (parts.size() != 4 || parts[0] != set.name) return no_such_path();
  return tile(set, {parts[1], without_ending(parts[3]), parts[2]}, request);
}

WebAnswer TileServer::key_value_pairs(const std::map<std::string, std::string>& pairs,
                                      const WebRequest& request) const {
  const std::string asked = value_of(pairs, "request");
  if (same_letters(asked, "GetCapabilities")) return description(kXml, wmts_capabilities(sets_, request.base));
  if (!same_letters(asked, "GetTile")) {
    return content(kXml, ogc_exception("OperationNotSupported", "REQUEST is GetCapabilities or GetTile"), 400);
  }
  const ServedSet* const set = find(value_of(pairs, "layer"));
  if (set == nullptr || value_of(pairs, "tilematrixset") != set->name) {
    return content(kXml, ogc_exception("InvalidParameterValue", "there is no such LAYER or TILEMATRIXSET"), 400);
  }
  const std::string zoom = value_of(pairs, "tilematrix"), row = value_of(pairs, "tilerow"),
                    column = value_of(pairs, "tilecol");
  return tile(*set, {zoom, column, row}, request);
}

WebAnswer TileServer::archive(const ServedSet& set, const WebRequest& request) const {
  struct stat facts {};
  if (fstat(set.archive->number(), &facts) != 0) return content(kText, "the archive cannot be read\n", 500);
  const auto size = static_cast<std::uint64_t>(facts.st_size);
  WebAnswer answer{.type = "application/octet-stream",
                   .file = set.archive,
                   .of_file = {.offset = 0, .length = size},
                   .etag = fmt::format("\"{:x}-{:x}.{:x}\"", size, facts.st_mtim.tv_sec, facts.st_mtim.tv_nsec)};
  if (names_etag(request.if_none_match, answer.etag)) return {.status = 304, .etag = answer.etag};
  const bool is_same = request.if_range.empty() || request.if_range == answer.etag;
  const AskedRange asked = asked_range(is_same ? request.range : std::string_view(), size);
  if (asked.kind == AskedRange::Kind::beyond) {
    WebAnswer refusal = content(kText, "the range is beyond the end of the archive\n", 416);
    refusal.content_range = fmt::format("bytes */{}", size);
    return refusal;
  }
  if (asked.kind == AskedRange::Kind::part) {
    answer.status = 206;
    answer.of_file = asked.range;
    answer.content_range =
        fmt::format("bytes {}-{}/{}", asked.range.offset, asked.range.offset + asked.range.length - 1, size);
  }
  return answer;
}

WebAnswer TileServer::tile(const ServedSet& set, const AskedTile& asked, const WebRequest& request) const {
  const std::int64_t zoom = read_count(asked.zoom), column = read_count(asked.column), row = read_count(asked.row);
  if (zoom < 0 || column < 0 || row < 0) return no_such_path();
  const TileGrid& grid = set.info().grid;
  const std::int64_t level = zoom - first_zoom(set.info());
  if (level < grid.min_level || level > grid.max_level) return no_such_tile();
  TileId id{.level = static_cast<int>(level), .x = column, .y = row};
  const MatrixSize size = matrix_size(set.info(), id.level);
  if (column >= size.columns || row >= size.rows) return no_such_tile();
  if (asked.rows_from_south) id.y = size.rows - 1 - row;
  if (!set.is_made) return read(set, id, request.if_none_match);
  return {.later = [this, &set, id, known = std::string(request.if_none_match)] { return read(set, id, known); }};
}

WebAnswer TileServer::read(const ServedSet& set, const TileId& id, std::string_view if_none_match) const {
  auto stored = set.tiles->read(id);
  if (!stored) return failed(set, id, stored.error());
  auto bytes = encoded(*std::move(stored));
  if (!bytes) return failed(set, id, bytes.error());
  const auto type = type_of(*bytes, set.info());
  if (!type) return failed(set, id, {MissingKind::broken, type.error().message});
  std::string etag = etag_of(*bytes);
  return unless_known({.type = *type, .bytes = *std::move(bytes), .etag = std::move(etag)}, if_none_match);
}

WebAnswer TileServer::failed(const ServedSet& set, const TileId& id, const TileFailure& failure) const {
  if (failure.kind == MissingKind::absent || failure.kind == MissingKind::blank) return no_such_tile();
  const int count = logged_ < kMostLogged + 1 ? logged_++ : kMostLogged + 1;
  if (count < kMostLogged) {
    log_(fmt::format("{}: level {}, column {}, row {}: {}", set.name, id.level, id.x, id.y, failure.why));
  }
  if (count == kMostLogged) log_("more failures are not reported");
  const bool broken = failure.kind == MissingKind::broken;
  return content(kText, broken ? "the tile is broken\n" : "the tile cannot be read now\n", broken ? 500 : 503);
}

const ServedSet* TileServer::find(std::string_view name) const {
  const auto found = std::ranges::find(sets_, name, &ServedSet::name);
  return found == sets_.end() ? nullptr : &*found;
}

}  // namespace terrella
