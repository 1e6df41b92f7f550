#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "streaming/http/http_fetcher.h"
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

/// Source of tiles for the preloader. Every request that is not withdrawn gets exactly one answer in the form of an
/// HTTP reply. The `id` of the reply is the number of the request.
class TileOrigin {
 public:
  using OnAnswer = std::function<void(HttpReply&&)>;

  virtual ~TileOrigin() = default;
  virtual void ask(TileQuestion question) = 0;
  virtual void withdraw(std::uint64_t number) = 0;
  [[nodiscard]] virtual HttpCounts counts() const = 0;
};

/// Tiles from the network. `on_answer` is called on the network thread, one call at a time, and must be quick.
[[nodiscard]] std::unique_ptr<TileOrigin> network_origin(const RemoteTileSet& set, const HttpOptions& options,
                                                         TileOrigin::OnAnswer on_answer);
/// Tiles from a set on disk, read by `threads` threads, [1, 64]. These threads call `on_answer`, several at once. The
/// answers have no validators and no expiry.
[[nodiscard]] std::unique_ptr<TileOrigin> disk_origin(std::shared_ptr<TileSource> source, int threads,
                                                      TileOrigin::OnAnswer on_answer);

}  // namespace terrella
