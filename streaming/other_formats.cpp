#include "streaming/other_formats.h"

#include <fmt/format.h>

#include <array>

namespace terrella {
namespace {

using namespace std::string_view_literals;

struct FormatStart {
  const char* name;
  std::string_view bytes;
  std::size_t at = 0;
};
constexpr std::array kFormats = {
    FormatStart{"JPEG 2000", "\0\0\0\x0cjP  "sv},
    FormatStart{"JPEG 2000", "\xff\x4f\xff\x51"sv},
    FormatStart{"NetCDF", "CDF\1"sv},
    FormatStart{"NetCDF", "CDF\2"sv},
    FormatStart{"NetCDF", "CDF\5"sv},
    FormatStart{"HDF5 or NetCDF", "\x89HDF\r\n\x1a\n"sv},
    FormatStart{"HDF4", "\x0e\x03\x13\x01"sv},
    FormatStart{"GIF", "GIF8"sv},
    FormatStart{"BMP", "BM"sv},
    FormatStart{"PPM", "P6"sv},
    FormatStart{"PGM", "P5"sv},
    FormatStart{"Erdas Imagine", "EHFA_HEADER_TAG"sv},
    FormatStart{"GRIB", "GRIB"sv},
    FormatStart{"FITS", "SIMPLE  ="sv},
};
/// Formats recognised by text somewhere in the first bytes.
constexpr std::array kTextFormats = {FormatStart{"a GDAL VRT", "<VRTDataset"sv}, FormatStart{"PDS", "PDS_VERSION_ID"sv},
                                     FormatStart{"PDS", "Product_Observational"sv},
                                     FormatStart{"an ISIS cube", "IsisCube"sv}, FormatStart{"an ESRI grid", "ncols"sv}};

}  // namespace

std::string shell_word(const std::string& text) {
  constexpr auto kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/+-:=,@%"sv;
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string convert_hint(const std::filesystem::path& path, std::string_view head) {
  const char* name = nullptr;
  for (const FormatStart& format : kFormats) {
    if (head.size() >= format.at && head.substr(format.at).starts_with(format.bytes)) name = format.name;
  }
  for (const FormatStart& format : kTextFormats) {
    if (head.find(format.bytes) != std::string_view::npos) name = format.name;
  }
  if (name == nullptr) return {};
  const auto made = path.parent_path() / (path.stem().string() + ".tif");
  return fmt::format("it is {}; make a picture of it that is read: gdal_translate -of COG {} {}", name,
                     shell_word(path.string()), shell_word(made.string()));
}

}  // namespace terrella
