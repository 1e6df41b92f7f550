#include "streaming/georeference/geo_keys.h"

#include <fmt/format.h>
#include <geo_normalize.h>
#include <geo_simpletags.h>
#include <geo_tiffp.h>
#include <geotiff.h>
#include <geovalues.h>
#include <proj.h>
// Needs proj.h.
#include <proj_experimental.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "streaming/georeference/crs.h"

namespace terrella {
namespace {

/// Limits on the keys of a file, because libgeotiff counts its allocations in 16 bits. Real files need fewer.
constexpr std::size_t kMostKeyShorts = 4 * 1024;
constexpr std::size_t kMostKeyNumbers = 4096;
constexpr std::size_t kMostKeyText = 60'000;
constexpr double kSameFigure = 1e-6;  // tolerance for a radius or unit given both by the keys and by EPSG's register

struct FreeSimpleTags {
  void operator()(ST_TIFF* tags) const { ST_Destroy(tags); }
};
struct FreeGeoKeys {
  void operator()(GTIF* keys) const { GTIFFree(keys); }
};
using GeoKeyHandle = std::unique_ptr<GTIF, FreeGeoKeys>;

void be_silent(GTIF*, int, const char*, ...) {}

std::optional<int> short_key(GTIF* keys, geokey_t key) {
  unsigned short value = 0;
  if (GTIFKeyGetSHORT(keys, key, &value, 0, 1) != 1) return {};
  return value;
}

std::string text_key(GTIF* keys, geokey_t key) {
  std::array<char, 4096> text{};
  if (GTIFKeyGetASCII(keys, key, text.data(), static_cast<int>(text.size())) < 1) return {};
  return text.data();
}

/// Checks that each key has the type required by the standard, because libgeotiff ignores keys of other types.
Status check_key_types(GTIF* keys) {
  constexpr std::array kShortKeys = {GTModelTypeGeoKey,       GTRasterTypeGeoKey,    GeographicTypeGeoKey,
                                     ProjectedCSTypeGeoKey,   ProjCoordTransGeoKey,  GeogAngularUnitsGeoKey,
                                     GeogPrimeMeridianGeoKey, ProjLinearUnitsGeoKey, GeogEllipsoidGeoKey};
  constexpr std::array kDoubleKeys = {GeogSemiMajorAxisGeoKey,     GeogSemiMinorAxisGeoKey, GeogInvFlatteningGeoKey,
                                      GeogPrimeMeridianLongGeoKey, ProjNatOriginLongGeoKey, ProjCenterLongGeoKey};
  tagtype_t type = TYPE_UNKNOWN;
  int size = 0;
  for (const auto key : kShortKeys) {
    const int count = GTIFKeyInfo(keys, key, &size, &type);
    if (count != 0 && (count != 1 || type != TYPE_SHORT)) return Error{fmt::format("GeoKey {} is damaged", int(key))};
  }
  for (const auto key : kDoubleKeys) {
    double value = 0.0;
    const int count = GTIFKeyInfo(keys, key, &size, &type);
    if (count == 0) continue;
    const bool read = type == TYPE_DOUBLE && GTIFKeyGetDOUBLE(keys, key, &value, 0, 1) == 1;
    if (!read || !std::isfinite(value)) return Error{fmt::format("GeoKey {} is damaged", int(key))};
  }
  return Done{};
}

/// Text of a geographic system defined by the keys: ellipsoid, prime meridian and unit.
std::string own_geographic(const GTIFDefn& defn, const std::string& title) {
  const bool round = defn.SemiMajor == defn.SemiMinor;
  const double inverse_flattening = round ? 0.0 : defn.SemiMajor / (defn.SemiMajor - defn.SemiMinor);
  std::string name = title.empty() ? std::string("unknown") : title;
  std::erase_if(name, [](char c) { return c == '"' || static_cast<unsigned char>(c) < ' '; });
  const std::string unit = fmt::format("ANGLEUNIT[\"degree\",{:.17g}]", M_PI / 180.0);
  const std::string own_unit = fmt::format("ANGLEUNIT[\"unit\",{:.17g}]", defn.UOMAngleInDegrees * M_PI / 180.0);
  return fmt::format(
      "GEOGCRS[\"{}\",DATUM[\"unknown\",ELLIPSOID[\"unknown\",{:.17g},{:.17g},LENGTHUNIT[\"metre\",1]]],"
      "PRIMEM[\"of the file\",{:.17g},{}],CS[ellipsoidal,2],AXIS[\"longitude\",east],AXIS[\"latitude\",north],{}]",
      name, defn.SemiMajor, inverse_flattening, defn.PMLongToGreenwich, unit, own_unit);
}

/// Binds a system of the file's own to WGS 84 by the shift that its keys give: three or seven numbers, as a position
/// vector transformation in metres, arc-seconds and millionths.
std::string with_shift(const std::string& text, const GTIFDefn& defn) {
  if (defn.TOWGS84Count != 3 && defn.TOWGS84Count != 7) return text;
  const ProjContext context = make_proj_context();
  const ProjHandle source(proj_create(context.get(), text.c_str())), target(proj_create(context.get(), "EPSG:4326"));
  const auto wkt = [&](const ProjHandle& crs) {
    const char* made = crs ? proj_as_wkt(context.get(), crs.get(), PJ_WKT2_2019, nullptr) : nullptr;
    return std::string(made != nullptr ? made : "");
  };
  const std::string from = wkt(source), to = wkt(target);
  if (from.empty() || to.empty()) return text;
  constexpr std::array<const char*, 6> kNames{"X-axis translation", "Y-axis translation", "Z-axis translation",
                                              "X-axis rotation",    "Y-axis rotation",    "Z-axis rotation"};
  std::string shift;
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    shift += fmt::format("PARAMETER[\"{}\",{:.17g},ID[\"EPSG\",{}]],", kNames[k], defn.TOWGS84[k], 8605 + k);
  }
  return fmt::format(
      "BOUNDCRS[SOURCECRS[{}],TARGETCRS[{}],ABRIDGEDTRANSFORMATION[\"of the file\",METHOD[\"Position Vector "
      "transformation (geog2D domain)\",ID[\"EPSG\",9606]],{}PARAMETER[\"Scale "
      "difference\",{:.17g},ID[\"EPSG\",8611]]]]",
      from, to, shift, 1.0 + 1e-6 * defn.TOWGS84[6]);
}

Status check_figure(const GTIFDefn& defn) {
  const bool plausible = std::isfinite(defn.SemiMajor) && std::isfinite(defn.SemiMinor) && defn.SemiMajor >= 1.0 &&
                         defn.SemiMajor <= 1e10 && defn.SemiMinor > 0.0 && defn.SemiMinor <= defn.SemiMajor * 1.5;
  if (plausible) return Done{};
  return Error{fmt::format("its GeoKeys give the body radii of {:g} and {:g} metres", defn.SemiMajor, defn.SemiMinor)};
}

/// Checks that keys agree with EPSG's register: `key` names a code of its kind, and other keys repeat the code's
/// values.
Status check_against_register(GTIF* keys, const GTIFDefn& defn, geokey_t key, const std::string& code) {
  const auto crs = Crs::open(code);
  if (!crs) return Error{fmt::format("its GeoKeys name {}, which is not known", code)};
  if (crs->facts().geographic != (key == GeographicTypeGeoKey)) {
    return Error{fmt::format("its GeoKeys contradict each other: {} ({}) is {}, and the key for a {} system names it",
                             code, crs->facts().name, crs->facts().geographic ? "geographic" : "projected",
                             crs->facts().geographic ? "projected" : "geographic")};
  }
  const auto differs = [](double a, double b) { return std::abs(a - b) > kSameFigure * std::abs(b); };
  const CrsFacts& facts = crs->facts();
  const bool figure =
      defn.SemiMajor > 0.0 && (differs(defn.SemiMajor, facts.a_m) || differs(defn.SemiMinor, facts.b_m));
  const bool unit =
      facts.geographic && short_key(keys, GeogAngularUnitsGeoKey) && differs(defn.UOMAngleInDegrees, facts.unit_deg);
  if (!figure && !unit) return Done{};
  return Error{fmt::format("its GeoKeys contradict each other: {} ({}), and {} that {} does not have", code, facts.name,
                           figure ? fmt::format("radii of {:.9g} and {:.9g} m", defn.SemiMajor, defn.SemiMinor)
                                  : fmt::format("a unit of {:.9g} degrees", defn.UOMAngleInDegrees),
                           code)};
}

/// Adds the parameters that libgeotiff leaves out of its PROJ string.
void complete(const GTIFDefn& defn, std::string& text) {
  constexpr std::string_view kNoParallel = "+lat_ts=0.000000000 ";
  constexpr int kObliqueMercatorB = 9815;
  const double scale = defn.ProjParm[4];
  if (defn.CTProjection == CT_Stereographic && scale > 0.0) text += fmt::format(" +k={:.17g}", scale);
  // PROJ ignores the scale of Mercator's projection beside a standard parallel.
  const std::size_t parallel = text.find(kNoParallel);
  if (defn.CTProjection == CT_Mercator && scale > 0.0 && parallel != std::string::npos) {
    text.erase(parallel, kNoParallel.size());
  }
  const bool variant_a = defn.CTProjection == CT_ObliqueMercator;
  if (variant_a) text += " +no_uoff";
  if ((variant_a || defn.CTProjection == kObliqueMercatorB) && defn.ProjParmId[3] == ProjRectifiedGridAngleGeoKey &&
      text.find("+gamma=") == std::string::npos) {
    text += fmt::format(" +gamma={:.17g}", defn.ProjParm[3]);
  }
}

/// Puts a projection onto the registered geographic system that the keys name, so that its datum counts.
std::string on_base(const std::string& projection, int geographic_code) {
  const ProjContext context = make_proj_context();
  const ProjHandle own(proj_create(context.get(), projection.c_str()));
  const ProjHandle base(proj_create(context.get(), fmt::format("EPSG:{}", geographic_code).c_str()));
  if (!own || !base || proj_get_type(own.get()) != PJ_TYPE_PROJECTED_CRS ||
      proj_get_type(base.get()) != PJ_TYPE_GEOGRAPHIC_2D_CRS) {
    return projection;
  }
  const ProjHandle conversion(proj_crs_get_coordoperation(context.get(), own.get()));
  const ProjHandle axes(proj_crs_get_coordinate_system(context.get(), own.get()));
  if (!conversion || !axes) return projection;
  const ProjHandle made(proj_create_projected_crs(context.get(), "unknown", base.get(), conversion.get(), axes.get()));
  const char* wkt = made ? proj_as_wkt(context.get(), made.get(), PJ_WKT2_2019, nullptr) : nullptr;
  return wkt != nullptr ? wkt : projection;
}

Result<std::string> projected_text(GTIF* keys, GTIFDefn& defn) {
  const auto code = short_key(keys, ProjectedCSTypeGeoKey).value_or(KvUserDefined);
  const bool has_own = short_key(keys, ProjCoordTransGeoKey).has_value();
  if (code != KvUserDefined && code != 0) {
    if (has_own) {
      return Error{fmt::format("its GeoKeys name EPSG:{} and give a projection of their own besides", code)};
    }
    const std::string text = fmt::format("EPSG:{}", code);
    if (Status same = check_against_register(keys, defn, ProjectedCSTypeGeoKey, text); !same) return same.error();
    return text;
  }
  constexpr std::string_view kEsriText = "ESRI PE String = ";
  for (const geokey_t key : {PCSCitationGeoKey, GTCitationGeoKey}) {
    const std::string citation = text_key(keys, key);
    if (!citation.starts_with(kEsriText)) continue;
    const std::string text = wkt_only(citation.substr(kEsriText.size()));
    if (text.empty()) return Error{"its GeoKeys hold a text for a coordinate system that is no WKT"};
    return text;
  }
  if (!has_own && defn.CTProjection == KvUserDefined) return Error{"its GeoKeys say that it is projected, and not how"};
  if (Status plausible = check_figure(defn); !plausible) return plausible.error();
  // PROJ's utm takes no sphere, and the parameters of transverse Mercator say the same.
  defn.MapSys = KvUserDefined;
  const std::unique_ptr<char, void (*)(char*)> text(GTIFGetProj4Defn(&defn), GTIFFreeMemory);
  if (!text || std::string_view(text.get()).find("+proj=unknown") != std::string_view::npos ||
      std::string_view(text.get()).find("+proj=") == std::string_view::npos) {
    return Error{fmt::format("its GeoKeys name a projection that is not known (ProjCoordTrans {})", defn.CTProjection)};
  }
  std::string whole = text.get();
  complete(defn, whole);
  if (defn.PMLongToGreenwich != 0.0 && whole.find("+pm=") == std::string::npos) {
    whole += fmt::format(" +pm={:.17g}", defn.PMLongToGreenwich);
  }
  whole += " +type=crs";
  const int base = short_key(keys, GeographicTypeGeoKey).value_or(KvUserDefined);
  if (base == KvUserDefined || base == 0) return with_shift(whole, defn);
  return defn.PMLongToGreenwich != 0.0 ? whole : on_base(whole, base);
}

Result<std::string> geographic_text(GTIF* keys, const GTIFDefn& defn, const std::string& title) {
  const auto code = short_key(keys, GeographicTypeGeoKey).value_or(KvUserDefined);
  if (code != KvUserDefined && code != 0) {
    const std::string text = fmt::format("EPSG:{}", code);
    if (Status same = check_against_register(keys, defn, GeographicTypeGeoKey, text); !same) return same.error();
    return text;
  }
  if (Status plausible = check_figure(defn); !plausible) return plausible.error();
  if (!(defn.UOMAngleInDegrees > 1e-9 && defn.UOMAngleInDegrees < 360.0)) {
    return Error{fmt::format("its GeoKeys count angles in units of {:g} degrees", defn.UOMAngleInDegrees)};
  }
  return with_shift(own_geographic(defn, title), defn);
}

/// First line of the citations, without GDAL's prefix.
std::string title_of(GTIF* keys) {
  std::string title;
  for (const geokey_t key : {PCSCitationGeoKey, GTCitationGeoKey, GeogCitationGeoKey}) {
    if (title.empty()) title = text_key(keys, key);
  }
  title = title.substr(0, title.find_first_of("|\n"));
  for (const std::string_view before : {"GCS Name = ", "PCS Name = "}) {
    if (title.starts_with(before)) title.erase(0, before.size());
  }
  if (title == "unknown" || title.starts_with("ESRI PE String")) return {};
  return title.substr(0, 100);
}

Result<GeoKeys> interpret(GTIF* keys) {
  if (Status sound = check_key_types(keys); !sound) return sound.error();
  GeoKeys said{.crs = {}, .title = title_of(keys), .pixel_is_point = false};
  const auto raster = short_key(keys, GTRasterTypeGeoKey);
  if (raster && *raster != RasterPixelIsArea && *raster != RasterPixelIsPoint) {
    return Error{fmt::format("its GeoKeys have a raster type {} that is not known", *raster)};
  }
  said.pixel_is_point = raster == RasterPixelIsPoint;
  GTIFDefn defn{};
  if (GTIFGetDefn(keys, &defn) != 1) return said;
  const auto model = short_key(keys, GTModelTypeGeoKey);
  // GDAL writes a projection that GeoTIFF does not have as a text in the citation, and calls the model user-defined.
  const bool own_model = model != ModelTypeGeographic && !text_key(keys, PCSCitationGeoKey).empty();
  const bool names_projected = short_key(keys, ProjectedCSTypeGeoKey) || short_key(keys, ProjCoordTransGeoKey) ||
                               short_key(keys, ProjectionGeoKey) || own_model;
  const bool names_geographic = short_key(keys, GeographicTypeGeoKey) || defn.SemiMajor > 0.0;
  if (!model && !names_projected && !names_geographic) return said;
  if (model == ModelTypeGeographic && names_projected) {
    return Error{"its GeoKeys contradict each other: the model is geographic, and a projection is named"};
  }
  if (model && *model != ModelTypeGeographic && *model != ModelTypeProjected && *model != 0 &&
      *model != KvUserDefined) {
    return Error{fmt::format("its GeoKeys say that it is geocentric, or a model {} that is not known", *model)};
  }
  const bool projected = model == ModelTypeProjected || names_projected;
  if (!projected && !names_geographic) return Error{"its GeoKeys name neither a body nor a coordinate system"};
  auto text = projected ? projected_text(keys, defn) : geographic_text(keys, defn, said.title);
  if (!text) return text.error();
  said.crs = *std::move(text);
  return said;
}

Result<GeoKeys> read_anew(const GeoTags& tags) {
  if (tags.key_directory.empty()) return GeoKeys{};
  const auto& directory = tags.key_directory;
  if (directory.size() < 4 || directory.size() < 4 + 4 * std::size_t{directory[3]} || directory[0] != 1) {
    return Error{"its GeoKey directory is damaged"};
  }
  if (directory.size() > kMostKeyShorts || tags.key_numbers.size() > kMostKeyNumbers ||
      tags.key_text.size() > kMostKeyText) {
    return Error{"its GeoKey directory is larger than any coordinate system needs"};
  }
  const std::unique_ptr<ST_TIFF, FreeSimpleTags> simple(ST_Create());
  // libgeotiff copies its input.
  const auto set = [&](int tag, std::size_t count, int type, const void* data) {
    if (count > 0) ST_SetKey(simple.get(), tag, static_cast<int>(count), type, const_cast<void*>(data));
  };
  set(34735, directory.size(), STT_SHORT, directory.data());
  set(34736, tags.key_numbers.size(), STT_DOUBLE, tags.key_numbers.data());
  // The text must include its final 0.
  set(34737, tags.key_text.size() + 1, STT_ASCII, tags.key_text.c_str());
  TIFFMethod methods{};
  GTIFSetSimpleTagsMethods(&methods);
  const GeoKeyHandle keys(GTIFNewWithMethodsEx(simple.get(), &methods, be_silent, nullptr));
  if (!keys) return Error{"its GeoKey directory is damaged"};
  const ProjContext context = make_proj_context();
  GTIFAttachPROJContext(keys.get(), context.get());
  return interpret(keys.get());
}

}  // namespace

Result<GeoKeys> read_geo_keys(const GeoTags& tags) {
  // Thousands of files of one mosaic have the same keys, and PROJ takes a millisecond for them.
  struct Last {
    GeoTags tags;
    Result<GeoKeys> keys = GeoKeys{};
  };
  thread_local Last last;
  const bool known = tags.key_directory == last.tags.key_directory && tags.key_numbers == last.tags.key_numbers &&
                     tags.key_text == last.tags.key_text;
  if (!known) {
    last.keys = read_anew(tags);
    last.tags = tags;
  }
  return last.keys;
}

}  // namespace terrella
