#include "streaming/georeference/crs.h"

#include <fmt/format.h>
#include <proj.h>
// Needs proj.h.
#include <proj_experimental.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "geo/body.h"

namespace terrella {
namespace {

/// Largest relative difference of two ellipsoids that PROJ treats as one body. It transforms between their datums.
constexpr double kOneBody = 0.005;

ProjHandle wrap(PJconsts* object) { return ProjHandle(object); }

std::string_view word(const char* text) { return text == nullptr ? std::string_view() : text; }

/// Reduces a system to its horizontal part: removes heights. A bound system goes to `bound`, and its source goes on.
ProjHandle horizontal(PJ_CONTEXT* context, ProjHandle crs, ProjHandle& bound) {
  for (int depth = 0; crs && depth < 4; ++depth) {
    const PJ_TYPE type = proj_get_type(crs.get());
    if (type == PJ_TYPE_COMPOUND_CRS) {
      crs = wrap(proj_crs_get_sub_crs(context, crs.get(), 0));
    } else if (type == PJ_TYPE_BOUND_CRS) {
      ProjHandle source = wrap(proj_get_source_crs(context, crs.get()));
      if (!bound) bound = std::move(crs);
      crs = std::move(source);
    } else {
      return crs;
    }
  }
  return crs;
}

/// Moves the false easting of a transverse Mercator map of a sphere by a micrometre. PROJ would compute UTM's
/// parameters by its program for UTM, which takes no sphere. Returns other systems as they are.
ProjHandle without_utm(PJ_CONTEXT* context, ProjHandle crs, const CrsFacts& facts) {
  if (facts.method != "Transverse Mercator" || facts.a_m != facts.b_m) return crs;
  const ProjHandle conversion = wrap(proj_crs_get_coordoperation(context, crs.get()));
  std::array<double, 5> si{};  // latitude, longitude (radians), scale, easting, northing (metres)
  for (int i = 0; conversion && i < 5; ++i) {
    double value = 0.0, unit = 1.0;
    if (proj_coordoperation_get_param(context, conversion.get(), i, nullptr, nullptr, nullptr, &value, nullptr, &unit,
                                      nullptr, nullptr, nullptr, nullptr) == 0) {
      return crs;
    }
    si[static_cast<std::size_t>(i)] = value * unit;
  }
  constexpr double kMicrometre_m = 1e-6;
  const ProjHandle moved = wrap(proj_create_conversion_transverse_mercator(
      context, si[0], si[1], si[2], si[3] + kMicrometre_m, si[4], "radian", 1.0, "metre", 1.0));
  const ProjHandle base = wrap(proj_crs_get_geodetic_crs(context, crs.get()));
  const ProjHandle axes = wrap(proj_crs_get_coordinate_system(context, crs.get()));
  if (!moved || !base || !axes) return crs;
  ProjHandle made =
      wrap(proj_create_projected_crs(context, proj_get_name(crs.get()), base.get(), moved.get(), axes.get()));
  return made ? std::move(made) : std::move(crs);
}

void read_axes(PJ_CONTEXT* context, const PJconsts* crs, CrsFacts& facts) {
  const ProjHandle axes = wrap(proj_crs_get_coordinate_system(context, crs));
  if (!axes) return;
  for (int i = 0; i < proj_cs_get_axis_count(context, axes.get()); ++i) {
    const char* name = nullptr;
    double unit = 0.0;
    if (proj_cs_get_axis_info(context, axes.get(), i, &name, nullptr, nullptr, &unit, nullptr, nullptr, nullptr) == 0) {
      continue;
    }
    facts.centric = facts.centric || word(name).find("centric") != std::string_view::npos;
    if (facts.geographic) facts.unit_deg = unit * 180.0 / M_PI;
  }
}

double first_unit(PJ_CONTEXT* context, const PJconsts* crs) {
  const ProjHandle axes = wrap(proj_crs_get_coordinate_system(context, crs));
  double unit = 0.0;
  if (axes) proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, nullptr, &unit, nullptr, nullptr, nullptr);
  return unit;
}

void read_projection(PJ_CONTEXT* context, const PJconsts* crs, CrsFacts& facts) {
  const ProjHandle conversion = wrap(proj_crs_get_coordoperation(context, crs));
  if (!conversion) return;
  const char* name = nullptr;
  if (proj_coordoperation_get_method_info(context, conversion.get(), &name, nullptr, nullptr) != 0) {
    facts.method = word(name);
  }
  for (int i = 0; i < proj_coordoperation_get_param_count(context, conversion.get()); ++i) {
    double value = 0.0, unit = 1.0;
    const int read = proj_coordoperation_get_param(context, conversion.get(), i, &name, nullptr, nullptr, &value,
                                                   nullptr, &unit, nullptr, nullptr, nullptr, nullptr);
    if (read != 0 && word(name).starts_with("Longitude of")) facts.central_meridian_deg = value * unit * 180.0 / M_PI;
  }
}

/// Largest radius of a body (geo/ellipsoid.h), metres.
constexpr double kMostRadius_m = 1e10;

Status read_figure(PJ_CONTEXT* context, const PJconsts* crs, CrsFacts& facts) {
  const ProjHandle figure = wrap(proj_get_ellipsoid(context, crs));
  if (figure && proj_ellipsoid_get_parameters(context, figure.get(), &facts.a_m, &facts.b_m, nullptr, nullptr) != 0 &&
      facts.a_m > 0.0 && facts.a_m <= kMostRadius_m && facts.b_m > 0.0 && facts.b_m <= kMostRadius_m) {
    return Done{};
  }
  return Error{"its coordinate system names no body"};
}

OwnDegrees own_degrees(PJ_CONTEXT* context, const PJconsts* geodetic) {
  OwnDegrees own;
  const ProjHandle axes = wrap(proj_crs_get_coordinate_system(context, geodetic));
  for (int i = 0; axes && i < proj_cs_get_axis_count(context, axes.get()); ++i) {
    const char* direction = nullptr;
    double unit = 0.0;
    proj_cs_get_axis_info(context, axes.get(), i, nullptr, nullptr, &direction, &unit, nullptr, nullptr, nullptr);
    own.west_positive = own.west_positive || word(direction) == "west";
    if (i < 2) own.unit_deg = unit * 180.0 / M_PI;
  }
  const ProjHandle meridian = wrap(proj_get_prime_meridian(context, geodetic));
  double longitude = 0.0, unit = 0.0;
  if (meridian && proj_prime_meridian_get_parameters(context, meridian.get(), &longitude, &unit, nullptr) != 0) {
    own.prime_meridian_deg = longitude * unit * 180.0 / M_PI;
  }
  return own;
}

bool is_registered(PJ_CONTEXT* context, const PJconsts* crs) {
  const ProjHandle geodetic = wrap(proj_crs_get_geodetic_crs(context, crs));
  return geodetic && proj_get_id_code(geodetic.get(), 0) != nullptr;
}

ProjHandle path_between(PJ_CONTEXT* context, const PJconsts* from, const PJconsts* to) {
  if (to == nullptr) return nullptr;
  const ProjHandle path = wrap(proj_create_crs_to_crs_from_pj(context, const_cast<PJconsts*>(from),
                                                              const_cast<PJconsts*>(to), nullptr, nullptr));
  return path ? wrap(proj_normalize_for_visualization(context, path.get())) : nullptr;
}

/// Infinite if there is no result.
CrsPoint moved(PJconsts* path, PJ_DIRECTION direction, CrsPoint from) {
  const PJ_COORD to = proj_trans(path, direction, proj_coord(from.x, from.y, 0.0, HUGE_VAL));
  if (std::isfinite(to.xy.x) && std::isfinite(to.xy.y)) return {to.xy.x, to.xy.y};
  return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

}  // namespace

void FreeProjContext::operator()(pj_ctx* context) const { proj_context_destroy(context); }
void FreeProj::operator()(PJconsts* object) const { proj_destroy(object); }

ProjContext make_proj_context() {
  ProjContext context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  return context;
}

std::string wkt_only(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' '; }, ' ');
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  const std::size_t word_end = text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_", begin);
  const bool is_wkt = word_end != begin && word_end != std::string::npos && text[word_end] == '[';
  return is_wkt ? text.substr(begin) : std::string();
}

