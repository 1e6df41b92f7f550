#include "apps/program/command_line.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/process/console.h"
#include "apps/program/commands.h"
#include "apps/program/task_file.h"
#include "apps/viewer/tools/folder_list.h"

namespace terrella {
namespace {

/// Returns the subcommand that the parse reached, or the program; an error message refers to its --help.
const CLI::App& innermost(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

/// Number of single-character changes that turn one word into the other.
std::size_t changes_between(std::string_view one, std::string_view other) {
  std::vector<std::size_t> row(other.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < one.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t k = 0; k < other.size(); ++k) {
      const std::size_t replaced = diagonal + (one[i] == other[k] ? 0 : 1);
      diagonal = std::exchange(row[k + 1], std::min({replaced, row[k] + 1, row[k + 1] + 1}));
    }
  }
  return row.back();
}

/// Returns "; did you mean WORD?" with the known word that a typing error turns into `typed`; empty if there is none.
std::string suggestion(const std::string& typed, const std::vector<std::string>& known) {
  constexpr std::size_t kMostChanges = 2;
  const auto changes = [&typed](const std::string& word) { return changes_between(typed, word); };
  const auto nearest = std::ranges::min_element(known, {}, changes);
  if (nearest == known.end() || changes(*nearest) > kMostChanges) return {};
  return "; did you mean " + *nearest + "?";
}

bool can_be_shown(const std::string& argument) {
  std::error_code unknown;
  return argument.find("://") != argument.npos || std::filesystem::exists(argument, unknown) ||
         has_shown_name(argument);
}

/// Message for the first argument that neither the program nor the subcommand knows.
std::string about_unknown(const CLI::App& where, const std::string& argument) {
  std::vector<std::string> known;
  if (argument.starts_with('-')) {
    const std::string name = argument.substr(0, argument.find('='));  // the value may be a secret
    for (const CLI::Option* option : where.get_options()) known.push_back(option->get_name());
    return "there is no option " + name + suggestion(name, known);
  }
  const auto commands = where.get_subcommands([](const CLI::App*) { return true; });
  if (commands.empty()) return "unexpected argument " + argument;
  for (const CLI::App* command : commands) known.push_back(command->get_name());
  return "there is no command " + argument + suggestion(argument, known);
}

/// Maps CLI11's many exit codes for mistakes to the contract's single code, 2.
int report_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  const CLI::App& where = innermost(app);
  // CLI11 reports missing arguments before unknown ones, so a mistyped name would be reported as a missing one. CLI11
  // also prints all unknown arguments, including the value of a mistyped --header.
  auto unknown = where.remaining();
  std::erase(unknown, "--");  // the mark that only positional arguments follow
  const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (missing && &where == &app && unknown.empty()) {
    print_result("{}", app.help());
    return kDone;
  }
  const std::string command = &where == &app ? app.get_name() : app.get_name() + " " + where.get_name();
  const bool mistyped = (missing || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) && !unknown.empty();
  print_message("{}: {}\n", command, mistyped ? about_unknown(where, unknown.front()) : std::string(error.what()));
  print_message("See {} --help.\n", command);
  return kWrongUsage;
}

/// The arguments, last one first, as CLI11 takes them. `help COMMAND` becomes `COMMAND --help`, and a picture, a tile
/// set or an address in the place of the command becomes `view PICTURE`.
std::vector<std::string> reversed_arguments(const CLI::App& app, std::vector<std::string> arguments) {
  const auto names_command = [&app](const std::string& word) {
    const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
    return std::ranges::any_of(commands, [&word](const CLI::App* command) { return command->get_name() == word; });
  };
  if (!arguments.empty() && !arguments.front().starts_with('-') && !names_command(arguments.front()) &&
      can_be_shown(arguments.front())) {
    arguments.insert(arguments.begin(), "view");
  }
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  std::ranges::reverse(arguments);
  return arguments;
}

}  // namespace

void thank(const std::string& output, const std::string& attributions) {
  if (!attributions.empty()) print_result("{}: thanks to {}\n", output, one_line(attributions));
}

int fail(const char* command, const std::string& why) {
  print_message("terrella {}: {}\n", command, why);
  return kFailed;
}

void append_option(const std::string& name, const std::string& value, std::vector<std::string>& arguments) {
  if (value.empty()) {
    arguments.insert(arguments.end(), {name, value});
  } else {
    arguments.push_back(fmt::format("{}={}", name, value));
  }
}

int run_command_line(CLI::App& app, std::vector<std::string> arguments, const int& exit_code) {
  const std::string command = arguments.empty() ? std::string() : arguments.front();
  auto stated = with_task(app, std::move(arguments));
  if (!stated) {
    print_message("terrella {}: {}\n", command, stated.error().message);
    if (stated.error().is_usage) print_message("See terrella {} --help.\n", command);
    return stated.error().is_usage ? kWrongUsage : kFailed;
  }
  try {
    app.parse(reversed_arguments(app, *std::move(stated)));
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return report_parse(app, error);
  }
}

}  // namespace terrella
