#include "streaming/cut/tile_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "streaming/tileset_json.h"

namespace terrella {

namespace {

namespace fs = std::filesystem;

bool is_gpkg(const fs::path& output) { return output.extension() == ".gpkg"; }

}  // namespace

Status check_output(const fs::path& output) {
  if (output.empty()) return Error{"no output is named; give a file that ends in .gpkg, or a folder"};
  std::error_code failed;
  if (!fs::exists(output, failed)) return Done{};
  const std::string name = output.string();
  const bool folder = fs::is_directory(output, failed);
  if (is_gpkg(output) && !folder) return Done{};
  if (is_gpkg(output)) {
    return Error{fmt::format("{}: is a folder; name a file, or a folder that does not end in .gpkg", name)};
  }
  if (!folder) return Error{fmt::format("{}: is a file; name one that ends in .gpkg, or a folder", name)};
  if (fs::is_empty(output, failed) || fs::exists(output / kTileSetFile, failed)) return Done{};
  return Error{fmt::format("{}: is a folder with other things in it, which would be lost; name a new one", name)};
}

Result<std::unique_ptr<TileWriter>> make_tile_writer(const WriterSetup& setup) {
  return is_gpkg(setup.output) ? make_gpkg_writer(setup) : make_folder_writer(setup);
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
