#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <vector>

#include "streaming/tile_source.h"
#include "streaming/tile_texels.h"

namespace terrella {

struct TileRequest {
  TileId id;
  double priority = 0.0;  ///< larger first
};

/// One finished request: texels ready for upload, premultiplied, or why there are none.
struct LoadedTile {
  TileId id;
  Result<TileTexels, TileFailure> pixels;
};

struct LoaderOptions {
  int workers = 2;                              ///< threads that read and decode, [1, 64]
  std::size_t max_finished_bytes = 64UL << 20;  ///< decoded tiles waiting to be polled; workers pause over it
  int gutter = 4;                               ///< texels of border on each side of mip 0 (TileTexels)
  int mips = 3;                                 ///< mip levels with the finest, [1, kMaxMips]
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
class TileLoader {
 public:
  TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options = {});
  ~TileLoader();  ///< joins the workers; what was not started is dropped
  TileLoader(const TileLoader&) = delete;
  TileLoader& operator=(const TileLoader&) = delete;

  /// The whole list of what is wanted now. Replaces the list of the last call: what is no longer in it and has not
  /// started is cancelled; what is running or finished is not started twice; priority is read when a worker
  /// becomes free. A finished tile that was polled and is requested again is read again. thread: main
  void request(std::span<const TileRequest> wanted);
  /// Finished tiles, at most `max_bytes` of pixels but at least one if there is one. thread: main
  [[nodiscard]] std::vector<LoadedTile> poll(std::size_t max_bytes);
  /// Waits until something is finished, nothing is under way, or the deadline; true if something is finished. thread:
  /// main
  bool wait(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts counts() const;  ///< thread: main

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace terrella
