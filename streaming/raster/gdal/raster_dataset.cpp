#include "streaming/raster/gdal/raster_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "streaming/georeference/crs.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

/// A place that is stated by points instead of a grid.
enum class PointPlace { none, control_points, camera };

std::optional<Affine> transform_of(GDALDatasetH dataset) {
  std::array<double, 6> t{};
  if (gdal().GDALGetGeoTransform(dataset, t.data()) != CE_None) return {};
  return Affine{t[0], t[1], t[2], t[3], t[4], t[5]};
}

/// The system as WKT 2, which keeps units and axes that overrule those of a code.
std::string wkt_of(OGRSpatialReferenceH system) {
  if (system == nullptr) return {};
  const char* const options[] = {"FORMAT=WKT2_2018", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const bool is_written = gdal().OSRExportToWktEx(system, &text, options) == OGRERR_NONE && text != nullptr;
  std::string wkt = is_written ? text : "";
  gdal().VSIFree(text);
  return wkt;
}

/// The name in a citation. GDAL writes systems that GeoTIFF has no keys for, as those of other bodies, by their name,
/// and reads them as local ones.
std::string name_in(std::string_view citation) {
  constexpr std::string_view kBefore = "GCS Name = ";
  if (!citation.starts_with(kBefore)) return {};
  const std::string_view rest = citation.substr(kBefore.size());
  return std::string(rest.substr(0, rest.find('|')));
}

bool has_camera(GDALDatasetH dataset) { return gdal().CSLCount(gdal().GDALGetMetadata(dataset, "RPC")) > 0; }

/// The points by which a dataset must be resampled; none if it states a grid, or nothing.
PointPlace points_of(GDALDatasetH dataset) {
  if (transform_of(dataset)) return PointPlace::none;
  if (gdal().GDALGetGCPCount(dataset) > 0) return PointPlace::control_points;
  return has_camera(dataset) ? PointPlace::camera : PointPlace::none;
}

/// The statement of a dataset about its place; none if it states neither a grid nor points nor a coordinate system.
/// `resampled`: the same raster on a grid; null if its points are not used.
std::optional<Georeference> read_place(GDALDatasetH dataset, GDALDatasetH resampled) {
  GDALDatasetH placed = resampled != nullptr ? resampled : dataset;
  Georeference said;
  const std::string_view driver = gdal().GDALGetDescription(gdal().GDALGetDatasetDriver(dataset));
  said.source = driver == "GTiff" ? "GeoTIFF tags" : std::string(driver) + " header";
  said.transform = transform_of(placed);
  if (resampled != nullptr)
    said.points = points_of(dataset) == PointPlace::camera ? "camera model (RPC)" : "ground control points";
  const OGRSpatialReferenceH system = gdal().GDALGetSpatialRef(placed);
  said.crs = wkt_of(system);
  if (system != nullptr) {
    if (const char* title = gdal().OSRGetName(system)) said.crs_title = title;
    const std::string name = name_in(said.crs_title);
    if (!name.empty() && gdal().OSRIsLocal(system) != 0) said.crs = said.crs_title = name;
  }
  const char* pixel = gdal().GDALGetMetadataItem(dataset, GDALMD_AREA_OR_POINT, nullptr);
  said.pixel_is_point = pixel != nullptr && std::string_view(pixel) == GDALMD_AOP_POINT;
  if (!said.transform && said.crs.empty()) return {};
  return said;
}

/// True if the names are the same, and the radii differ by less than a metre.
bool are_of_one_name(const CrsFacts& one, const CrsFacts& other) {
  return one.name == other.name && std::abs(one.a_m - other.a_m) < 1.0 && std::abs(one.b_m - other.b_m) < 1.0;
}

/// Finds out whether two systems place a raster alike, within a hundredth of a pixel.
bool place_alike(const Georeference& one, const Georeference& other, GDALDatasetH dataset) {
  const auto crs = Crs::open(one.crs), beside = Crs::open(other.crs);
  if (!crs || !beside || !one.transform || !are_of_one_name(crs->facts(), beside->facts())) return false;
  const Affine& to = *one.transform;
  const double alike =
      0.01 * std::min(std::hypot(to.x_per_column, to.y_per_column), std::hypot(to.x_per_row, to.y_per_row));
  const double width = gdal().GDALGetRasterXSize(dataset), height = gdal().GDALGetRasterYSize(dataset);
  const std::vector<CrsPoint> points{to.at(0, 0), to.at(width, 0), to.at(0, height), to.at(width, height),
                                     to.at(0.5 * width, 0.5 * height)};
  const auto places = beside->places(points);
  const auto back = places ? crs->points(*places) : places;
  return back && std::ranges::equal(*back, points, [&](const CrsPoint& a, const CrsPoint& b) {
           return std::hypot(a.x - b.x, a.y - b.y) < alike;
         });
}

/// Returns what warnings say against the place. A system whose code has another definition in the registry is no fault
/// if both place the raster alike.
std::string doubt_of(const std::vector<std::string>& warnings, const DatasetSource& source, const Georeference& said) {
  const auto is_of_code = [](const std::string& warning) {
    return warning.find("not the same as the one from the EPSG registry") != std::string::npos;
  };
  const auto first = std::ranges::find_if_not(warnings, is_of_code);
  if (first != warnings.end()) return *first;
  if (warnings.empty()) return {};
  for (const char* definition : {"GEOKEYS", "EPSG"}) {
    const GdalSettings by_one(GdalSettings::Settings{{"GTIFF_SRS_SOURCE", definition}});
    const auto again = open_dataset(source);
    const auto other = again ? read_place((*again)->stored, (*again)->warped) : std::nullopt;
    if (other && place_alike(said, *other, (*again)->read())) continue;
    return "their numbers and the code of their coordinate system contradict each other";
  }
  return {};
}

/// Names of the rasters in a file that holds several; the first one is that of GDAL.
std::vector<std::string> sub_datasets(GDALDatasetH dataset) {
  std::vector<std::string> names;
  char** const items = gdal().GDALGetMetadata(dataset, "SUBDATASETS");
  for (int i = 0; i < gdal().CSLCount(items); ++i) {
    const std::string_view item = items[i];
    const std::size_t value = item.find("_NAME=");
    if (value != std::string_view::npos) names.emplace_back(item.substr(value + 6));
  }
  return names;
}

Result<GDALDatasetH> open_by_name(const std::string& name, bool alone, const std::string& option) {
  const GdalSettings settings(
      GdalSettings::Settings{{"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE"}, {"GTIFF_IMPLICIT_JPEG_OVR", "NO"}});
  const GdalMessages messages;
  const char* const no_siblings[] = {nullptr};
  const char* const options[] = {option.empty() ? nullptr : option.c_str(), nullptr};
  GDALDatasetH dataset = gdal().GDALOpenEx(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                           gdal().drivers.data(), options, alone ? no_siblings : nullptr);
  if (dataset != nullptr) return dataset;
  const bool is_unknown = messages.error().empty() || messages.error().find("not recognized as") != std::string::npos;
  return Error{is_unknown ? "it is no raster that GDAL reads" : without_name(messages.error(), name)};
}

/// Resamples a raster that states control points or a camera model onto a grid, as it is read.
GDALDatasetH resampled(GDALDatasetH dataset, bool by_camera) {
  const bool palette = gdal().GDALGetRasterColorTable(gdal().GDALGetRasterBand(dataset, 1)) != nullptr;
  std::vector<const char*> words{"-of", "VRT", "-et", "0.01", "-r", palette ? "near" : "bilinear", "-dstalpha"};
  if (by_camera) words.insert(words.end(), {"-rpc", "-t_srs", "EPSG:4326"});
  words.push_back(nullptr);
  GDALWarpAppOptions* options = gdal().GDALWarpAppOptionsNew(const_cast<char**>(words.data()), nullptr);
  GDALDatasetH warped = gdal().GDALWarp("", nullptr, 1, &dataset, options, nullptr);
  gdal().GDALWarpAppOptionsFree(options);
  return warped;
}

}  // namespace

