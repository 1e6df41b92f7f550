#include "streaming/raster/gdal/gdal_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace terrella {
namespace {

/// Memory for GDAL's own cache of decoded blocks, bytes. Terrella keeps decoded blocks itself; this cache only has to
/// hold a row of blocks while its bands are read.
constexpr GIntBig kGdalCacheBytes = 8LL << 20;

/// Drivers that read from a network, a database or a program, or that make a raster of something else than a file.
constexpr std::array<std::string_view, 24> kOtherDrivers{
    "DAAS",       "DERIVED", "EEDA",   "EEDAI",  "GDALG",    "GPKG",     "HTTP",          "KMLSUPEROVERLAY",
    "MBTiles",    "MEM",     "NGW",    "OGCAPI", "PLMOSAIC", "PLScenes", "PostGISRaster", "RASTERLITE",
    "Rasterlite", "STACIT",  "STACTA", "TileDB", "WCS",      "WMS",      "WMTS",          "XYZ"};

std::vector<const char*> file_drivers(const GdalApi& api) {
  std::vector<const char*> names;
  for (int i = 0; i < api.GDALGetDriverCount(); ++i) {
    GDALDriverH driver = api.GDALGetDriver(i);
    const char* name = api.GDALGetDescription(driver);
    const bool reads = api.GDALGetMetadataItem(driver, GDAL_DCAP_RASTER, nullptr) != nullptr &&
                       api.GDALGetMetadataItem(driver, GDAL_DCAP_OPEN, nullptr) != nullptr;
    if (reads && std::ranges::find(kOtherDrivers, name) == kOtherDrivers.end()) names.push_back(name);
  }
  names.push_back(nullptr);
  return names;
}

Result<std::unique_ptr<const GdalApi>> load() {
  void* library = dlopen(TERRELLA_GDAL_SONAME, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) {
    return Error{
        fmt::format("rasters and vector files are read by GDAL, and {} is not installed: apt-get install libgdal32",
                    TERRELLA_GDAL_SONAME)};
  }
  auto api = std::make_unique<GdalApi>();
  const char* missing = nullptr;
#define TERRELLA_GDAL_LOAD(name)                                            \
  api->name = reinterpret_cast<decltype(api->name)>(dlsym(library, #name)); \
  if (api->name == nullptr) missing = #name;
  TERRELLA_GDAL_FUNCTIONS(TERRELLA_GDAL_LOAD)
#undef TERRELLA_GDAL_LOAD
  if (missing != nullptr) {
    return Error{fmt::format("{} has no function {}; install GDAL 3.6 or later", TERRELLA_GDAL_SONAME, missing)};
  }
  // An application that uses GDAL itself keeps its own settings.
  const bool is_first = api->GDALGetDriverCount() == 0;
  api->GDALAllRegister();
  if (is_first) api->GDALSetCacheMax64(kGdalCacheBytes);
  api->drivers = file_drivers(*api);
  return std::unique_ptr<const GdalApi>(std::move(api));
}

std::string on_one_line(const char* text) {
  std::string line = text == nullptr ? "" : text;
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  if (line.starts_with("PROJ: ")) line.erase(0, 6);
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

Result<const GdalApi*> load_gdal() {
  static const Result<std::unique_ptr<const GdalApi>> loaded = load();
  if (!loaded) return loaded.error();
  return loaded->get();
}

const GdalApi& gdal() { return **load_gdal(); }

GdalMessages::GdalMessages() { gdal().CPLPushErrorHandlerEx(take, this); }
GdalMessages::~GdalMessages() { gdal().CPLPopErrorHandler(); }

void CPL_STDCALL GdalMessages::take(CPLErr kind, CPLErrorNum, const char* text) {
  auto& self = *static_cast<GdalMessages*>(gdal().CPLGetErrorHandlerUserData());
  std::string line = on_one_line(text);
  if (kind == CE_Failure || kind == CE_Fatal) {
    if (self.error_.empty()) self.error_ = std::move(line);
  } else if (kind == CE_Warning && std::ranges::find(self.warnings_, line) == self.warnings_.end()) {
    self.warnings_.push_back(std::move(line));
  }
}

GdalSettings::GdalSettings(Settings settings) : settings_(std::move(settings)) {
  for (const auto& [name, value] : settings_) gdal().CPLSetThreadLocalConfigOption(name, value);
}
GdalSettings::~GdalSettings() {
  for (const auto& [name, value] : settings_) gdal().CPLSetThreadLocalConfigOption(name, nullptr);
}

}  // namespace terrella
