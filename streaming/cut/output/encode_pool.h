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
  std::int64_t tiles = 0;  ///< excludes squeezed tiles, which are extra
  std::int64_t bytes = 0;
  void add(const TileId& id, std::size_t size) {
    if (id.squeeze == 0) ++tiles;
    bytes += static_cast<std::int64_t>(size);
  }
};

/// Encodes the tiles of strips on `jobs` threads and writes them on one more thread. Tiles are always written in the
/// order of submission, so the same picture gives the same file. The number of lent strips (StripPool) and
/// kMaxUnwrittenTiles bound the queue. After a failure, new strips are dropped. thread: one at a time
class EncodePool {
 public:
  /// The first `already` tiles exist already and are only counted.
  EncodePool(int jobs, TileCoding coding, TileWriter& writer, std::int64_t already = 0);
  ~EncodePool();  ///< drops strips that are not encoded yet
  EncodePool(const EncodePool&) = delete;
  EncodePool& operator=(const EncodePool&) = delete;

  void submit(const std::shared_ptr<const Strip>& strip);
  [[nodiscard]] bool failed() const;
  /// Waits until everything is written, or returns the first failure. Rethrows an exception of a thread
  /// (std::bad_alloc). No strip can be submitted afterwards.
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
