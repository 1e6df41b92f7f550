#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "streaming/http/reply_queue.h"
#include "streaming/remote/remote_tile_set.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A request for a tile, with the validators of the stored copy if there is one.
struct TileQuestion {
  std::uint64_t number = 0;  ///< chosen by the caller; unique among requests in flight
  TileId id;
  std::string etag;
  std::string last_modified;
};

/// Source of the preloader's tiles. Every question that is not withdrawn ends in exactly one answer, as HTTP would put
/// it, whose `id` is the question's number. Answers go to a queue that outlives the origin. thread: any for every call
class TileOrigin {
 public:
  virtual ~TileOrigin() = default;
  virtual void ask(TileQuestion question) = 0;
  virtual void withdraw(std::uint64_t number) = 0;
  [[nodiscard]] virtual HttpCounts counts() const = 0;
};

/// Tiles from the network. thread: any
[[nodiscard]] std::unique_ptr<TileOrigin> network_origin(const RemoteTileSet& set, const HttpOptions& options,
                                                         ReplyQueue& answers);
/// Tiles from a set on disk, read by `threads` threads, [1, 64]. Its answers carry no validators and no expiry.
/// thread: any
[[nodiscard]] std::unique_ptr<TileOrigin> disk_origin(std::shared_ptr<TileSource> source, int threads,
                                                      ReplyQueue& answers);

}  // namespace terrella
