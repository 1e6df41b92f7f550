#include "streaming/cut/output/tile_writer.h"

#include <fmt/format.h>

#include "streaming/file_bytes.h"

namespace terrella {

bool is_gpkg_name(const std::filesystem::path& output) { return output.extension() == ".gpkg"; }

Result<std::unique_ptr<TileWriter>> make_tile_writer(const WriterSetup& setup) {
  return is_gpkg_name(setup.output) ? make_gpkg_writer(setup) : make_folder_writer(setup);
}

Error cannot_write(const std::filesystem::path& output, int error_number) {
  return Error{fmt::format("{}: cannot be written: {}", output.string(), why_not_written(error_number))};
}

}  // namespace terrella
