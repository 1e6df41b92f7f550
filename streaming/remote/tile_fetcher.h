#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <vector>

#include "streaming/http/http_fetcher.h"
#include "streaming/http/reply_queue.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Requests the tiles of a set and checks that they decode (check_body()). A tile or directory that does not decode is
/// requested once more. A tile with its own address is one request. A tile within one file (PMTiles) is a range of the
/// file; the directories that lead to the tile are requested first, each once, whatever number of tiles waits for it.
/// Replies go to a queue that outlives the fetcher, after apply_reply_rules(). thread: any
class TileFetcher {
 public:
  TileFetcher(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& replies);
  ~TileFetcher();
  TileFetcher(const TileFetcher&) = delete;
  TileFetcher& operator=(const TileFetcher&) = delete;

  /// The request has an id below 2^63, validators and a priority; its address and headers come from the set.
  void fetch(const TileId& id, HttpRequest request);
  void set_priority(std::uint64_t number, double priority);
  void cancel(std::uint64_t number);
  [[nodiscard]] HttpCounts counts() const { return fetcher_.counts(); }

 private:
  /// A tile without a reply.
  struct Asked {
    TileId id;
    HttpRequest request;
    int reads = 0;
    bool again = false;  ///< the tile came once and did not decode
  };
  /// A directory that is requested, and the tiles that wait for it.
  struct Directory {
    ByteRange range;
    std::vector<std::uint64_t> tiles;
    bool again = false;  ///< the tile came once and was damaged
  };

  void start_checking();
  void proceed(std::uint64_t number);
  void wait_for(const ByteRange& range, std::uint64_t number);
  void request_directory(Directory directory);
  void answer(HttpReply&& reply);
  void give_up(std::uint64_t number, const std::string& why);
  void answer_tile(HttpReply&& reply);
  void answer_directory(const HttpReply& reply);
  void give(HttpReply&& reply);
  void give(std::uint64_t number, HttpOutcome outcome, const std::string& why);
  void check_version(HttpReply& reply) const;
  void unpack(HttpReply& reply) const;

  const RemoteTileSet set_;
  ReplyQueue& replies_;
  std::mutex mutex_;  ///< guards the members below
  std::unordered_map<std::uint64_t, Asked> asked_;
  std::map<std::uint64_t, Directory> directories_;  ///< by the number of the request
  std::uint64_t last_directory_;
  ReplyQueue raw_;  ///< replies that are not checked yet
  HttpFetcher fetcher_;
  std::vector<std::jthread> checkers_;  ///< last: use the rest
};

}  // namespace terrella
