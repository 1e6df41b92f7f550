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

/// What is asked for: a tile, and of what one has of it the validators.
struct TileQuestion {
  std::uint64_t number = 0;  ///< the asker's, unique among what is under way
  TileId id;
  std::string etag;
  std::string last_modified;
};

/// Where the preloader's tiles come from. Every question that is not withdrawn ends in exactly one answer, as HTTP
/// would put it, whose `id` is the question's number.
class TileOrigin {
 public:
  using OnAnswer = std::function<void(HttpReply&&)>;

  virtual ~TileOrigin() = default;
  virtual void ask(TileQuestion question) = 0;
  virtual void withdraw(std::uint64_t number) = 0;
  [[nodiscard]] virtual HttpCounts counts() const = 0;
};

/// Tiles from the network. `on_answer` is called on the network thread, one at a time, and must be quick.
[[nodiscard]] std::unique_ptr<TileOrigin> network_origin(const RemoteTileSet& set, const HttpOptions& options,
                                                         TileOrigin::OnAnswer on_answer);
/// Tiles from a set on disk, read by `threads` threads, [1, 64], from which `on_answer` is called, several at once. Its
/// answers carry no validators and no expiry.
[[nodiscard]] std::unique_ptr<TileOrigin> disk_origin(std::shared_ptr<TileSource> source, int threads,
                                                      TileOrigin::OnAnswer on_answer);

}  // namespace terrella
