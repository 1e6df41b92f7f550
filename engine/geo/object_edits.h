#pragma once

#include <cstddef>
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
  std::optional<bool> visible = {};   ///< false: neither drawn nor picked
  std::optional<bool> filtered = {};  ///< true: hidden as by `visible`, which stays (globe/features/shown_features.h)
  std::optional<bool> selected = {};  ///< true: drawn in the selection's colour (ObjectEdits), with its own alpha
  std::optional<ObjectColor> color = {};  ///< colour of points (tint of icons), lines, labels and strokes
  std::optional<ObjectColor> label = {};  ///< colour of labels, in place of `color`
  std::optional<ObjectColor> fill = {};   ///< fill colour of areas
  std::optional<float> size_px = {};      ///< size of markers, width of lines and strokes; positive
  std::optional<Angle> heading = {};      ///< heading of models and icons
  std::optional<LabelLook> look = {};     ///< look of labels, but their colour
};

/// Lets the line of a feature go on: places come to its end, and go from its start, as for the track of something that
/// moves. Costs what comes and goes, whatever the length of the line. New parts lie over lines that were there before.
/// While fewer than two places are left, nothing is drawn. The feature must have one line.
struct LineGrowth {
  ObjectId id = ObjectId::none;
  std::vector<Geodetic> append = {};
  std::size_t drop_first = 0;  ///< places that go from the start, after the others have come
};

/// Gives the line or the area of a feature another shape. The feature must have one of them. Costs the tessellation of
/// this object; until it is there, the earlier shape is drawn.
struct ObjectShape {
  ObjectId id = ObjectId::none;
  std::vector<std::vector<Geodetic>> ways = {};  ///< the places of a line, or the rings of an area
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
  std::vector<LineGrowth> growths = {};
  std::vector<ObjectShape> shapes = {};
  std::vector<ObjectChange> changes = {};
  std::vector<ObjectText> texts = {};
  std::optional<ObjectColor> selected_color = {};  ///< new colour of the layer's selected objects; its alpha is unused
};

/// Colour of selected objects until an edit sets another.
inline constexpr ObjectColor kSelectedColor{255, 220, 40};

}  // namespace terrella
