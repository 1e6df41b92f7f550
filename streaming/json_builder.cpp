#include "streaming/json_builder.h"

namespace terrella {

using nlohmann::json;

bool JsonBuilder::count() {
  if (open_.size() > limits_.depth) problem_ = Problem::too_deep;
  if (++pieces_ > limits_.pieces) problem_ = Problem::too_much;
  return problem_ == Problem::none;
}

// A container does not move while it is open, because its parent grows only after it is closed.
json* JsonBuilder::place(json value) {
  if (open_.empty()) {
    document_ = std::move(value);
    return &document_;
  }
  json& in = *open_.back();
  if (in.is_array()) {
    in.push_back(std::move(value));
    return &in.back();
  }
  json& member = in[key_];
  member = std::move(value);
  return &member;
}

bool JsonBuilder::add(json value) { return count() && complete(*place(std::move(value))); }

bool JsonBuilder::open(json container) {
  if (!count()) return false;
  open_.push_back(place(std::move(container)));
  keys_.push_back(key_);
  return true;
}

bool JsonBuilder::close() {
  json& container = *open_.back();
  open_.pop_back();
  key_ = std::move(keys_.back());
  keys_.pop_back();
  return count() && complete(container);
}

bool JsonBuilder::complete(json& value) {
  constexpr std::size_t kDeepestAsked = 2;
  if (!keep_ || open_.size() > kDeepestAsked || keep_(open_.size(), member_, value)) return true;
  pieces_ = 0;
  if (open_.empty()) {
    document_ = nullptr;
  } else if (json& in = *open_.back(); in.is_array()) {
    in.erase(in.size() - 1);
  } else {
    in.erase(key_);
  }
  return true;
}

bool JsonBuilder::key(string_t& name) {
  if (open_.size() == 1) member_ = name;
  key_ = std::move(name);
  return count();
}

bool JsonBuilder::parse_error(std::size_t byte, const std::string&, const json::exception& error) {
  constexpr int kNumberOutOfRange = 406;
  problem_ = error.id == kNumberOutOfRange ? Problem::number : Problem::syntax;
  byte_ = byte;
  return false;
}

}  // namespace terrella
