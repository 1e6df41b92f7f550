#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Accepts numbers in [low, high]. Refuses NaN (which passes CLI11's own range), text after the number, and
/// hexadecimal. The message contains the value and the range; CLI11 puts the option's name in front.
[[nodiscard]] CLI::Validator number_in(double low, double high);
/// Accepts each finite number.
[[nodiscard]] CLI::Validator any_number();
[[nodiscard]] CLI::Validator whole_number_in(long low, long high);

/// Adds `--timeout`, seconds.
void add_timeout_option(CLI::App& app, double& seconds, const char* help);

/// Reads "WxH", whole pixels, each in [1, kMaxSide_px].
[[nodiscard]] Result<Viewport> parse_size(std::string_view text);

/// Largest length and height of an option, metres; planets are smaller.
inline constexpr double kMostLength_m = 1.0e9;

/// Names of all bodies, with commas.
[[nodiscard]] std::string body_names();

/// Reads a length of 0 to kMostLength_m metres; "off" gives nullopt.
[[nodiscard]] Result<std::optional<double>> parse_length_or_off(std::string_view text);

/// Returns the value, or throws a CLI::ValidationError that names the option.
template <class T>
[[nodiscard]] T parsed_or_throw(const char* option, Result<T> parsed) {
  if (!parsed) throw CLI::ValidationError(option, parsed.error().message);
  return std::move(parsed).value();
}

/// Adds an option that takes one of a few words.
template <class Value, class Target>
CLI::Option* add_choice(CLI::App& command, const char* option, Target& target,
                        std::vector<std::pair<std::string, Value>> words, const char* help) {
  std::string names;
  for (const auto& [word, value] : words) names += (names.empty() ? "" : "|") + word;
  const auto choose = [&target, words = std::move(words), names, option](const std::string& text) {
    for (const auto& [word, value] : words) {
      if (word == text) {
        target = value;
        return;
      }
    }
    throw CLI::ValidationError(option, "'" + text + "' is none of " + names);
  };
  return command.add_option_function<std::string>(option, choose, help)->type_name(names);
}

}  // namespace terrella
