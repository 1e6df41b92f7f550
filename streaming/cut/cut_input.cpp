#include "streaming/cut/cut_input.h"

#include <fmt/format.h>

#include "streaming/cut/height_input.h"
#include "streaming/cut/mosaic_rows.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

bool is_planet(const GeoRect& rect) {
  return rect.west.deg() == -180.0 && rect.east.deg() == 180.0 && rect.south.deg() == -90.0 && rect.north.deg() == 90.0;
}

/// What one picture says of itself, if it says so in degrees.
Result<std::optional<GeoRect>> bounds_of(const fs::path& image, const PictureInfo& info) {
  const auto place = read_georeference(image);
  if (!place) return std::optional<GeoRect>{};
  const auto bounds = covered_by(*place, info.width_px, info.height_px);
  if (bounds) return is_planet(*bounds) ? std::optional<GeoRect>{} : bounds;
  return Error{
      fmt::format("{}: says that it covers all longitudes from {:.9g} degrees on; it must begin at -180 (gdalwarp "
                  "-te -180 -90 180 90), or give --bounds",
                  image.string(), place->west_deg)};
}

Result<CutInput> open_one(const CutOptions& options, const OpenRows& open) {
  auto reader = open(options.images.front());
  if (!reader) return reader.error();
  const PictureInfo info = (*reader)->info();
  CutInput input{.rows = *std::move(reader), .bounds = {}, .elevation = {}};
  if (options.bounds) return input;
  if (options.elevation && is_node_planet(info.width_px, info.height_px)) {
    input.rows = between_nodes(std::move(input.rows));
    return input;
  }
  const auto bounds = bounds_of(options.images.front(), info);
  if (!bounds) return bounds.error();
  input.bounds = *bounds;
  return input;
}

Result<CutInput> open_mosaic(const CutOptions& options, const OpenRows& open) {
  std::vector<MosaicPart> parts;
  PictureInfo info;
  for (const fs::path& image : options.images) {
    const auto reader = open(image);
    if (!reader) return reader.error();
    const PictureInfo& part = (*reader)->info();
    parts.push_back({.path = image,
                     .width_px = part.width_px,
                     .height_px = part.height_px,
                     .place = options.mosaic ? std::nullopt : read_georeference(image)});
    info.has_alpha = info.has_alpha || part.has_alpha;
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
    if (options.format == ImageFormat::jpeg) return Error{"heights are written as PNG alone; leave --format out"};
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

}  // namespace terrella
