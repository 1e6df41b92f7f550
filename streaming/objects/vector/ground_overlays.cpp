#include "streaming/objects/vector/ground_overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "base/number.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurn = 360.0;
constexpr std::size_t kMostDocuments = 20'000;
constexpr int kMostFolders = 64;  // levels of elements whose visibility counts

std::optional<double> number_in(const pugi::xml_node& parent, std::string_view name) {
  return read_number(text_of(parent, name));
}

bool is_place(const CrsPoint& corner) { return std::abs(corner.x) <= 2.0 * kTurn && std::abs(corner.y) <= 90.0; }

/// Corners of a LatLonBox. The error says what is wrong.
Result<std::array<CrsPoint, 4>> corners_of_box(const pugi::xml_node& box) {
  const auto north = number_in(box, "north"), south = number_in(box, "south");
  const auto west = number_in(box, "west"), said_east = number_in(box, "east");
  if (!north || !south || !west || !said_east) return Error{"its LatLonBox needs north, south, east and west"};
  const double east = *said_east < *west ? *said_east + kTurn : *said_east;
  if (!(*north > *south) || !(east > *west) || east - *west > kTurn) {
    return Error{"its LatLonBox has no area, or is wider than 360 degrees"};
  }
  const CrsPoint middle{0.5 * (*west + east), 0.5 * (*south + *north)};
  const double turn = number_in(box, "rotation").value_or(0.0) * kDegree;
  const double squeeze = turn == 0.0 ? 1.0 : std::cos(middle.y * kDegree);
  const double half_x = 0.5 * (east - *west) * squeeze, half_y = 0.5 * (*north - *south);
  const auto corner = [&](double x, double y) {
    return CrsPoint{middle.x + (x * std::cos(turn) - y * std::sin(turn)) / squeeze,
                    middle.y + x * std::sin(turn) + y * std::cos(turn)};
  };
  return std::array{corner(-half_x, -half_y), corner(half_x, -half_y), corner(half_x, half_y), corner(-half_x, half_y)};
}

/// Corners of a gx:LatLonQuad, with longitudes that go on over ±180°.
Result<std::array<CrsPoint, 4>> corners_of_quad(const pugi::xml_node& quad) {
  std::array<CrsPoint, 4> corners{};
  std::istringstream places{std::string(text_of(quad, "coordinates"))};
  std::string place;
  std::size_t count = 0;
  for (; places >> place && count < corners.size(); ++count) {
    const auto parts = split_at_commas(place);
    const auto x = read_number(parts[0]), y = read_number(parts.size() > 1 ? parts[1] : "");
    if (!x || !y) break;
    const double turns = count == 0 ? 0.0 : std::round((*x - corners[0].x) / kTurn);
    corners[count] = {*x - kTurn * turns, *y};
  }
  if (count != corners.size()) return Error{"its gx:LatLonQuad needs four places, \"longitude,latitude\""};
  return corners;
}

/// Collects the overlays and the links of one document.
class OverlayWalk : public pugi::xml_tree_walker {
 public:
  OverlayWalk(std::string document, GroundOverlays& found) : document_(std::move(document)), found_(found) {}

  bool for_each(pugi::xml_node& node) override {
    const std::string_view name = local_name(node);
    if (name == "GroundOverlay") take(node);
    if (name == "NetworkLink") link(node);
    has_places_ |= name == "Placemark";
    return found_.pictures.size() < kMostGroundOverlays;
  }

  [[nodiscard]] const std::vector<std::string>& links() const { return links_; }
  [[nodiscard]] bool has_places() const { return has_places_; }

 private:
  void complain(const pugi::xml_node& overlay, const std::string& what) {
    const std::string name(text_of(overlay, "name"));
    found_.complaints.push_back(fmt::format("GroundOverlay {}: {}", in_quotes(name), what));
  }

  void take(const pugi::xml_node& overlay) {
    const std::string_view reference = text_of(child_of(overlay, "Icon"), "href");
    if (reference.empty()) return complain(overlay, "it names no picture; it is left out");
    if (reference.find("://") != std::string_view::npos) {
      return complain(overlay, fmt::format("its picture {} is on a network; save it beside the file", reference));
    }
    const pugi::xml_node quad = child_of(overlay, "LatLonQuad");
    const auto corners = quad ? corners_of_quad(quad) : corners_of_box(child_of(overlay, "LatLonBox"));
    if (!corners) return complain(overlay, corners.error().message + "; it is left out");
    if (!std::ranges::all_of(*corners, is_place)) return complain(overlay, "its corners are no places; it is left out");
    if (text_of(overlay, "altitudeMode") == "absolute") complain(overlay, "it is drawn on the ground");
    const std::string_view colour = text_of(overlay, "color");
    if (colour.size() == 8 && !colour.starts_with("ff") && !colour.starts_with("FF")) {
      complain(overlay, "it is drawn opaque; set the opacity of its layer");
    }
    found_.pictures.push_back({.picture = KmlFile::resolved(document_, reference),
                               .corners = *corners,
                               .order = number_in(overlay, "drawOrder").value_or(0.0),
                               .shown = is_shown(overlay)});
  }

  void link(const pugi::xml_node& node) {
    const pugi::xml_node link = child_of(node, "Link");
    const std::string_view reference = text_of(link ? link : child_of(node, "Url"), "href");
    if (reference.empty() || !is_shown(node)) return;
    if (reference.find("://") == std::string_view::npos) {
      return links_.push_back(KmlFile::resolved(document_, reference));
    }
    found_.complaints.push_back(fmt::format("its link to {} is not followed", reference));
    found_.all_linked = false;
  }

  static bool is_shown(pugi::xml_node node) {
    for (int depth = 0; node && depth < kMostFolders; ++depth, node = node.parent()) {
      if (text_of(node, "visibility") == "0") return false;
    }
    return true;
  }

  std::string document_;
  GroundOverlays& found_;
  std::vector<std::string> links_;
  bool has_places_ = false;
};

Result<std::vector<std::string>> read_document(const KmlFile& file, const std::string& name, GroundOverlays& found) {
  auto text = file.read(name);
  if (!text) return text.error();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(text->data(), text->size());
  if (!parsed) return Error{fmt::format("{}: broken XML at byte {}: {}", name, parsed.offset, parsed.description())};
  OverlayWalk walk(name, found);
  document.traverse(walk);
  if (walk.has_places() && name != file.document()) found.all_linked = false;
  return walk.links();
}

}  // namespace

Result<GroundOverlays> read_ground_overlays(const KmlFile& file) {
  GroundOverlays found;
  std::deque<std::string> waiting{file.document()};
  std::set<std::string> seen{file.document()};
  while (!waiting.empty() && found.pictures.size() < kMostGroundOverlays) {
    const std::string name = std::move(waiting.front());
    waiting.pop_front();
    const auto links = read_document(file, name, found);
    if (!links && name == file.document())
      return Error{fmt::format("{}: {}", file.path().string(), links.error().message)};
    if (!links) {
      found.complaints.push_back(links.error().message + "; it is left out");
      found.all_linked = false;
      continue;
    }
    for (const std::string& link : *links) {
      if (seen.size() < kMostDocuments && seen.insert(link).second) waiting.push_back(link);
    }
  }
  if (found.pictures.size() == kMostGroundOverlays) {
    found.complaints.push_back(fmt::format("its GroundOverlays after the first {} are left out", kMostGroundOverlays));
  }
  return found;
}

}  // namespace terrella
