#include "streaming/remote/describe_remote.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <pugixml.hpp>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/http/http_address.h"
#include "streaming/remote/gdal_wms/gdal_wms.h"
#include "streaming/remote/remote_tms.h"
#include "streaming/remote/source_json.h"
#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wms/wms.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/wmts.h"
#include "streaming/remote/wmts/xml_names.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sets/tms_xml.h"

namespace terrella {
namespace {

enum class Kind { url_template, json, wmts, wms, gdal_wms, tms, unknown };

std::string_view file_name(std::string_view path) { return path.substr(path.find_last_of('/') + 1); }

std::string_view path_of(std::string_view address) { return address.substr(0, address.find_first_of("?#")); }

Kind kind_of_name(std::string_view tile_set) {
  if (tile_set.find('{') != std::string_view::npos) return Kind::url_template;
  const std::string lowered = lower_case(tile_set);
  const std::string_view path = path_of(lowered);
  if (is_wms_address(tile_set)) return Kind::wms;
  if (lowered.find("wmtscapabilities") != std::string::npos ||
      lowered.find("request=getcapabilities") != std::string::npos)
    return Kind::wmts;
  if (file_name(path) == kTmsFile) return Kind::tms;
  return path.ends_with(".json") ? Kind::json : Kind::unknown;
}

Kind kind_of_document(std::string_view text) {
  if (trimmed(text).starts_with('{')) return Kind::json;
  pugi::xml_document document;
  if (text.size() > kMaxCapabilitiesBytes) return Kind::unknown;
  // A damaged document keeps its root, and its reader names the damage.
  static_cast<void>(document.load_buffer(text.data(), text.size()));
  const std::string_view root = local_name(document.document_element().name());
  if (root == "TileMap") return Kind::tms;
  if (same_letters(root, "GDAL_WMS")) return Kind::gdal_wms;
  if (root == "WMS_Capabilities" || root == "WMT_MS_Capabilities" || root == "ServiceExceptionReport") return Kind::wms;
  return root == "Capabilities" || root == "ExceptionReport" ? Kind::wmts : Kind::unknown;
}

/// True if `other` has the scheme, host and port for which headers were given. Another port may belong to another
/// owner.
bool may_have_headers(const Url& given_for, const Url& other) {
  const auto from = http::parse_http_address(given_for);
  const auto to = http::parse_http_address(other);
  return from && to && from->origin == to->origin;
}

Status check_pointer(const Url& from, const Url& to, const RemoteOptions& options) {
  if (is_from_network(from) && !is_from_network(to)) {
    return Error{fmt::format("{}: it points to {}, which is not on the network", from.redacted(), to.redacted())};
  }
  if (is_from_network(from) && !options.headers.empty() && !may_have_headers(from, to)) {
    return Error{
        fmt::format("{}: it points to {}, which has another scheme, host or port, and the headers were given for the "
                    "first alone; if they should go there, give the URL template of the tiles",
                    from.redacted(), to.redacted())};
  }
  return Done{};
}

/// Refuses the address of a picture or of a tile set on this machine, which programs open by its path alone.
Status check_local(const Url& address) {
  const auto file = http::parse_http_address(address);
  if (!file || file->scheme != http::Address::Scheme::file || kind_of_name(file->path) != Kind::unknown ||
      is_remote(file->path) || file_name(file->path).find('.') == std::string_view::npos) {
    return Done{};
  }
  return Error{fmt::format("{}: leave \"file://\" out: give the path {}", address.redacted(), file->path)};
}

/// Checks the host of a set's tiles for each sub-domain, by the address of the first tile.
Result<RemoteTileSet> checked(Result<RemoteTileSet> set, const Url& from) {
  if (!set) return set;
  const RemoteOptions headers{.headers = set->headers};
  RemoteTileSet each = *set;
  for (std::size_t i = 0; i < std::max<std::size_t>(1, set->subdomains.size()); ++i) {
    if (!set->subdomains.empty()) each.subdomains = {set->subdomains[i]};
    const Url url = tile_url(each, {.level = set->info.grid.min_level});
    if (Status pointed = check_pointer(from, url, headers); !pointed) return pointed.error();
  }
  return set;
}

class Describing {
 public:
  explicit Describing(const FetchDocument& fetch) : fetch_(fetch) {}

  Result<RemoteTileSet> describe(const Url& address, const RemoteOptions& options) {
    const Kind kind = kind_of_name(address.with_secrets());
    if (kind == Kind::url_template) return template_tile_set(address, options, true, "tile set");
    if (Status fine = check_local(address); !fine) return fine.error();
    const Result<std::string> text =
        read(kind == Kind::wms ? read_wms_address(address).capabilities : address, options);
    if (!text) return text.error();
    return interpret(told_by_document(kind, *text), *text, address, options);
  }

 private:
  /// An address that asks for capabilities may not say of which service.
  static Kind told_by_document(Kind kind, const std::string& text) {
    if (kind != Kind::unknown && kind != Kind::wmts) return kind;
    const Kind told = kind_of_document(text);
    return kind == Kind::unknown || told == Kind::wms ? told : kind;
  }

