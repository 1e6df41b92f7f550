#include "apps/program/task_file.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

using Json = nlohmann::json;

constexpr const char* kTaskOption = "--task";
constexpr const char* kCommandKey = "command";
constexpr std::size_t kMostTaskBytes = 16UL << 20;

/// An argument `--task FILE` or `--task=FILE`.
struct TaskArgument {
  std::size_t first = 0;
  std::size_t count = 0;
  std::string file;
};

std::optional<TaskArgument> find_task(const std::vector<std::string>& arguments) {
  const std::string joined = std::string(kTaskOption) + "=";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--") break;  // positional arguments follow
    if (arguments[i].starts_with(joined)) return TaskArgument{i, 1, arguments[i].substr(joined.size())};
    if (arguments[i] == kTaskOption && i + 1 < arguments.size()) return TaskArgument{i, 2, arguments[i + 1]};
  }
  return {};
}

/// True if an argument is this option by one of its names, with or without a value.
bool gives(const CLI::Option& option, std::string_view argument) {
  const auto& longs = option.get_lnames();
  const auto& shorts = option.get_snames();
  if (argument.starts_with("--")) {
    const std::string_view name = argument.substr(2, argument.find('=') - 2);
    return std::ranges::find(longs, name) != longs.end();
  }
  return argument.size() > 1 && argument[0] == '-' && std::ranges::find(shorts, argument.substr(1, 1)) != shorts.end();
}

/// Text of one value; nothing if JSON's value is none.
std::optional<std::string> text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  if (!value.is_array() || value.empty()) return {};
  if (!std::ranges::all_of(value, [](const Json& one) { return one.is_number(); })) return {};
  std::string joined;
  for (const Json& one : value) joined += (joined.empty() ? "" : ",") + one.dump();
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
  if (is_flag != value.is_boolean()) return Error{is_flag ? "is true or false" : "has a value: a text or a number"};
  if (is_flag) {
    if (value.get<bool>()) arguments.push_back("--" + key);
    return Done{};
  }
  const auto texts = texts_of(value);
  if (!texts) return Error{"is a text, a number, or a list of them"};
  const bool positional = option.get_positional();
  for (const std::string& text : *texts) {
    if (positional && text.starts_with('-')) return Error{"begins with a dash; write ./ before the name of a file"};
    arguments.push_back(positional ? text : fmt::format("--{}={}", key, text));
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

/// The task's arguments, without those that `given` replace.
Result<std::vector<std::string>> arguments_of(const Json& task, const CLI::App& subcommand,
                                              const std::vector<std::string>& given, const std::string& where) {
  std::vector<std::string> arguments;
  for (const auto& [key, value] : task.items()) {
    if (key == kCommandKey) {
      if (value == subcommand.get_name()) continue;
      return Error{fmt::format("{}: the task is not for {}; its \"command\" says for which command it is", where,
                               subcommand.get_name())};
    }
    const CLI::Option* option = option_of(subcommand, key);
    if (option == nullptr) {
      return Error{fmt::format("{}: {} has no option \"{}\"; terrella {} --help lists them", where,
                               subcommand.get_name(), key, subcommand.get_name())};
    }
    if (std::ranges::any_of(given, [option](const std::string& one) { return gives(*option, one); })) continue;
    if (const Status added = append(*option, key, value, arguments); !added) {
      return Error{fmt::format("{}: the option \"{}\" {}", where, key, added.error().message)};
    }
  }
  return arguments;
}

}  // namespace

void add_task_option(CLI::App& subcommand) {
  subcommand
      .add_option(
          kTaskOption,
          "Do what a task file says: JSON with the names of options as keys. Options beside it replace its own; "
          "paths count from the folder in which the command runs")
      ->type_name("FILE.json");
}

Result<std::vector<std::string>> with_task(const CLI::App& app, std::vector<std::string> arguments) {
  if (arguments.empty()) return arguments;
  const auto found = app.get_subcommands([&](const CLI::App* one) {
    return one->get_name() == arguments.front() && one->get_option_no_throw(kTaskOption) != nullptr;
  });
  if (found.empty()) return arguments;
  const CLI::App& subcommand = *found.front();
  const auto argument = find_task(arguments);
  if (!argument) return arguments;
  const auto first = arguments.begin() + static_cast<std::ptrdiff_t>(argument->first);
  arguments.erase(first, first + static_cast<std::ptrdiff_t>(argument->count));
  if (find_task(arguments)) return Error{"--task is given twice; a command does one task"};
  const auto bytes = read_file(argument->file, kMostTaskBytes);
  if (!bytes) return Error{bytes.error().message};
  const auto task = parse_json_object(as_text(*bytes), kMostTaskBytes, argument->file);
  if (!task) return task.error();
  const auto stated = arguments_of(*task, subcommand, arguments, argument->file);
  if (!stated) return stated.error();
  arguments.insert(arguments.begin() + 1, stated->begin(), stated->end());
  return arguments;
}

}  // namespace terrella
