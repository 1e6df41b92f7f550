#include "streaming/georeference/georeference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "streaming/georeference/gdal_advice.h"
#include "streaming/georeference/side_files.h"
#include "streaming/raster/raster_file.h"

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

/// Statement of the picture's own header.
Result<std::optional<Georeference>> from_header(const PictureFile& picture, bool with_crs) {
  if (!picture.raster) return std::optional<Georeference>{};
  auto said = picture.raster->header().said;
  if (said && with_crs && !said->fault.empty()) return Error{said->fault};
  return said;
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
  if (said.crs.empty()) said.crs = claim.crs;
  said.source += (said.source.empty() ? "" : ", ") + name;
  return Done{};
}

Error cannot_believe(const PictureFile& picture, const std::string& why) {
  return Error{
      fmt::format("{}: {}, so where it lies is not known; say it with ‹crs› CRS and ‹bounds› W,S,E,N, or write it into "
                  "a copy: {}",
                  picture.path.string(), why, assign_command(picture))};
}

Error contradiction(const PictureFile& picture, const std::string& why) {
  return Error{fmt::format("{}: {}; move away the file that is wrong, or take what the picture itself says: {}",
                           picture.path.string(), why, own_word_command(picture))};
}

}  // namespace

Result<std::optional<Georeference>> read_georeference(const PictureFile& picture, bool with_crs) {
  auto own = from_header(picture, with_crs);
  if (!own) return cannot_believe(picture, own.error().message);
  const bool counts_sides = !picture.raster || picture.raster->header().is_local_tiff;
  const auto claims =
      counts_sides ? read_side_files(picture.path) : Result<std::vector<SideClaim>>(std::vector<SideClaim>());
  if (!claims) return Error{fmt::format("{}: {}", picture.path.string(), claims.error().message)};
  Georeference said = own->value_or(Georeference{});
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
