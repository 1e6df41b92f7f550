#include "apps/commands/picture_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/georeference/geo_tags.h"
#include "streaming/georeference/placement.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Known facts; unknown ones are absent.
struct PictureFacts {
  PictureFile file;
  int orientation = 1;      ///< EXIF orientation by which the picture is turned; 1: not turned
  bool is_heights = false;  ///< true for pixel types used only for heights
  std::optional<Georeference> said;
  std::optional<CrsFacts> crs;
  std::optional<Placement> placement;
  std::string command;  ///< command that shows the picture
  std::string refused;  ///< reason for a refusal; empty if the picture is accepted
};

Result<PictureFacts> measure(const fs::path& picture) {
  PictureFacts facts;
  facts.file.path = picture;
  const auto tags = read_geo_tags(picture);
  if (tags && *tags) {
    facts.file.width_px = (*tags)->width_px;
    facts.file.height_px = (*tags)->height_px;
    facts.is_heights = (*tags)->samples == SampleKind::int16 || (*tags)->samples == SampleKind::floats;
    return facts;
  }
  const auto rows = open_rows(picture);
  if (!rows) return rows.error();
  facts.file.width_px = (*rows)->info().width_px;
  facts.file.height_px = (*rows)->info().height_px;
  facts.orientation = (*rows)->info().orientation;
  return facts;
}

/// Tests with the cutter whether the picture is accepted, with the options that the picture needs.
void try_out(PictureFacts& facts) {
  const NeededOptions needed = facts.crs ? needed_options(*facts.crs) : NeededOptions{};
  CutOptions cut;
  cut.images = {facts.file.path};
  cut.body = needed.body;
  cut.latitude = needed.centric ? LatitudeKind::centric : LatitudeKind::graphic;
  // A given scale avoids reading pixels to find the range of heights.
  if (facts.is_heights) cut.elevation = CutElevation{.scale = 1.0, .offset = 0.0};
  const std::string name = shell_word(facts.file.path.string());
  facts.command = facts.is_heights ? fmt::format("terrella cut {}{} --elevation -o HEIGHTS.gpkg", name, needed.text())
                                   : fmt::format("terrella view {}{}", name, needed.text());
  if (const Status can = check_pictures(cut); !can) facts.refused = can.error().message;
}

Result<PictureFacts> look_at(const fs::path& picture) {
  auto facts = measure(picture);
  if (!facts) return facts;
  if (auto said = read_georeference(facts->file)) facts->said = *std::move(said);
  if (facts->said && !facts->said->crs.empty()) {
    if (const auto crs = Crs::open(facts->said->crs)) facts->crs = crs->facts();
  }
  if (const auto placed = place_picture(facts->file)) facts->placement = placed->placement;
  try_out(*facts);
  return facts;
}

/// Height of a pixel in metres.
double pixel_m(const PictureFacts& facts) {
  const double radius_m = facts.crs ? facts.crs->a_m : earth().ellipsoid.a_m();
  return facts.placement->pixel_height_deg * radius_m * M_PI / 180.0;
}

struct Bounds {
  double west, south, east, north;
};
Bounds bounds_of(const PictureFacts& facts) {
  const Placement& at = *facts.placement;
  return {at.west_deg, at.north_deg - static_cast<double>(facts.file.height_px) * at.pixel_height_deg,
          at.west_deg + static_cast<double>(facts.file.width_px) * at.pixel_width_deg, at.north_deg};
}

std::string system_text(const PictureFacts& facts) {
  if (!facts.crs) return facts.said->crs.empty() ? "(not said)" : "(not known)";
  const CrsFacts& crs = *facts.crs;
  std::string text = crs.name == "unknown" && !facts.said->crs_title.empty() ? facts.said->crs_title : crs.name;
  if (!crs.code.empty()) text += ", " + crs.code;
  text += crs.geographic ? ", geographic" : ", projected: " + crs.method;
  if (crs.central_meridian_deg) text += fmt::format(", central meridian {:.9g}°", *crs.central_meridian_deg);
  return text + (crs.centric ? ", planetocentric latitude" : "");
}

