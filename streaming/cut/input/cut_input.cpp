#include "streaming/cut/input/cut_input.h"

#include <fmt/format.h>

#include <cmath>

#include "geo/body.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/cut/input/mosaic_rows.h"
#include "streaming/georeference/placement.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

bool is_planet(const GeoRect& rect) {
  return rect.west.deg() == -180.0 && rect.east.deg() == 180.0 && rect.south.deg() == -90.0 && rect.north.deg() == 90.0;
}

/// Fails if the picture belongs to another body than the options say, or counts other latitudes.
Status fits_body(const CutOptions& options, const PictureFile& picture, const PlacedPicture& place) {
  const auto body = options.body.empty() ? earth() : parse_body(options.body);
  return body ? check_figure(picture, place, *body, options.latitude) : body.error();
}

/// Error for a picture whose place is no rectangle of the grid.
Error to_resample(const PictureFile& picture, const PlacedPicture& place, const Error& why) {
  const std::string options = place.crs ? needed_options(*place.crs).text() : "";
  return Error{fmt::format("{}; resample it{}{}: {}", why.message, options.empty() ? "" : ", and show the result with",
                           options, resample_command(picture, place))};
}

/// True if the place is that of a planet sampled at nodes: the nodes are centres of pixels that reach half a pixel
/// beyond the planet.
bool lies_on_nodes(const Placement& place, const PictureFile& picture) {
  const double step = 360.0 / static_cast<double>(picture.width_px);
  const auto near = [step](double a, double b) { return std::abs(a - b) <= 0.01 * step; };
  const auto height = static_cast<double>(picture.height_px);
  return near(place.west_deg, -180.0 - 0.5 * step) && near(place.north_deg, 90.0 + 0.5 * step) &&
         near(place.pixel_width_deg * static_cast<double>(picture.width_px), 360.0) &&
         near(place.pixel_height_deg * height, step * height);
}

/// Bounds of one picture. Also tells if the picture is a planet sampled at nodes.
struct SaidPlace {
  std::optional<GeoRect> bounds;
  bool nodes = false;
  std::string resample_command;
};

Result<SaidPlace> said_place(const CutOptions& options, const PictureFile& picture) {
  const bool node_sides = options.elevation && is_node_planet(picture.width_px, picture.height_px);
  const auto place = place_picture(picture);
  // The bounds replace a place that is not usable.
  if (!place && options.bounds) return SaidPlace{};
  if (!place) return place.error();
  const bool is_placed = place->placement && !options.bounds;
  if (is_placed && node_sides && lies_on_nodes(*place->placement, picture)) {
    if (Status fits = fits_body(options, picture, *place); !fits) return fits.error();
    return SaidPlace{.bounds = {}, .nodes = true, .resample_command = {}};
  }
  const auto bounds = is_placed ? covered_by(picture, *place->placement) : GeoRect{};
  if (!bounds) return to_resample(picture, *place, bounds.error());
  if (Status fits = fits_body(options, picture, *place); !fits) return fits.error();
  if (!is_placed) return SaidPlace{.bounds = {}, .nodes = node_sides && !options.bounds, .resample_command = {}};
  SaidPlace said{.bounds = *bounds, .nodes = false, .resample_command = resample_command(picture, *place)};
  // A planet without bounds may have an odd width, and half of that is no whole number of rows.
  if (is_planet(*bounds)) said.bounds.reset();
  return said;
}

Result<CutInput> open_one(const CutOptions& options, const OpenRows& open) {
  auto reader = open(options.images.front());
  if (!reader) return reader.error();
  const PictureInfo info = (*reader)->info();
  CutInput input{.rows = *std::move(reader), .bounds = {}, .elevation = {}};
  const auto said =
      said_place(options, {.path = options.images.front(), .width_px = info.width_px, .height_px = info.height_px});
  if (!said) return said.error();
  if (said->nodes) input.rows = between_nodes(std::move(input.rows));
  input.bounds = said->bounds;
  input.resample_command = said->resample_command;
  return input;
}

Result<CutInput> open_mosaic(const CutOptions& options, const OpenRows& open) {
  std::vector<MosaicPart> parts;
  PictureInfo info;
  for (const fs::path& image : options.images) {
    const auto reader = open(image);
    if (!reader) return reader.error();
    const PictureInfo& part = (*reader)->info();
    parts.push_back({.path = image, .width_px = part.width_px, .height_px = part.height_px, .place = {}});
    info.has_alpha = info.has_alpha || part.has_alpha;
    if (options.bounds && options.mosaic) continue;
    const PictureFile picture{.path = image, .width_px = part.width_px, .height_px = part.height_px};
    const auto place = place_picture(picture);
    if (!place) return place.error();
    if (Status fits = fits_body(options, picture, *place); !fits) return fits.error();
    parts.back().place = place->placement;
  }
  auto layout = lay_out(parts, options.mosaic);
  if (!layout) return layout.error();
  if (layout->bounds && is_planet(*layout->bounds)) layout->bounds.reset();
  info.width_px = layout->width_px;
  info.height_px = layout->height_px;
  const auto bounds = layout->bounds;
  return CutInput{
      .rows = make_mosaic_rows(std::move(parts), *std::move(layout), info, open), .bounds = bounds, .elevation = {}};
}

}  // namespace

Result<CutInput> open_input(const CutOptions& options) {
  std::optional<HeightPlan> heights;
  if (options.elevation) {
    if (options.format && options.format != ImageFormat::png)
      return Error{"heights are written as PNG alone; leave --format out"};
    const auto planned = plan_heights(options.images, *options.elevation);
    if (!planned) return planned.error();
    heights = *planned;
  }
  const OpenRows open = [heights](const fs::path& image) {
    return heights ? open_height_rows(image, heights->coding) : open_rows(image);
  };
  const bool several = options.images.size() > 1 || options.mosaic;
  auto input = several ? open_mosaic(options, open) : open_one(options, open);
  if (input && heights) input->elevation = heights->elevation;
  return input;
}

Result<std::optional<GeoRect>> said_bounds(const CutOptions& options) {
  const auto reader = open_rows(options.images.front());
  if (!reader) return reader.error();
  const PictureInfo& info = (*reader)->info();
  const auto said =
      said_place(options, {.path = options.images.front(), .width_px = info.width_px, .height_px = info.height_px});
  if (!said) return said.error();
  return said->bounds;
}

}  // namespace terrella
