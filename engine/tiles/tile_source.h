#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/time_steps.h"
#include "codecs/image.h"
#include "codecs/numbers.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A range of whole numbers.
struct WholeRange {
  int least = 0;
  int most = 0;  ///< ≥ least
  bool operator==(const WholeRange&) const = default;
};

/// The meaning of the numbers in tiles: heights, temperatures, any quantity with one number per pixel.
struct NumberInfo {
  double scale = 1.0;                 ///< value = number · scale + offset, in `unit`; not 0
  double offset = 0.0;                ///< in `unit`
  std::optional<double> nodata = {};  ///< number that means "no data"; for integer tiles in [0, 65535]
  bool floats = false;                ///< true: tiles are TIFFs of 32-bit floats; false: gray PNGs of 16 bits
  bool is_signed = false;             ///< the 16 bits of a PNG are a two's complement number, as GDAL's Int16
  /// true: tiles are lossless pictures of 8-bit colours, number = R · 65536 + G · 256 + B, clear pixels have no data:
  /// terrain-RGB and Terrarium
  bool rgb = false;
  /// Set: all numbers at full resolution are whole and lie in this range, `nodata` included. Such numbers take half the
  /// memory of others on the GPU, if the range has fewer than 65536 numbers or contains `nodata`.
  std::optional<WholeRange> whole = {};
  /// Above 0, to 1e9: directions. Numbers that differ by it are the same, as 0 and 360 degrees; means go round.
  double period = 0.0;
  std::string unit = {};      ///< unit of values, for a person: "m", "°C"; empty: unknown, heights in metres
  std::string quantity = {};  ///< quantity of the values, for a person: "height", "temperature"; empty: unknown
  bool operator==(const NumberInfo&) const = default;
};

/// The meaning of the same numbers once they are decoded: floats, NaN for "no data". thread: any
[[nodiscard]] inline NumberInfo decoded(NumberInfo info) {
  info.nodata.reset();
  info.is_signed = false;
  info.rgb = false;
  info.floats = true;
  return info;
}

/// Fails if scale or offset is not finite, scale is 0, or a range is empty. thread: any
[[nodiscard]] Status check_numbers(const NumberInfo& info);

/// A level of a `projected` set that has a place of its own.
struct CrsLevel {
  double west = 0.0;  ///< north-west corner of the first tile, easting first, in units of the system
  double north = 0.0;
  double unit_per_px = 1.0;  ///< side of a pixel, in units of the system; > 0
  std::int64_t columns = 0;  ///< tiles; > 0
  std::int64_t rows = 0;
  bool operator==(const CrsLevel&) const = default;
};

/// The square of a coordinate reference system that a `projected` grid covers.
struct CrsSquare {
  std::string crs;    ///< text for Crs::open() (streaming/georeference)
  double west = 0.0;  ///< north-west corner, easting first, in units of `crs`
  double north = 0.0;
  double unit_per_deg = 1.0;  ///< 1/360 of the side, in units of `crs`; > 0
  /// Places of levels that do not halve or whose corners move, by level of the grid; empty: those of the quadtree. The
  /// grid then only counts tiles: degrees of its columns and rows have no meaning, and its bounds are whole.
  std::vector<CrsLevel> levels = {};
  bool operator==(const CrsSquare&) const = default;
};

/// The description that a tile set contains. `cut` writes it, `info` prints it.
struct TileSetInfo {
  std::string name;
  std::string attribution;
  std::string body;  ///< preset name or "A,F"; empty: unknown
  TileGrid grid;
  ImageFormat format = ImageFormat::jpeg;
  std::optional<NumberInfo> numbers = {};  ///< set: the tiles are numbers; none: pictures
  /// The grid of the tiles from which this set's tiles are made.
  std::optional<TileGrid> made_of = {};
  std::optional<CrsSquare> square = {};  ///< square of a `projected` grid: this set's, or that of `made_of`
  std::string time = {};                 ///< instant of the tiles, as their service writes it; empty: none is known
  std::string times = {};                ///< summary of the instants that the service has; empty: none is known
  std::optional<UtcTime> instant = {};   ///< Instant that `time` names; none if unknown.
  /// The instants for which TileSource::at_time() has a source, never empty; null: none is known.
  std::shared_ptr<const TimeSteps> steps = {};
  std::vector<std::string> remarks = {};  ///< notes for the user: what was left out when the set was opened
};

