#pragma once

#include <chrono>
#include <memory>
#include <span>
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

/// One finished request: the decoded tile, or why there is none.
template <class Decoded>
struct Loaded {
  TileId id;
  Result<Decoded, TileFailure> tile;
};

struct LoaderOptions {
  int workers = 2;                              ///< threads that read and decode, [1, 64]
  std::size_t max_finished_bytes = 64UL << 20;  ///< decoded tiles waiting to be polled; workers pause over it
  int gutter = 4;                               ///< texels of border on each side of mip 0 (TileTexels)
  int mips = 3;                                 ///< mip levels with the finest, [1, kMaxMips]
  std::shared_ptr<ArrivalBell> bell = {};       ///< rung when a tile is finished; may be none
};

struct LoaderCounts {
  std::size_t waiting = 0;   ///< asked for, not started
  std::size_t running = 0;   ///< in a worker's hands, or arrived and waiting for one
  std::size_t fetching = 0;  ///< asked of the network
  std::size_t finished = 0;  ///< waiting to be polled
  std::size_t read = 0;      ///< tiles read since the start
  std::size_t lacked = 0;    ///< of those, without pixels
};

/// Reads, fetches and decodes tiles. Workers read and decode; what the source has to fetch waits with the network, not
/// in a worker. Two calls form the border: request() and poll(). A tile is in one state at a time:
///   waiting   it is wanted, and no worker has looked for it yet;
///   running   a worker reads it from the source, or decodes it;
///   fetching  the source does not have it here, and the network has been asked;
///   arrived   the network has answered, and no worker has decoded it yet;
///   finished  its texels, or the reason why there are none, wait to be polled.
/// From waiting, fetching and arrived it is dropped when it is no longer wanted.
/// A kind of tile is what `Decoded` is: TileLoader is for imagery, HeightLoader for heights.
template <class Decoded>
class Loader {
 public:
  ~Loader();  ///< joins the workers; what was not started is dropped
  Loader(Loader&&) = default;
  Loader& operator=(Loader&&) = delete;

  /// The whole list of what is wanted now. Replaces the list of the last call: what is no longer in it and has not
  /// started is cancelled; what is running or finished is not started twice; priority is read when a worker
  /// becomes free. A finished tile that was polled and is requested again is read again. thread: main
  void request(std::span<const TileRequest> wanted);
  /// Finished tiles, at most `max_bytes` decoded but at least one if there is one. thread: main
  [[nodiscard]] std::vector<Loaded<Decoded>> poll(std::size_t max_bytes);
  /// Waits until something is finished, nothing is under way, or the deadline; true if something is finished. thread:
  /// main
  bool wait(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts counts() const;  ///< thread: main

 protected:
  explicit Loader(std::shared_ptr<TileScheduler<Decoded>> scheduler) : scheduler_(std::move(scheduler)) {}

 private:
  std::shared_ptr<TileScheduler<Decoded>> scheduler_;
};
extern template class Loader<TileTexels>;

/// Loads imagery: texels ready for upload, premultiplied. thread: main
class TileLoader : public Loader<TileTexels> {
 public:
  TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options = {});
};
using LoadedTile = Loaded<TileTexels>;

}  // namespace terrella
