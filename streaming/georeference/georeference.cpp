#include "streaming/georeference/georeference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "streaming/georeference/gdal_advice.h"
#include "streaming/georeference/geo_keys.h"
#include "streaming/georeference/side_files.h"

namespace terrella {
namespace {

/// Largest distance between the places stated by two files, pixels: the error of numbers with few decimals.
constexpr double kSamePlace_px = 0.01;

bool same_place(const Affine& a, const Affine& b, const PictureFile& picture) {
  const double pixel = std::max(std::hypot(a.x_per_column, a.y_per_column), std::hypot(a.x_per_row, a.y_per_row));
  for (const double column : {0.0, static_cast<double>(picture.width_px)}) {
    for (const double row : {0.0, static_cast<double>(picture.height_px)}) {
      const CrsPoint p = a.at(column, row), q = b.at(column, row);
      if (!(std::hypot(p.x - q.x, p.y - q.y) <= kSamePlace_px * pixel)) return false;
    }
  }
  return true;
}

/// Transform from pixel scale and tie point; none without a scale.
Result<std::optional<Affine>> scaled_transform(const GeoTags& tags) {
  if (tags.pixel_scale.empty() || tags.tie_points.size() > 6) return std::optional<Affine>{};
  if (tags.pixel_scale.size() < 2 || tags.tie_points.size() != 6) {
    return Error{"its GeoTIFF tags give a pixel size and no tie point"};
  }
  // GDAL writes the width of columns that run westwards with a minus, and ignores a minus of the height.
  const double width = tags.pixel_scale[0], height = std::abs(tags.pixel_scale[1]);
  if (!(std::abs(width) > 0.0) || !(height > 0.0)) {
    return Error{fmt::format("its GeoTIFF tags give pixels of {:g} by {:g}", width, height)};
  }
  const auto& tie = tags.tie_points;
  return std::optional(Affine{tie[3] - tie[0] * width, width, 0.0, tie[4] + tie[1] * height, 0.0, -height});
}

/// Transform from all tags; none if the tags give none.
Result<std::optional<Affine>> tag_transform(const GeoTags& tags, const PictureFile& picture) {
  auto transform = scaled_transform(tags);
  if (!transform || tags.matrix.empty()) return transform;
  const auto& m = tags.matrix;
  if (m.size() != 16) return Error{fmt::format("its ModelTransformation has {} numbers, not 16", m.size())};
  const Affine by_matrix{m[3], m[0], m[1], m[7], m[4], m[5]};
  if (*transform && !same_place(**transform, by_matrix, picture)) {
    return Error{"its GeoTIFF tags contradict each other: pixel scale and tie point, and the ModelTransformation"};
  }
  return std::optional(by_matrix);
}

/// Without `with_crs`, damaged keys count as none.
Result<std::optional<Georeference>> from_tags(const PictureFile& picture, bool with_crs) {
  const auto tags = read_geo_tags(picture);
  if (!tags) return Error{tags.error().message};
  if (!*tags) return std::optional<Georeference>{};
  auto keys = read_geo_keys(**tags);
  if (!keys && with_crs) return keys.error();
  if (!keys) keys = GeoKeys{};
  auto transform = tag_transform(**tags, picture);
  if (!transform) return transform.error();
  Georeference said;
  said.source = "GeoTIFF tags";
  said.crs = keys->crs;
  said.crs_title = keys->title;
  said.pixel_is_point = keys->pixel_is_point;
  said.has_control_points = !*transform && !(*tags)->tie_points.empty();
  said.has_camera_model = !*transform && (*tags)->has_rpc;
  if (*transform) said.transform = said.pixel_is_point ? (*transform)->from_centre() : **transform;
  if (said.crs.empty() && !(*tags)->has_place()) return std::optional<Georeference>{};
  return std::optional(std::move(said));
}

/// Adds the statement of a file beside the picture.
Status add_claim(Georeference& said, const SideClaim& claim, const PictureFile& picture) {
  const std::string name = claim.file.filename().string();
  if (claim.transform && said.transform && !same_place(*said.transform, *claim.transform, picture)) {
    return Error{fmt::format("its {} and {} beside it place it differently", said.source, name)};
  }
  if (claim.transform && said.has_control_points) {
    return Error{fmt::format("its {} give control points, and {} beside it a place", said.source, name)};
  }
  if (!said.transform) said.transform = claim.transform;
  said.has_control_points = said.has_control_points || (claim.has_control_points && !said.transform);
  if (said.crs.empty() && !claim.crs.empty()) {
    said.crs = claim.crs;
    said.gdal_reads_crs = claim.file.extension() == ".xml";
  }
  said.source += (said.source.empty() ? "" : ", ") + name;
  return Done{};
}

Error cannot_believe(const PictureFile& picture, const std::string& why) {
  return Error{
      fmt::format("{}: {}, so where it lies is not known; say it with --crs CRS and --bounds W,S,E,N, or write it into "
                  "a copy: {}",
                  picture.path.string(), why, assign_command(picture))};
}

Error contradiction(const PictureFile& picture, const std::string& why) {
  return Error{fmt::format("{}: {}; move away the file that is wrong, or take what the picture itself says: {}",
                           picture.path.string(), why, own_word_command(picture))};
}

}  // namespace

Result<std::optional<Georeference>> read_georeference(const PictureFile& picture, bool with_crs) {
  auto tags = from_tags(picture, with_crs);
  if (!tags) return cannot_believe(picture, tags.error().message);
  const auto claims =
      picture.bytes ? Result<std::vector<SideClaim>>(std::vector<SideClaim>()) : read_side_files(picture.path);
  if (!claims) return Error{fmt::format("{}: {}", picture.path.string(), claims.error().message)};
  Georeference said = tags->value_or(Georeference{});
  for (const SideClaim& claim : *claims) {
    if (Status added = add_claim(said, claim, picture); !added) return contradiction(picture, added.error().message);
  }
  if (said.source.empty()) return std::optional<Georeference>{};
  if (said.transform && !said.transform->is_finite()) {
    return cannot_believe(picture, fmt::format("its {} hold numbers that place nothing", said.source));
  }
  return std::optional(std::move(said));
}

}  // namespace terrella
