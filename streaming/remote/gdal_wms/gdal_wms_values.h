#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace terrella {

/// Child element by its name in letters of any case, as GDAL finds it. thread: any
[[nodiscard]] pugi::xml_node any_child(const pugi::xml_node& node, std::string_view name);

/// Values of an XML element: its child elements and its attributes, by names in letters of any case. Keeps the first
/// fault. A missing element has no values. thread: one
class XmlValues {
 public:
  explicit XmlValues(const pugi::xml_node& node) : node_(node) {}

  [[nodiscard]] bool has(std::string_view name) const;  ///< true if there is a value that is not empty
  [[nodiscard]] std::string text(std::string_view name, std::string_view otherwise = {}) const;
  [[nodiscard]] std::optional<double> number(std::string_view name);  ///< none if missing or no number
  [[nodiscard]] int whole(std::string_view name, int otherwise, int least, int most);
  [[nodiscard]] bool flag(std::string_view name, bool otherwise);
  [[nodiscard]] const std::optional<std::string>& fault() const { return fault_; }

 private:
  void refuse(std::string_view name, std::string_view wanted);

  pugi::xml_node node_;
  std::optional<std::string> fault_;
};

}  // namespace terrella
