#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"

// thread: any, for all of this header
namespace terrella {

enum class MarkKind { place, line, area };

/// Look of a drawn mark.
struct MarkLook {
  ObjectColor color{230, 60, 50};     ///< colour of the marker, the line or the outline
  float width_px = 3.0F;              ///< width of the line or the outline at 96 dots per inch, [0, 256]
  ObjectColor fill{230, 60, 50, 90};  ///< fill of an area
  bool operator==(const MarkLook&) const = default;
};

/// A mark that the user drew on the ground.
struct DrawnMark {
  ObjectId id = ObjectId::none;  ///< unique in its drawing
  MarkKind kind = MarkKind::place;
  std::vector<Geodetic> places = {};  ///< vertices, heights unused; the last place of an area does not repeat the first
  std::string name = {};              ///< UTF-8; empty: none
  MarkLook look = {};
  bool operator==(const DrawnMark&) const = default;
};

/// All marks of the user, in the order in which they were drawn, which is that of their ids. A plain value.
struct Drawing {
  std::vector<DrawnMark> marks = {};
  bool operator==(const Drawing&) const = default;

  [[nodiscard]] DrawnMark* find(ObjectId id);
  [[nodiscard]] const DrawnMark* find(ObjectId id) const;
  /// Adds a mark under a new id, and returns the id.
  ObjectId add(DrawnMark mark);
  void remove(ObjectId id);
};

/// The word for a kind: "Place mark", "Line" or "Area".
[[nodiscard]] const char* kind_name(MarkKind kind);
/// Fails if a mark has too few places, or if its edges enclose no area that can be drawn (geo/great_circle.h). The
/// error says what is missing.
[[nodiscard]] Status check_mark(const DrawnMark& mark);
/// The place in the middle of a mark's places.
[[nodiscard]] Geodetic middle_of(const DrawnMark& mark);
/// Turns a mark about the planet's centre, the shortest way that brings `from` to `to`. Angles between the normals of
/// its places stay, also across ±180° and poles.
[[nodiscard]] DrawnMark moved_mark(DrawnMark mark, const Geodetic& from, const Geodetic& to);

/// The states of a drawing between which the user goes back and forth.
class UndoHistory {
 public:
  static constexpr std::size_t kMostSteps = 100;
  static constexpr std::size_t kMostPlaces = 2'000'000;  ///< in all states together, unless two states have more

  explicit UndoHistory(Drawing start = {});

  [[nodiscard]] const Drawing& now() const { return states_[at_]; }
  /// Makes a state the present one, and forgets the states that were undone. No effect if nothing changed.
  void commit(Drawing next);
  [[nodiscard]] bool can_undo() const { return at_ > 0; }
  [[nodiscard]] bool can_redo() const { return at_ + 1 < states_.size(); }
  void undo();  ///< no effect without an earlier state
  void redo();  ///< no effect without a later state

 private:
  std::vector<Drawing> states_;  ///< never empty
  std::size_t at_ = 0;
};

}  // namespace terrella
