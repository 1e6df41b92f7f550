#include "streaming/cut/tile_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

namespace terrella {

Result<std::unique_ptr<TileWriter>> make_tile_writer(const std::filesystem::path& output, const TileSetInfo& info) {
  if (output.empty()) return Error{"no output is named; give a file that ends in .gpkg, or a folder"};
  return output.extension() == ".gpkg" ? make_gpkg_writer(output, info) : make_folder_writer(output, info);
}

Error cannot_write(const std::filesystem::path& output, int error_number) {
  std::string advice = "; check that the folder exists and may be written to";
  if (error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG) {
    advice = "; make room, or name an output on another disk";
  }
  if (error_number == 0) advice.clear();
  const char* reason = error_number == 0 ? "unknown reason" : std::strerror(error_number);
  return Error{fmt::format("{}: cannot be written: {}{}", output.string(), reason, advice)};
}

}  // namespace terrella
