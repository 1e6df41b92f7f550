#include "streaming/remote/wmts/xml_names.h"
#include "base/number.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace terrella {
namespace {

constexpr std::string_view kWhite = " \t\r\n";

template <class T>
std::optional<T> to_value(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node child : node.children()) {
    if (local_name(child.name()) == name) return child;
  }
  return {};
}

std::vector<pugi::xml_node> children_of(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node child : node.children()) {
    if (local_name(child.name()) == name) found.push_back(child);
  }
  return found;
}

std::string_view text_of(const pugi::xml_node& node, std::string_view child) {
  return trimmed(child_of(node, child).child_value());
}

std::string_view attribute_of(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    if (local_name(attribute.name()) == name) return attribute.value();
  }
  return {};
}

std::optional<double> to_number(std::string_view text) {
  const auto number = to_value<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::int64_t> to_integer(std::string_view text) { return to_value<std::int64_t>(text); }

std::optional<std::pair<double, double>> to_pair(std::string_view text) {
  text = trimmed(text);
  const std::size_t gap = text.find_first_of(kWhite);
  if (gap == std::string_view::npos) return std::nullopt;
  const auto first = to_number(text.substr(0, gap));
  const auto second = to_number(text.substr(gap));
  return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

}  // namespace terrella
