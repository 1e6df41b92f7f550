#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "objects/layer_objects.h"

// The arrow heads of a layer's lines. An arrow is a point with an icon, which is neither picked nor moved by itself.
namespace terrella {
namespace {

constexpr double kArrowWidth = 0.8;  // width over length
/// The tip is this many widths of the line beyond its end, so that the head covers the end.
constexpr float kTip = 1.5F;

/// A white triangle whose tip is in the middle of the upper edge.
std::shared_ptr<const IconImage> arrow_image() {
  constexpr int kSide_px = 64;
  auto image = std::make_shared<IconImage>(IconImage{kSide_px, kSide_px, {}});
  image->rgba.assign(4U * kSide_px * kSide_px, 255);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      const double inside_px = 0.5 * kArrowWidth * (y + 0.5) - std::abs(x + 0.5 - 0.5 * kSide_px);
      image->rgba[4U * static_cast<std::size_t>(y * kSide_px + x) + 3] =
          static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(0.5 + inside_px, 0.0, 1.0)));
    }
  }
  return image;
}

/// The direction from one place to another at its start, clockwise from north.
Angle bearing(const Geodetic& from, const Geodetic& to) {
  const double east = (to.lon - from.lon).rad();
  return Angle::radians(std::atan2(std::sin(east) * std::cos(to.lat.rad()),
                                   std::cos(from.lat.rad()) * std::sin(to.lat.rad()) -
                                       std::sin(from.lat.rad()) * std::cos(to.lat.rad()) * std::cos(east)));
}

bool is_same(const Geodetic& a, const Geodetic& b) { return a.lat == b.lat && a.lon == b.lon; }

/// Sets the size of an arrow for the width of its line.
void set_width(PointObject& arrow, float width_px) {
  arrow.size_px = 5.0F * width_px + 4.0F;
  arrow.icon.anchor = {0.5F, kTip * width_px / arrow.size_px};
}

}  // namespace

void LayerObjects::add_arrows(std::uint32_t line) {
  static const std::shared_ptr<const IconImage> kImage = arrow_image();
  for (const LineEnd end : {LineEnd::start, LineEnd::end}) {
    const LineObject& object = *lines_[line].object;
    if (!(end == LineEnd::start ? object.arrow_at_start : object.arrow_at_end)) continue;
    KeptPoint arrow;
    arrow.arrow = end;
    arrow.object = {.icon = {.image = kImage, .from_north = true, .tint = object.color},
                    .through_surface = object.through_surface,
                    .of = object.of,
                    .heights = object.heights};
    set_width(arrow.object, object.width_px);
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(std::move(arrow));
    set_arrow(index, object.places);
    link({ObjectKind::point, index}, object.of.id);
  }
}

// A line without a direction has no arrows.
void LayerObjects::set_arrow(std::uint32_t index, std::span<const Geodetic> places) {
  KeptPoint& arrow = points_[index];
  arrow.has_direction = false;
  if (!places.empty()) {
    const bool at_start = arrow.arrow == LineEnd::start;
    const Geodetic& tip = at_start ? places.front() : places.back();
    const auto other = [&](const Geodetic& place) { return !is_same(place, tip); };
    const auto first = std::ranges::find_if(places, other);
    const auto last = std::find_if(places.rbegin(), places.rend(), other);
    arrow.has_direction = first != places.end();
    if (arrow.has_direction) {
      const Geodetic& from = at_start ? *first : *last;
      arrow.object.icon.heading = bearing(tip, from) + Angle::radians(std::numbers::pi);
    }
    arrow.object.place = tip;
    arrow.place_m = place_of(tip, arrow.object.heights);
  }
  draw(arrow);
}

void LayerObjects::change_arrow(KeptPoint& arrow, const ObjectChange& change) {
  arrow.object.icon.tint = change.color.value_or(arrow.object.icon.tint);
  if (change.size_px) set_width(arrow.object, *change.size_px);
}

void LayerObjects::find_arrows(ObjectId id, KeptTrack& track) {
  track.arrows.clear();
  each_part(id, [&](PartRef part) {
    if (part.kind == ObjectKind::point && points_[part.index].arrow != LineEnd::none) {
      track.arrows.push_back(part.index);
    }
  });
}

}  // namespace terrella
