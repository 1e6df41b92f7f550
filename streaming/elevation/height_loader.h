#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <vector>

#include "geo/height_tile.h"
#include "streaming/elevation/elevation_source.h"
#include "streaming/tile_loader.h"

namespace terrella {

/// One finished request: heights, or why there are none.
struct LoadedHeights {
  TileId id;
  Result<HeightTile, TileFailure> heights;
};

struct HeightLoaderOptions {
  int workers = 1;                              ///< threads that read and decode, [1, 64]
  std::size_t max_finished_bytes = 16UL << 20;  ///< decoded tiles waiting to be polled; workers pause over it
};

/// A TileLoader (there: the states of a tile, and what each call does) for heights.
class HeightLoader {
 public:
  HeightLoader(const ElevationSource& source, const HeightLoaderOptions& options = {});
  ~HeightLoader();  ///< joins the workers; what was not started is dropped
  HeightLoader(const HeightLoader&) = delete;
  HeightLoader& operator=(const HeightLoader&) = delete;

  void request(std::span<const TileRequest> wanted);                     ///< thread: main
  [[nodiscard]] std::vector<LoadedHeights> poll(std::size_t max_bytes);  ///< thread: main
  bool wait(std::chrono::steady_clock::time_point deadline);             ///< thread: main
  [[nodiscard]] LoaderCounts counts() const;                             ///< thread: main

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace terrella
