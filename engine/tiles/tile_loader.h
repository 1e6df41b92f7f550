#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "tiles/tile_source.h"
#include "tiles/tile_texels.h"

namespace terrella {

struct TileRequest {
  TileId id;
  double priority = 0.0;  ///< larger first
};

class ArrivalBell;
template <class Decoded>
class TileScheduler;

/// One finished request: the decoded tile, or the reason why it failed.
template <class Decoded>
struct Loaded {
  TileId id;
  Result<Decoded, TileFailure> tile;
  std::uint64_t edition = 0;  ///< TileSource::edition() before the tile was read
};

/// Threads that decode the tiles of one layer: one for each core, from 2 to 8, because more would starve the thread
/// that draws, and uploads could not keep up with them. thread: any
[[nodiscard]] int decoder_threads(unsigned cores = std::thread::hardware_concurrency());

struct LoaderOptions {
  int workers = 2;                              ///< threads that read and decode, [1, 64]
  std::size_t max_finished_bytes = 64UL << 20;  ///< decoded tiles that wait to be polled; over this, workers pause
  int gutter = 4;                               ///< texels of border on each side of mip 0 (TileTexels)
  int mips = 3;                                 ///< mip levels including the finest, [1, kMaxMips]
  std::shared_ptr<ArrivalBell> bell = {};       ///< rung when a tile is finished; may be empty
};

struct LoaderCounts {
  std::size_t waiting = 0;   ///< requested, not started
  std::size_t running = 0;   ///< in a worker, or arrived and waiting for a worker
  std::size_t fetching = 0;  ///< requested from the network
  std::size_t finished = 0;  ///< waiting to be polled
  std::size_t read = 0;      ///< tiles finished since the start
  std::size_t missing = 0;   ///< those among `read` that failed
};

/// Reads, fetches and decodes tiles. Workers read and decode. A tile that the source has to fetch waits in the network,
/// not in a worker. The caller uses two calls: request() and poll(). A tile is in one state at a time:
///   waiting   the tile is wanted, and no worker has looked for it yet;
///   running   a worker reads the tile from the source, or decodes it;
///   fetching  the source does not have the tile locally and has asked the network;
///   arrived   the network has answered, and no worker has decoded the tile yet;
///   finished  the decoded tile, or the reason why it failed, waits to be polled.
/// A tile that is no longer wanted is dropped from waiting, fetching and arrived.
/// `Decoded` is the kind of tile: TileLoader loads imagery, HeightLoader heights.
template <class Decoded>
class Loader {
 public:
  ~Loader();  ///< drops waiting tiles; waits for no read() and no decoder
  Loader(Loader&&) noexcept = default;
  Loader& operator=(Loader&&) = delete;

  /// Sets the whole list of wanted tiles and replaces the previous list. Cancels tiles that are no longer listed and
  /// have not started. Never starts a running or finished tile twice. Workers use the newest priorities. A tile that
  /// was polled and is requested again is read again. thread: main
  void request(std::span<const TileRequest> wanted);
  /// Drops what has been read or fetched of one tile, because the source's data changed. A wanted tile that a worker is
  /// reading is read again. thread: main
  void reread(const TileId& id);
  /// Returns finished tiles: at most `max_bytes` decoded, but at least one tile if any is finished. thread: main
  [[nodiscard]] std::vector<Loaded<Decoded>> poll(std::size_t max_bytes);
  /// Waits until a tile is finished, nothing is in flight, or the deadline has passed. True if a tile is finished.
  /// thread: main
  bool wait(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts counts() const;  ///< thread: main

 protected:
  explicit Loader(std::shared_ptr<TileScheduler<Decoded>> scheduler) : scheduler_(std::move(scheduler)) {}

 private:
  std::shared_ptr<TileScheduler<Decoded>> scheduler_;
};
extern template class Loader<TileTexels>;

/// Loads imagery: texels ready for upload, premultiplied; numbers as they are. thread: main
class TileLoader : public Loader<TileTexels> {
 public:
  TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options = {});
};
using LoadedTile = Loaded<TileTexels>;

}  // namespace terrella
