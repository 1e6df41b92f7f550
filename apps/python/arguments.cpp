#include "apps/python/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "apps/program/command_line.h"

namespace terrella {
namespace {

namespace py = pybind11;

/// The keyword of an option or argument: surface_alpha for --surface-alpha, caches for a list of CACHE.
std::string keyword_of(const CLI::Option& option) {
  const bool positional = option.nonpositional() == false;
  std::string name = positional ? option.get_name(true) : option.get_lnames().front();
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::tolower(c)); });
  return name;
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

/// The character between the parts of a value, by the name of its type: 'x' for WxH, ',' for LAT,LON or NAME|A,F.
char separator_of(const CLI::Option& option) {
  const std::string& form = option.get_type_name();
  const std::size_t last = form.find_last_of('|') + 1;  // 0 without one
  const auto is_name = [](unsigned char c) { return std::isupper(c) != 0 || c == '_'; };
  const auto between = std::find_if_not(form.begin() + static_cast<std::ptrdiff_t>(last), form.end(), is_name);
  return between != form.end() && std::string_view("x/-").find(*between) != std::string_view::npos ? *between : ',';
}

std::string text_of(const CLI::Option& option, py::handle value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::tuple>(value)) {
    std::string joined;
    for (const py::handle part : value)
      joined += (joined.empty() ? "" : std::string(1, separator_of(option))) + text_of(option, part);
    return joined;
  }
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  const bool is_array = py::hasattr(value, "__array__") && py::hasattr(value, "ndim") &&
                        !py::isinstance<py::int_>(value) && value.attr("ndim").cast<int>() > 0;
  if (!is_array && PyNumber_Check(value.ptr()) != 0) return py::str(value);
  throw py::type_error(fmt::format("{} takes text, a number, a path, a tuple or a list, not {}", keyword_of(option),
                                   std::string(py::str(py::type::of(value).attr("__name__")))));
}

std::vector<std::string> texts_of(const CLI::Option& option, py::handle value) {
  if (!py::isinstance<py::list>(value)) return {text_of(option, value)};
  std::vector<std::string> texts;
  for (const py::handle one : value) texts.push_back(text_of(option, one));
  return texts;
}

/// Adds an option, or words at the end for an argument without a name.
void add_value(const CLI::Option& option, py::handle value, std::vector<std::string>& words,
               std::vector<std::string>& last) {
  if (value.is_none()) return;
  if (!option.nonpositional()) {
    for (std::string& text : texts_of(option, value)) last.push_back(std::move(text));
    return;
  }
  const std::string name = "--" + option.get_lnames().front();
  if (is_flag(option)) {
    if (py::cast<bool>(value)) words.push_back(name);
    return;
  }
  for (const std::string& text : texts_of(option, value)) append_option(name, text, words);
}

bool is_keyword(const CLI::Option& option, const std::vector<std::string>& left_out) {
  const std::string name = keyword_of(option);
  return name != "help" && std::ranges::find(left_out, name) == left_out.end();
}

}  // namespace

std::string command_doc(const std::string& function, const CLI::App& command,
                        const std::vector<std::string>& left_out) {
  std::string first, required, keywords, lines;
  for (const CLI::Option* option : command.get_options()) {
    if (!is_keyword(*option, left_out)) continue;
    const std::string name = keyword_of(*option);
    const char* standard = option->get_required() ? "" : is_flag(*option) ? "=False" : "=None";
    (option->nonpositional() ? (option->get_required() ? required : keywords) : first) +=
        fmt::format(", {}{}", name, standard);
    const std::string form = is_flag(*option) ? "bool" : option->get_type_name();
    const std::string& given = option->get_default_str();
    lines += fmt::format("    {} ({}{}): {}\n", name, form,
                         given.empty() || is_flag(*option) ? "" : ", default " + given, option->get_description());
  }
  std::string all = first + ", *" + required + keywords;
  all.erase(0, 2);
  return fmt::format("{}({})\n--\n\n{}.\n\nArgs:\n{}", function, all, command.get_description(), lines);
}

std::vector<std::string> command_arguments(const CLI::App& command, const py::args& positional,
                                           const py::kwargs& keywords) {
  std::vector<std::string> words = {command.get_name()}, last;
  std::vector<const CLI::Option*> places, named;
  for (const CLI::Option* option : command.get_options()) (option->nonpositional() ? named : places).push_back(option);
  if (positional.size() > places.size()) {
    throw py::type_error(
        fmt::format("{} takes {} positional argument(s); give the others by name", command.get_name(), places.size()));
  }
  for (std::size_t i = 0; i < positional.size(); ++i) add_value(*places[i], positional[i], words, last);
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    const auto has_name = [&name](const CLI::Option* option) { return keyword_of(*option) == name; };
    auto found = std::ranges::find_if(named, has_name);
    if (found != named.end()) {
      add_value(**found, value, words, last);
      continue;
    }
    found = std::ranges::find_if(places, has_name);
    if (found != places.end()) {
      add_value(**found, value, words, last);
      continue;
    }
    std::string option = name;  // the command says that it does not know the option, and which is meant
    std::ranges::replace(option, '_', '-');
    words.push_back("--" + option);
  }
  if (!last.empty()) words.emplace_back("--");
  words.insert(words.end(), last.begin(), last.end());
  return words;
}

}  // namespace terrella
