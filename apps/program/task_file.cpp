#include "apps/program/task_file.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "apps/program/command_line.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

using Json = nlohmann::json;

constexpr const char* kTaskOption = "--task";
constexpr const char* kCommandKey = "command";
constexpr std::size_t kMostTaskBytes = 16UL << 20;

/// An option or a positional argument of a command line.
struct Word {
  std::size_t at = 0;                   ///< place among the arguments
  std::size_t count = 1;                ///< 2 if the option's value is an argument of its own
  const CLI::Option* option = nullptr;  ///< null: a positional argument, or an unknown option
  bool is_positional = false;
};

std::vector<Word> words_of(const CLI::App& subcommand, const std::vector<std::string>& arguments) {
  std::vector<Word> words;
  bool options_may_come = true;
  for (std::size_t at = 1; at < arguments.size(); at += words.back().count) {
    const std::string& text = arguments[at];
    const bool is_option = options_may_come && text.size() > 1 && text[0] == '-';
    words.push_back({.at = at, .is_positional = !is_option});
    if (!is_option) continue;
    if (text == "--") {
      options_may_come = false;
      continue;
    }
    const bool is_long = text[1] == '-';
    const std::string name = is_long ? text.substr(0, text.find('=')) : text.substr(0, 2);
    const CLI::Option* option = subcommand.get_option_no_throw(name);
    words.back().option = option;
    const bool takes_next = option != nullptr && option->get_items_expected_min() > 0 && name == text;
    if (takes_next && at + 1 < arguments.size()) words.back().count = 2;
  }
  return words;
}

/// Text of a number. A whole number has no fraction, because options that count refuse one.
std::string number_text(const Json& number) {
  constexpr double kMostWhole = 9e15;
  const double value = number.get<double>();
  if (number.is_number_float() && std::abs(value) < kMostWhole && value == std::floor(value)) {
    return std::to_string(static_cast<std::int64_t>(value));
  }
  return number.dump();
}

/// Text of one value; nothing if JSON's value is none.
std::optional<std::string> text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return number_text(value);
  if (!value.is_array() || value.empty()) return {};
  if (!std::ranges::all_of(value, [](const Json& one) { return one.is_number(); })) return {};
  std::string joined;
  for (const Json& one : value) joined += (joined.empty() ? "" : ",") + number_text(one);
  return joined;
}

/// The values of an option, in order; nothing if JSON's value is none.
std::optional<std::vector<std::string>> texts_of(const Json& value) {
  if (auto text = text_of(value)) return std::vector{*std::move(text)};
  if (!value.is_array()) return {};
  std::vector<std::string> texts;
  texts.reserve(value.size());
  for (const Json& one : value) {
    auto text = text_of(one);
    if (!text) return {};
    texts.push_back(*std::move(text));
  }
  return texts;
}

/// Appends the arguments of one key. Returns what is wrong with its value.
Status append(const CLI::Option& option, const std::string& key, const Json& value,
              std::vector<std::string>& arguments) {
  const bool is_flag = option.get_items_expected_max() == 0;
  if (is_flag != value.is_boolean()) return Error{is_flag ? "takes true or false" : "takes a text or a number"};
  if (is_flag) {
    if (value.get<bool>()) arguments.push_back("--" + key);
    return Done{};
  }
  const auto texts = texts_of(value);
  if (!texts) return Error{"takes a text, a number, or a list of them"};
  for (const std::string& text : *texts) {
    if (option.get_positional()) {
      if (text.starts_with('-')) return Error{"begins with a dash; write ./ before the name of a file"};
      arguments.push_back(text);
    } else {
      append_option("--" + key, text, arguments);
    }
  }
  return Done{};
}

/// The option that a key names; null if there is none.
const CLI::Option* option_of(const CLI::App& subcommand, const std::string& key) {
  if (key.empty() || key.starts_with('-') || key == "task" || key == "help") return nullptr;
  const CLI::Option* named = subcommand.get_option_no_throw("--" + key);
  if (named != nullptr) return named;
  const CLI::Option* positional = subcommand.get_option_no_throw(key);
  return positional != nullptr && positional->get_positional() ? positional : nullptr;
}

