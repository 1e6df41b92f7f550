#include "apps/open_scene/options/option_checks.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "apps/open_scene/options/scene_options.h"
#include "base/number.h"
#include "geo/body.h"

namespace terrella {
namespace {

std::string outside(std::string_view text, double low, double high) {
  return fmt::format("{} is out of range; it takes {} to {}", in_quotes(text), low, high);
}

/// Explains why read_number() rejects the text.
std::string not_read(std::string_view text, const char* wanted, double low, double high) {
  double ignored = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  const bool overflows = problem == std::errc::result_out_of_range && end == text.data() + text.size();
  return fmt::format("{} is {}; it takes {} to {}", in_quotes(text),
                     overflows ? "too large, or too close to 0, for a number here" : wanted, low, high);
}

}  // namespace

CLI::Validator number_in(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    const auto value = read_number(text);
    if (!value) return not_read(text, "not a number", low, high);
    return *value < low || *value > high ? outside(text, low, high) : std::string();
  };
  return {check, fmt::format("{}...{}", low, high)};
}

CLI::Validator any_number() {
  constexpr double kMost = std::numeric_limits<double>::max();
  return number_in(-kMost, kMost);
}

CLI::Validator whole_number_in(long low, long high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    const auto value = read_number(text);
    if (!value || *value != std::floor(*value)) {
      return not_read(text, "not a whole number", double(low), double(high));
    }
    return *value < double(low) || *value > double(high) ? outside(text, double(low), double(high)) : std::string();
  };
  return {check, fmt::format("{}...{}", low, high)};
}

std::string body_names() {
  std::string names;
  for (const Body& body : body_presets()) names += (names.empty() ? "" : ", ") + body.name;
  return names;
}

Result<std::optional<double>> parse_length_or_off(std::string_view text) {
  if (text == "off") return std::optional<double>();
  const std::optional<double> length = read_number(text);
  if (!length || *length < 0.0 || *length > kMostLength_m) {
    return Error{fmt::format("{} is neither a length of 0 to {} m nor off", in_quotes(text), kMostLength_m)};
  }
  return length;
}

void add_timeout_option(CLI::App& app, double& seconds, const char* help) {
  app.add_option("--timeout", seconds, help)->check(number_in(0.0, 1e6))->capture_default_str();
}

Result<Viewport> parse_size(std::string_view text) {
  const std::size_t x = text.find('x');
  const auto width = read_number(text.substr(0, x));
  const auto height = read_number(x == std::string_view::npos ? "" : text.substr(x + 1));
  if (!width || !height || *width != std::floor(*width) || *height != std::floor(*height)) {
    return Error{in_quotes(text) + " is not a size; write WIDTHxHEIGHT in pixels, as 1024x768"};
  }
  for (const double side : {*width, *height}) {
    if (side < 1 || side > kMaxSide_px) {
      return Error{fmt::format("{}: a side takes 1 to {} pixels", in_quotes(text), kMaxSide_px)};
    }
  }
  return Viewport{.width_px = static_cast<int>(*width), .height_px = static_cast<int>(*height)};
}

}  // namespace terrella