/// The reason why a tile is missing (engine/DESIGN.md, 11). Each kind has its own lifetime.
enum class MissingKind {
  /// The source does not have the tile (404, 204, no row, outside the bounds); permanent, ancestors are drawn instead.
  absent,
  blank,   ///< the tile exists and is empty
  broken,  ///< the tile exists and cannot be decoded
  failed,  ///< the tile could not be had for now; may be retried
  /// The tile is not local, but TileSource::remote() can fetch it; an intermediate result, never a tile's final state.
  remote,
};
struct TileFailure {
  MissingKind kind = MissingKind::failed;
  std::string why;
};

/// The exception being caught, as a failed tile: one that left a thread would end the program. thread: any
[[nodiscard]] TileFailure caught_failure();

/// The bytes of one tile as stored, or a function that makes its picture.
struct EncodedTile {
  std::vector<std::byte> bytes;
  /// For numbers: decoded · scale + offset is the number in the terms of the set (NumberInfo).
  double number_scale = 1.0;
  double number_offset = 0.0;
  /// For a tile that is made of others: makes its picture, and `bytes` is empty. Takes milliseconds. thread: worker
  std::function<Result<Image, TileFailure>()> make_picture = {};
  /// The same for a set of numbers: makes the numbers as decoded from a tile, tile_px a side. thread: worker
  std::function<Result<Numbers, TileFailure>()> make_numbers = {};
};

/// The network side of a source: fetches tiles that read() does not have locally, without blocking. The sources of
/// the library share a desk for it. thread: any
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

/// A set of tiles, read one by one. info() is thread: any; read() is thread: worker, several at once. A globe that is
/// destroyed, or removes its layer, does not wait for a read() in progress: it keeps the source until read() has
/// returned. So read() must own what it uses, and the destructor may run on a worker.
class TileSource {
 public:
  virtual ~TileSource() = default;
  [[nodiscard]] virtual const TileSetInfo& info() const = 0;
  /// Reads one tile; absent outside the grid, the levels or the bounds.
  [[nodiscard]] virtual Result<EncodedTile, TileFailure> read(const TileId& id) = 0;
  /// Reads one tile of a source whose read() may take long. May fail early once `stop` is requested, because nobody
  /// needs the tile any more. By default calls read(id). thread: worker, several at once
  [[nodiscard]] virtual Result<EncodedTile, TileFailure> read_or_stop(const TileId& id, const std::stop_token& stop) {
    static_cast<void>(stop);
    return read(id);
  }
  /// Returns the object that fetches tiles for which read() returns `remote`; null for a source whose tiles are all
  /// local. Lives as long as the source.
  [[nodiscard]] virtual RemoteTiles* remote() { return nullptr; }
  /// Returns the value of the finest pixel at a place on the body `figure`, as the source stores it: not resampled,
  /// scale and offset applied (NumberInfo). `blank`: that pixel has no data; `absent`: the source has no numbers there;
  /// `remote`: only the network has them. Decodes a tile, milliseconds. thread: worker
  [[nodiscard]] virtual Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure);
  /// Counts the changes of the source's tiles. 0: tiles never change. The globe reads drawn tiles again that have
  /// changed since they were read, and shows the earlier ones meanwhile. thread: any
  [[nodiscard]] virtual std::uint64_t edition() const { return 0; }
  /// Returns the count at the last change of a tile that could be read before. thread: any
  [[nodiscard]] virtual std::uint64_t edition_of(const TileId& id) const {
    static_cast<void>(id);
    return edition();
  }
  /// Makes the source of the same tiles at the last of TileSetInfo::steps at or before a time. Requests no description
  /// of the set, but may open a cache, milliseconds. Fails if no steps are known, or if the time is before the first
  /// one, which the error names. Has no effect on this source. thread: any, one at a time
  [[nodiscard]] virtual Result<std::unique_ptr<TileSource>> at_time(UtcTime time);
  /// Counts the tiles of a level; nothing if that would require a request per tile. May take long. thread: worker
  [[nodiscard]] virtual std::optional<std::int64_t> count_tiles(int level) {
    static_cast<void>(level);
    return std::nullopt;
  }
};

}  // namespace terrella
