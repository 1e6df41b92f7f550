#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

namespace terrella {

/// Elements by their names without a prefix: which prefix stands for a namespace is the writer's choice. thread: any
[[nodiscard]] std::string_view local_name(std::string_view name);
[[nodiscard]] pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name);
[[nodiscard]] std::vector<pugi::xml_node> children_of(const pugi::xml_node& node, std::string_view name);
/// The text of a child without white space around it; empty if it is not there.
[[nodiscard]] std::string_view text_of(const pugi::xml_node& node, std::string_view child);
[[nodiscard]] std::string_view attribute_of(const pugi::xml_node& node, std::string_view name);

[[nodiscard]] std::string_view trimmed(std::string_view text);
/// A finite number that fills the text; nothing if it is anything else.
[[nodiscard]] std::optional<double> to_number(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> to_integer(std::string_view text);
/// Two numbers with white space between them.
[[nodiscard]] std::optional<std::pair<double, double>> to_pair(std::string_view text);

}  // namespace terrella