std::string said_text(const PictureFacts& facts) {
  std::string text = fmt::format("system       {}\n", system_text(facts));
  if (facts.crs) text += fmt::format("body         radii of {:.10g} and {:.10g} m\n", facts.crs->a_m, facts.crs->b_m);
  text += fmt::format("raster type  {}\n", facts.said->pixel_is_point ? "pixel is point" : "pixel is area");
  if (const auto& t = facts.said->transform) {
    text += fmt::format("transform    corner at ({:.12g}, {:.12g}), pixels of {:.9g} by {:.9g}{}\n", t->x0, t->y0,
                        std::hypot(t->x_per_column, t->y_per_column), std::hypot(t->x_per_row, t->y_per_row),
                        t->is_turned() ? ", turned" : "");
  }
  if (facts.said->has_control_points) text += "transform    (ground control points)\n";
  if (facts.said->has_camera_model) text += "transform    (camera model, RPC)\n";
  return text;
}

std::string to_text(const PictureFacts& facts) {
  std::string text = fmt::format("picture      {}\n", facts.file.path.string());
  const std::string turned =
      facts.orientation == 1 ? "" : fmt::format(", turned upright by its EXIF orientation {}", facts.orientation);
  text += fmt::format("pixels       {}x{}{}\n", facts.file.width_px, facts.file.height_px, turned);
  text += fmt::format("georeference {}\n", facts.said ? facts.said->source : "(none)");
  if (facts.said) text += said_text(facts);
  if (facts.placement) {
    const Bounds b = bounds_of(facts);
    text += fmt::format("bounds       west {:.9g}°, south {:.9g}°, east {:.9g}°, north {:.9g}°\n", b.west, b.south,
                        b.east, b.north);
    text += fmt::format("pixel size   {:.9g}° by {:.9g}°, {:.6g} m high\n", facts.placement->pixel_width_deg,
                        facts.placement->pixel_height_deg, pixel_m(facts));
  }
  if (facts.refused.empty()) return text + fmt::format("to show it   {}\n", facts.command);
  return text + fmt::format("refused      {}\n", facts.refused);
}

Json said_json(const PictureFacts& facts) {
  Json object{{"source", facts.said->source}, {"pixel_is_point", facts.said->pixel_is_point}};
  if (facts.crs) {
    object["crs"] = {{"name", facts.crs->name}, {"geographic", facts.crs->geographic}};
    if (!facts.crs->code.empty()) object["crs"]["code"] = facts.crs->code;
    if (!facts.said->crs_title.empty()) object["crs"]["citation"] = facts.said->crs_title;
    if (!facts.crs->geographic) object["crs"]["method"] = facts.crs->method;
    if (facts.crs->central_meridian_deg) object["crs"]["central_meridian_deg"] = *facts.crs->central_meridian_deg;
    object["body"] = {{"semi_major_m", facts.crs->a_m}, {"semi_minor_m", facts.crs->b_m}};
  }
  if (const auto& t = facts.said->transform) {
    object["transform"] = {t->x0, t->x_per_column, t->x_per_row, t->y0, t->y_per_column, t->y_per_row};
  }
  object["control_points"] = facts.said->has_control_points;
  return object;
}

std::string to_json(const PictureFacts& facts) {
  Json object{{"picture", facts.file.path.string()},
              {"width_px", facts.file.width_px},
              {"height_px", facts.file.height_px},
              {"exif_orientation", facts.orientation},
              {"georeference", facts.said ? said_json(facts) : Json()}};
  if (facts.placement) {
    const Bounds b = bounds_of(facts);
    object["bounds_deg"] = {b.west, b.south, b.east, b.north};
    object["pixel_deg"] = {facts.placement->pixel_width_deg, facts.placement->pixel_height_deg};
    object["pixel_m"] = pixel_m(facts);
  }
  object["shown"] = facts.refused.empty();
  if (facts.refused.empty()) object["command"] = facts.command;
  if (!facts.refused.empty()) object["refused"] = facts.refused;
  // Paths may contain bytes that are not UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Result<std::string> picture_report(const fs::path& picture, bool json) {
  const auto facts = look_at(picture);
  if (!facts) return facts.error();
  return json ? to_json(*facts) : to_text(*facts);
}

}  // namespace terrella
