#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/objects.h"

// thread: any, for all of this header
namespace terrella {

/// Moves the points, labels and models of a feature. Its lines and areas stay.
struct ObjectMove {
  ObjectId id = ObjectId::none;
  Geodetic place = {};
  std::optional<Angle> heading = {};  ///< heading of its models and icons from now on
};

/// Changes how a feature looks. Values that are not set stay as they are. Nothing is tessellated, except an area or
/// line that had been without colour.
struct ObjectChange {
  ObjectId id = ObjectId::none;
  std::optional<bool> visible = {};       ///< false: neither drawn nor picked
  std::optional<bool> selected = {};      ///< true: drawn in the selection's colour (ObjectEdits), with its own alpha
  std::optional<ObjectColor> color = {};  ///< colour of points (tint of icons), lines, labels and strokes
  std::optional<ObjectColor> fill = {};   ///< fill colour of areas
  std::optional<float> size_px = {};      ///< size of markers, width of lines and strokes; positive
  std::optional<Angle> heading = {};      ///< heading of models and icons
};

/// Replaces the text of a feature's labels.
struct ObjectText {
  ObjectId id = ObjectId::none;
  std::string text = {};
};

/// Edits of one object layer, made together in this order. The cost depends on the edited objects, not on the size of
/// the layer or the globe.
struct ObjectEdits {
  std::vector<ObjectId> remove = {};
  ObjectScene add = {};  ///< objects to add; an id that is in the layer gets further parts
  std::vector<ObjectMove> moves = {};
  std::vector<ObjectChange> changes = {};
  std::vector<ObjectText> texts = {};
  std::optional<ObjectColor> selected_color = {};  ///< new colour of the layer's selected objects; its alpha is unused
};

/// Colour of selected objects until an edit sets another.
inline constexpr ObjectColor kSelectedColor{255, 220, 40};

}  // namespace terrella
