#include "streaming/remote/gdal_wms/gdal_wms_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "streaming/remote/web_address.h"

namespace terrella {

pugi::xml_node any_child(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node child : node.children()) {
    if (same_letters(child.name(), name)) return child;
  }
  return {};
}

std::string XmlValues::text(std::string_view name, std::string_view otherwise) const {
  std::string_view said = trimmed(any_child(node_, name).child_value());
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (said.empty() && same_letters(attribute.name(), name)) said = trimmed(attribute.value());
  }
  return std::string(said.empty() ? otherwise : said);
}

bool XmlValues::has(std::string_view name) const { return !text(name).empty(); }

void XmlValues::refuse(std::string_view name, std::string_view wanted) {
  if (!fault_) fault_ = fmt::format("its {} is {}; it must be {}", name, in_quotes(text(name)), wanted);
}

std::optional<double> XmlValues::number(std::string_view name) {
  if (!has(name)) return std::nullopt;
  const auto number = read_number(text(name));
  if (!number) refuse(name, "a number");
  return number;
}

int XmlValues::whole(std::string_view name, int otherwise, int least, int most) {
  if (!has(name)) return otherwise;
  const auto number = read_number(text(name));
  if (number && *number == std::floor(*number) && *number >= least && *number <= most) return static_cast<int>(*number);
  refuse(name, fmt::format("a whole number in [{}, {}]", least, most));
  return otherwise;
}

bool XmlValues::flag(std::string_view name, bool otherwise) {
  const std::string said = lower_case(text(name));
  if (said.empty()) return otherwise;
  const auto is_one_of = [&](auto... words) { return ((said == words) || ...); };
  if (is_one_of("true", "yes", "on", "1", "ok")) return true;
  if (!is_one_of("false", "no", "off", "0")) refuse(name, "true or false");
  return false;
}

}  // namespace terrella
