#include "streaming/objects/vector/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/objects/vector/ground_overlays.h"
#include "streaming/objects/vector/kml_check.h"
#include "streaming/objects/vector_objects.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShapefile = "ESRI Shapefile";
constexpr const char* kKml = "LIBKML";
constexpr std::array<std::pair<std::string_view, const char*>, 14> kVectorDrivers{{{".csv", "CSV"},
                                                                                   {".fgb", "FlatGeobuf"},
                                                                                   {".gpkg", "GPKG"},
                                                                                   {".gpx", "GPX"},
                                                                                   {".kml", kKml},
                                                                                   {".kmz", kKml},
                                                                                   {".mif", "MapInfo File"},
                                                                                   {".mvt", "MVT"},
                                                                                   {".pbf", "MVT"},
                                                                                   {".shp", kShapefile},
                                                                                   {".shz", kShapefile},
                                                                                   {".tab", "MapInfo File"},
                                                                                   {".tsv", "CSV"},
                                                                                   {".zip", kShapefile}}};

bool holds_shapefile(const fs::path& folder) {
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (lower_extension(entry->path()) == ".shp") return true;
  }
  return false;
}

/// Sum of the lengths that a ZIP file states of its files. GDAL reads no more of each.
Result<std::uint64_t> unpacked_bytes(const std::string& zip) {
  constexpr int kMostFiles = 10'000;
  char** const names = gdal().VSIReadDirRecursive(zip.c_str());
  const std::unique_ptr<char*, decltype(gdal().CSLDestroy)> owner(names, gdal().CSLDestroy);
  const int count = gdal().CSLCount(names);
  if (count == 0) return Error{"it is no ZIP file, or an empty one"};
  if (count > kMostFiles) return Error{fmt::format("it holds more than {} files; unpack it", kMostFiles)};
  std::uint64_t sum = 0;
  for (int i = 0; i < count; ++i) {
    VSIStatBufL found{};
    if (gdal().VSIStatExL((zip + "/" + names[i]).c_str(), &found, VSI_STAT_SIZE_FLAG) != 0) continue;
    sum += std::min(static_cast<std::uint64_t>(found.st_size), std::uint64_t{1} << 40);
  }
  return sum;
}

/// Opens by one driver. No driver of a network or of links to other files is ever asked.
GDALDatasetH open_by_driver(const std::string& name, const char* driver) {
  const GdalSettings settings(vector_settings());
  const char* const drivers[] = {driver, nullptr};
  const char* const table[] = {"X_POSSIBLE_NAMES=x,lon,lng,long,longitude",
                               "Y_POSSIBLE_NAMES=y,lat,latitude",
                               "Z_POSSIBLE_NAMES=z,height_m",
                               "GEOM_POSSIBLE_NAMES=wkt,geom,geometry,the_geom",
                               "AUTODETECT_TYPE=YES",
                               nullptr};
  const bool is_table = std::string_view(driver) == "CSV";
  return gdal().GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers,
                           is_table ? table : nullptr, nullptr);
}

/// True if a text has a mark. Reads no more than kMaxVectorUnpackedBytes.
bool has_text(const std::string& name, std::string_view mark) {
  VSILFILE* const text = gdal().VSIFOpenL(name.c_str(), "rb");
  if (text == nullptr) return false;
  std::string part(1UL << 16, ' ');
  std::size_t kept = 0, sum = 0;
  bool found = false;
  while (!found && sum < kMaxVectorUnpackedBytes) {
    const std::size_t got = gdal().VSIFReadL(part.data() + kept, 1, part.size() - kept, text);
    if (got == 0) break;
    sum += got;
    const std::string_view all(part.data(), kept + got);
    found = all.find(mark) != std::string_view::npos;
    kept = std::min(all.size(), mark.size());
    std::ranges::copy(all.substr(all.size() - kept), part.begin());
  }
  static_cast<void>(gdal().VSIFCloseL(text));
  return found;
}

