#include <algorithm>
#include <utility>

#include "geo/split_position.h"
#include "objects/layer_objects.h"
#include "objects/object_shapes.h"

// Lines of a layer that grow, and objects that get another shape.
namespace terrella {
namespace {

/// Places of a part of a line that grows. Fewer cost more parts; more cost more for each place that comes.
constexpr std::size_t kPartPlaces = 16;

/// A line without arrows that looks like another.
LineObject alike(const LineObject& line, std::vector<Geodetic> places) {
  return {.places = std::move(places),
          .width_px = line.width_px,
          .color = line.color,
          .through_surface = line.through_surface,
          .of = line.of,
          .heights = line.heights,
          .dashes = line.dashes,
          .casing_px = line.casing_px,
          .casing = line.casing};
}

Angle total_length(const std::vector<std::vector<Geodetic>>& ways) {
  Angle length{};
  for (const auto& way : ways) length = length + length_of(way);
  return length;
}

}  // namespace

// A feature whose line grows keeps other lines that an edit adds to it apart.
PartRef LayerObjects::only_part(ObjectId id) {
  PartRef only;
  std::size_t count = 0;
  each_part(id, [&](PartRef part) {
    if (part.kind != ObjectKind::line && part.kind != ObjectKind::polygon) return;
    only = part;
    ++count;
  });
  return count == 1 ? only : PartRef{};
}

KeptTrack* LayerObjects::track_of(ObjectId id) {
  const auto found = tracks_.find(static_cast<std::uint64_t>(id));
  if (found != tracks_.end()) return &found->second;
  const PartRef line = only_part(id);
  if (!line || line.kind != ObjectKind::line) return nullptr;
  lines_[line.index].part.is_part = true;
  KeptTrack& track = tracks_[static_cast<std::uint64_t>(id)];
  track.parts.push_back(line.index);
  find_arrows(id, track);
  return &track;
}

// Workers may read the object that they have.
std::vector<Geodetic>& LayerObjects::own_places(KeptLine& line) {
  if (line.object.use_count() > 1) line.object = std::make_shared<LineObject>(*line.object);
  return line.object->places;
}

std::uint32_t LayerObjects::add_track_part(std::uint32_t like, std::vector<Geodetic> places) {
  KeptLine part;
  part.object = std::make_shared<LineObject>(alike(*lines_[like].object, std::move(places)));
  part.number = lines_[like].number;
  part.visible = lines_[like].visible;
  part.filtered = lines_[like].filtered;
  part.selected = lines_[like].selected;
  part.part.is_part = true;
  const auto index = static_cast<std::uint32_t>(lines_.size());
  lines_.push_back(std::move(part));
  link({ObjectKind::line, index}, lines_[index].object->of.id);
  note_grown(index);
  return index;
}

void LayerObjects::note_grown(std::uint32_t index) {
  KeptLine& line = lines_[index];
  line.picked.reset();
  if (!std::exchange(line.grown, true)) grown_.push_back(index);
  if (index_ && !std::exchange(line.unindexed, true)) unindexed_.push_back(index);
}

void LayerObjects::append(KeptTrack& track, const Geodetic& place) {
  const std::uint32_t last = track.parts.back();
  if (!lines_[last].object->places.empty()) {
    length_ = length_ + length_of({lines_[last].object->places.back(), place});
  }
  if (lines_[last].object->places.size() < kPartPlaces) {
    own_places(lines_[last]).push_back(place);
    return note_grown(last);
  }
  const std::uint32_t next = add_track_part(last, {lines_[last].object->places.back(), place});
  KeptLine& before = lines_[last];
  const std::vector<Geodetic>& places = before.object->places;
  before.part.after = place;
  lines_[next].part.before = places[places.size() - 2];
  if (before.object->dashes.off_px > 0.0F) {
    lines_[next].part.from_rad = before.part.from_rad + length_of(places).rad();
  }
  track.parts.push_back(next);
  join(before);
}

// Cuts a long part into short ones, so that its start can go.
void LayerObjects::divide_first(KeptTrack& track) {
  const std::uint32_t whole = track.parts.front();
  const std::vector<Geodetic> places = lines_[whole].object->places;
  const LinePart ends = lines_[whole].part;
  const bool has_gaps = lines_[whole].object->dashes.off_px > 0.0F;
  track.parts.pop_front();
  std::deque<std::uint32_t> parts;
  double from_rad = ends.from_rad;
  for (std::size_t first = 0; first + 1 < places.size(); first += kPartPlaces - 1) {
    const std::size_t end = std::min(first + kPartPlaces, places.size());
    std::vector<Geodetic> some(places.begin() + static_cast<std::ptrdiff_t>(first),
                               places.begin() + static_cast<std::ptrdiff_t>(end));
    const double length_rad = has_gaps ? length_of(some).rad() : 0.0;
    parts.push_back(add_track_part(whole, std::move(some)));
    LinePart& part = lines_[parts.back()].part;
    part.before = first > 0 ? std::optional(places[first - 1]) : ends.before;
    part.after = end < places.size() ? std::optional(places[end]) : ends.after;
    part.from_rad = from_rad;
    from_rad += length_rad;
  }
  track.parts.insert(track.parts.begin(), parts.begin(), parts.end());
  take_away({ObjectKind::line, whole});
}

void LayerObjects::drop_first(KeptTrack& track, std::size_t count) {
  while (count > 0) {
    const std::uint32_t index = track.parts.front();
    if (lines_[index].object->places.size() > kPartPlaces) {
      divide_first(track);
      continue;
    }
    const bool is_last = track.parts.size() == 1;
    std::vector<Geodetic>& places = own_places(lines_[index]);
    const std::size_t shared = is_last ? 0 : 1;  // the last place of a part is the first of the next one
    const std::size_t gone = std::min(count, places.size() - shared);
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(std::min(gone + 1, places.size()));
    const Angle length = length_of({places.begin(), end});
    length_ = length_ - length;
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(gone));
    count -= gone;
    LinePart* part = &lines_[index].part;
    if (!is_last && places.size() == shared) {
      const double from_rad = part->from_rad + length.rad();
      take_away({ObjectKind::line, index});
      track.parts.pop_front();
      part = &lines_[track.parts.front()].part;
      part->from_rad = from_rad;
    } else {
      part->from_rad += length.rad();
      if (is_last) count = 0;
    }
    part->before.reset();
    note_grown(track.parts.front());
  }
}

