#include "streaming/cut/input/cut_input.h"

#include <fmt/format.h>

#include "geo/body.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/cut/input/mosaic_rows.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/cut/input/rolled_rows.h"
#include "streaming/cut/input/warped_input.h"
#include "streaming/georeference/figure.h"
#include "streaming/georeference/gdal_advice.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Number that means "no height" in tiles that need one. Known heights move by one where they equal it.
constexpr int kAddedNodata = 65535;

/// Brings the rows onto the grid.
CutInput put_rows(std::unique_ptr<RowReader> rows, const PicturePlace& place, bool heights) {
  if (place.kind == PlaceKind::nodes) rows = between_nodes(std::move(rows));
  if (place.kind == PlaceKind::rolled) {
    rows = rolled_rows(std::move(rows), place.first_column, place.turn_px, heights);
  }
  return {.rows = std::move(rows),
          .bounds = place.bounds,
          .latitude = place.latitude,
          .place = place_text(place),
          .has_gaps = place.kind == PlaceKind::rolled,
          .remarks = place.placed.remarks};
}

Result<CutInput> open_one(const CutOptions& options, const OpenRows& open, const std::optional<HeightPlan>& heights) {
  const auto picture = measure_picture(options.images.front());
  if (!picture) return picture.error();
  const auto place = find_place(options, *picture);
  if (!place) return place.error();
  if (place->kind == PlaceKind::warped) {
    auto warped = open_warped(options, *picture, *place, heights);
    if (!warped) return warped.error();
    CutInput input = put_rows(std::move(warped->rows), *place, heights.has_value());
    input.bounds = warped->bounds;
    input.has_gaps = true;
    return input;
  }
  auto rows = open(picture->path);
  if (!rows) return rows.error();
  return put_rows(*std::move(rows), *place, heights.has_value());
}

/// Place of a part of a mosaic, in even steps of degrees.
Result<PicturePlace> place_of_part(const CutOptions& options, const PictureFile& picture) {
  const PlaceWords words = words_of(options);
  auto placed = place_picture(picture, {.crs = words.crs});
  if (!placed) return placed.error();
  const auto body = options.body.empty() ? earth() : parse_body(options.body);
  if (!body) return body.error();
  const auto latitude = check_figure(*placed, *body, options.latitude);
  if (!latitude) return latitude.error();
  if (placed->projected && !placed->placement) {
    return Error{fmt::format("{}, and parts of a mosaic are not resampled; make one picture of them: {}", placed->claim,
                             join_command(options.images))};
  }
  return PicturePlace{.latitude = *latitude, .placed = *std::move(placed)};
}

Result<CutInput> open_mosaic(const CutOptions& options, const OpenRows& open, bool heights) {
  std::vector<MosaicPart> parts;
  PictureInfo info;
  LatitudeKind latitude = options.latitude.value_or(LatitudeKind::graphic);
  for (const fs::path& image : options.images) {
    const auto reader = open(image);
    if (!reader) return reader.error();
    const PictureInfo& part = (*reader)->info();
    parts.push_back({.path = image, .width_px = part.width_px, .height_px = part.height_px, .place = {}});
    info.has_alpha = info.has_alpha || part.has_alpha;
    if (options.bounds && options.mosaic) continue;
    const auto place = place_of_part(options, {.path = image, .width_px = part.width_px, .height_px = part.height_px});
    if (!place) return place.error();
    parts.back().place = place->placed.placement;
    latitude = place->latitude;
  }
  auto layout = lay_out(parts, options.mosaic);
  if (!layout) return layout.error();
  info.width_px = layout->width_px;
  info.height_px = layout->height_px;
  auto place = find_joined_place(options, {parts.front().path, info.width_px, info.height_px}, layout->place);
  if (!place) return place.error();
  place->latitude = latitude;
  return put_rows(make_mosaic_rows(std::move(parts), *std::move(layout), info, open), *place, heights);
}

}  // namespace

Result<CutInput> open_input(const CutOptions& options) {
  std::optional<HeightPlan> heights;
  if (options.elevation) {
    if (options.format && options.format != ImageFormat::png)
      return Error{"heights are written as PNG alone; leave --format out"};
    const auto planned = plan_heights(options.images, *options.elevation, options.jobs);
    if (!planned) return planned.error();
    heights = *planned;
  }
  const OpenRows open = [heights, jobs = options.jobs](const fs::path& image) {
    return heights ? open_height_rows(image, heights->coding, jobs) : open_rows(image, jobs);
  };
  const bool several = options.images.size() > 1 || options.mosaic;
  auto input = several ? open_mosaic(options, open, heights.has_value()) : open_one(options, open, heights);
  if (!input || !heights) return input;
  input->elevation = heights->elevation;
  if (input->has_gaps && !input->elevation->nodata) input->elevation->nodata = kAddedNodata;
  return input;
}

}  // namespace terrella
