#include "streaming/mosaic/mosaic_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "base/hash_mix.h"
#include "streaming/georeference/length_unit.h"
#include "streaming/mosaic/mosaic_store.h"
#include "streaming/raster/in_parallel.h"

namespace terrella {
namespace {

/// Lends placers to threads. Each keeps the coordinate systems that it has opened.
class Placers {
 public:
  explicit Placers(const MosaicFigure& figure) : figure_(figure) {}

  std::unique_ptr<MosaicPlacer> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<MosaicPlacer>(figure_);
    auto placer = std::move(idle_.back());
    idle_.pop_back();
    return placer;
  }
  void give_back(std::unique_ptr<MosaicPlacer> placer) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(placer));
  }

 private:
  const MosaicFigure figure_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<MosaicPlacer>> idle_;
};

std::string text_of(const std::optional<double>& number) { return number ? fmt::format("{:a}", *number) : "-"; }

std::uint64_t mark_of(const MosaicFile& file, const MosaicEntry& entry, const MosaicIndexOptions& options) {
  const CrsBounds bounds = entry.words.bounds.value_or(CrsBounds{});
  const MosaicFigure& figure = options.figure;
  const int latitude = figure.latitude ? static_cast<int>(*figure.latitude) : -1;
  std::string corners;
  if (entry.corners) {
    for (const CrsPoint& corner : *entry.corners) corners += fmt::format("{:a},{:a},", corner.x, corner.y);
  }
  return name_hash(fmt::format("{}|{}|{}|{}|{},{},{},{}|{}|{}|{}|{}|{}|{}|{}", file.path.string(), file.bytes,
                               file.changed_ns, entry.words.crs, bounds.west, bounds.south, bounds.east, bounds.north,
                               corners, text_of(entry.nodata), text_of(entry.scale), text_of(entry.offset),
                               figure.body.name, latitude, figure.may_be_planet));
}

/// Reads one file, or finds it in the store.
class HeaderReader {
 public:
  HeaderReader(const MosaicIndexOptions& options, MosaicStore* store)
      : options_(options),
        placers_(options.figure),
        kept_(store != nullptr ? store->headers() : MosaicStore::Headers{}) {}

  Result<PlacedFile> read(const MosaicEntry& entry, bool& was_kept) {
    MosaicFile file;
    file.path = entry.path;
    file.nodata = entry.nodata;
    if (Status looked = look_at(file); !looked) return looked.error();
    const std::uint64_t mark = mark_of(file, entry, options_);
    if (const auto kept = kept_.find(entry.path.string()); kept != kept_.end() && kept->second.first == mark) {
      if (auto facts = parse_header_text(kept->second.second)) {
        was_kept = true;
        facts->file.path = entry.path;
        facts->mark = mark;
        facts->order = entry.order;
        return *std::move(facts);
      }
    }
    if (Status header = read_header(file, options_.reading); !header) return header.error();
    file.scale = entry.scale.value_or(file.scale);
    file.offset = entry.offset.value_or(file.offset);
    auto placer = placers_.take();
    auto place = placer->place(file, entry);
    placers_.give_back(std::move(placer));
    if (!place) return place.error();
    file.raster.reset();
    return PlacedFile{.file = std::move(file), .place = *std::move(place), .mark = mark, .order = entry.order};
  }

 private:
  const MosaicIndexOptions& options_;
  Placers placers_;
  const MosaicStore::Headers kept_;
};

/// Reads all files that can be read, in the order given.
void read_files(const MosaicList& list, const MosaicIndexOptions& options, MosaicStore* store, MosaicIndex& index) {
  HeaderReader reader(options, store);
  std::vector<std::optional<Result<PlacedFile>>> read(list.entries.size());
  std::vector<char> was_kept(list.entries.size());
  in_parallel(options.jobs, static_cast<std::int64_t>(read.size()), [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    bool kept = false;
    read[at] = reader.read(list.entries[at], kept);
    was_kept[at] = kept ? 1 : 0;
  });
  std::vector<MosaicStore::Header> fresh;
  for (std::size_t i = 0; i < read.size(); ++i) {
    auto& file = *read[i];
    index.headers_read += was_kept[i] == 0 ? 1 : 0;
    if (!file) {
      index.left_out.push_back(file.error().message);
      continue;
    }
    if (was_kept[i] == 0) fresh.push_back({file->file.path.string(), file->mark, header_text(*file)});
    index.files.push_back(*std::move(file));
  }
  if (store != nullptr && !fresh.empty()) store->keep_headers(fresh);
}

