#include "apps/viewer/draw/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "geo/ellipsoid.h"
#include "geo/great_circle.h"

namespace terrella {
namespace {

constexpr double kNoLength = 1e-12;  // sum of unit normals that cancel each other, with its rounding

std::size_t fewest_places(MarkKind kind) {
  if (kind == MarkKind::place) return 1;
  return kind == MarkKind::line ? 2 : 3;
}

std::size_t places_in(const Drawing& drawing) {
  std::size_t sum = 0;
  for (const DrawnMark& mark : drawing.marks) sum += mark.places.size();
  return sum;
}

}  // namespace

const DrawnMark* Drawing::find(ObjectId id) const {
  const auto found = std::ranges::lower_bound(marks, id, {}, &DrawnMark::id);
  return found == marks.end() || found->id != id ? nullptr : &*found;
}

DrawnMark* Drawing::find(ObjectId id) { return const_cast<DrawnMark*>(std::as_const(*this).find(id)); }

ObjectId Drawing::add(DrawnMark mark) {
  const std::uint64_t last = marks.empty() ? 0 : static_cast<std::uint64_t>(marks.back().id);
  mark.id = ObjectId{last + 1};
  marks.push_back(std::move(mark));
  return marks.back().id;
}

void Drawing::remove(ObjectId id) {
  std::erase_if(marks, [id](const DrawnMark& mark) { return mark.id == id; });
}

const char* kind_name(MarkKind kind) {
  if (kind == MarkKind::place) return "Place mark";
  return kind == MarkKind::line ? "Line" : "Area";
}

Status check_mark(const DrawnMark& mark) {
  const std::size_t fewest = fewest_places(mark.kind);
  if (mark.places.size() < fewest) {
    return Error{
        fmt::format("{}: {} places are needed, and there are {}", kind_name(mark.kind), fewest, mark.places.size())};
  }
  if (mark.kind != MarkKind::area) return Done{};
  std::vector<MapPoint> ring;
  ring.reserve(mark.places.size() + 1);
  for (const Geodetic& place : mark.places) ring.push_back({place.lon.deg(), place.lat.deg()});
  ring.push_back(ring.front());
  const auto rings = rings_of(ring);
  return rings ? Status(Done{}) : Error{"Area: " + rings.error().message};
}

Geodetic middle_of(const DrawnMark& mark) {
  glm::dvec3 sum(0.0);
  for (const Geodetic& place : mark.places) sum += Ellipsoid::normal(place.lat, place.lon).xyz;
  const double length = glm::length(sum);
  if (length < kNoLength) return mark.places.empty() ? Geodetic{} : mark.places.front();
  return Ellipsoid::lat_lon({sum / length});
}

// Rodrigues' formula. Opposite places have no shortest way, and the mark stays.
DrawnMark moved_mark(DrawnMark mark, const Geodetic& from, const Geodetic& to) {
  const glm::dvec3 start = Ellipsoid::normal(from.lat, from.lon).xyz, end = Ellipsoid::normal(to.lat, to.lon).xyz;
  const glm::dvec3 across = glm::cross(start, end);
  const double sine = glm::length(across), cosine = glm::dot(start, end);
  if (sine == 0.0) return mark;
  const glm::dvec3 axis = across / sine;
  for (Geodetic& place : mark.places) {
    const glm::dvec3 normal = Ellipsoid::normal(place.lat, place.lon).xyz;
    const glm::dvec3 turned =
        cosine * normal + sine * glm::cross(axis, normal) + (1.0 - cosine) * glm::dot(axis, normal) * axis;
    place = Ellipsoid::lat_lon({glm::normalize(turned)});
  }
  return mark;
}

UndoHistory::UndoHistory(Drawing start) { states_.push_back(std::move(start)); }

void UndoHistory::commit(Drawing next) {
  if (next == now()) return;
  states_.resize(at_ + 1);
  states_.push_back(std::move(next));
  std::size_t places = 0;
  for (const Drawing& state : states_) places += places_in(state);
  while (states_.size() > 2 && (states_.size() > kMostSteps + 1 || places > kMostPlaces)) {
    places -= places_in(states_.front());
    states_.erase(states_.begin());
  }
  at_ = states_.size() - 1;
}

void UndoHistory::undo() {
  if (can_undo()) --at_;
}

void UndoHistory::redo() {
  if (can_redo()) ++at_;
}

}  // namespace terrella
