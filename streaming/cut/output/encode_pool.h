#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/result.h"
#include "streaming/cut/output/tile_encoder.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/cut/strip.h"

namespace terrella {

struct TileCounts {
  std::int64_t tiles = 0;  ///< without squeezed ones, which are there besides
  std::int64_t bytes = 0;
  void add(const TileId& id, std::size_t size) {
    if (id.squeeze == 0) ++tiles;
    bytes += static_cast<std::int64_t>(size);
  }
};

/// Encodes the tiles of strips on `jobs` threads and writes them on one more, in the order of submission whatever
/// thread was faster, so that the same picture gives the same file. What waits is bounded by the strips that are lent
/// (StripPool) and by kMaxUnwrittenTiles. After a failure it drops what comes.
/// thread: one at a time
class EncodePool {
 public:
  /// The first `already` tiles are written already and only counted past.
  EncodePool(int jobs, TileCoding coding, TileWriter& writer, std::int64_t already = 0);
  ~EncodePool();  ///< drops what has not been encoded
  EncodePool(const EncodePool&) = delete;
  EncodePool& operator=(const EncodePool&) = delete;

  void submit(const std::shared_ptr<const Strip>& strip);
  [[nodiscard]] bool failed() const;
  /// Waits until everything is written, or tells the first failure. Throws what a thread has thrown (std::bad_alloc).
  /// Nothing can be submitted after it.
  [[nodiscard]] Result<TileCounts> finish();

 private:
  static constexpr std::size_t kMaxUnwrittenTiles = 256;
  struct Job {
    std::shared_ptr<const Strip> strip;
    std::int64_t index;
    std::uint64_t order;
  };
  struct Encoded {
    TileId id;
    std::vector<std::byte> bytes;
  };

  void run_guarded(const std::function<void()>& work);
  void run_encoder(const TileCoding& coding);
  void run_writer();
  void fail(const Error& error);
  void join();

  TileWriter& writer_;
  mutable std::mutex mutex_;
  std::condition_variable work_, encoded_, written_;
  std::deque<Job> jobs_;
  std::map<std::uint64_t, Encoded> finished_;
  std::uint64_t already_ = 0;
  std::uint64_t submitted_ = 0;
  std::uint64_t next_to_write_ = 0;
  bool closed_ = false;
  std::optional<Error> error_;
  std::exception_ptr thrown_;
  TileCounts counts_;
  std::vector<std::thread> threads_;
};

}  // namespace terrella
