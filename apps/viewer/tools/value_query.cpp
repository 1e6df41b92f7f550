#include "apps/viewer/tools/value_query.h"

#include <fmt/format.h>

#include <chrono>

namespace terrella {

std::string value_text(double value, const std::string& unit) {
  const auto narrow = static_cast<float>(value);
  std::string text = static_cast<double>(narrow) == value ? fmt::format("{}", narrow) : fmt::format("{:.12g}", value);
  if (!unit.empty()) text += " " + unit;
  return text;
}

void ValueQuery::ask(const Globe& globe, LayerId layer, const Geodetic& place) {
  take();
  if (open_.valid()) return;
  if (layer == layer_ && is_of(place)) return;
  answer_.reset();
  layer_ = layer;
  place_ = place;
  open_ = globe.stored_value(layer, place);
}

bool ValueQuery::ready() const {
  return open_.valid() && open_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

bool ValueQuery::take() {
  if (!ready()) return false;
  answer_ = open_.get();
  return true;
}

std::string ValueQuery::text(const Geodetic& place, const std::string& unit) const {
  if (!answer_ || !is_of(place)) return "...";
  if (*answer_) return value_text(**answer_, unit);
  return answer_->error().kind == MissingKind::blank ? "no data" : "";
}

}  // namespace terrella
