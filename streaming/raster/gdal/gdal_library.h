#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_utils.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Functions of GDAL's C interface that Terrella calls. The library is loaded when the first raster or vector file is
/// opened, because loading takes some 40 ms and programs without such files need none of it.
// clang-format off
#define TERRELLA_GDAL_FUNCTIONS(X) \
  X(CPLGetErrorHandlerUserData) X(CPLPopErrorHandler) X(CPLPushErrorHandlerEx) X(CPLSetThreadLocalConfigOption) \
  X(CSLCount) X(GDALAllRegister) X(GDALClose) X(GDALDatasetRasterIOEx) X(GDALGetBandDataset) X(GDALGetBlockSize) \
  X(GDALGetColorEntryAsRGB) X(GDALGetColorEntryCount) X(GDALGetDatasetDriver) X(GDALGetDescription) \
  X(GDALGetDriver) X(GDALGetDriverCount) X(GDALGetGCPCount) X(GDALGetGeoTransform) \
  X(GDALGetMaskBand) X(GDALGetMaskFlags) X(GDALGetMetadata) X(GDALGetMetadataItem) X(GDALGetOverview) \
  X(GDALGetOverviewCount) X(GDALGetRasterBand) X(GDALGetRasterBandXSize) X(GDALGetRasterBandYSize) \
  X(GDALGetRasterColorInterpretation) X(GDALGetRasterColorTable) X(GDALGetRasterCount) X(GDALGetRasterDataType) \
  X(GDALGetRasterNoDataValue) X(GDALGetRasterNoDataValueAsInt64) X(GDALGetRasterNoDataValueAsUInt64) \
  X(GDALGetRasterOffset) X(GDALGetRasterScale) X(GDALGetRasterStatistics) X(GDALGetRasterUnitType) \
  X(GDALGetRasterXSize) X(GDALGetRasterYSize) X(GDALGetSpatialRef) X(GDALIdentifyDriverEx) X(GDALOpenEx) \
  X(GDALRasterIOEx) X(GDALReadBlock) X(GDALSetCacheMax64) X(GDALWarp) X(GDALWarpAppOptionsFree) \
  X(GDALWarpAppOptionsNew) X(OSRExportToWktEx) X(OSRGetName) X(OSRIsLocal) \
  X(CPLForceToASCII) X(CPLIsUTF8) X(CSLDestroy) X(GDALDatasetGetLayer) X(GDALDatasetGetLayerCount) \
  X(OCTDestroyCoordinateTransformation) X(OCTNewCoordinateTransformation) X(OCTTransform) X(OGR_FD_GetFieldCount) \
  X(OGR_FD_GetFieldDefn) X(OGR_F_Destroy) X(OGR_F_GetFieldAsDouble) X(OGR_F_GetFieldAsInteger64) \
  X(OGR_FD_GetFieldIndex) X(OGR_F_GetFieldAsDateTimeEx) X(OGR_F_GetFieldAsString) X(OGR_F_GetGeometryRef) \
  X(OGR_F_GetStyleString) X(OGR_F_IsFieldSetAndNotNull) \
  X(OGR_Fld_GetNameRef) X(OGR_Fld_GetSubType) X(OGR_Fld_GetType) X(OGR_GT_Flatten) X(OGR_G_DestroyGeometry) \
  X(OGR_G_GetGeometryCount) X(OGR_G_GetGeometryName) X(OGR_G_GetGeometryRef) X(OGR_G_GetGeometryType) \
  X(OGR_G_GetLinearGeometry) X(OGR_G_GetPointCount) X(OGR_G_GetX) X(OGR_G_GetY) X(OGR_G_GetZ) X(OGR_G_Is3D) \
  X(OGR_G_IsEmpty) X(OGR_G_Transform) X(OGR_G_WkbSize) X(OGR_L_GetExtent) X(OGR_L_GetLayerDefn) \
  X(OGR_L_GetName) X(OGR_L_GetNextFeature) X(OGR_L_GetSpatialRef) X(OGR_L_ResetReading) X(OGR_SM_Create) \
  X(OGR_SM_Destroy) X(OGR_SM_GetPart) X(OGR_SM_GetPartCount) X(OGR_ST_Destroy) X(OGR_ST_GetParamDbl) \
  X(OGR_ST_GetParamStr) X(OGR_ST_GetType) X(OGR_ST_SetUnit) X(OSRCloneGeogCS) X(OSRDestroySpatialReference) \
  X(OSRGetSemiMajor) X(OSRNewSpatialReference) X(OSRSetAxisMappingStrategy) \
  X(OGRGeometryTypeToName) X(OGR_GetFieldTypeName) X(OGR_L_GetFeatureCount) X(OGR_L_GetGeomType) \
  X(OSRGetAuthorityCode) X(OSRGetAuthorityName) X(OSRIsCompound) X(OSRSetFromUserInput) \
  X(VSIFCloseL) X(VSIFOpenL) X(VSIFReadL) X(VSIReadDirRecursive) X(VSIStatExL) \
  X(VSIAllocFilesystemPluginCallbacksStruct) X(VSIFree) X(VSIFreeFilesystemPluginCallbacksStruct) \
  X(VSIInstallPluginHandler) \
  X(GDALAddBand) X(GDALCreate) X(GDALCreateCopy) X(GDALGetDriverByName) X(GDALSetGeoTransform) \
  X(GDALSetMetadataItem) X(GDALSetRasterColorInterpretation) X(GDALSetSpatialRef)
// clang-format on

/// The loaded library: api.GDALOpenEx(…) calls GDAL's function of that name.
struct GdalApi {
#define TERRELLA_GDAL_MEMBER(name) decltype(&::name) name = nullptr;  // NOLINT(bugprone-macro-parentheses)
  TERRELLA_GDAL_FUNCTIONS(TERRELLA_GDAL_MEMBER)
#undef TERRELLA_GDAL_MEMBER
  /// Names of the drivers that may open a file: readers of rasters, none that asks a network or a database.
  std::vector<const char*> drivers;  ///< ends with nullptr
};

/// Loads GDAL once. The error names the package that contains the library. thread: any
[[nodiscard]] Result<const GdalApi*> load_gdal();
/// GDAL after load_gdal() has succeeded. thread: any
[[nodiscard]] const GdalApi& gdal();

/// Collects what GDAL reports on this thread while it lives, instead of printing it. thread: that of the constructor
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  /// The first error, on one line; empty if there was none.
  [[nodiscard]] const std::string& error() const { return error_; }
  /// Warnings, on one line each, without repetitions.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void CPL_STDCALL take(CPLErr kind, CPLErrorNum number, const char* text);
  std::string error_;
  std::vector<std::string> warnings_;
};

/// Settings of GDAL that hold on this thread while the object lives.
class GdalSettings {
 public:
  using Settings = std::vector<std::pair<const char*, const char*>>;
  explicit GdalSettings(Settings settings);
  ~GdalSettings();
  GdalSettings(const GdalSettings&) = delete;
  GdalSettings& operator=(const GdalSettings&) = delete;

 private:
  Settings settings_;
};

}  // namespace terrella
