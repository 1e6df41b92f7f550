#include "streaming/remote_tiff/span_fetcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <new>
#include <utility>

namespace terrella {
namespace {

/// Spans that are wanted together come one after the other within this time.
constexpr std::chrono::milliseconds kGather{3};
/// Bytes between two spans that cost less than another request. Writers put up to 8 bytes between tiles.
constexpr std::uint64_t kMostGapBytes = 4096;
constexpr std::uint64_t kMostGroupBytes = 1U << 20;
/// A tile of 64 MiB that grew by its coding.
constexpr std::size_t kMostSpanBytes = 130UL << 20;
/// Threads that decode spans to check them.
constexpr unsigned kMostSplitters = 4;

HttpOptions with_room(HttpOptions options) {
  options.max_response_bytes = std::max(options.max_response_bytes, kMostSpanBytes);
  return options;
}

std::uint64_t end_of(const ByteRange& range) { return range.offset + range.length; }

}  // namespace

SpanFetcher::SpanFetcher(FileAddress file, const HttpOptions& options, ReplyQueue& answers)
    : file_(std::move(file)),
      most_in_flight_(static_cast<std::size_t>(options.connections_per_host)),
      answers_(answers),
      fetcher_(with_room(options), raw_) {
  const unsigned splitters = std::clamp(std::thread::hardware_concurrency(), 1U, kMostSplitters);
  for (unsigned i = 0; i < splitters; ++i) {
    splitters_.emplace_back([this] {
      while (auto reply = raw_.take()) split(*std::move(reply));
    });
  }
  launcher_ = std::jthread([this] { launch_gathered(); });
}

SpanFetcher::~SpanFetcher() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  came_.notify_all();
  raw_.close();
}

void SpanFetcher::fetch(std::uint64_t number, const ByteRange& span, double priority, SpanCheck check) {
  wait(number, {span, priority, std::move(check)});
}

void SpanFetcher::wait(std::uint64_t number, Span span) {
  {
    const std::lock_guard lock(mutex_);
    places_.emplace(span.range.offset, number);
    waiting_.insert_or_assign(number, std::move(span));
    new_spans_ = true;
  }
  came_.notify_one();
}

void SpanFetcher::set_priority(std::uint64_t number, double priority) {
  const std::lock_guard lock(mutex_);
  if (const auto span = waiting_.find(number); span != waiting_.end()) {
    span->second.priority = priority;
  } else if (const auto group = group_of_.find(number); group != group_of_.end()) {
    fetcher_.set_priority(group->second, priority);
  }
}

void SpanFetcher::cancel(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  if (in_check_.erase(number) > 0) return;
  if (const auto span = waiting_.extract(number); !span.empty()) {
    places_.erase({span.mapped().range.offset, number});
    return;
  }
  const auto in_group = group_of_.extract(number);
  if (in_group.empty()) return;
  Group& group = groups_.at(in_group.mapped());
  group.spans.erase(number);
  if (!group.spans.empty()) return;
  fetcher_.cancel(in_group.mapped());
  groups_.erase(in_group.mapped());
  launch();
}

HttpCounts SpanFetcher::counts() const {
  const std::lock_guard lock(mutex_);
  HttpCounts counts = fetcher_.counts();
  counts.waiting = waiting_.size();
  return counts;
}

void SpanFetcher::launch_gathered() {
  Lock lock(mutex_);
  for (;;) {
    came_.wait(lock, [this] { return stopping_ || new_spans_; });
    if (came_.wait_for(lock, kGather, [this] { return stopping_; })) return;
    new_spans_ = false;
    launch();
  }
}

/// Requests groups until enough are in flight. The lock is held.
void SpanFetcher::launch() {
  while (!stopping_ && groups_.size() < most_in_flight_ && !places_.empty()) {
    const std::uint64_t number = ++last_group_;
    const Group& group = groups_.emplace(number, take_group(most_wanted())).first->second;
    for (const auto& [span, asked] : group.spans) group_of_.emplace(span, number);
    submit(number, group);
  }
}

