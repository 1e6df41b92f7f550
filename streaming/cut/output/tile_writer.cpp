#include "streaming/cut/output/tile_writer.h"

#include <fmt/format.h>

#include "streaming/convert/web_tiles.h"
#include "streaming/file_bytes.h"

namespace terrella {

OutputKind output_kind(const std::filesystem::path& output) {
  const std::filesystem::path ending = output.extension();
  if (ending == ".gpkg") return OutputKind::geopackage;
  if (ending == ".mbtiles") return OutputKind::mbtiles;
  return ending == ".pmtiles" ? OutputKind::pmtiles : OutputKind::folder;
}

bool is_web_format(const std::filesystem::path& output) {
  const OutputKind kind = output_kind(output);
  return kind == OutputKind::mbtiles || kind == OutputKind::pmtiles;
}

Status check_output(const std::filesystem::path& output, const TileSetInfo& info) {
  return is_web_format(output) ? check_web_tiles(output, info) : Status(Done{});
}

Result<std::unique_ptr<TileWriter>> make_tile_writer(const WriterSetup& setup) {
  switch (output_kind(setup.output)) {
    case OutputKind::geopackage:
      return make_gpkg_writer(setup);
    case OutputKind::mbtiles:
      return make_mbtiles_writer(setup);
    case OutputKind::pmtiles:
      return make_pmtiles_writer(setup);
    case OutputKind::folder:
      break;
  }
  return make_folder_writer(setup);
}

Error cannot_write(const std::filesystem::path& output, int error_number) {
  return Error{fmt::format("{}: cannot be written: {}", output.string(), why_not_written(error_number))};
}

}  // namespace terrella
