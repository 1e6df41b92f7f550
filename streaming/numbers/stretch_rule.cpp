#include "streaming/numbers/stretch_rule.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/number.h"

namespace terrella {
namespace {

using Kind = StretchRule::Kind;

/// Largest value of a stretch, which is drawn with 32-bit floats.
constexpr double kMostValue = 1.0e38;

std::optional<std::pair<double, double>> two_numbers(std::string_view first, std::string_view second) {
  const auto a = read_number(first);
  const auto b = read_number(second);
  return a && b ? std::optional(std::pair(*a, *b)) : std::nullopt;
}

std::optional<std::pair<double, double>> pair_at(std::string_view text, char between) {
  const std::size_t at = text.find(between);
  if (at == std::string_view::npos) return {};
  return two_numbers(text.substr(0, at), text.substr(at + 1));
}

std::optional<StretchRule> percentiles(const std::optional<std::pair<double, double>>& both) {
  if (!both || both->first < 0.0 || both->second > 100.0 || !(both->first < both->second)) return {};
  return StretchRule{.kind = Kind::percent, .low = both->first, .high = both->second};
}

std::optional<StretchRule> read_rule(std::string_view text) {
  constexpr std::string_view kPercent = "percent:", kSigma = "sigma:";
  if (text == "auto") return StretchRule{};
  if (text == "minmax") return StretchRule{.kind = Kind::min_max, .low = 0.0, .high = 0.0};
  if (text.starts_with(kPercent)) return percentiles(pair_at(text.substr(kPercent.size()), ','));
  if (text.starts_with(kSigma)) {
    const auto times = read_number(text.substr(kSigma.size()));
    if (!times || !(*times > 0.0) || *times > 1e6) return {};
    return StretchRule{.kind = Kind::sigma, .low = 0.0, .high = *times};
  }
  if (const auto range = pair_at(text, ',')) {
    if (!(range->first < range->second) || range->first < -kMostValue || range->second > kMostValue) return {};
    return StretchRule{.kind = Kind::range, .low = range->first, .high = range->second};
  }
  return percentiles(pair_at(text, '-'));
}

}  // namespace

Result<StretchRule> parse_stretch(const std::string& text) {
  if (const auto rule = read_rule(trimmed(text))) return *rule;
  return Error{
      fmt::format("{} is no stretch; write MIN,MAX with MIN < MAX and both within ±1e38, minmax, percent:2,98 (or "
                  "2-98), sigma:2 or auto",
                  in_quotes(text))};
}

std::string stretch_text(const StretchRule& rule) {
  switch (rule.kind) {
    case Kind::range:
      return fmt::format("{:.17g},{:.17g}", rule.low, rule.high);
    case Kind::min_max:
      return "minmax";
    case Kind::percent:
      return fmt::format("percent:{},{}", rule.low, rule.high);
    case Kind::sigma:
      break;
  }
  return fmt::format("sigma:{}", rule.high);
}

Stretch stretch_by(const StretchRule& rule, const NumberStatistics& statistics) {
  Stretch range{.low = rule.low, .high = rule.high};
  if (rule.kind == Kind::min_max) range = {.low = statistics.min, .high = statistics.max};
  if (rule.kind == Kind::percent) {
    range = {.low = statistics.percentile(rule.low), .high = statistics.percentile(rule.high)};
  }
  if (rule.kind == Kind::sigma) {
    range = {.low = statistics.mean - rule.high * statistics.sigma,
             .high = statistics.mean + rule.high * statistics.sigma};
  }
  if (range.low < range.high) return range;
  // A raster that is nearly all one value still shows its others.
  if (statistics.min < statistics.max) return {.low = statistics.min, .high = statistics.max};
  const double half = std::max(0.5, std::abs(range.low) * 1e-6);
  return {.low = range.low - half, .high = range.low + half};
}

}  // namespace terrella