/// Fails if files contain numbers of several units.
Status check_units(const std::string& where, const MosaicIndex& index) {
  const MosaicFile& first = index.files.front().file;
  for (const PlacedFile& other : index.files) {
    if (other.file.unit == first.unit) continue;
    return Error{
        fmt::format("{}: the numbers of {} are in \"{}\" and those of {} in \"{}\", and a layer has one unit; put "
                    "them into two folders or lists",
                    where, first.path.string(), first.unit, other.file.path.string(), other.file.unit)};
  }
  return Done{};
}

/// Decides between colours and numbers.
Status choose_pixels(const std::string& where, MosaicPixels pixels, MosaicIndex& index) {
  if (pixels == MosaicPixels::as_stored) {
    const auto other = std::ranges::find_if(index.files, [&](const PlacedFile& file) {
      return file.file.is_numbers != index.files.front().file.is_numbers;
    });
    if (other != index.files.end()) {
      const bool first = index.files.front().file.is_numbers;
      const std::string one = index.files.front().file.path.string(), two = other->file.path.string();
      return Error{
          fmt::format("{}: {} contains numbers and {} is a picture, and a layer has one of them; put them into "
                      "two folders or lists",
                      where, first ? one : two, first ? two : one)};
    }
    index.numbers = index.files.front().file.is_numbers;
    return index.numbers ? check_units(where, index) : Status(Done{});
  }
  index.numbers = pixels == MosaicPixels::heights;
  if (!index.numbers) {
    const auto numbers = std::ranges::find_if(index.files, [](const PlacedFile& file) { return file.file.is_numbers; });
    if (numbers == index.files.end()) return Done{};
    return Error{
        fmt::format("{}: {} contains numbers, and each file would get colours of its own; give ‹elevation› for "
                    "heights, or make pictures of 8 bits with one scale (gdal_translate -ot Byte -scale)",
                    where, numbers->file.path.string())};
  }
  for (const PlacedFile& file : index.files) {
    const std::string name = file.file.path.string();
    if (!file.file.one_band) {
      return Error{
          fmt::format("{}: heights need one number a pixel, and this is a picture in colours; leave it out, or "
                      "take one of its bands (gdal_translate -b 1)",
                      name)};
    }
    if (!metres_of_unit(file.file.unit)) return Error{name + ": " + no_length(file.file.unit)};
  }
  return Done{};
}

void add_once(std::vector<double>& values, double value) {
  const auto is_same = [value](double other) { return other == value || (std::isnan(other) && std::isnan(value)); };
  if (std::ranges::none_of(values, is_same)) values.push_back(value);
}

}  // namespace

std::vector<int> MosaicIndex::files_in(const MosaicBox& box) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].place.box.meets(box)) found.push_back(static_cast<int>(i));
  }
  return found;
}

MosaicBox area_of(const std::vector<PlacedFile>& files) {
  std::vector<std::pair<double, double>> ranges;
  MosaicBox area{.west = -180.0, .south = 90.0, .east = 180.0, .north = -90.0};
  for (const PlacedFile& file : files) {
    const MosaicBox& box = file.place.box;
    ranges.emplace_back(box.west, box.east);
    area.south = std::min(area.south, box.south);
    area.north = std::max(area.north, box.north);
  }
  std::ranges::sort(ranges);
  // The widest gap between ranges is where the area ends.
  double end = ranges.front().second, widest = 0.0;
  for (const auto& [west, east] : ranges) {
    if (west - end > widest) {
      widest = west - end;
      area.west = west;
      area.east = end + 360.0;
    }
    end = std::max(end, east);
  }
  const double round = ranges.front().first + 360.0 - end;
  if (round > 0.0 && round >= widest) {
    area.west = ranges.front().first;
    area.east = end;
  }
  return area;
}

Result<MosaicIndex> index_mosaic(const MosaicList& list, const std::string& where, const MosaicIndexOptions& options,
                                 MosaicStore* store) {
  MosaicIndex index;
  read_files(list, options, store, index);
  if (index.files.empty()) {
    return Error{
        fmt::format("{}: none of the {} files that it names can be shown; the first: {}. A folder or a text "
                    "file must name pictures, one a line: JPEG, PNG, WebP, TIFF; tile sets are folders with "
                    "tileset.json, GeoPackages, MBTiles and PMTiles",
                    where, list.entries.size(), index.left_out.empty() ? std::string("-") : index.left_out.front())};
  }
  index.latitude = index.files.front().place.latitude;
  if (Status chosen = choose_pixels(where, options.pixels, index); !chosen) return chosen.error();
  sort_files(index.files);
  index.sheets = make_sheets(index.files);
  index.sheet_of.resize(index.files.size());
  for (std::size_t sheet = 0; sheet < index.sheets.size(); ++sheet) {
    for (const SheetPart& part : index.sheets[sheet].parts) {
      index.sheet_of[static_cast<std::size_t>(part.file)] = static_cast<int>(sheet);
    }
  }
  return index;
}

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
