#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "codecs/image.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// What the numbers of tiles of heights mean.
struct ElevationInfo {
  double scale = 1.0;                 ///< metres = number · scale + offset; not 0
  double offset = 0.0;                ///< metres
  std::optional<double> nodata = {};  ///< the number that says that there is no height; of whole ones in [0, 65535]
  bool floats = false;                ///< tiles are TIFFs of 32-bit floats; else gray PNGs of 16 bits
  bool operator==(const ElevationInfo&) const = default;
};

/// What a tile set says of itself; `cut` writes it, `info` prints it.
struct TileSetInfo {
  std::string name;
  std::string attribution;
  std::string body;  ///< preset name or "A,F"; empty: not said
  TileGrid grid;
  ImageFormat format = ImageFormat::jpeg;
  std::optional<ElevationInfo> elevation = {};  ///< the tiles are heights; none: pictures
  std::optional<TileGrid> made_of = {};         ///< the tiles are made of those of this grid (streaming/mercator)
};

/// Why a tile is not there (engine/DESIGN.md, 11). Each kind has its own lifetime.
enum class Absence {
  absent,  ///< the source does not have it (404, 204, no row, outside the bounds): for good, ancestors stand in
  blank,   ///< it is there and says "nothing here"
  broken,  ///< it is there and cannot be decoded
  failed,  ///< it could not be asked for now; may be asked again
  remote,  ///< not here, but TileSource::remote() can fetch it; never the end of a tile's life
};
struct TileFailure {
  Absence kind = Absence::failed;
  std::string why;
};

/// The bytes of one tile as stored, or what makes it.
struct EncodedTile {
  std::vector<std::byte> bytes;
  /// Of heights: what is decoded counts as decoded · scale + offset among the set's numbers (ElevationInfo).
  double number_scale = 1.0;
  double number_offset = 0.0;
  /// Of a tile that is made of others: its picture, and `bytes` are empty. Takes milliseconds. thread: worker
  std::function<Result<Image, TileFailure>()> make_picture = {};
};

/// The far side of a source behind a network: what read() does not have here is fetched without blocking.
/// thread: any for every call
class RemoteTiles {
 public:
  using Done = std::function<void(Result<EncodedTile, TileFailure>)>;
  virtual ~RemoteTiles() = default;
  /// Asks for one tile that is not under way already. A thread of the source calls `done` once. The thread never calls
  /// `done` after cancel() has returned, unless `done` runs at that moment.
  virtual void fetch(const TileId& id, double priority, Done done) = 0;
  virtual void set_priority(const TileId& id, double priority) = 0;  ///< larger first
  virtual void cancel(const TileId& id) = 0;
};

/// A set of tiles that can be read one by one.
/// thread: info() any; read() worker, several at once.
class TileSource {
 public:
  virtual ~TileSource() = default;
  [[nodiscard]] virtual const TileSetInfo& info() const = 0;
  /// Reads one tile. Outside the grid, the levels or the bounds: absent.
  [[nodiscard]] virtual Result<EncodedTile, TileFailure> read(const TileId& id) = 0;
  /// Nothing for a source that has all of its tiles at hand; else where to fetch what read() answers `remote` for.
  /// Lives as long as the source.
  [[nodiscard]] virtual RemoteTiles* remote() { return nullptr; }
  /// Tiles that are there at a level, if that can be counted without asking for each. May take long. thread: worker
  [[nodiscard]] virtual std::optional<std::int64_t> count_tiles(int level) {
    static_cast<void>(level);
    return std::nullopt;
  }
};

}  // namespace terrella
