#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/http/range_reader.h"
#include "streaming/raster/byte_file.h"
#include "streaming/remote_tiff/range_cache.h"
#include "streaming/remote_tiff/span_fetcher.h"

namespace terrella {

struct RemoteFileOptions {
  Url url;
  std::vector<std::string> headers{};  ///< may be secret
  HttpOptions http{};
  bool offline = false;                               ///< no request is sent; the cache alone counts
  std::function<bool()> go_on = [] { return true; };  ///< see RangeReader
  std::string held_key{};                             ///< key of the cache that is there; empty: none
  /// Opens or creates the cache with a key of range_cache_key(); nullptr: without a cache. A key other than `held_key`
  /// means that the file has changed on the server.
  std::function<Result<std::shared_ptr<TileCache>>(const std::string& key)> open_cache{};
};

/// Bytes in memory, and the number of the first one in the file.
struct FilePiece {
  std::uint64_t offset = 0;
  std::shared_ptr<const std::vector<std::byte>> bytes;
};

/// A file on a server: its version, the blocks of its directories, and its cache. thread: any
class RemoteFile {
 public:
  /// Finds the version: by the cache while that is fresh, else by a request for the file's first block. The error names
  /// the address. Waits for the network.
  [[nodiscard]] static Result<std::shared_ptr<RemoteFile>> open(const RemoteFileOptions& options);

  [[nodiscard]] const std::string& name() const { return name_; }  ///< the address, redacted
  [[nodiscard]] const FileAddress& address() const { return address_; }
  [[nodiscard]] const HttpOptions& http() const { return http_; }
  [[nodiscard]] bool offline() const { return offline_; }
  [[nodiscard]] RangeCache* cache() const { return cache_.get(); }  ///< null: there is none
  [[nodiscard]] std::string cache_key() const { return range_cache_key(address_.url, address_.version); }

  /// The file as far as it is there without a request: blocks, and the pieces that are lent at the moment.
  [[nodiscard]] std::shared_ptr<const ByteFile> held() const { return held_; }
  /// The whole file. Reads wait for the network. take_fault() says why a read ended early.
  [[nodiscard]] std::shared_ptr<const ByteFile> fetching() const { return fetching_; }
  [[nodiscard]] std::string take_fault();  ///< empty: there was none since the last call
  /// Puts the blocks read so far into the cache: they made sense.
  void keep_directories() { reader_->keep_blocks(); }
  /// Lets fetching() and later runs ask the server for the blocks again, because they make no sense. Returns false, and
  /// does nothing, from the second call on.
  bool doubt_directories();
  /// Lets the next opening ask the server for the version again.
  void doubt_version();
  /// Ends reads of fetching() that wait, and all later ones that would.
  void stop() { *stopped_ = true; }

  /// Adds pieces to held() while it lives. The file must outlive it.
  class Loan {
   public:
    Loan(RemoteFile& file, std::vector<FilePiece> pieces);
    ~Loan();
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

   private:
    RemoteFile& file_;
    std::list<std::vector<FilePiece>>::iterator place_;
  };

 private:
  class Held;
  class Fetching;
  using Flag = std::shared_ptr<std::atomic<bool>>;
  RemoteFile(const RemoteFileOptions& options, std::unique_ptr<RangeReader> reader, Flag stopped,
             std::shared_ptr<RangeCache> cache);
  [[nodiscard]] bool read_lent(std::uint64_t offset, std::span<std::byte> into) const;

  const std::string name_;
  const HttpOptions http_;
  const bool offline_;
  const Flag stopped_;
  std::atomic<bool> doubted_ = false;
  const std::unique_ptr<RangeReader> reader_;
  const std::shared_ptr<RangeCache> cache_;
  const FileAddress address_;
  std::shared_ptr<const ByteFile> held_, fetching_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::list<std::vector<FilePiece>> lent_;
  mutable std::string fault_;
};

}  // namespace terrella