/// The waiting span of the highest priority; among equals the first in the file.
SpanFetcher::Place SpanFetcher::most_wanted() const {
  return std::ranges::max_element(places_, {},
                                  [this](const auto& place) { return waiting_.at(place.second).priority; });
}

/// Takes a waiting span and its neighbours on both sides.
SpanFetcher::Group SpanFetcher::take_group(Place first) {
  Group group{.range = waiting_.at(first->second).range, .spans = {}};
  auto begin = first, end = std::next(first);
  for (; end != places_.end(); ++end) {
    const ByteRange& next = waiting_.at(end->second).range;
    const std::uint64_t whole_end = std::max(end_of(group.range), end_of(next));
    if (next.offset > end_of(group.range) + kMostGapBytes || whole_end - group.range.offset > kMostGroupBytes) break;
    group.range.length = whole_end - group.range.offset;
  }
  for (; begin != places_.begin(); --begin) {
    const ByteRange& next = waiting_.at(std::prev(begin)->second).range;
    const std::uint64_t whole_end = std::max(end_of(group.range), end_of(next));
    if (group.range.offset > end_of(next) + kMostGapBytes || whole_end - next.offset > kMostGroupBytes) break;
    group.range = {.offset = next.offset, .length = whole_end - next.offset};
  }
  for (auto place = begin; place != end; ++place) {
    group.spans.emplace(place->second, std::move(waiting_.extract(place->second).mapped()));
  }
  places_.erase(begin, end);
  return group;
}

void SpanFetcher::submit(std::uint64_t number, const Group& group) {
  HttpRequest request;
  request.id = number;
  request.url = file_.url;
  request.headers = file_.headers;
  request.range = group.range;
  request.if_match = file_.version.strong_etag();
  fetcher_.submit(std::move(request));
}

void SpanFetcher::split(HttpReply&& reply) {
  if (reply.outcome == HttpOutcome::content && file_.version.differs_from(reply)) reply.status = 412;
  if (reply.status == 412) {
    reply.outcome = HttpOutcome::refused;
    reply.why = file_.url.redacted() + ": the file has changed on the server since it was opened; open it again";
  }
  Group group;
  {
    const std::lock_guard lock(mutex_);
    const auto found = groups_.extract(reply.id);
    if (found.empty()) return;
    group = std::move(found.mapped());
    for (const auto& [number, span] : group.spans) {
      group_of_.erase(number);
      in_check_.insert(number);
    }
    launch();
  }
  const std::vector<std::byte> body = std::move(reply.body);
  for (auto& [number, span] : group.spans) {
    HttpReply part = reply;
    part.id = number;
    if (part.outcome == HttpOutcome::content) cut_out(part, group, span, body);
    {
      const std::lock_guard lock(mutex_);
      if (in_check_.erase(number) == 0) continue;  // cancelled
    }
    if (part.outcome == HttpOutcome::broken && !std::exchange(span.again, true)) {
      wait(number, std::move(span));
    } else {
      answers_.push(std::move(part));
    }
  }
}

/// Gives an answer the bytes of a span, or says why it has none.
void SpanFetcher::cut_out(HttpReply& part, const Group& group, const Span& span,
                          std::span<const std::byte> body) const {
  const ByteRange within{span.range.offset - group.range.offset, span.range.length};
  if (!is_within(within, body.size())) {
    part.outcome = HttpOutcome::refused;
    part.why = file_.url.redacted() + ": the file ends within a tile; it is truncated, get it again";
    return;
  }
  const auto bytes = body.subspan(within.offset, within.length);
  try {
    if (Status good = span.check(span.range, bytes); !good) {
      part.outcome = HttpOutcome::broken;
      part.why = fmt::format("{}: bytes of a tile do not decode: {}", file_.url.redacted(), good.error().message);
      return;
    }
    part.body.assign(bytes.begin(), bytes.end());
  } catch (const std::bad_alloc&) {
    part.outcome = HttpOutcome::failed;
    part.why = file_.url.redacted() + ": there is not enough memory to decode a tile";
  }
}

}  // namespace terrella
