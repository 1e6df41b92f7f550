#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/viewer/draw/drawing.h"

namespace terrella {

enum class DrawAsk {
  none,
  sketch,  ///< begin a mark of DrawWish::kind
  finish,  ///< end the mark that is being drawn
  cancel,  ///< drop it
  undo,
  redo,
  select,      ///< DrawWish::id
  choose,      ///< DrawWish::place
  change,      ///< DrawWish::changed; may go on while an item is held
  move_place,  ///< the chosen place, to the middle of the view
  move_mark,   ///< the mark, so that its chosen place is in the middle of the view
  insert,      ///< a place after the chosen one, in the middle of the view
  remove_place,
  remove,
  fly,
  save,
  open,
};

/// User's request in the panel. It is about the selected mark unless it says otherwise.
struct DrawWish {
  DrawAsk ask = DrawAsk::none;
  MarkKind kind = MarkKind::place;
  ObjectId id = ObjectId::none;
  std::size_t place = 0;
  std::optional<DrawnMark> changed = {};
};

/// Contents of the panel.
struct DrawPanelState {
  const Drawing& drawing;
  const DrawnMark* selected = nullptr;  ///< null: none
  std::size_t place = 0;                ///< index of its chosen place
  std::optional<MarkKind> sketch = {};  ///< kind of the mark that is being drawn
  std::string sketched = {};            ///< its length and area; may be empty
  bool can_undo = false, can_redo = false;
};

/// Draws the panel at the left edge, between Ui::begin_frame() and Ui::end_frame(). `foot` units at the lower edge stay
/// free. `just_opened` gives the panel the keyboard. `path`: the text in the line for the file. thread: main
[[nodiscard]] DrawWish draw_drawing(const char* title, const DrawPanelState& state, std::string& path, float foot,
                                    bool just_opened);

}  // namespace terrella
