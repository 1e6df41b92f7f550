#include "streaming/mosaic/mosaic_facts.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

void add_once(std::vector<double>& values, double value) {
  const auto is_same = [value](double other) { return other == value || (std::isnan(other) && std::isnan(value)); };
  if (std::ranges::none_of(values, is_same)) values.push_back(value);
}

}  // namespace

MosaicFacts facts_of(const MosaicIndex& index) {
  MosaicFacts facts{.files = static_cast<int>(index.files.size()),
                    .left_out = static_cast<int>(index.left_out.size()),
                    .headers_read = index.headers_read,
                    .sheets = static_cast<int>(index.sheets.size()),
                    .area = area_of(index.files),
                    .numbers = index.numbers,
                    .unit = index.files.front().file.unit};
  for (const PlacedFile& placed : index.files) {
    const MosaicFile& file = placed.file;
    if (std::ranges::find(facts.systems, placed.place.at.crs) == facts.systems.end()) {
      facts.systems.push_back(placed.place.at.crs);
    }
    const double side_m = placed.place.pixel_units * placed.place.unit_m;
    facts.finest_m = facts.pixels > 0.0 ? std::min(facts.finest_m, side_m) : side_m;
    facts.coarsest_m = std::max(facts.coarsest_m, side_m);
    facts.pixels += static_cast<double>(file.width_px()) * static_cast<double>(file.height_px());
    const auto none = file.nodata ? file.nodata : file.own_nodata;
    if (none) add_once(facts.nodata, *none);
    facts.without_nodata += none ? 0 : 1;
  }
  return facts;
}

}  // namespace terrella
