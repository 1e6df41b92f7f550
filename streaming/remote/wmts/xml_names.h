#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

namespace terrella {

/// Finds elements by their names without prefix, because writers choose the prefix of a namespace. thread: any
[[nodiscard]] std::string_view local_name(std::string_view name);
[[nodiscard]] pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name);
[[nodiscard]] std::vector<pugi::xml_node> children_of(const pugi::xml_node& node, std::string_view name);
/// Trimmed text of a child; empty if there is no such child.
[[nodiscard]] std::string_view text_of(const pugi::xml_node& node, std::string_view child);
[[nodiscard]] std::string_view attribute_of(const pugi::xml_node& node, std::string_view name);

/// A finite number that fills the text; nothing otherwise.
[[nodiscard]] std::optional<double> to_number(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> to_integer(std::string_view text);
/// Two numbers separated by white space.
[[nodiscard]] std::optional<std::pair<double, double>> to_pair(std::string_view text);

}  // namespace terrella
