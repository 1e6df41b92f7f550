#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/byte_range.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/http/reply_queue.h"

namespace terrella {

/// Identity of a file on a server at one time.
struct FileVersion {
  std::string etag;                         ///< empty: none was sent
  std::string last_modified;                ///< empty: none was sent
  std::optional<std::uint64_t> file_bytes;  ///< none: the server does not state the length

  /// True if a reply comes from another version of the file. Compares entity tags; without them, dates.
  [[nodiscard]] bool differs_from(const HttpReply& reply) const;
  /// Entity tag for HttpRequest::if_match; empty if it is weak, because If-Match compares strongly (RFC 9110, 13.1.1).
  [[nodiscard]] std::string strong_etag() const;
};

/// Keeps parts of a file longer than a RangeReader does. thread: any
class RangeStore {
 public:
  virtual ~RangeStore() = default;
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> find(const ByteRange& range) = 0;
  virtual void keep(const ByteRange& range, std::vector<std::byte> bytes) = 0;
  /// Lets later runs ask the server for the range again.
  virtual void doubt(const ByteRange& range) = 0;
};

/// The smallest unit that a RangeReader requests, bytes.
inline constexpr std::uint64_t kRangeBlockBytes = 16384;

/// Reads parts of one file on a server by range requests, in blocks. Missing blocks that are neighbours are one
/// request. A block of zeros alone is requested twice, because faulty servers send such in place of the file. Keeps
/// the latest 16 MiB. A file that changes is an error. Calls of read() wait for the network, one after the other.
/// thread: any
class RangeReader {
 public:
  /// `go_on` is asked ten times a second while a call waits; false ends the call with an error.
  RangeReader(
      Url url, std::vector<std::string> headers, const HttpOptions& options,
      std::function<bool()> go_on = [] { return true; }, std::uint64_t block_bytes = kRangeBlockBytes);

  /// Returns the bytes of the range, or those up to the file's end. The range has at most kMaxReadBytes. The error
  /// names the address.
  [[nodiscard]] Result<std::vector<std::byte>> read(const ByteRange& range);
  static constexpr std::uint64_t kMaxReadBytes = 8UL << 20;
  /// Returns the bytes of the range, or those up to the file's end, if they are there without a request. Does not wait.
  [[nodiscard]] std::optional<std::vector<std::byte>> held(const ByteRange& range);
  /// Known once a call of read() succeeded.
  [[nodiscard]] FileVersion version() const;
  /// Takes blocks of `version` from a store from now on. With `offline`, a block that the store does not have is an
  /// error.
  void use_store(std::shared_ptr<RangeStore> store, const FileVersion& version, bool offline);
  /// Puts the blocks read so far into the store: the caller could make sense of them.
  void keep_blocks();
  /// Requests each block read so far again when read() needs it: the caller could make no sense of them. No effect if
  /// offline.
  void doubt_blocks();
  /// The answer to the latest request, without its body.
  [[nodiscard]] HttpReply latest_answer() const;

 private:
  struct Block {
    std::vector<std::byte> bytes;  ///< fewer than a block at the file's end
    std::uint64_t last_use = 0;
    bool kept = false;     ///< the store has it
    bool doubted = false;  ///< held() still returns it
  };
  using Lock = std::unique_lock<std::mutex>;
  [[nodiscard]] bool find_block(std::uint64_t number);
  [[nodiscard]] bool needs_request(std::uint64_t number);
  [[nodiscard]] ByteRange range_of(std::uint64_t number) const;
  [[nodiscard]] std::vector<std::byte> put_together(const ByteRange& range);
  [[nodiscard]] Status fetch_blocks(Lock& lock, std::uint64_t first, std::uint64_t last);
  [[nodiscard]] Result<std::vector<std::byte>> request(Lock& lock, const ByteRange& range);
  [[nodiscard]] Status accept(const HttpReply& reply);
  [[nodiscard]] Result<HttpReply> ask(const ByteRange& range, const FileVersion& version);
  void drop_old();

  const Url url_;
  const std::vector<std::string> headers_;
  const std::function<bool()> go_on_;
  const std::uint64_t block_bytes_;
  std::mutex network_;        ///< held by the one call that waits for the network; taken before mutex_
  mutable std::mutex mutex_;  ///< guards the members below
  FileVersion version_;
  bool has_version_ = false;
  std::map<std::uint64_t, Block> blocks_;  ///< by number
  std::uint64_t uses_ = 0;
  std::shared_ptr<RangeStore> store_;  ///< null: blocks are kept in memory alone
  bool offline_ = false;
  HttpReply latest_;
  ReplyQueue replies_;
  HttpFetcher fetcher_;
};

}  // namespace terrella
