#include "streaming/preload/sample_size.h"

#include <algorithm>
#include <vector>

namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;

/// At most `most` places in the walk, in the middles of equal parts.
std::vector<TileId> spread(const TilePlan& plan, int most) {
  const std::int64_t total = plan.total();
  const std::int64_t wanted = std::min<std::int64_t>(most, total);
  std::vector<TileId> tiles;
  const auto feed = plan.walk();
  std::int64_t passed = 0;
  while (static_cast<std::int64_t>(tiles.size()) < wanted) {
    const auto run = feed->next();
    if (!run) break;
    passed += run->count();
    while (static_cast<std::int64_t>(tiles.size()) < wanted) {
      const auto n = static_cast<double>(tiles.size());
      const auto place =
          static_cast<std::int64_t>((n + 0.5) / static_cast<double>(wanted) * static_cast<double>(total));
      if (place >= passed) break;
      tiles.push_back({run->level, run->x, run->first_y + place - (passed - run->count())});
    }
  }
  return tiles;
}

}  // namespace

SizeSample sample_sizes(const TilePlan& plan, int most,
                        const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin,
                        const std::function<bool()>& go_on) {
  ReplyQueue answers;
  const auto origin = make_origin(answers);
  SizeSample sample;
  double bytes = 0.0;
  double seconds = 0.0;
  for (const TileId& id : spread(plan, most)) {
    const auto begun = Clock::now();
    origin->ask({static_cast<std::uint64_t>(++sample.asked), id, {}, {}});
    std::vector<HttpReply> replies;
    while (replies.empty() && go_on()) replies = answers.take_all(std::chrono::milliseconds(2));
    if (replies.empty()) break;
    const HttpReply& reply = replies.front();
    if (reply.outcome == HttpOutcome::content || reply.outcome == HttpOutcome::nothing) {
      ++sample.answered;
      bytes += static_cast<double>(reply.body.size());
      seconds += std::chrono::duration<double>(Clock::now() - begun).count();
    } else {
      sample.why = reply.why;
      if (sample.asked - sample.answered >= 2) break;
    }
  }
  if (sample.answered > 0) {
    sample.bytes_per_tile = bytes / sample.answered;
    sample.seconds_per_tile = seconds / sample.answered;
  }
  return sample;
}

}  // namespace terrella
