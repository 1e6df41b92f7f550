#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streaming/byte_range.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/http/range_reader.h"
#include "streaming/http/reply_queue.h"
#include "streaming/url.h"

namespace terrella {

/// One version of a file on a server.
struct FileAddress {
  Url url;
  std::vector<std::string> headers;  ///< may be secret
  FileVersion version;
};

/// Says why the bytes of a span do not decode. Comes from the one who knows the coding. thread: one of the fetcher's
using SpanCheck = std::function<Status(const ByteRange& span, std::span<const std::byte> bytes)>;

/// Fetches spans of one file, neighbours by one request. Waiting spans whose bytes touch, or nearly do, go together, up
/// to 1 MiB. Each span gets an answer of its own: its bytes, or why there are none. A span that does not decode is
/// requested once more; if it does not decode again, its answer is `broken`. An answer of another version of the file
/// is `refused` with the status 412. Answers go to a queue that outlives the fetcher. thread: any
class SpanFetcher {
 public:
  SpanFetcher(FileAddress file, const HttpOptions& options, ReplyQueue& answers);
  ~SpanFetcher();
  SpanFetcher(const SpanFetcher&) = delete;
  SpanFetcher& operator=(const SpanFetcher&) = delete;

  /// `number` names the answer (HttpReply::id); unique among spans without an answer. The span has at least one byte.
  void fetch(std::uint64_t number, const ByteRange& span, double priority, SpanCheck check);
  void set_priority(std::uint64_t number, double priority);
  void cancel(std::uint64_t number);
  [[nodiscard]] HttpCounts counts() const;

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Span {
    ByteRange range;
    double priority = 0.0;
    SpanCheck check;
    bool again = false;  ///< the span came once and did not decode
  };
  struct Group {
    ByteRange range;
    std::map<std::uint64_t, Span> spans;  ///< by number
  };
  using Place = std::set<std::pair<std::uint64_t, std::uint64_t>>::iterator;

  void launch_gathered();
  void launch();
  [[nodiscard]] Place most_wanted() const;
  [[nodiscard]] Group take_group(Place first);
  void submit(std::uint64_t number, const Group& group);
  void wait(std::uint64_t number, Span span);
  void split(HttpReply&& reply);
  void cut_out(HttpReply& part, const Group& group, const Span& span, std::span<const std::byte> body) const;

  const FileAddress file_;
  const std::size_t most_in_flight_;
  ReplyQueue& answers_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable came_;
  bool stopping_ = false;
  bool new_spans_ = false;
  std::unordered_map<std::uint64_t, Span> waiting_;
  std::set<std::pair<std::uint64_t, std::uint64_t>> places_;  ///< offset and number of each waiting span
  std::map<std::uint64_t, Group> groups_;                     ///< in flight, by number of the request
  std::unordered_map<std::uint64_t, std::uint64_t> group_of_;
  std::set<std::uint64_t> in_check_;  ///< spans that came and have no answer yet
  std::uint64_t last_group_ = 0;
  ReplyQueue raw_;
  HttpFetcher fetcher_;
  std::vector<std::jthread> splitters_;  ///< last, with the launcher: use the rest
  std::jthread launcher_;
};

}  // namespace terrella
