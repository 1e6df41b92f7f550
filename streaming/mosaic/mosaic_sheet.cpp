#include "streaming/mosaic/mosaic_sheet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace terrella {
namespace {

/// Distance from the lattice that counts as rounding, pixels. GDAL's own mosaics allow more.
constexpr double kOnLattice_px = 0.02;
/// Ratio of resolutions that count as one.
constexpr double kSameResolution = 1.05;
/// The coarsest level of a sheet shows the largest file by about this many pixels.
constexpr std::int64_t kCoarsest_px = 128;
constexpr std::int64_t kLeastBlock_px = 16, kMostBlock_px = 256;

/// Pixel coordinates of a point.
CrsPoint pixel_at(const Affine& t, CrsPoint point) {
  const double det = t.x_per_column * t.y_per_row - t.x_per_row * t.y_per_column;
  const double x = point.x - t.x0, y = point.y - t.y0;
  return {(x * t.y_per_row - y * t.x_per_row) / det, (y * t.x_per_column - x * t.y_per_column) / det};
}

/// The place of a file's corner on the lattice; none if its pixels lie beside the lattice's.
std::optional<SheetPart> place_on(const MosaicSheet& sheet, const PlacedFile& file, int index) {
  const Affine& t = file.place.at.to_crs;
  if (sheet.crs != file.place.at.crs) return {};
  const auto width = static_cast<double>(file.file.width_px()), height = static_cast<double>(file.file.height_px());
  const CrsPoint corner = pixel_at(sheet.to_crs, t.at(0.0, 0.0));
  const double column = std::round(corner.x), row = std::round(corner.y);
  const auto fits = [&](double x, double y) {
    const CrsPoint at = pixel_at(sheet.to_crs, t.at(x, y));
    return std::abs(at.x - column - x) <= kOnLattice_px && std::abs(at.y - row - y) <= kOnLattice_px;
  };
  if (!fits(0.0, 0.0) || !fits(width, 0.0) || !fits(0.0, height)) return {};
  return SheetPart{.file = index, .column = static_cast<std::int64_t>(column), .row = static_cast<std::int64_t>(row)};
}

/// True if a file of a sheet above `sheet` lies under the new file.
bool is_covered(const std::vector<MosaicSheet>& sheets, std::size_t sheet, const std::vector<PlacedFile>& files,
                const PlacedFile& file) {
  for (std::size_t above = sheet + 1; above < sheets.size(); ++above) {
    for (const SheetPart& part : sheets[above].parts) {
      if (files[static_cast<std::size_t>(part.file)].place.box.meets(file.place.box)) return true;
    }
  }
  return false;
}

void move_origin(MosaicSheet& sheet, std::int64_t column, std::int64_t row) {
  const CrsPoint corner = sheet.to_crs.at(static_cast<double>(column), static_cast<double>(row));
  sheet.to_crs.x0 = corner.x;
  sheet.to_crs.y0 = corner.y;
  for (SheetPart& part : sheet.parts) {
    part.column -= column;
    part.row -= row;
  }
}

/// Sets origin, size and levels from the parts.
void finish(MosaicSheet& sheet, const std::vector<PlacedFile>& files) {
  std::int64_t west = sheet.parts.front().column, north = sheet.parts.front().row, wide = 0, high = 0;
  for (const SheetPart& part : sheet.parts) {
    west = std::min(west, part.column);
    north = std::min(north, part.row);
  }
  move_origin(sheet, west, north);
  for (const SheetPart& part : sheet.parts) {
    const MosaicFile& file = files[static_cast<std::size_t>(part.file)].file;
    sheet.width_px = std::max(sheet.width_px, part.column + file.width_px());
    sheet.height_px = std::max(sheet.height_px, part.row + file.height_px());
    wide = std::max(wide, file.width_px());
    high = std::max(high, file.height_px());
  }
  sheet.block_width_px = static_cast<int>(std::clamp(wide, kLeastBlock_px, kMostBlock_px));
  sheet.block_height_px = static_cast<int>(std::clamp(high, kLeastBlock_px, kMostBlock_px));
  while ((std::max(wide, high) >> sheet.levels) >= kCoarsest_px) ++sheet.levels;
}

int resolution_class(double pixel_m) {
  return static_cast<int>(std::lround(std::log(pixel_m) / std::log(kSameResolution)));
}

}  // namespace

void sort_files(std::vector<PlacedFile>& files) {
  std::map<std::string, double> unit_m;  // one for a system, so that files with equal steps stay equal
  for (const PlacedFile& file : files) unit_m.try_emplace(file.place.at.crs, file.place.unit_m);
  std::ranges::stable_sort(files, std::ranges::less(), [&](const PlacedFile& file) {
    return std::pair(file.order, -resolution_class(file.place.pixel_units * unit_m.at(file.place.at.crs)));
  });
}

std::vector<MosaicSheet> make_sheets(const std::vector<PlacedFile>& files) {
  std::vector<MosaicSheet> sheets;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const int index = static_cast<int>(i);
    bool placed = false;
    for (std::size_t s = sheets.size(); s-- > 0 && !placed;) {
      const auto part = place_on(sheets[s], files[i], index);
      if (!part || is_covered(sheets, s, files, files[i])) continue;
      sheets[s].parts.push_back(*part);
      placed = true;
    }
    if (placed) continue;
    const CrsPlace& at = files[i].place.at;
    MosaicSheet sheet;
    sheet.crs = at.crs;
    sheet.to_crs = at.to_crs;
    sheet.parts.push_back({.file = index});
    sheets.push_back(std::move(sheet));
  }
  for (MosaicSheet& sheet : sheets) finish(sheet, files);
  return sheets;
}

}  // namespace terrella
