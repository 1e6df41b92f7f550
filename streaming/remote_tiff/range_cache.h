#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "streaming/byte_range.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/http/range_reader.h"
#include "streaming/url.h"

namespace terrella {

/// The description with which TileCache::open() opens a cache of byte ranges. thread: any
[[nodiscard]] TileSetInfo range_cache_info();
/// The source key of such a cache: the address without secrets, and the version of the file. A cache never holds parts
/// of two versions. thread: any
[[nodiscard]] std::string range_cache_key(const Url& url, const FileVersion& version);
/// The version in the key of a cache of ranges of `url`; none for other keys. thread: any
[[nodiscard]] std::optional<FileVersion> version_in_key(const std::string& key, const Url& url);

/// Ranges of one version of a file on a server, kept in a TileCache: blocks that hold the file's directories, and spans
/// that hold tiles. Spans of a preload are pinned. thread: any
class RangeCache : public RangeStore {
 public:
  explicit RangeCache(std::shared_ptr<TileCache> cache) : cache_(std::move(cache)) {}

  [[nodiscard]] std::optional<std::vector<std::byte>> find(const ByteRange& block) override;
  void keep(const ByteRange& block, std::vector<std::byte> bytes) override;
  void doubt(const ByteRange& block) override;
  [[nodiscard]] std::optional<std::vector<std::byte>> find_span(const ByteRange& span);
  void keep_span(const ByteRange& span, std::vector<std::byte> bytes);
  void doubt_span(const ByteRange& span);  ///< find_span() no longer finds it

  /// Name of a span in the cache: by its first byte.
  [[nodiscard]] static TileId span_id(const ByteRange& span);
  [[nodiscard]] const std::shared_ptr<TileCache>& tiles() const { return cache_; }

  /// True if the version needs no request until later, by the latest call of set_checked().
  [[nodiscard]] bool is_checked(std::int64_t now_unix_s);
  /// Notes that the server has this version, and the time until which no request is needed to know.
  void set_checked(std::int64_t now_unix_s, std::int64_t until_unix_s);

 private:
  [[nodiscard]] std::optional<std::vector<std::byte>> bytes_of(const TileId& id);
  void expire(const TileId& id);

  const std::shared_ptr<TileCache> cache_;
};

}  // namespace terrella