Result<Crs> Crs::open(const std::string& text) {
  Crs made;
  made.context_ = make_proj_context();
  PJ_CONTEXT* context = made.context_.get();
  made.crs_ = horizontal(context, wrap(proj_create(context, text.c_str())), made.bound_);
  if (!made.crs_ || proj_is_crs(made.crs_.get()) == 0) {
    return Error{"its coordinate system is not one that PROJ knows"};
  }
  // PROJ knows better ways from registered datums than the shift that a text repeats.
  if (made.bound_ && is_registered(context, made.crs_.get())) made.bound_.reset();
  const PJ_TYPE type = proj_get_type(made.crs_.get());
  CrsFacts& facts = made.facts_;
  facts.geographic =
      type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS || type == PJ_TYPE_GEODETIC_CRS;
  facts.name = word(proj_get_name(made.crs_.get()));
  if (!facts.geographic && type != PJ_TYPE_PROJECTED_CRS) {
    return Error{fmt::format("its coordinate system ({}) is neither geographic nor projected", facts.name)};
  }
  // GeoTIFF has no key for the kind of latitude. The IAU's names contain it ("Mars (2015) / Ocentric").
  const auto named = [&facts](const char* kind) { return facts.name.find(kind) != std::string::npos; };
  facts.centric = named("Ocentric") || named("lanetocentric");
  const char* code = proj_get_id_code(made.crs_.get(), 0);
  const char* authority = proj_get_id_auth_name(made.crs_.get(), 0);
  if (code != nullptr && authority != nullptr) facts.code = fmt::format("{}:{}", authority, code);
  if (Status read = read_figure(context, made.crs_.get(), facts); !read) return read.error();
  read_axes(context, made.crs_.get(), facts);
  if (!facts.geographic) {
    facts.unit_m = first_unit(context, made.crs_.get());
    read_projection(context, made.crs_.get(), facts);
    const ProjHandle base = wrap(proj_crs_get_geodetic_crs(context, made.crs_.get()));
    if (base) read_axes(context, base.get(), facts);
    made.crs_ = without_utm(context, std::move(made.crs_), facts);
  }
  return made;
}