Status check_command(const Json& stated, const std::string& command, const std::string& file) {
  if (stated == command) return Done{};
  return Error{
      fmt::format("the task is not for {}: its \"command\" is {}; run terrella with that command and --task {}",
                  command, stated.dump(), file)};
}

/// The task's arguments, without those that are given beside it.
Result<std::vector<std::string>> arguments_of(const Json& task, const CLI::App& subcommand,
                                              const std::vector<Word>& given, const std::string& file) {
  const auto is_given = [&given](const CLI::Option& option) {
    return std::ranges::any_of(given, [&option](const Word& word) {
      return option.get_positional() ? word.is_positional : word.option == &option;
    });
  };
  const std::string& command = subcommand.get_name();
  std::vector<std::string> stated;
  for (const auto& [key, value] : task.items()) {
    if (key == kCommandKey) {
      if (const Status right = check_command(value, command, file); !right) return right.error();
      continue;
    }
    const CLI::Option* option = option_of(subcommand, key);
    if (option == nullptr) {
      return Error{fmt::format("{0} has no option \"{1}\"; terrella {0} --help lists them", command, key)};
    }
    if (is_given(*option)) continue;
    if (const Status added = append(*option, key, value, stated); !added) {
      return Error{fmt::format("the option \"{}\" {}", key, added.error().message)};
    }
  }
  return stated;
}

/// A key that the object has twice: JSON's readers keep one of its values.
std::optional<std::string> find_repeated_key(std::string_view text) {
  std::set<std::string> keys;
  std::optional<std::string> repeated;
  const auto note = [&](int depth, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::key && depth == 1 && !keys.insert(parsed.get<std::string>()).second)
      repeated = parsed.get<std::string>();
    return true;
  };
  [[maybe_unused]] const Json same = Json::parse(text, note, false);
  return repeated;
}

TaskError wrong_usage(const std::string& message) { return {.message = message, .is_usage = true}; }

}  // namespace

void add_task_option(CLI::App& subcommand) {
  subcommand
      .add_option(kTaskOption,
                  "Do what a task file says: JSON with the names of options as keys. Arguments beside it replace its "
                  "own; paths are relative to the working directory")
      ->type_name("FILE.json");
}

Result<std::vector<std::string>, TaskError> with_task(const CLI::App& app, std::vector<std::string> arguments) {
  if (arguments.empty()) return arguments;
  const auto found = app.get_subcommands([&](const CLI::App* one) {
    return one->get_name() == arguments.front() && one->get_option_no_throw(kTaskOption) != nullptr;
  });
  if (found.empty()) return arguments;
  const CLI::App& subcommand = *found.front();
  const auto is_task = [&](const Word& word) { return word.option == subcommand.get_option_no_throw(kTaskOption); };
  const std::vector<Word> words = words_of(subcommand, arguments);
  const auto word = std::ranges::find_if(words, is_task);
  if (word == words.end()) return arguments;
  if (word->count == 1 && arguments[word->at] == kTaskOption) return arguments;  // has no file: the parser refuses it
  if (std::ranges::count_if(words, is_task) > 1) return wrong_usage("--task is given twice; a command does one task");
  const std::string& last = arguments[word->at + word->count - 1];
  const std::string file = word->count == 2 ? last : last.substr(std::string_view(kTaskOption).size() + 1);
  if (file.empty()) return wrong_usage("--task takes the name of a file");
  const auto first = arguments.begin() + static_cast<std::ptrdiff_t>(word->at);
  arguments.erase(first, first + static_cast<std::ptrdiff_t>(word->count));

  const auto bytes = read_file(file, kMostTaskBytes);
  if (!bytes) return TaskError{.message = bytes.error().message};
  const auto task = parse_json_object(as_text(*bytes), kMostTaskBytes, file);
  if (!task) return TaskError{.message = task.error().message};
  if (const auto repeated = find_repeated_key(as_text(*bytes))) {
    return wrong_usage(fmt::format("{}: \"{}\" stands there twice; give several values as a list", file, *repeated));
  }
  const auto stated = arguments_of(*task, subcommand, words, file);
  if (!stated) return wrong_usage(file + ": " + stated.error().message);
  arguments.insert(arguments.begin() + 1, stated->begin(), stated->end());
  return arguments;
}

}  // namespace terrella
