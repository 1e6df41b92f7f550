#include "streaming/georeference/crs_text.h"

#include <fmt/format.h>
#include <proj.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "streaming/georeference/crs.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxCrsBytes = 65536;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

std::string_view without_margins(std::string_view text) {
  constexpr std::string_view kWhite = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kWhite);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kWhite) + 1 - first);
}

/// First and last part of "urn:ogc:def:crs:EPSG::3413", "http://www.opengis.net/def/crs/EPSG/0/3413", "EPSG:3413".
std::optional<std::string> code_of(std::string_view text) {
  std::string name(text);
  std::ranges::transform(name, name.begin(), upper);
  for (const std::string_view before : {"URN:OGC:DEF:CRS:", "URN:X-OGC:DEF:CRS:", "HTTP://WWW.OPENGIS.NET/DEF/CRS/",
                                        "HTTPS://WWW.OPENGIS.NET/DEF/CRS/"}) {
    if (name.starts_with(before)) name.erase(0, before.size());
  }
  std::ranges::replace(name, '/', ':');
  const std::string authority = name.substr(0, name.find(':'));
  const std::string code = name.substr(name.rfind(':') + 1);
  const bool plain = authority.size() < name.size() && !authority.empty() && std::ranges::all_of(authority, is_word) &&
                     std::ranges::all_of(name, [](char c) { return is_word(c) || c == ':' || c == '.'; });
  if (!plain) return std::nullopt;
  if ((authority == "CRS" && code == "84") || code == "CRS84") return "OGC:CRS84";
  if (code.empty() || code.size() > 9 || !std::ranges::all_of(code, is_digit)) return std::nullopt;
  if (authority == "EPSG" && (code == "900913" || code == "102100" || code == "102113")) return "EPSG:3857";
  return (authority.starts_with("IAU") ? "IAU_2015" : authority) + ":" + code;
}

/// A PROJ string without parameters that name files.
bool is_harmless_proj_string(std::string_view text) {
  const auto is_plain = [](char c) {
    return is_word(c) || std::string_view("+-=., ").find(c) != std::string_view::npos;
  };
  constexpr std::array<std::string_view, 5> kFiles = {"init", "grids", "file", "catalog", "step"};
  return (text.starts_with("+proj=") || text.starts_with("proj=")) && std::ranges::all_of(text, is_plain) &&
         std::ranges::none_of(kFiles, [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

ProjHandle open_crs(PJ_CONTEXT* context, const std::string& text) {
  ProjHandle crs(proj_create(context, text.c_str()));
  return crs && proj_is_crs(crs.get()) != 0 ? std::move(crs) : nullptr;
}

Error unknown() { return Error{"its coordinate system is not one that PROJ knows"}; }

std::string first_axis(PJ_CONTEXT* context, const PJconsts* crs) {
  const ProjHandle axes(proj_crs_get_coordinate_system(context, crs));
  const char* name = nullptr;
  if (!axes ||
      proj_cs_get_axis_info(context, axes.get(), 0, &name, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr) == 0) {
    return {};
  }
  return name;
}

}  // namespace

Result<std::string> stated_crs(const std::string& text) {
  const std::string_view said = without_margins(text);
  if (said.empty()) return Error{"it names no coordinate system"};
  if (said.size() > kMaxCrsBytes)
    return Error{fmt::format("its coordinate system is longer than {} bytes", kMaxCrsBytes)};
  if (auto code = code_of(said)) return *std::move(code);
  if (std::string wkt = wkt_only(std::string(said)); !wkt.empty()) {
    if (wkt.find("grids") == std::string::npos) return wkt;
    return Error{"its coordinate system names a file of datum shifts, which is not read"};
  }
  std::string proj(said);
  std::ranges::replace_if(
      proj, [](unsigned char c) { return c < ' '; }, ' ');
  if (is_harmless_proj_string(proj)) return proj.find("+type=crs") == std::string::npos ? proj + " +type=crs" : proj;
  return Error{fmt::format("its coordinate system \"{}\" is no code such as EPSG:4326, no WKT and no plain PROJ string",
                           said.substr(0, 100))};
}

std::string crs_text(const CrsFacts& crs, const std::string& title) {
  const bool named = !crs.name.empty() && crs.name != "unknown";
  std::string text = named ? crs.name : (title.empty() ? std::string("a system without a name") : title);
  if (!crs.code.empty()) text += ", " + crs.code;
  if (!crs.geographic) text += ", " + crs.method;
  if (crs.central_meridian_deg) text += fmt::format(" with central meridian {:.9g} degrees", *crs.central_meridian_deg);
  return text;
}

Result<bool> is_northing_first(const std::string& text) {
  const ProjContext context = make_proj_context();
  const ProjHandle crs = open_crs(context.get(), text);
  if (!crs) return unknown();
  const ProjHandle easting_first(proj_normalize_for_visualization(context.get(), crs.get()));
  if (!easting_first) return Error{"PROJ does not say the order of its axes"};
  return first_axis(context.get(), crs.get()) != first_axis(context.get(), easting_first.get());
}

Result<CrsIdentity> identify_crs(const std::string& text) {
  const ProjContext context = make_proj_context();
  const ProjHandle crs = open_crs(context.get(), text);
  if (!crs) return unknown();
  CrsIdentity identity;
  if (const char* name = proj_get_name(crs.get())) identity.name = name;
  const char* authority = proj_get_id_auth_name(crs.get(), 0);
  const char* code = proj_get_id_code(crs.get(), 0);
  if (authority != nullptr && code != nullptr) {
    const std::string_view digits = code;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), identity.code);
    if (read.ec == std::errc{} && identity.code > 0) identity.authority = authority;
  }
  if (const char* wkt = proj_as_wkt(context.get(), crs.get(), PJ_WKT1_GDAL, nullptr)) identity.wkt = wkt;
  std::erase_if(identity.wkt, [](unsigned char c) { return c < ' '; });
  return identity;
}

}  // namespace terrella
