#include "streaming/remote/gdal_wms/gdal_wms_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <utility>

#include "base/number.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/remote/gdal_wms/gdal_wms_values.h"
#include "streaming/remote/web_address.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

constexpr double kMostPixels = 2147483647.0;  // GDAL's limit
constexpr int kMaxGdalBlockPx = 1024;         // GDAL's default
constexpr double kWebMercatorEnd_m = 20037508.34;

Status read_service_name(const std::string& name, GdalWmsDocument& said) {
  using Service = GdalWmsDocument::Service;
  constexpr std::array kServices = {std::pair("TMS", Service::tms), std::pair("VirtualEarth", Service::virtual_earth),
                                    std::pair("WMS", Service::wms)};
  for (const auto& [known, service] : kServices) {
    if (!same_letters(name, known)) continue;
    said.service = service;
    return Done{};
  }
  return Error{fmt::format("its service is {}, and TMS, VirtualEarth and WMS are read; {}",
                           name.empty() ? "not named" : in_quotes(name),
                           same_letters(name, "TiledWMS") ? "give the address of the server's WMTS capabilities"
                                                          : "give a URL template of the tiles, if the server has one")};
}

Status read_wms_service(const XmlValues& service, GdalWmsDocument& said) {
  said.version = service.text("Version", "1.1.1");
  said.layers = percent_decode(service.text("Layers"));
  said.styles = percent_decode(service.text("Styles"));
  said.image_format = service.text("ImageFormat", "image/jpeg");
  const std::string order = service.text("BBoxOrder", "xyXY");
  if (order != "xyXY" && order != "yxYX") {
    return Error{fmt::format("its BBoxOrder {} is neither xyXY nor yxYX", in_quotes(order))};
  }
  said.northing_first = order == "yxYX";
  said.request_crs = service.text(said.version.starts_with("1.3") ? "CRS" : "SRS", "EPSG:4326");
  if (!said.version.starts_with("1.1") && !said.version.starts_with("1.3")) {
    return Error{fmt::format("its WMS is of version {}, and 1.1.1 and 1.3.0 are read", in_quotes(said.version))};
  }
  if (said.layers.empty()) return Error{"its <Service> has no <Layers>"};
  return Done{};
}

Status read_service(const pugi::xml_node& root, XmlValues& values, GdalWmsDocument& said) {
  const pugi::xml_node node = any_child(root, "Service");
  if (!node) return Error{"it has no <Service>"};
  XmlValues service(node);
  if (Status named = read_service_name(service.text("name"), said); !named) return named;
  said.server_url = service.text("ServerUrl");
  if (said.server_url.empty()) return Error{"its <Service> has no <ServerUrl>"};
  said.version = service.text("Version", "1.0.0");
  said.layer = service.text("Layer");
  said.format = service.text("Format", "jpg");
  said.transparent = service.flag("Transparent", false);
  if (service.fault()) return Error{*service.fault()};
  if (said.service == GdalWmsDocument::Service::wms) {
    if (Status read = read_wms_service(service, said); !read) return read;
  }
  if (values.flag("UnsafeSSL", false)) {
    return Error{
        "it asks not to check the server's certificate (UnsafeSSL); take that out, and give ‹ca_file› to preload if "
        "the "
        "certificate is your own"};
  }
  if (values.flag("OfflineMode", false)) return Error{"it says OfflineMode; take that out and say ‹offline›"};
  return Done{};
}

/// Size of the raster in pixels, from SizeX and SizeY or from the tiles of the coarsest level.
Status read_size(const GdalWmsDocument& said, XmlValues& window, GdalWindow& at) {
  double width = window.number("SizeX").value_or(0.0);
  double height = window.number("SizeY").value_or(0.0);
  if (width == 0.0 || height == 0.0) {
    const bool bing = said.service == GdalWmsDocument::Service::virtual_earth;
    const auto across = window.number("TileCountX");
    const auto down = window.number("TileCountY");
    if (!bing && (!across || !down || !window.has("TileLevel"))) {
      return Error{"its <DataWindow> has neither SizeX and SizeY nor TileLevel, TileCountX and TileCountY"};
    }
    width = std::ldexp(across.value_or(1.0) * at.block_px, at.level);
    height = std::ldexp(down.value_or(1.0) * at.block_px, at.level);
  }
  const auto is_size = [](double pixels) {
    return pixels >= 1.0 && pixels <= kMostPixels && pixels == std::floor(pixels);
  };
  if (!is_size(width) || !is_size(height)) {
    return Error{fmt::format("its raster has {} by {} pixels, and 1 to {} a side can be", width, height, kMostPixels)};
  }
  at.width_px = static_cast<std::int64_t>(width);
  at.height_px = static_cast<std::int64_t>(height);
  return Done{};
}

