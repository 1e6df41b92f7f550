#include "apps/commands/raster_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "apps/commands/picture_report.h"
#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/process/console.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/remote/describe_remote.h"

namespace terrella {
namespace {

/// Makes "name: value" of the chosen lines of a report, whose names and values stand in columns of 13 characters.
std::vector<std::string> panel_lines(const std::string& report) {
  constexpr std::size_t kNames = 13;
  constexpr std::array kShown{"pixels ", "bands ",   "files ",  "no data ",   "values ",
                              "system ", "corners ", "bounds ", "pixel size "};
  std::vector<std::string> lines;
  std::istringstream text(report);
  for (std::string line; std::getline(text, line);) {
    if (std::ranges::none_of(kShown, [&](const char* name) { return line.starts_with(name); })) continue;
    const std::string name = line.substr(0, line.find("  "));
    lines.push_back(one_line(name + ": " + line.substr(std::min(kNames, line.size()))));
  }
  return lines;
}

std::vector<std::string> panel_lines(const Result<PictureFacts>& facts) {
  return facts ? panel_lines(picture_report(*facts, false)) : std::vector<std::string>();
}

std::string systems_text(const std::vector<std::string>& systems) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, systems.size()); ++i) {
    const auto crs = Crs::open(systems[i]);
    text += fmt::format("{}{}", i == 0 ? "" : "; ", crs ? crs_text(crs->facts(), {}) : one_line(systems[i]));
  }
  return systems.size() > kNamed ? fmt::format("{}; and {} more", text, systems.size() - kNamed) : text;
}

std::string nodata_text(const MosaicFacts& mosaic) {
  constexpr std::size_t kNamed = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, mosaic.nodata.size()); ++i) {
    text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", mosaic.nodata[i]);
  }
  if (mosaic.nodata.size() > kNamed) text += fmt::format(", and {} more values", mosaic.nodata.size() - kNamed);
  if (mosaic.without_nodata > 0) text += fmt::format("; {} files state none", mosaic.without_nodata);
  return text;
}

}  // namespace

std::string mosaic_lines(const MosaicFacts& mosaic) {
  std::string text = fmt::format("files        {} rasters in {} group{}, {} left out\n", mosaic.files, mosaic.sheets,
                                 mosaic.sheets == 1 ? "" : "s", mosaic.left_out);
  text += fmt::format("pixels       {:.6g} million in all\n", mosaic.pixels / 1e6);
  text += fmt::format("system       {}\n", systems_text(mosaic.systems));
  if (!mosaic.nodata.empty()) text += fmt::format("no data      {}\n", nodata_text(mosaic));
  if (!mosaic.unit.empty()) text += fmt::format("values       in {}\n", one_line(mosaic.unit));
  const bool one_size = mosaic.coarsest_m <= 1.05 * mosaic.finest_m;
  const std::string coarsest = one_size ? "" : fmt::format(" to {:.4g} m", mosaic.coarsest_m);
  return text + fmt::format("pixel size   {:.4g} m{}\n", mosaic.finest_m, coarsest);
}

std::vector<std::string> raster_facts(const std::filesystem::path& picture, const PlaceWords& words,
                                      const DescribedBand& band) {
  return panel_lines(look_at(picture, words, band));
}

std::vector<std::string> raster_facts(const RemotePicture& tiff, const PlaceWords& words, const DescribedBand& band) {
  return panel_lines(look_at_place(tiff, words, band));
}

std::vector<std::string> raster_facts(const MosaicFacts& mosaic) {
  const MosaicBox& area = mosaic.area;
  return panel_lines(mosaic_lines(mosaic) +
                     fmt::format("bounds       west {:.9g}°, south {:.9g}°, east {:.9g}°, north {:.9g}°\n", area.west,
                                 area.south, area.east, area.north));
}

FactsReader facts_reader(const Url& tile_set, const PlaceWords& words, const DescribedBand& band,
                         const OpenedRasters& opened) {
  const std::string& name = tile_set.with_secrets();
  std::vector<std::string> lines;
  if (const auto remote = opened.remote.find(name); remote != opened.remote.end()) {
    lines = raster_facts(remote->second, words, band);
  } else if (const auto many = opened.many.find(name); many != opened.many.end()) {
    lines = raster_facts(many->second);
  } else if (!is_remote(tile_set) && !names_dated_files(tile_set) && is_picture(name)) {
    return [picture = std::filesystem::path(name), words, band] { return raster_facts(picture, words, band); };
  } else {
    return {};
  }
  return [lines = std::move(lines)] { return lines; };
}

}  // namespace terrella
