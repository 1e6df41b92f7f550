#include "streaming/cut/input/cut_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "geo/body.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/cut/input/mosaic_rows.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/cut/input/rolled_rows.h"
#include "streaming/cut/input/warped_input.h"
#include "streaming/georeference/figure.h"
#include "streaming/georeference/gdal_advice.h"
#include "streaming/warp/direct_tiles.h"

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

/// Place of a raster without rows. It is always warped; pixels that fit the grid are copied then.
Result<PicturePlace> warped_place(PicturePlace place, const PictureFile& picture) {
  place.kind = PlaceKind::warped;
  place.from = place.placed.projected;
  if (place.from) return place;
  if (picture.width_px != 2 * picture.height_px) {
    return Error{
        fmt::format("{}: nothing in it says where it lies (files beside it on the server are not read), and {}x{} "
                    "pixels are no whole planet (2:1); say it with ‹crs› CRS and ‹bounds› W,S,E,N",
                    picture.path.string(), picture.width_px, picture.height_px)};
  }
  place.placed.remarks.push_back(taken_for_planet(picture.path.string()));
  const double step = 180.0 / static_cast<double>(picture.height_px);
  place.from =
      CrsPlace{.to_crs = {.x0 = -180.0, .x_per_column = step, .y0 = 90.0, .y_per_row = -step}, .crs = "EPSG:4326"};
  return place;
}

Result<CutInput> open_one(const CutOptions& options, const OpenRows& open, const std::optional<HeightPlan>& heights) {
  const auto picture = picture_of(options);
  if (!picture) return picture.error();
  auto place = find_place(options, *picture);
  if (place && options.raster) place = warped_place(*std::move(place), *picture);
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

/// Many rasters, each resampled to one grid.
Result<CutInput> open_resampled(const CutOptions& options, const std::optional<HeightPlan>& heights) {
  std::vector<std::string> remarks;
  auto warped = open_many(options, heights, remarks);
  if (!warped) return warped.error();
  return CutInput{.rows = std::move(warped->rows),
                  .bounds = warped->bounds,
                  .latitude = warped->latitude,
                  .place = "many",
                  .has_gaps = true,
                  .remarks = std::move(remarks),
                  .left_out = warped->left_out};
}

/// True if a part of a mosaic states a place whose rows are no parallels.
bool needs_resampling(const CutOptions& options, const PictureFile& part) {
  const auto placed = place_picture(part, {.crs = options.crs});
  return placed && placed->projected && !placed->placement;
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
    const auto file = measure_picture(image);
    if (!file) return file.error();
    const auto place = place_of_part(options, *file);
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

/// True if tiles need a number that means "no data": pixels may lie beside the picture.
bool may_have_gaps(const CutOptions& options) {
  if (options.images.size() > 1 || options.mosaic || is_mosaic(options.images.front())) return true;
  const auto picture = picture_of(options);
  const auto place = picture ? find_place(options, *picture) : Result<PicturePlace>(picture.error());
  if (!place) return true;  // open_one() says why
  const bool whole = place->kind == PlaceKind::planet || place->kind == PlaceKind::nodes || !place->bounds;
  return place->kind == PlaceKind::warped || !whole;
}

/// True for a folder or a list of rasters, and for parts in a projection.
bool is_many(const CutOptions& options) {
  if (options.images.size() == 1 && !options.mosaic) return is_mosaic(options.images.front());
  if (options.mosaic || options.bounds) return false;
  return std::ranges::any_of(options.images, [&](const fs::path& image) {
    const auto part = measure_picture(image);
    return part && needs_resampling(options, *part);
  });
}

Result<std::optional<HeightPlan>> plan_of(const CutOptions& options) {
  if (!options.elevation && !options.numbers) return std::optional<HeightPlan>();
  if (options.format && options.format != ImageFormat::png) {
    return Error{"heights and other numbers are written as PNG or TIFF; leave ‹format› out"};
  }
  HeightPictures pictures{.images = options.images, .many = !options.raster && is_many(options)};
  if (options.raster) pictures.remote = options.picture->raster;
  if (is_mosaic(options.images.front())) {
    const auto list = list_of(options);
    if (!list) return list.error();
    pictures.images.clear();
    for (const MosaicEntry& entry : list->entries) {
      if (measure_picture(entry.path)) pictures.images.push_back(entry.path);  // others are left out, and named
    }
    if (pictures.images.empty()) pictures.images.push_back(list->entries.front().path);
  }
  const auto planned = options.elevation ? plan_heights(pictures, *options.elevation, options.jobs)
                                         : plan_numbers(pictures, *options.numbers, may_have_gaps(options));
  if (!planned) return planned.error();
  return std::optional(*planned);
}

}  // namespace

BandComposite composite_of(const CutBands& bands) {
  BandComposite composite{.bands = {}, .stretch = bands.stretch};
  std::ranges::transform(bands.bands, composite.bands.begin(),
                         [](int counted_from_1) { return static_cast<std::size_t>(counted_from_1 - 1); });
  return composite;
}

CodingOptions choice_of(const CutOptions& options) {
  CodingOptions choice;
  if (options.numbers) {
    choice.nodata = options.numbers->nodata;
    choice.band = static_cast<std::size_t>(options.numbers->band - 1);
  }
  if (!options.composite) return choice;
  choice.nodata = options.composite->nodata;
  choice.composite = composite_of(*options.composite);
  return choice;
}

Result<CutInput> open_input(const CutOptions& said) {
  CutOptions options = said;
  if (options.images.size() == 1 && !is_mosaic(options.images.front())) {
    auto picture = picture_of(said);
    if (!picture) return picture.error();
    options.picture = *std::move(picture);
  }
  const auto planned = plan_of(options);
  if (!planned) return planned.error();
  const std::optional<HeightPlan>& heights = *planned;
  const CodingOptions choice = choice_of(options);
  const OpenRows open = [heights, choice, jobs = options.jobs](const fs::path& image) {
    return heights ? open_height_rows(image, heights->coding, jobs) : open_rows(image, choice, jobs);
  };
  const bool several = !options.raster && (options.images.size() > 1 || options.mosaic);
  auto input = is_many(options) ? open_resampled(options, heights)
               : several        ? open_mosaic(options, open, heights.has_value())
                                : open_one(options, open, heights);
  if (!input || !heights) return input;
  input->numbers = heights->numbers;
  const bool gaps = options.numbers ? may_have_gaps(options) : input->has_gaps;
  if (gaps && !input->numbers->nodata && !input->numbers->floats) input->numbers->nodata = kAddedNodata;
  return input;
}

}  // namespace terrella