/// GDAL's number of overviews without TileLevel: until the smaller side is under a block, or 32 pixels.
int overviews_of(const GdalWindow& at) {
  const double least = std::max(32, at.block_px);
  const double halvings = std::log2(static_cast<double>(std::min(at.width_px, at.height_px)) / least);
  return static_cast<int>(std::clamp(std::ceil(halvings), 0.0, 32.0));
}

Status read_corners(const GdalWmsDocument& said, XmlValues& window, GdalWindow& at) {
  const bool bing = said.service == GdalWmsDocument::Service::virtual_earth;
  const auto side = [&](const char* name, double otherwise) {
    const auto number = window.number(name);
    return number ? *number : bing ? otherwise : std::numeric_limits<double>::quiet_NaN();
  };
  at.west = side("UpperLeftX", -kWebMercatorEnd_m);
  at.north = side("UpperLeftY", kWebMercatorEnd_m);
  at.east = side("LowerRightX", kWebMercatorEnd_m);
  at.south = side("LowerRightY", -kWebMercatorEnd_m);
  if (std::isnan(at.west) || std::isnan(at.north) || std::isnan(at.east) || std::isnan(at.south)) {
    return Error{"its <DataWindow> needs UpperLeftX, UpperLeftY, LowerRightX and LowerRightY"};
  }
  if (!(at.west < at.east) || !(at.south < at.north) || std::abs(at.east - at.west) > 1e12 ||
      std::abs(at.north - at.south) > 1e12) {
    return Error{
        fmt::format("its <DataWindow> from ({}, {}) to ({}, {}) is no window from the north-west to the "
                    "south-east",
                    at.west, at.north, at.east, at.south)};
  }
  return Done{};
}

Status read_window(const pugi::xml_node& root, XmlValues& values, GdalWmsDocument& said) {
  GdalWindow& at = said.window;
  const bool bing = said.service == GdalWmsDocument::Service::virtual_earth;
  const bool is_wms = said.service == GdalWmsDocument::Service::wms;
  at.block_px = values.whole("BlockSizeX", bing ? 256 : kMaxGdalBlockPx, 1, 1 << 20);
  const int block_height = values.whole("BlockSizeY", bing ? 256 : kMaxGdalBlockPx, 1, 1 << 20);
  XmlValues window(any_child(root, "DataWindow"));
  at.level = window.whole("TileLevel", bing ? 19 : 0, 0, 60);
  at.column_0 = window.whole("TileX", 0, 0, 2147483647);
  at.row_0 = window.whole("TileY", 0, 0, 2147483647);
  const std::string origin = window.text("YOrigin", "default");
  if (origin != "top" && origin != "bottom" && origin != "default") {
    return Error{fmt::format("its YOrigin {} is not top, bottom or default", in_quotes(origin))};
  }
  at.rows_from_south = origin != "top" && !bing;
  if (Status corners = read_corners(said, window, at); !corners) return corners;
  if (Status size = read_size(said, window, at); !size) return size;
  const bool has_level = window.has("TileLevel") || bing;
  at.overviews = values.whole("OverviewCount", has_level ? at.level - (bing ? 1 : 0) : overviews_of(at), 0, 60);
  if (!is_wms) at.overviews = std::min(at.overviews, at.level);
  for (const XmlValues* read : {&values, &window}) {
    if (read->fault()) return Error{*read->fault()};
  }
  if (is_wms) return Done{};
  if (at.block_px != block_height || at.block_px < kMinTilePx || at.block_px > kMaxTilePx) {
    return Error{fmt::format("its tiles have {} by {} pixels; squares of {} to {} can be drawn", at.block_px,
                             block_height, kMinTilePx, kMaxTilePx)};
  }
  const double pixel_height = (at.north - at.south) / static_cast<double>(at.height_px);
  const auto most_px = static_cast<double>(std::max(at.width_px, at.height_px));
  if (std::abs(at.pixel() / pixel_height - 1.0) * most_px > 0.5) {
    return Error{fmt::format("its pixels are not square: {} by {} units; correct the corners, or the size", at.pixel(),
                             pixel_height)};
  }
  return Done{};
}

