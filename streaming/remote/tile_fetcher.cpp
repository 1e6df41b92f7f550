#include "streaming/remote/tile_fetcher.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

/// Numbers of directory requests begin here.
constexpr std::uint64_t kDirectories = std::uint64_t{1} << 63;

}  // namespace

TileFetcher::TileFetcher(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& replies)
    : set_(set), replies_(replies), last_directory_(kDirectories), fetcher_(options, set.file ? raw_ : replies) {
  if (!set.file) return;
  thread_ = std::jthread([this] {
    while (auto reply = raw_.take()) answer(*std::move(reply));
  });
}

TileFetcher::~TileFetcher() { raw_.close(); }

void TileFetcher::fetch(const TileId& id, HttpRequest request) {
  request.url = tile_url(set_, id);
  request.headers = set_.headers;
  if (!set_.file) return fetcher_.submit(std::move(request));
  const std::uint64_t number = request.id;
  proceed(number, {.id = id, .request = std::move(request)});
}

void TileFetcher::set_priority(std::uint64_t number, double priority) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = waiting_.find(number); found != waiting_.end()) {
      found->second.request.priority = priority;
      return;
    }
  }
  fetcher_.set_priority(number, priority);
}

void TileFetcher::cancel(std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.erase(number) > 0) return;
  }
  fetcher_.cancel(number);
}

void TileFetcher::proceed(std::uint64_t number, Waiting waiting) {
  if (waiting.reads++ == kMaxPmtilesReads) return give(number, HttpOutcome::refused, "its directories are too large");
  const auto step = set_.file->index->next(waiting.id);
  if (!step) {
    const bool absent = step.error().kind == MissingKind::absent;
    return give(number, absent ? HttpOutcome::nothing : HttpOutcome::refused, step.error().why);
  }
  if (!step->is_tile) return wait_for(step->range, number, std::move(waiting));
  waiting.request.range = step->range;
  waiting.request.if_match = set_.file->version.strong_etag();
  fetcher_.submit(std::move(waiting.request));
}

void TileFetcher::wait_for(const ByteRange& range, std::uint64_t number, Waiting waiting) {
  HttpRequest request;
  request.url = waiting.request.url;
  request.headers = set_.headers;
  request.priority = waiting.request.priority;
  request.range = range;
  request.if_match = set_.file->version.strong_etag();
  {
    const std::lock_guard lock(mutex_);
    waiting_.insert_or_assign(number, std::move(waiting));
    const auto under_way = std::ranges::find(directories_, range, [](const auto& entry) { return entry.second.range; });
    if (under_way != directories_.end()) return under_way->second.tiles.push_back(number);
    request.id = ++last_directory_;
    directories_.emplace(request.id, Directory{.range = range, .tiles = {number}});
  }
  fetcher_.submit(std::move(request));
}

void TileFetcher::answer(HttpReply&& reply) {
  check_version(reply);
  if (reply.id < kDirectories) {
    unpack(reply);
    return replies_.push(std::move(reply));
  }
  Directory directory;
  {
    const std::lock_guard lock(mutex_);
    directory = std::move(directories_.extract(reply.id).mapped());
  }
  learn(std::move(directory), std::move(reply));
}

void TileFetcher::learn(Directory directory, HttpReply&& reply) {
  const bool came = reply.outcome == HttpOutcome::content;
  if (came) set_.file->index->learn(directory.range, reply.body);
  for (const std::uint64_t number : directory.tiles) {
    std::optional<Waiting> waiting;
    {
      const std::lock_guard lock(mutex_);
      if (auto found = waiting_.extract(number)) waiting = std::move(found.mapped());
    }
    if (!waiting) continue;
    if (came) {
      proceed(number, *std::move(waiting));
    } else {
      // A directory that does not exist says nothing about the tile.
      give(number, reply.outcome == HttpOutcome::nothing ? HttpOutcome::refused : reply.outcome, reply.why);
    }
  }
}

void TileFetcher::give(std::uint64_t number, HttpOutcome outcome, std::string why) {
  HttpReply reply;
  reply.id = number;
  reply.outcome = outcome;
  reply.why = std::move(why);
  replies_.push(std::move(reply));
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
  reply.outcome = HttpOutcome::refused;
  reply.body.clear();
  reply.why = tile.error().message;
}

}  // namespace terrella
