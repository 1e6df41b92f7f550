#include "apps/commands/picture_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/process/console.h"
#include "streaming/georeference/crs_text.h"

namespace terrella {
namespace {

using Json = nlohmann::ordered_json;

/// One word for programs: how `view` draws the picture.
const char* kind_word(PlaceKind kind) {
  switch (kind) {
    case PlaceKind::planet:
      return "planet";
    case PlaceKind::nodes:
      return "nodes";
    case PlaceKind::as_it_is:
      return "as it is";
    case PlaceKind::rolled:
      return "rolled";
    case PlaceKind::warped:
      return "resampled";
  }
  return "";
}

std::string kind_text(const PictureFacts& facts) {
  const PicturePlace& place = *facts.place;
  const char* latitude = place.latitude == LatitudeKind::centric ? "; its rows count planetocentric latitudes" : "";
  std::string text = "as it is";
  if (place.kind == PlaceKind::planet) text = "as it is: a whole planet from -180 degrees";
  if (place.kind == PlaceKind::nodes) text = "as means of its nodes, a whole planet from -180 degrees";
  if (place.kind == PlaceKind::rolled)
    text = fmt::format("as it is, from column {} of the grid on", place.first_column);
  if (place.kind == PlaceKind::warped) {
    const bool even = facts.place->placed.placement.has_value();
    text = even ? "resampled, because its pixels fit no grid"
                : fmt::format("resampled from {}", facts.crs ? crs_text(*facts.crs, {}) : place.from->crs);
  }
  return text + latitude;
}

std::string system_text(const PictureFacts& facts) {
  if (!facts.crs) return facts.said->crs.empty() ? "(not said)" : "(not known)";
  std::string text = crs_text(*facts.crs, facts.said ? facts.said->crs_title : std::string());
  if (!facts.words.crs.empty()) text += ", by --crs";
  return text + (facts.crs->geographic ? ", geographic" : ", projected") +
         (facts.crs->centric ? ", planetocentric latitude" : "");
}

std::string said_text(const PictureFacts& facts) {
  std::string text = fmt::format("raster type  {}\n", facts.said->pixel_is_point ? "pixel is point" : "pixel is area");
  if (const auto& t = facts.said->transform) {
    text += fmt::format("transform    corner at ({:.12g}, {:.12g}), pixels of {:.9g} by {:.9g}{}\n", t->x0, t->y0,
                        std::hypot(t->x_per_column, t->y_per_column), std::hypot(t->x_per_row, t->y_per_row),
                        t->is_turned() ? ", turned" : "");
  }
  if (facts.said->has_control_points) text += "transform    (ground control points)\n";
  if (!facts.said->points.empty()) text += fmt::format("transform    by its {}\n", facts.said->points);
  return text;
}

/// Rounding errors near 0 become 0.
double without_dust(double degrees) { return std::abs(degrees) < 1e-9 ? 0.0 : degrees; }

std::string place_lines(const PictureFacts& facts) {
  std::string text;
  if (facts.transform) {
    const CrsBounds b = own_bounds(facts);
    const char* unit = facts.crs && !facts.crs->geographic ? "in units of the system" : "in degrees";
    text +=
        fmt::format("corners      {:.12g} to {:.12g}, {:.12g} to {:.12g} {}\n", b.west, b.east, b.south, b.north, unit);
  }
  if (const auto& b = facts.bounds_deg) {
    text += fmt::format("bounds       west {:.9g}°, south {:.9g}°, east {:.9g}°, north {:.9g}°\n",
                        without_dust(b->west), without_dust(b->south), without_dust(b->east), without_dust(b->north));
  }
  if (const auto& p = facts.pixel) {
    text += fmt::format("pixel size   {:.6g}° by {:.6g}° of {}, {:.6g} m by {:.6g} m in the middle\n", p->width_deg,
                        p->height_deg, p->of_arc ? "arc" : "longitude and latitude", p->width_m, p->height_m);
  }
  return text;
}

std::string statistics_line(const NumberStatistics& s) {
  if (s.known == 0) return "statistics   no pixel of the coarsest level has data\n";
  return fmt::format(
      "statistics   {:.7g} to {:.7g}, 2 % below {:.7g}, 98 % below {:.7g}, mean {:.7g}, sigma {:.7g} (of {} pixels of "
      "the coarsest level; {} without data)\n",
      s.min, s.max, s.percentile(2.0), s.percentile(98.0), s.mean, s.sigma, s.known, s.unknown);
}

std::string raster_lines(const RasterFacts& raster) {
  std::string text = fmt::format("bands        {} of {}; {}\n", raster.bands, raster.samples, raster.layout);
  std::string sizes;
  for (const auto& [width, height] : raster.overviews) {
    sizes += fmt::format("{}{}x{}", sizes.empty() ? "" : ", ", width, height);
  }
  text += fmt::format("overviews    {}\n", sizes.empty() ? "(none)" : sizes);
  if (raster.has_mask) text += "mask         yes\n";
  if (raster.nodata) text += fmt::format("no data      {:.9g}\n", *raster.nodata);
  if (raster.scale != 1.0 || raster.offset != 0.0 || !raster.unit.empty()) {
    text += fmt::format("values       number * {:.9g} + {:.9g}{}{}\n", raster.scale, raster.offset,
                        raster.unit.empty() ? "" : " ", one_line(raster.unit));
  }
  if (raster.statistics) text += statistics_line(*raster.statistics);
  for (const std::string& note : raster.notes) text += fmt::format("note         {}\n", note);
  return text;
}

std::string to_text(const PictureFacts& facts) {
  std::string text = fmt::format("picture      {}\n", facts.file.path.string());
  const std::string turned =
      facts.orientation == 1 ? "" : fmt::format(", turned upright by its EXIF orientation {}", facts.orientation);
  text += fmt::format("pixels       {}x{}{}\n", facts.file.width_px, facts.file.height_px, turned);
  if (facts.raster) text += raster_lines(*facts.raster);
  text += fmt::format("georeference {}\n", facts.said ? facts.said->source : "(none)");
  if (facts.said || facts.crs) text += fmt::format("system       {}\n", system_text(facts));
  if (facts.crs) text += fmt::format("body         radii of {:.10g} and {:.10g} m\n", facts.crs->a_m, facts.crs->b_m);
  if (facts.said) text += said_text(facts);
  text += place_lines(facts);
  for (const std::string& remark : facts.remarks) text += fmt::format("remark       {}\n", remark);
  if (!facts.refused.empty()) return text + fmt::format("refused      {}\n", facts.refused);
  if (facts.place) text += fmt::format("drawn        {}\n", kind_text(facts));
  return text + fmt::format("to show it   {}\n", facts.command);
}

Json crs_json(const PictureFacts& facts) {
  Json object{{"name", facts.crs->name}, {"geographic", facts.crs->geographic}};
  if (!facts.crs->code.empty()) object["code"] = facts.crs->code;
  if (facts.said && !facts.said->crs_title.empty()) object["citation"] = facts.said->crs_title;
  if (!facts.crs->geographic) object["method"] = facts.crs->method;
  if (facts.crs->central_meridian_deg) object["central_meridian_deg"] = *facts.crs->central_meridian_deg;
  return object;
}

Json said_json(const PictureFacts& facts) {
  Json object{{"source", facts.said->source}, {"pixel_is_point", facts.said->pixel_is_point}};
  if (facts.crs) {
    object["crs"] = crs_json(facts);
    object["body"] = {{"semi_major_m", facts.crs->a_m}, {"semi_minor_m", facts.crs->b_m}};
  }
  if (const auto& t = facts.said->transform) {
    object["transform"] = {t->x0, t->x_per_column, t->x_per_row, t->y0, t->y_per_column, t->y_per_row};
  }
  object["control_points"] = facts.said->has_control_points;
  return object;
}

void add_raster(Json& object, const RasterFacts& raster) {
  object["bands"] = raster.bands;
  object["samples"] = raster.samples;
  object["layout"] = raster.layout;
  object["overviews"] = raster.overviews;
  object["mask"] = raster.has_mask;
  object["nodata"] = raster.nodata ? Json(*raster.nodata) : Json();
  object["scale"] = raster.scale;
  object["offset"] = raster.offset;
  if (!raster.unit.empty()) object["unit"] = raster.unit;
  if (!raster.quantity.empty()) object["quantity"] = raster.quantity;
  if (raster.statistics && raster.statistics->known > 0) {
    const NumberStatistics& s = *raster.statistics;
    object["statistics"] = {{"min", s.min},
                            {"max", s.max},
                            {"mean", s.mean},
                            {"sigma", s.sigma},
                            {"percentile_2", s.percentile(2.0)},
                            {"percentile_98", s.percentile(98.0)},
                            {"pixels", s.known},
                            {"pixels_without_data", s.unknown}};
  }
  if (!raster.notes.empty()) object["notes"] = raster.notes;
}

void add_place(Json& object, const PictureFacts& facts) {
  if (facts.transform) {
    const CrsBounds b = own_bounds(facts);
    object["bounds_crs"] = {b.west, b.south, b.east, b.north};
  }
  if (const auto& b = facts.bounds_deg) object["bounds_deg"] = {b->west, b->south, b->east, b->north};
  if (const auto& p = facts.pixel) {
    object["pixel_deg"] = {p->width_deg, p->height_deg};
    object["pixel_m"] = {p->width_m, p->height_m};
  }
  if (!facts.remarks.empty()) object["remarks"] = facts.remarks;
}

std::string to_json(const PictureFacts& facts) {
  Json object{{"picture", facts.file.path.string()},
              {"width_px", facts.file.width_px},
              {"height_px", facts.file.height_px},
              {"exif_orientation", facts.orientation},
              {"georeference", facts.said ? said_json(facts) : Json()}};
  if (facts.raster) add_raster(object, *facts.raster);
  add_place(object, facts);
  object["shown"] = facts.refused.empty();
  if (facts.refused.empty() && facts.place) {
    object["drawn"] = kind_word(facts.place->kind);
    object["latitude"] = facts.place->latitude == LatitudeKind::centric ? "centric" : "graphic";
  }
  if (facts.refused.empty()) object["command"] = facts.command;
  if (!facts.refused.empty()) object["refused"] = facts.refused;
  // Paths may contain bytes that are not UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string picture_report(const PictureFacts& facts, bool json) { return json ? to_json(facts) : to_text(facts); }

}  // namespace terrella
