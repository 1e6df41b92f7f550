#include "apps/viewer/balloon/object_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "base/code_points.h"
#include "base/number.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::size_t kMostFields = 100, kMostFieldBytes = 1000, kMostMarkupBytes = 1 << 16;
constexpr std::array<std::string_view, 7> kTitles = {"name", "title", "Name", "Title", "NAME", "TITLE", "label"};
constexpr std::array<std::string_view, 14> kBlocks = {"p",  "br", "div", "tr", "li", "table", "ul",
                                                      "ol", "hr", "h1",  "h2", "h3", "h4",    "h5"};

/// Collects the text of a document, with a line for each block.
struct TextOfMarkup : pugi::xml_tree_walker {
  std::string text;
  std::vector<int> blocks;  ///< depths of the blocks that have not ended
  bool has_markup = false;

  void end_line() {
    if (!text.empty() && text.back() != '\n') text += '\n';
  }
  bool for_each(pugi::xml_node& node) override {
    for (; !blocks.empty() && depth() <= blocks.back(); blocks.pop_back()) end_line();
    const std::string_view name = node.name();
    has_markup |= node.type() == pugi::node_element;
    if (name == "td" || name == "th") text += ' ';
    if (std::ranges::find(kBlocks, name) != kBlocks.end()) {
      end_line();
      blocks.push_back(depth());
    }
    text += node.value();
    return true;
  }
};

std::string with_closed_breaks(std::string text) {
  for (const std::string_view open : {"<br>", "<BR>", "<hr>"}) {
    for (auto at = text.find(open); at != text.npos; at = text.find(open, at)) text.replace(at, open.size(), "<br/>");
  }
  return text;
}

/// The text without the markup of HTML; unchanged if the markup is not well formed.
std::string without_markup(const std::string& text) {
  if (text.size() > kMostMarkupBytes || text.find('<') == text.npos) return text;
  pugi::xml_document document;
  const auto options = pugi::parse_default | pugi::parse_fragment;
  if (!document.load_string(with_closed_breaks(text).c_str(), options)) return text;
  TextOfMarkup all;
  document.traverse(all);
  return all.has_markup ? all.text : text;
}

/// The first bytes of a long text, in whole letters.
std::string shortened(std::string text) {
  if (text.size() <= kMostFieldBytes) return text;
  std::size_t end = kMostFieldBytes;
  while (end > 0 && is_within_character(text[end])) --end;
  text.resize(end);
  return text + " ...";
}

std::string field_text(const json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return shortened(std::string(trimmed(without_markup(value.get_ref<const std::string&>()))));
  return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

const char* word_of(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::point:
      return "Point";
    case ObjectKind::line:
      return "Line";
    case ObjectKind::polygon:
      return "Area";
    case ObjectKind::mesh:
      return "Model";
    case ObjectKind::label:
      return "Label";
  }
  return "";
}

}  // namespace

ObjectFields object_fields(std::string_view properties) {
  ObjectFields fields;
  const json all = json::parse(properties, nullptr, false);
  if (!all.is_object()) return fields;
  for (const std::string_view name : kTitles) {
    const auto found = all.find(name);
    if (found != all.end() && found->is_primitive() && fields.title.empty()) fields.title = field_text(*found);
  }
  std::size_t more = 0;
  for (const auto& [name, value] : all.items()) {
    std::string text = field_text(value);
    const bool is_title = text == fields.title && std::ranges::find(kTitles, name) != kTitles.end();
    if (text.empty() || is_title) continue;
    if (fields.rows.size() < kMostFields)
      fields.rows.push_back({shortened(name), std::move(text)});
    else
      ++more;
  }
  if (more > 0) fields.rows.push_back({"...", fmt::format("{} more fields", more)});
  return fields;
}

std::string object_field(std::string_view properties, const std::string& name) {
  const json all = json::parse(properties, nullptr, false);
  if (!all.is_object()) return {};
  const auto found = all.find(name);
  return found == all.end() ? std::string() : field_text(*found);
}

std::string object_title(const PickedObject& object, const ObjectFields& fields) {
  return fields.title.empty() ? word_of(object.kind) : fields.title;
}

bool is_link(std::string_view text) {
  const auto begins = [text](std::string_view scheme) {
    return text.size() > scheme.size() && std::ranges::equal(text.substr(0, scheme.size()), scheme, {}, [](char c) {
             return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
           });
  };
  if (!begins("http://") && !begins("https://")) return false;
  return std::ranges::none_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte <= 0x20U || byte == 0x7FU || std::string_view("\"<>\\^`{|}").find(c) != std::string_view::npos;
  });
}

}  // namespace terrella