bool Crs::is_earth() const {
  const double earth_m = earth().ellipsoid.a_m();
  return std::abs(facts_.a_m - earth_m) < kOneBody * earth_m;
}

bool Crs::is_same_as(const Crs& other) const {
  if (static_cast<bool>(bound_) != static_cast<bool>(other.bound_)) return false;
  return proj_is_equivalent_to_with_ctx(context_.get(), (bound_ ? bound_ : crs_).get(),
                                        (other.bound_ ? other.bound_ : other.crs_).get(),
                                        PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS) != 0;
}

std::string Crs::degrees_text() const {
  if (is_earth()) return "EPSG:4326";
  return fmt::format("+proj=longlat +a={:.17g} +b={:.17g} +no_defs", facts_.a_m, facts_.b_m);
}

Status Crs::find_path() const {
  if (path_) return Done{};
  PJ_CONTEXT* context = context_.get();
  if (is_earth()) {
    path_ = path_between(context, (bound_ ? bound_ : crs_).get(), wrap(proj_create(context, "EPSG:4326")).get());
  }
  if (!path_) {
    const ProjHandle geodetic = wrap(proj_crs_get_geodetic_crs(context, crs_.get()));
    path_ = path_between(context, crs_.get(), geodetic.get());
    if (path_) own_ = own_degrees(context, geodetic.get());
  }
  if (!path_) return Error{fmt::format("there is no way from {} to longitudes and latitudes", facts_.name)};
  return Done{};
}

Result<std::vector<CrsPoint>> Crs::places(std::vector<CrsPoint> points) const {
  if (Status found = find_path(); !found) return found.error();
  for (CrsPoint& point : points) point = own_.of(moved(path_.get(), PJ_FWD, point));
  return points;
}

Result<std::vector<CrsPoint>> Crs::points(std::vector<CrsPoint> places) const {
  if (Status found = find_path(); !found) return found.error();
  for (CrsPoint& place : places) place = moved(path_.get(), PJ_INV, own_.from(place));
  return places;
}

}  // namespace terrella
