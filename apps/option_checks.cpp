#include "apps/option_checks.h"

#include <fmt/core.h>

#include <charconv>

#include "apps/scene_options.h"

namespace terrella {
namespace {

/// The whole text as one number; nothing if it is not one.
template <class T>
std::optional<T> whole_text_as(std::string_view text) {
  T value{};
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <class T>
CLI::Validator in_range(T low, T high, const char* kind) {
  const auto check = [low, high, kind](const std::string& text) -> std::string {
    const auto value = whole_text_as<T>(text);
    if (!value) return fmt::format("'{}' is not a {}; it takes {} to {}", text, kind, low, high);
    // Written so that NaN, of which every comparison is false, is refused.
    if (!(*value >= low && *value <= high))
      return fmt::format("{} is out of range; it takes {} to {}", text, low, high);
    return {};
  };
  return CLI::Validator(check, fmt::format("{}...{}", low, high));
}

}  // namespace

CLI::Validator number_in(double low, double high) { return in_range(low, high, "number"); }
CLI::Validator whole_number_in(long low, long high) { return in_range(low, high, "whole number"); }

Result<Viewport> parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  const auto width = whole_text_as<int>(std::string_view(text).substr(0, x));
  const auto height = x == std::string::npos ? std::nullopt : whole_text_as<int>(std::string_view(text).substr(x + 1));
  if (!width || !height)
    return Error{fmt::format("'{}' is not a size; write WIDTHxHEIGHT in pixels, as 1024x768", text)};
  for (const int side : {*width, *height}) {
    if (side < 1 || side > kMaxSide_px) {
      return Error{fmt::format("{}: {} is out of range; a side takes 1 to {} pixels", text, side, kMaxSide_px)};
    }
  }
  return Viewport{.width_px = *width, .height_px = *height};
}

}  // namespace terrella
