#include "streaming/json_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "streaming/json_text.h"

namespace terrella {

using nlohmann::json;

Result<json> parse_json_object(std::string_view text, std::size_t max_bytes, const std::string& where) {
  if (text.size() > max_bytes) {
    return Error{fmt::format("{}: {} bytes are too many for a description of a tile set, at most {} are read", where,
                             text.size(), max_bytes)};
  }
  Result<json> object = parse_json(text);
  if (!object) return Error{where + ": " + object.error().message};
  if (!object->is_object()) return Error{where + ": must hold one JSON object"};
  return object;
}

const json* JsonFields::find(const char* field, bool required) {
  const auto found = object_.find(field);
  if (found != object_.end() && !found->is_null()) return &*found;
  if (required) fail<int>(field, "is missing");
  return nullptr;
}

bool JsonFields::has(const char* field) const {
  const auto found = object_.find(field);
  return found != object_.end() && !found->is_null();
}

std::string JsonFields::text(const char* field) {
  const json* value = find(field, false);
  if (value == nullptr) return {};
  if (!value->is_string()) return fail<std::string>(field, "must be a text");
  const auto& text = value->get_ref<const std::string&>();
  if (text.size() > kMaxJsonTextBytes) {
    return fail<std::string>(field, fmt::format("is longer than {} bytes", kMaxJsonTextBytes));
  }
  return text;
}

int JsonFields::integer(const char* field, std::optional<int> otherwise) {
  const json* value = find(field, !otherwise);
  if (value == nullptr) return otherwise.value_or(0);
  const bool small = value->is_number_integer() && std::abs(value->get<double>()) < 1e9;
  return small ? value->get<int>() : fail<int>(field, "must be a whole number");
}

double JsonFields::number(const char* field) {
  const json* value = find(field, true);
  if (value == nullptr) return 0.0;
  return value->is_number() ? value->get<double>() : fail<double>(field, "must be a number");
}

int JsonFields::choice(const char* field, std::span<const char* const> words, std::optional<int> otherwise) {
  const json* value = find(field, !otherwise);
  if (value == nullptr) return otherwise.value_or(0);
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (*value == words[i]) return static_cast<int>(i);
    list += fmt::format("{}\"{}\"", i == 0 ? "" : " or ", words[i]);
  }
  return fail<int>(field, "must be " + list);
}

int JsonFields::choice(const char* field, const char* first, const char* second, std::optional<int> otherwise) {
  return choice(field, std::array{first, second}, otherwise);
}

bool JsonFields::flag(const char* field, bool otherwise) {
  const auto found = object_.find(field);
  if (found == object_.end()) return otherwise;
  return found->is_boolean() ? found->get<bool>() : fail<bool>(field, "takes true or false");
}

GeoRect JsonFields::bounds(const char* field) {
  const json* value = find(field, false);
  if (value == nullptr) return {};
  if (!value->is_array() || value->size() != 4) return fail<GeoRect>(field, "must be [west, south, east, north]");
  for (const json& side : *value) {
    if (!side.is_number()) return fail<GeoRect>(field, "must hold four numbers, in degrees");
  }
  const auto side = [&](std::size_t i) { return Angle::degrees((*value)[i].get<double>()); };
  return {.west = side(0), .south = side(1), .east = side(2), .north = side(3)};
}

std::vector<std::string> JsonFields::texts(const char* field) {
  const json* value = find(field, false);
  if (value == nullptr) return {};
  if (!value->is_array()) return fail<std::vector<std::string>>(field, "must be a list of texts");
  std::vector<std::string> texts;
  for (const json& text : *value) {
    if (!text.is_string()) return fail<std::vector<std::string>>(field, "must be a list of texts");
    texts.push_back(text.get<std::string>());
  }
  return texts;
}

void JsonFields::refuse_others(std::span<const char* const> known) {
  for (const auto& [field, value] : object_.items()) {
    if (std::ranges::none_of(known, [&name = field](const char* one) { return name == one; })) {
      fail<int>(field.substr(0, 64).c_str(), "is not known; see the list in streaming/remote/README.md");
    }
  }
}

}  // namespace terrella
