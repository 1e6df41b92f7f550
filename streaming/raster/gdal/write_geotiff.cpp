#include "streaming/raster/gdal/write_geotiff.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <memory>
#include <system_error>
#include <vector>

#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {
namespace {

struct CloseWritten {
  void operator()(void* dataset) const { gdal().GDALClose(dataset); }
};
using WrittenDataset = std::unique_ptr<void, CloseWritten>;

struct DestroySystem {
  void operator()(void* system) const { gdal().OSRDestroySpatialReference(system); }
};

/// A dataset over the picture's own bytes.
WrittenDataset dataset_over(const WrittenPicture& picture) {
  const Image& image = picture.image;
  const GdalApi& api = gdal();
  WrittenDataset dataset(
      api.GDALCreate(api.GDALGetDriverByName("MEM"), "", image.width_px, image.height_px, 0, GDT_Byte, nullptr));
  if (!dataset) return dataset;
  constexpr std::array kMeanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
  const int bands = picture.with_alpha ? 4 : 3;
  for (int band = 0; band < bands; ++band) {
    const std::string at = fmt::format("DATAPOINTER={}", static_cast<const void*>(image.rgba.data() + band));
    const std::string line = fmt::format("LINEOFFSET={}", 4 * static_cast<std::int64_t>(image.width_px));
    const std::array<const char*, 4> options = {at.c_str(), "PIXELOFFSET=4", line.c_str(), nullptr};
    if (api.GDALAddBand(dataset.get(), GDT_Byte, const_cast<char**>(options.data())) != CE_None) return {};
    api.GDALSetRasterColorInterpretation(api.GDALGetRasterBand(dataset.get(), band + 1),
                                         kMeanings[static_cast<std::size_t>(band)]);
  }
  return dataset;
}

bool place_it(void* dataset, const std::string& crs, const Affine& to_crs) {
  const GdalApi& api = gdal();
  const std::unique_ptr<void, DestroySystem> system(api.OSRNewSpatialReference(nullptr));
  if (!system || api.OSRSetFromUserInput(static_cast<OGRSpatialReferenceH>(system.get()), crs.c_str()) != OGRERR_NONE) {
    return false;
  }
  api.OSRSetAxisMappingStrategy(static_cast<OGRSpatialReferenceH>(system.get()), OAMS_TRADITIONAL_GIS_ORDER);
  std::array<double, 6> transform = {to_crs.x0, to_crs.x_per_column, to_crs.x_per_row,
                                     to_crs.y0, to_crs.y_per_column, to_crs.y_per_row};
  return api.GDALSetSpatialRef(dataset, static_cast<OGRSpatialReferenceH>(system.get())) == CE_None &&
         api.GDALSetGeoTransform(dataset, transform.data()) == CE_None;
}

/// Writes the file under another name. False if GDAL has reported an error.
bool write_part(const std::filesystem::path& part, const WrittenPicture& picture, const std::string& crs,
                const Affine& to_crs, const std::string& attribution) {
  const GdalApi& api = gdal();
  const WrittenDataset dataset = dataset_over(picture);
  if (!dataset || !place_it(dataset.get(), crs, to_crs)) return false;
  if (!attribution.empty()) {
    api.GDALSetMetadataItem(dataset.get(), "TIFFTAG_COPYRIGHT", attribution.c_str(), nullptr);
  }
  const std::array<const char*, 6> options = {"COMPRESS=DEFLATE", "PREDICTOR=YES",        "OVERVIEW_RESAMPLING=AVERAGE",
                                              "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS", nullptr};
  const WrittenDataset written(api.GDALCreateCopy(api.GDALGetDriverByName("COG"), part.c_str(), dataset.get(), FALSE,
                                                  const_cast<char**>(options.data()), nullptr, nullptr));
  return written != nullptr;
}

}  // namespace

Status write_geotiff(const std::filesystem::path& path, const WrittenPicture& picture, const std::string& crs,
                     const Affine& to_crs, const std::string& attribution) {
  if (const auto loaded = load_gdal(); !loaded) return Error{path.string() + ": " + loaded.error().message};
  std::error_code failed;
  if (std::filesystem::exists(path, failed) && !std::filesystem::is_regular_file(path, failed)) {
    return Error{path.string() + ": is no file; name a new one"};
  }
  const std::filesystem::path part = fmt::format("{}.{}.part", path.string(), getpid());
  const GdalMessages messages;
  const bool done = write_part(part, picture, crs, to_crs, attribution) && messages.error().empty();
  failed.clear();
  if (done) std::filesystem::rename(part, path, failed);
  if (done && !failed) return Done{};
  const std::string why = failed ? failed.message() : messages.error().empty() ? "GDAL failed" : messages.error();
  std::filesystem::remove(part, failed);
  return Error{fmt::format("{}: cannot be written: {}", path.string(), why)};
}

}  // namespace terrella