bool LayerObjects::grow(const LineGrowth& growth) {
  KeptTrack* track = track_of(growth.id);
  if (track == nullptr) return false;
  for (const Geodetic& place : growth.append) append(*track, place);
  drop_first(*track, growth.drop_first);
  for (const std::uint32_t arrow : track->arrows) {
    const bool at_start = points_[arrow].arrow == LineEnd::start;
    set_arrow(arrow, lines_[at_start ? track->parts.front() : track->parts.back()].object->places);
  }
  return true;
}

// The neighbours of a part's ends make its joints.
void LayerObjects::join(KeptLine& line) {
  for (const auto& [lines, slot] : {std::pair(&batches_.casings, line.casing), std::pair(&batches_.lines, line.slot)}) {
    if (slot.count < line.part.vertices || line.part.vertices == 0) continue;
    const std::span<LineVertex> vertices = lines->change(slot);
    const auto set = [&](LineVertex& vertex, const std::optional<Geodetic>& place) {
      if (!place) return;
      const SplitPosition p = split_position(place_of(*place, line.object->heights));
      vertex.high_m = p.high;
      vertex.low_m = p.low;
    };
    set(vertices.front(), line.part.before);
    set(vertices[line.part.vertices - 1], line.part.after);
  }
}

// A line that has grown becomes one part again.
bool LayerObjects::reshape(const ObjectShape& shape) {
  if (const auto track = tracks_.find(static_cast<std::uint64_t>(shape.id)); track != tracks_.end()) {
    while (track->second.parts.size() > 1) {
      take_away({ObjectKind::line, track->second.parts.back()});
      track->second.parts.pop_back();
    }
    lines_[track->second.parts.front()].part = {};
    tracks_.erase(track);
  }
  const PartRef part = only_part(shape.id);
  if (!part) return false;
  if (part.kind == ObjectKind::line) {
    if (shape.ways.size() != 1) return false;
    KeptLine& line = lines_[part.index];
    length_ = length_ - length_of(line.object->places) + total_length(shape.ways);
    LineObject other = alike(*line.object, shape.ways.front());
    line.object = std::make_shared<LineObject>(std::move(other));
    line.picked.reset();
    line.asked = false;
    ask_for(part.index, line);
    each_part(shape.id, [&](PartRef arrow) {
      if (arrow.kind == ObjectKind::point && points_[arrow.index].arrow != LineEnd::none) {
        set_arrow(arrow.index, shape.ways.front());
      }
    });
  } else {
    KeptArea& area = areas_[part.index];
    length_ = length_ - total_length(area.object->rings) + total_length(shape.ways);
    auto other = std::make_shared<PolygonObject>(*area.object);
    other->rings = shape.ways;
    area.object = std::move(other);
    area.picked.reset();
    area.asked_fill = area.asked_outline = false;
    ask_for(part.index, area);
  }
  if (index_) index_part(part);
  return true;
}

// The parts of lines that grow get other indices.
void LayerObjects::forget_removed_lines() {
  std::vector<std::uint32_t> now(lines_.size());
  std::uint32_t left = 0;
  for (std::size_t k = 0; k < lines_.size(); ++k) now[k] = lines_[k].removed ? left : left++;
  for (auto& [id, track] : tracks_) {
    for (std::uint32_t& part : track.parts) part = now[part];
  }
  std::erase_if(lines_, [](const KeptLine& line) { return line.removed; });
  unindexed_.clear();
  for (KeptLine& line : lines_) line.unindexed = false;
}

}  // namespace terrella
