#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
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

/// Reads parts of one file on a server by range requests, in blocks of 16 KiB. Missing blocks that are neighbours are
/// one request. Keeps the latest 16 MiB. A file that changes is an error. Calls wait for the network, one after the
/// other. thread: any
class RangeReader {
 public:
  /// `go_on` is asked ten times a second while a call waits; false ends the call with an error.
  RangeReader(
      Url url, std::vector<std::string> headers, const HttpOptions& options,
      std::function<bool()> go_on = [] { return true; });

  /// Returns the bytes of the range, or those up to the file's end. The range has at most kMaxReadBytes. The error
  /// names the address.
  [[nodiscard]] Result<std::vector<std::byte>> read(const ByteRange& range);
  static constexpr std::uint64_t kMaxReadBytes = 8UL << 20;
  /// Known once a call of read() succeeded.
  [[nodiscard]] FileVersion version() const;

 private:
  struct Block {
    std::vector<std::byte> bytes;  ///< fewer than a block at the file's end
    std::uint64_t last_use = 0;
  };
  [[nodiscard]] Status fetch_blocks(std::uint64_t first, std::uint64_t last);
  [[nodiscard]] Status accept(const HttpReply& reply);
  [[nodiscard]] Result<HttpReply> ask(const ByteRange& range);
  void drop_old();

  const Url url_;
  const std::vector<std::string> headers_;
  const std::function<bool()> go_on_;
  mutable std::mutex mutex_;  ///< guards what follows
  FileVersion version_;
  bool has_version_ = false;
  std::map<std::uint64_t, Block> blocks_;  ///< by number
  std::uint64_t uses_ = 0;
  ReplyQueue replies_;
  HttpFetcher fetcher_;
};

}  // namespace terrella