  Result<std::string> read(const Url& address, const RemoteOptions& options) {
    if (Status fine = check_options(options, address.redacted()); !fine) return fine.error();
    if (!has_scheme(address.with_secrets())) {
      Result<std::vector<std::byte>, FileError> bytes = read_file(address.with_secrets(), kMaxCapabilitiesBytes);
      if (!bytes) return Error{bytes.error().message};
      return std::string(as_text(*bytes));
    }
    const auto parsed = parse_address(address);
    if (!parsed || (parsed->scheme != "http" && parsed->scheme != "https" && parsed->scheme != "file")) {
      return Error{fmt::format("{}: not an address that can be read; http, https and file can", address.redacted())};
    }
    Result<std::vector<std::byte>> bytes = fetch_(address, options.headers);
    if (!bytes) return bytes.error();
    return std::string(as_text(*bytes));
  }

  Result<RemoteTileSet> interpret(Kind kind, const std::string& text, const Url& address,
                                  const RemoteOptions& options) {
    const std::string where = address.redacted();
    if (kind != Kind::json && !options.times.empty()) {
      return Error{where + ": ‹times› are for a URL template with {time}; a service lists its own"};
    }
    switch (kind) {
      case Kind::wmts:
        return checked(parse_wmts_capabilities(text, options, where), address);
      case Kind::wms:
        return checked(parse_wms_capabilities(text, read_wms_address(address), options, where), address);
      case Kind::gdal_wms:
        return checked(parse_gdal_wms(text, options, where), address);
      case Kind::tms:
        return parse_remote_tms(text, with_scheme(address), options, where);
      case Kind::json:
        return follow(text, address, options);
      default:
        return Error{where +
                     ": neither a URL template ({z}, {x} and {y}) nor the description of a tile set: WMTS or WMS "
                     "capabilities, tilemapresource.xml, <GDAL_WMS> or JSON"};
    }
  }

  Result<RemoteTileSet> follow(const std::string& text, const Url& address, const RemoteOptions& options) {
    const std::string where = address.redacted();
    const Result<SourceDescription> source = parse_source_json(text, where);
    if (!source) return source.error();
    RemoteOptions merged = merge(options, source->options);
    if (merged.numbers && !merged.numbers->rgb) merged.format = ImageFormat::png;
    Result<RemoteTileSet> set = follow(*source, address, merged, options);
    if (!set || !merged.numbers) return set;
    if (!merged.numbers->rgb && set->info.format != ImageFormat::png) {
      return Error{where + ": its tiles are no PNG pictures, and heights are PNG of 16 bits; leave \"elevation\" out"};
    }
    set->info.numbers = merged.numbers;
    return set;
  }

  Result<RemoteTileSet> follow(const SourceDescription& source, const Url& address, const RemoteOptions& merged,
                               const RemoteOptions& options) {
    const std::string where = address.redacted();
    if (source.kind == SourceDescription::Kind::url_template) {
      // A description may give its own headers for its own tiles. Headers of the command line were given for its host
      // only.
      Result<RemoteTileSet> set = template_tile_set(source.address, merged, !is_from_network(address), where);
      if (!set || options.headers.empty()) return set;
      return checked(std::move(set), address);
    }
    if (Status pointed = check_pointer(address, source.address, options); !pointed) return pointed.error();
    const bool is_wms = source.kind == SourceDescription::Kind::wms;
    const Result<std::string> document =
        read(is_wms ? read_wms_address(source.address).capabilities : source.address, merged);
    if (!document) return Error{where + ": " + document.error().message};
    const Kind kind = is_wms ? Kind::wms : source.kind == SourceDescription::Kind::wmts ? Kind::wmts : Kind::tms;
    return interpret(kind, *document, source.address, merged);
  }

  static Url with_scheme(const Url& address) {
    if (has_scheme(address.with_secrets())) return address;
    std::error_code ignored;
    return "file://" + std::filesystem::absolute(address.with_secrets(), ignored).string();
  }

  const FetchDocument& fetch_;
};

/// True for the label of a raster in a planetary archive (PDS4) on disk, which is XML too.
bool is_raster_label(const std::filesystem::path& path) {
  const auto head = read_head(path, 4096);
  const auto text = head ? as_text(*head) : "";
  return text.find("<Product_Observational") != std::string_view::npos;
}

}  // namespace

bool names_its_kind(const Url& tile_set) { return kind_of_name(tile_set.with_secrets()) != Kind::unknown; }

bool is_remote(const Url& tile_set) {
  const std::string_view text = tile_set.with_secrets();
  if (has_scheme(text) || text.find("{z}") != std::string_view::npos) return true;
  const std::string name = lower_case(file_name(text));
  return (name.ends_with(".json") && name != kTileSetFile) ||
         (name.ends_with(".xml") && name != kTmsFile && !is_raster_label(text)) || name.ends_with(".wms");
}

Result<RemoteTileSet> describe_remote(const Url& tile_set, const RemoteOptions& options, const FetchDocument& fetch) {
  auto set = Describing(fetch).describe(tile_set, options);
  if (set && options.numbers) set->info.numbers = options.numbers;
  return set;
}

}  // namespace terrella
