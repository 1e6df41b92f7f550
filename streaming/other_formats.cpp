#include "streaming/other_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace terrella {

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/+-:=,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

namespace {

using namespace std::string_view_literals;

/// Program that makes a picture of a file, and the form of its command.
enum class Maker {
  gdal,           ///< gdal_translate
  gdal_unmasked,  ///< gdal_translate without the mask, which GDAL's COG writer refuses
  gdal_netcdf,    ///< gdal_translate of a variable in NetCDF
  gdal_parts,     ///< gdal_translate of one of several rasters in the file
  imagemagick,
  djxl,
};

struct FormatStart {
  const char* name;
  std::string_view bytes;
  std::size_t at = 0;
  Maker maker = Maker::gdal;
};
constexpr std::array kFormats = {
    FormatStart{"JPEG 2000", "\0\0\0\x0cjP  "sv},
    FormatStart{"JPEG 2000", "\xff\x4f\xff\x51"sv},
    FormatStart{"JPEG XL", "\0\0\0\x0cJXL "sv, 0, Maker::djxl},
    FormatStart{"JPEG XL", "\xff\x0a"sv, 0, Maker::djxl},
    FormatStart{"AVIF", "ftypavif"sv, 4, Maker::imagemagick},
    FormatStart{"HEIF", "ftyphei"sv, 4},
    FormatStart{"HEIF", "ftypmif1"sv, 4},
    FormatStart{"NetCDF", "CDF\1"sv, 0, Maker::gdal_netcdf},
    FormatStart{"NetCDF", "CDF\2"sv, 0, Maker::gdal_netcdf},
    FormatStart{"NetCDF", "CDF\5"sv, 0, Maker::gdal_netcdf},
    FormatStart{"HDF5 or NetCDF", "\x89HDF\r\n\x1a\n"sv, 0, Maker::gdal_netcdf},
    FormatStart{"HDF4", "\x0e\x03\x13\x01"sv, 0, Maker::gdal_parts},
    FormatStart{"GIF", "GIF8"sv},
    FormatStart{"BMP", "BM"sv},
    FormatStart{"PPM", "P6"sv},
    FormatStart{"PGM", "P5"sv},
    FormatStart{"Erdas Imagine", "EHFA_HEADER_TAG"sv},
    FormatStart{"GRIB", "GRIB"sv},
    FormatStart{"FITS", "SIMPLE  ="sv},
    FormatStart{"VICAR", "LBLSIZE="sv},
};
/// Formats recognised by text somewhere in the first bytes.
constexpr std::array kTextFormats = {
    FormatStart{"a GDAL VRT", "<VRTDataset"sv},    FormatStart{"PDS", "PDS_VERSION_ID"sv},
    FormatStart{"PDS", "Product_Observational"sv}, FormatStart{"an ISIS cube", "IsisCube"sv, 0, Maker::gdal_unmasked},
    FormatStart{"an ESRI grid", "ncols"sv},        FormatStart{"an ESRI grid", "NCOLS"sv},
};

const FormatStart* format_by_head(std::string_view head) {
  for (const FormatStart& format : kFormats) {
    if (head.size() >= format.at && head.substr(format.at).starts_with(format.bytes)) return &format;
  }
  const auto* const found = std::ranges::find_if(
      kTextFormats, [head](const FormatStart& format) { return head.find(format.bytes) != std::string_view::npos; });
  return found == kTextFormats.end() ? nullptr : found;
}

std::string command_for(Maker maker, const std::filesystem::path& path) {
  const std::string in = shell_word(path.string());
  const std::filesystem::path stem = path.parent_path() / path.stem();
  const std::string tif = shell_word(stem.string() + ".tif"), png = shell_word(stem.string() + ".png");
  const std::string plain = fmt::format("gdal_translate -of COG {} {}", in, tif);
  // GDAL reads a name between double quotes, which the shell keeps between single ones.
  const std::string variable = shell_word(fmt::format("NETCDF:\"{}\":VARIABLE", path.string()));
  switch (maker) {
    case Maker::gdal_unmasked:
      return fmt::format("gdal_translate -of COG -mask none {} {}", in, tif);
    case Maker::gdal_netcdf:
      return fmt::format("{}; of several variables choose one that gdalinfo {} lists: gdal_translate -of COG {} {}",
                         plain, in, variable, tif);
    case Maker::gdal_parts:
      return fmt::format(
          "{}; of several rasters choose one: gdalinfo {} lists their SUBDATASET names, each of which "
          "can replace {} in the command",
          plain, in, in);
    case Maker::imagemagick:
      return fmt::format("convert {} {}", in, png);
    case Maker::djxl:
      return fmt::format("djxl {} {}", in, png);
    case Maker::gdal:
      break;
  }
  return plain;
}

}  // namespace

std::string convert_hint(const std::filesystem::path& path, std::string_view head) {
  const FormatStart* format = format_by_head(head);
  if (format == nullptr) return {};
  return fmt::format("it is {}; make a picture of it that is read: {}", format->name, command_for(format->maker, path));
}

}  // namespace terrella
