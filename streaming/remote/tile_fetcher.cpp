#include "streaming/remote/tile_fetcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include "streaming/remote/reply_rules.h"

namespace terrella {
namespace {

/// Numbers of directory requests begin here.
constexpr std::uint64_t kDirectories = std::uint64_t{1} << 63;
constexpr unsigned kMostCheckers = 4;

}  // namespace

TileFetcher::TileFetcher(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& replies)
    : set_(set), replies_(replies), last_directory_(kDirectories), fetcher_(options, raw_) {
  start_checking();
}

TileFetcher::~TileFetcher() { raw_.close(); }

void TileFetcher::start_checking() {
  const unsigned checkers = std::clamp(std::thread::hardware_concurrency(), 1U, kMostCheckers);
  for (unsigned i = 0; i < checkers; ++i) {
    try {
      checkers_.emplace_back([this] {
        while (auto reply = raw_.take()) answer(*std::move(reply));
      });
    } catch (const std::system_error&) {
      if (checkers_.empty()) throw;
      return;  // the system has no more threads; one suffices
    }
  }
}

void TileFetcher::fetch(const TileId& id, HttpRequest request) {
  const std::uint64_t number = request.id;
  request.url = tile_url(set_, id);
  request.headers = set_.headers;
  {
    const std::lock_guard lock(mutex_);
    asked_.insert_or_assign(number, Asked{id, std::move(request)});
  }
  proceed(number);
}

void TileFetcher::set_priority(std::uint64_t number, double priority) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = asked_.find(number); found != asked_.end()) found->second.request.priority = priority;
  }
  fetcher_.set_priority(number, priority);
}

void TileFetcher::cancel(std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    asked_.erase(number);
  }
  fetcher_.cancel(number);
}

/// Requests the tile, or the directory that leads to it. No effect on a tile that was cancelled.
void TileFetcher::proceed(std::uint64_t number) {
  HttpRequest request;
  TileId id;
  int reads = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto found = asked_.find(number);
    if (found == asked_.end()) return;
    request = found->second.request;
    id = found->second.id;
    reads = found->second.reads++;
  }
  if (!set_.file) return fetcher_.submit(std::move(request));
  if (reads == kMaxPmtilesReads) return give(number, HttpOutcome::refused, "its directories are too large");
  const auto step = set_.file->index->next(id);
  if (!step) {
    const bool absent = step.error().kind == MissingKind::absent;
    return give(number, absent ? HttpOutcome::nothing : HttpOutcome::broken, step.error().why);
  }
  if (!step->is_tile) return wait_for(step->range, number);
  request.range = step->range;
  request.if_match = set_.file->version.strong_etag();
  fetcher_.submit(std::move(request));
}

void TileFetcher::wait_for(const ByteRange& range, std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    const auto under_way = std::ranges::find(directories_, range, [](const auto& entry) { return entry.second.range; });
    if (under_way != directories_.end()) return under_way->second.tiles.push_back(number);
  }
  request_directory({range, {number}});
}

void TileFetcher::request_directory(Directory directory) {
  HttpRequest request;
  request.headers = set_.headers;
  request.range = directory.range;
  request.if_match = set_.file->version.strong_etag();
  {
    const std::lock_guard lock(mutex_);
    const auto first = asked_.find(directory.tiles.front());
    if (first != asked_.end()) request.priority = first->second.request.priority;
    request.url = tile_url(set_, {});
    request.id = ++last_directory_;
    directories_.emplace(request.id, std::move(directory));
  }
  fetcher_.submit(std::move(request));
}

void TileFetcher::answer(HttpReply&& reply) {
  const std::uint64_t number = reply.id;
  try {
    if (set_.file) check_version(reply);
    if (number >= kDirectories) return answer_directory(reply);
    answer_tile(std::move(reply));
  } catch (const std::exception& error) {
    give_up(number, fmt::format("{}: {}", set_.url.redacted(), error.what()));
  }
}

/// Answers a tile, or all that wait for a directory, whose work has failed, as for want of memory.
void TileFetcher::give_up(std::uint64_t number, const std::string& why) {
  std::vector<std::uint64_t> tiles{number};
  if (number >= kDirectories) {
    const std::lock_guard lock(mutex_);
    const auto directory = directories_.extract(number);
    tiles = directory.empty() ? std::vector<std::uint64_t>() : directory.mapped().tiles;
  }
  for (const std::uint64_t tile : tiles) give(tile, HttpOutcome::failed, why);
}

void TileFetcher::answer_tile(HttpReply&& reply) {
  TileId id;
  {
    const std::lock_guard lock(mutex_);
    const auto found = asked_.find(reply.id);
    if (found == asked_.end()) return;
    id = found->second.id;
  }
  if (set_.file) unpack(reply);
  apply_reply_rules(set_, reply);
  check_body(set_.info, id, reply);
  if (reply.outcome == HttpOutcome::broken) {
    std::unique_lock lock(mutex_);
    const auto found = asked_.find(reply.id);
    if (found == asked_.end()) return;
    if (!std::exchange(found->second.again, true)) {
      lock.unlock();
      return proceed(reply.id);
    }
  }
  give(std::move(reply));
}

void TileFetcher::answer_directory(const HttpReply& reply) {
  ByteRange range;
  {
    const std::lock_guard lock(mutex_);
    range = directories_.at(reply.id).range;
  }
  const bool came = reply.outcome == HttpOutcome::content;
  const Status learned = came ? set_.file->index->learn(range, reply.body) : Status(Done{});
  Directory directory;
  {
    const std::lock_guard lock(mutex_);
    directory = std::move(directories_.extract(reply.id).mapped());
  }
  if (!learned && !std::exchange(directory.again, true)) return request_directory(std::move(directory));
  for (const std::uint64_t number : directory.tiles) {
    if (!learned) {
      give(number, HttpOutcome::broken, learned.error().message);
    } else if (came) {
      proceed(number);
    } else {
      // A directory that does not exist says nothing about the tile.
      give(number, reply.outcome == HttpOutcome::nothing ? HttpOutcome::refused : reply.outcome, reply.why);
    }
  }
}

/// Answers a tile that was not cancelled.
void TileFetcher::give(HttpReply&& reply) {
  {
    const std::lock_guard lock(mutex_);
    if (asked_.erase(reply.id) == 0) return;
  }
  replies_.push(std::move(reply));
}

void TileFetcher::give(std::uint64_t number, HttpOutcome outcome, const std::string& why) {
  HttpReply reply;
  reply.id = number;
  reply.outcome = outcome;
  reply.why = why;
  give(std::move(reply));
}

void TileFetcher::check_version(HttpReply& reply) const {
  if (reply.outcome != HttpOutcome::content || !set_.file->version.differs_from(reply)) return;
  reply.outcome = HttpOutcome::refused;
  reply.body.clear();
  reply.why = set_.url.redacted() + ": the file has changed on the server since it was opened; open it again";
}

void TileFetcher::unpack(HttpReply& reply) const {
  if (reply.outcome == HttpOutcome::nothing) reply.outcome = HttpOutcome::refused;
  if (reply.outcome != HttpOutcome::content) return;
  auto tile = set_.file->index->unpack_tile(std::move(reply.body));
  if (tile) {
    reply.body = *std::move(tile);
    return;
  }
  reply.outcome = HttpOutcome::broken;
  reply.body.clear();
  reply.why = tile.error().message;
}

}  // namespace terrella