Status read_numbers(const pugi::xml_node& root, XmlValues& values, GdalWmsDocument& said) {
  const int bands = values.whole("BandsCount", 3, 1, 10'000);
  const std::string type = values.text("DataType", "Byte");
  XmlValues data(any_child(root, "DataValues"));
  const auto nodata = data.number("NoData");
  if (data.fault()) return Error{*data.fault()};
  if (same_letters(type, "Byte")) {
    if (bands > 4) return Error{fmt::format("it has {} bands; pictures have 1 to 4", bands)};
    if (nodata)
      return Error{"its pictures have a NoData value, which is not read; take <DataValues> out to see all pixels"};
    return Done{};
  }
  const bool floats = same_letters(type, "Float32");
  const bool is_signed = same_letters(type, "Int16");
  if (!floats && !is_signed && !same_letters(type, "UInt16")) {
    return Error{fmt::format("its DataType is {}; Byte (pictures), Int16, UInt16 and Float32 (heights) are read",
                             in_quotes(type))};
  }
  if (bands != 1) return Error{fmt::format("it has {} bands of {}; heights have one", bands, type)};
  said.numbers = NumberInfo{.nodata = nodata, .floats = floats, .is_signed = is_signed};
  const double least = is_signed ? -32768.0 : 0.0;
  // A number that no pixel can have means nothing.
  if (nodata && !floats && (*nodata != std::round(*nodata) || *nodata < least || *nodata > least + 65535.0)) {
    said.numbers->nodata.reset();
  }
  return Done{};
}

Status read_codes(XmlValues& values, GdalWmsDocument& said) {
  const std::string codes = values.text("ZeroBlockHttpCodes");
  if (codes.empty()) return Done{};
  for (const std::string_view code : split_at_commas(codes)) {
    const auto number = read_number(code);
    if (!number || *number != std::floor(*number) || *number < 100 || *number > 599 ||
        said.missing_statuses.size() > 99) {
      return Error{fmt::format("its ZeroBlockHttpCodes {} are no HTTP statuses with commas between", in_quotes(codes))};
    }
    said.missing_statuses.push_back(static_cast<int>(*number));
  }
  return Done{};
}

Status read_network(const pugi::xml_node& root, XmlValues& values, GdalWmsDocument& said) {
  if (Status codes = read_codes(values, said); !codes) return codes;
  said.exception_is_missing = values.flag("ZeroBlockOnServerException", false);
  said.referer = values.text("Referer");
  said.user_and_password = values.text("UserPwd");
  constexpr int kDay_s = 86'400;
  if (values.has("Timeout")) said.timeout = std::chrono::seconds(values.whole("Timeout", 0, 1, kDay_s));
  said.connections = values.whole("MaxConnections", 0, 0, 10'000);
  XmlValues cache(any_child(root, "Cache"));
  if (cache.has("Expires")) said.tile_life = std::chrono::seconds(cache.whole("Expires", 0, 0, 3650 * kDay_s));
  for (const XmlValues* read : {&values, &cache}) {
    if (read->fault()) return Error{*read->fault()};
  }
  return Done{};
}

Status read_crs(XmlValues& values, GdalWmsDocument& said) {
  std::string text = values.text("Projection");
  if (text.empty() && said.service == GdalWmsDocument::Service::virtual_earth) text = "EPSG:3857";
  if (text.empty() && said.service == GdalWmsDocument::Service::wms) text = said.request_crs;
  if (text.empty()) {
    return Error{
        "it has no <Projection>, so its place and its body are not known; write one, such as EPSG:4326 or "
        "+proj=longlat +R=1737400"};
  }
  const Result<std::string> crs = stated_crs(text);
  if (!crs) return Error{"<Projection>: " + crs.error().message};
  said.crs = *crs;
  return Done{};
}

}  // namespace

Result<GdalWmsDocument> read_gdal_wms(std::string_view xml) {
  if (xml.size() > kMaxGdalWmsBytes) return Error{fmt::format("longer than {} bytes", kMaxGdalWmsBytes)};
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
  if (!parsed) return Error{fmt::format("not XML at byte {}: {}", parsed.offset, parsed.description())};
  const pugi::xml_node root = document.document_element();
  if (!same_letters(root.name(), "GDAL_WMS")) return Error{"its root is not <GDAL_WMS>"};
  GdalWmsDocument said;
  XmlValues values(root);
  if (Status service = read_service(root, values, said); !service) return service.error();
  if (Status window = read_window(root, values, said); !window) return window.error();
  if (Status numbers = read_numbers(root, values, said); !numbers) return numbers.error();
  if (Status network = read_network(root, values, said); !network) return network.error();
  if (Status crs = read_crs(values, said); !crs) return crs.error();
  return said;
}

}  // namespace terrella