/// True if the links of a KML file lead to pictures alone, which are imagery.
bool links_to_pictures(const fs::path& path) {
  const auto kml = KmlFile::open(path);
  if (!kml) return false;
  const auto overlays = read_ground_overlays(*kml);
  return overlays && overlays->all_linked;
}

}  // namespace

GdalSettings::Settings vector_settings() { return {{"LIBKML_EXTERNAL_STYLE", "NO"}, {"LIBKML_RESOLVE_STYLE", "YES"}}; }

bool is_zip_name(const fs::path& path) {
  const std::string ending = lower_extension(path);
  return ending == ".zip" || ending == ".shz" || ending == ".kmz";
}

const char* vector_driver_of(const fs::path& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return holds_shapefile(path) ? kShapefile : nullptr;
  const auto* const found =
      std::ranges::find(kVectorDrivers, lower_extension(path), [](const auto& one) { return std::string(one.first); });
  return found == kVectorDrivers.end() ? nullptr : found->second;
}

Status check_vector_length(const fs::path& path) {
  std::error_code problem;
  if (fs::is_directory(path, problem)) return Done{};
  const std::uint64_t bytes = fs::file_size(path, problem);
  if (problem) return Error{problem.message()};
  const bool is_zip = is_zip_name(path);
  const std::uint64_t most = lower_extension(path) == ".kml" ? kMaxVectorUnpackedBytes : kMaxObjectFileBytes;
  if (bytes > most) return Error{fmt::format("{} bytes are more than the {} that are read; divide it", bytes, most)};
  if (!is_zip) return Done{};
  const auto unpacked = unpacked_bytes("/vsizip/" + path.string());
  if (!unpacked) return unpacked.error();
  if (*unpacked > kMaxVectorUnpackedBytes) {
    return Error{fmt::format("its files have {} bytes when unpacked, more than the {} that are read; divide them",
                             *unpacked, kMaxVectorUnpackedBytes)};
  }
  return Done{};
}

Result<VectorFile> open_vector_file(const fs::path& path) {
  const auto fault = [&](const std::string& what) { return Error{fmt::format("{}: {}", path.string(), what)}; };
  std::error_code problem;
  const fs::path whole = fs::canonical(path, problem);  // no name of GDAL's that leads to a network
  if (problem) return fault(problem.message());
  const char* const driver = vector_driver_of(whole);
  if (driver == nullptr) return fault("it is no vector file by its name");
  if (const auto loaded = load_gdal(); !loaded) return fault(loaded.error().message);
  const GdalMessages messages;
  const bool is_zip = is_zip_name(whole);
  const std::string zip = "/vsizip/" + whole.string();
  const bool is_kml = std::string_view(driver) == kKml;
  if (const Status fits = check_vector_length(whole); !fits) return fault(fits.error().message);
  if (is_kml) {
    if (const Status good = check_kml(is_zip ? zip : whole.string(), is_zip); !good) return fault(good.error().message);
  }
  VectorFile file{.dataset = {}, .driver = driver, .is_kml = is_kml};
  file.dataset.reset(open_by_driver(is_zip && !is_kml ? zip : whole.string(), driver));
  if (!file.dataset) {
    const bool is_unknown = messages.error().empty() || messages.error().find("not recognized as") != std::string::npos;
    return fault(is_unknown ? fmt::format("GDAL's driver {} does not know it; its name and content must agree", driver)
                            : messages.error());
  }
  // A KMZ file of GDAL's has its layers beside doc.kml, which links to them; GDAL reads those.
  VSIStatBufL layers{};
  const bool has_layers = is_zip && gdal().VSIStatExL((zip + "/layers").c_str(), &layers, VSI_STAT_EXISTS_FLAG) == 0;
  file.has_links = is_kml && !has_layers && has_text(is_zip ? zip + "/doc.kml" : whole.string(), "<NetworkLink>") &&
                   !links_to_pictures(whole);
  return file;
}

}  // namespace terrella
