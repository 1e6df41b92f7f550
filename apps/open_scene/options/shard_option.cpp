#include "apps/open_scene/options/shard_option.h"

#include <fmt/format.h>

#include <cmath>

#include "base/number.h"

namespace terrella {

Result<Shard> parse_shard(const std::string& text) {
  constexpr double kMostShards = 1e6;
  const std::size_t slash = text.find('/');
  const auto index = read_number(text.substr(0, slash));
  const auto count = slash == std::string::npos ? read_number("") : read_number(text.substr(slash + 1));
  const auto is_count = [](const std::optional<double>& n) {
    return n && *n >= 1 && *n <= kMostShards && *n == std::floor(*n);
  };
  if (!is_count(index) || !is_count(count) || index > count) {
    return Error{fmt::format("{} is no shard; write I/N with I in 1...N, as 3/16", in_quotes(text))};
  }
  return Shard{static_cast<std::int64_t>(index.value_or(1.0)), static_cast<std::int64_t>(count.value_or(1.0))};
}

}  // namespace terrella
