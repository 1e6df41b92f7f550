#include "streaming/objects/vector/kml_tours.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <string_view>

#include "base/number.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

constexpr double kHighest_m = 1e12;
constexpr double kLongest_s = 1e6;
constexpr std::size_t kMostComplaints = 16;

struct ViewRange {
  const char* name;
  double low, high;
  double otherwise;  ///< value of an element that is not there
};

/// Reads a number among the children of an element.
Result<double> number_of(const pugi::xml_node& parent, const ViewRange& range) {
  const std::string_view text = text_of(parent, range.name);
  if (text.empty()) return range.otherwise;
  const auto number = read_number(text);
  if (number && *number >= range.low && *number <= range.high) return *number;
  return Error{fmt::format("{} {} is not a number in {}...{}", range.name, in_quotes(text), range.low, range.high)};
}

Result<std::optional<UtcTime>> instant_of(const pugi::xml_node& view) {
  const std::string_view when = text_of(child_of(view, "TimeStamp"), "when");
  if (when.empty()) return std::optional<UtcTime>();
  const auto time = parse_utc(when);
  if (!time) return Error{"its TimeStamp: " + time.error().message};
  return std::optional(*time);
}

Result<KmlView> view_of(const pugi::xml_node& node) {
  KmlView view;
  double range_m = 0.0;
  const bool looks_at = local_name(node) == "LookAt";
  struct Field {
    ViewRange range;
    double* to;
  };
  const Field fields[] = {{{"longitude", -360.0, 360.0, 0.0}, &view.lon_deg},
                          {{"latitude", -90.0, 90.0, 0.0}, &view.lat_deg},
                          {{"altitude", -kHighest_m, kHighest_m, 0.0}, &view.height_m},
                          {{"heading", -360.0, 360.0, 0.0}, &view.heading_deg},
                          {{"tilt", 0.0, looks_at ? 90.0 : 180.0, 0.0}, &view.tilt_deg},
                          {{"range", 0.0, kHighest_m, 0.0}, &range_m}};
  for (const Field& field : fields) {
    const auto number = number_of(node, field.range);
    if (!number) return number.error();
    *field.to = *number;
  }
  if (looks_at) {
    view.range_m = range_m;
    const std::string_view mode = text_of(node, "altitudeMode");
    if (mode.empty() || mode.starts_with("clampTo")) view.height_m = 0.0;
  }
  const auto instant = instant_of(node);
  if (!instant) return instant.error();
  view.instant = *instant;
  return view;
}

/// Collects the tours of a document.
class TourWalk : public pugi::xml_tree_walker {
 public:
  bool for_each(pugi::xml_node& node) override {
    if (local_name(node) != "Tour") return true;
    KmlTour tour{.name = std::string(text_of(node, "name")), .views = {}};
    fault_ = read(child_of(node, "Playlist"), tour);
    if (!fault_) {
      fault_ = Error{fmt::format("its tour {}: {}", in_quotes(tour.name), fault_.error().message)};
      return false;
    }
    if (tour.views.empty()) complain(fmt::format("the tour {} has no view", in_quotes(tour.name)));
    if (!tour.views.empty()) found.tours.push_back(std::move(tour));
    return true;
  }

  [[nodiscard]] const Status& fault() const { return fault_; }
  KmlTours found;

 private:
  void complain(std::string what) {
    if (found.complaints.size() == kMostComplaints) return;
    if (std::ranges::find(found.complaints, what) == found.complaints.end())
      found.complaints.push_back(std::move(what));
  }

  Status read(const pugi::xml_node& playlist, KmlTour& tour) {
    double time_s = 0.0;
    for (const pugi::xml_node& step : playlist.children()) {
      const std::string_view kind = local_name(step);
      if (step.type() != pugi::node_element) continue;
      if (++steps_ > kMostTourViews) return Error{fmt::format("it has more than {} steps", kMostTourViews)};
      if (kind != "FlyTo" && kind != "Wait") {
        complain(fmt::format("{} of tours is left out", kind));
        continue;
      }
      const auto duration = number_of(step, {"duration", 0.0, kLongest_s, 0.0});
      if (!duration) return duration.error();
      if (kind == "FlyTo") {
        if (Status taken = fly_to(step, *duration, time_s, tour); !taken) return taken;
      } else if (!tour.views.empty() && time_s + *duration > time_s) {
        time_s += *duration;
        tour.views.push_back({.view = tour.views.back().view, .time_s = time_s});
      }
    }
    return Done{};
  }

  Status fly_to(const pugi::xml_node& step, double duration_s, double& time_s, KmlTour& tour) {
    pugi::xml_node node = child_of(step, "LookAt");
    if (!node) node = child_of(step, "Camera");
    if (!node) {
      complain("FlyTo without a Camera or a LookAt is left out");
      return Done{};
    }
    const auto view = view_of(node);
    if (!view) return Error{fmt::format("view {}: {}", tour.views.size() + 1, view.error().message)};
    if (read_number(text_of(node, "roll")).value_or(0.0) != 0.0) complain("roll of views is left out");
    if (text_of(node, "altitudeMode").starts_with("relativeTo")) {
      complain("heights over the ground or the sea floor count from the ellipsoid");
    }
    const bool first = tour.views.empty();
    const double before_s = time_s;
    if (!first) time_s += duration_s;
    tour.views.push_back({.view = *view, .time_s = time_s, .jumps = !first && time_s == before_s});
    return Done{};
  }

  Status fault_ = Done{};
  std::size_t steps_ = 0;
};

}  // namespace

Result<KmlTours> read_tours(const std::string& document) {
  pugi::xml_document parsed;
  const pugi::xml_parse_result read = parsed.load_buffer(document.data(), document.size());
  if (!read) return Error{fmt::format("it is no XML: {} at byte {}", read.description(), read.offset)};
  TourWalk walk;
  parsed.traverse(walk);
  if (!walk.fault()) return walk.fault().error();
  return std::move(walk.found);
}

}  // namespace terrella
