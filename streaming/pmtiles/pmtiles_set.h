#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/pmtiles/pmtiles_index.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Reads bytes of a file; returns fewer if the file ends before.
using ReadBytes = std::function<Result<std::vector<std::byte>>(const ByteRange& range)>;

struct PmtilesSet {
  TileSetInfo info;  ///< in Web Mercator, as the specification says
  std::shared_ptr<PmtilesIndex> index;
};

/// Reads the description of a PMTiles archive: header, root directory, metadata, and the size and format of its first
/// tile. `file_bytes`: length of the file once a byte was read; none if unknown. The error begins with `where`.
/// thread: any
[[nodiscard]] Result<PmtilesSet> describe_pmtiles(const ReadBytes& read,
                                                  const std::function<std::optional<std::uint64_t>()>& file_bytes,
                                                  const std::string& where);

/// Reads the metadata, a JSON object by the specification, as text; empty if there are none. The error does not name
/// the file. thread: any
[[nodiscard]] Result<std::string> read_pmtiles_metadata(const ReadBytes& read, const PmtilesHeader& header);
[[nodiscard]] Result<std::string> read_pmtiles_metadata(const std::filesystem::path& path);

/// Opens an archive on disk. thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_pmtiles(const std::filesystem::path& path);

}  // namespace terrella