std::string without_name(std::string message, const std::string& name) {
  for (const std::string& part : {name + ": ", name + ":", name}) {
    for (std::size_t at = message.find(part); at != std::string::npos; at = message.find(part))
      message.erase(at, part.size());
  }
  return message;
}

Status failure(const GdalMessages& messages) {
  return Error{messages.error().empty() ? "GDAL gives no reason" : messages.error()};
}

void CloseDataset::operator()(OpenDataset* dataset) const {
  const GdalMessages messages;
  if (dataset->warped != nullptr) gdal().GDALClose(dataset->warped);
  if (dataset->stored != nullptr) gdal().GDALClose(dataset->stored);
  delete dataset;
}

Result<DatasetHandle> open_dataset(const DatasetSource& source) {
  const auto stored = open_by_name(source.name, source.alone, source.option);
  if (!stored) return stored.error();
  DatasetHandle handle(new OpenDataset{.stored = *stored});
  if (!source.by_points) return handle;
  const GdalMessages messages;
  const bool by_camera = points_of(*stored) == PointPlace::camera;
  handle->warped = resampled(*stored, by_camera);
  if (handle->warped != nullptr) return handle;
  return Error{fmt::format("it is placed by {} that cannot be used: {}",
                           by_camera ? "a camera model (RPC)" : "ground control points", messages.error())};
}

Result<DatasetHandle> open_first_dataset(DatasetSource& source, const std::string& shown_name,
                                         std::vector<std::string>& remarks) {
  auto handle = open_dataset(source);
  if (!handle || gdal().GDALGetRasterCount((*handle)->stored) > 0) return handle;
  const std::vector<std::string> parts = sub_datasets((*handle)->stored);
  if (parts.empty()) return Error{"it holds no raster"};
  source.name = parts.front();
  if (parts.size() > 1) {
    std::string others;
    for (std::size_t i = 1; i < std::min<std::size_t>(parts.size(), 8); ++i) others += " " + shell_word(parts[i]);
    remarks.push_back(fmt::format("{}: it holds {} rasters, of which the first is used; name another one instead:{}",
                                  shown_name, parts.size(), others));
  }
  return open_dataset(source);
}

std::optional<Georeference> place_of(DatasetSource& source, DatasetHandle& handle, const TiffTags& tags) {
  const GdalMessages messages;
  Georeference said;
  if (points_of(handle->stored) != PointPlace::none) {
    source.by_points = true;
    auto by_points = open_dataset(source);
    source.by_points = static_cast<bool>(by_points);
    if (by_points) handle = *std::move(by_points);
    if (!by_points) said.fault = by_points.error().message;
  }
  if (auto stated = read_place(handle->stored, handle->warped)) {
    stated->fault = said.fault;
    said = *std::move(stated);
  }
  if (said.fault.empty()) said.fault = messages.error();
  if (said.fault.empty()) said.fault = doubt_of(messages.warnings(), source, said);
  if (said.fault.empty() && tags.has_place && !said.transform) said.fault = "they give no scale, or no point";
  if (said.fault.empty() && tags.has_system && said.crs.empty()) said.fault = "they name no coordinate system";
  if (said.fault.empty() && !said.transform && said.crs.empty()) return {};
  if (said.source.empty()) said.source = "GeoTIFF tags";
  if (!said.fault.empty()) said.fault = fmt::format("its {} cannot be read: {}", said.source, said.fault);
  return said;
}

}  // namespace terrella
