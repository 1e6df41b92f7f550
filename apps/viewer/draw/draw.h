#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "apps/viewer/draw/draw_handles.h"
#include "apps/viewer/draw/draw_panel.h"
#include "apps/viewer/draw/drawing.h"
#include "apps/viewer/draw/kept_drawing.h"
#include "apps/viewer/draw/place_path.h"
#include "apps/viewer/input.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// Draws place marks, lines and areas on the ground, and edits them. Owns the marks, the layer that shows them, the
/// file that keeps them between runs, and the panel. thread: main
class Draw : public Panel {
 public:
  explicit Draw(const ViewerContext& context);

  /// Shows the marks that were kept, and those of the scene's project that are not among them. Call this once.
  void restore(const SceneOptions& scene);
  /// The marks as GeoJSON; empty without marks.
  [[nodiscard]] std::string text() const;
  /// True while a mark is being drawn: clicks and Enter add places.
  [[nodiscard]] bool is_sketching() const { return sketch_.has_value(); }
  /// True for the layer of the marks.
  [[nodiscard]] bool owns(LayerId layer) const { return layer_ == layer; }

  // Events of the globe. Pixels of the framebuffer.

  /// Adds a place to the mark that is being drawn, or selects the mark under the pixel. False if the click is for
  /// others.
  bool click(glm::dvec2 at_px);
  /// Ends the mark that is being drawn. False if the click is for others.
  bool right_click();
  /// Adds the place, or ends the mark if its last place is there. No effect unless a mark is being drawn.
  void add(glm::dvec2 at_px);
  void take_back();  ///< removes the last place of the mark that is being drawn
  /// Drags a handle of the selected mark. `begin` returns false if there is no handle.
  bool drag(DragStep step, glm::dvec2 at_px);

  void undo();
  void redo();
  void save();
  /// Makes a mark of measured places, which the panel shows.
  void keep_measured(std::vector<Geodetic> places);
  /// Draws the line to the cursor or the handles, under the panels. `cursor_px`: nullopt beside the globe.
  void draw_over(const View& view, std::optional<glm::dvec2> cursor_px);
  /// Ends and keeps everything. False, with a message, the first time that the marks cannot be kept.
  [[nodiscard]] bool may_quit();
  bool close() override;

 private:
  void draw_open(float foot) override;
  void toggled() override;
  void answer(const DrawWish& wish);
  void answer_place(const DrawWish& wish);
  void begin(MarkKind kind);
  void finish();
  void cancel_sketch();
  void finish_or_cancel();
  void open_file();
  void fly_there() const;
  [[nodiscard]] const Drawing& drawing() const { return live_ ? *live_ : history_.now(); }
  [[nodiscard]] const DrawnMark* selected() const { return drawing().find(selected_); }
  [[nodiscard]] std::optional<Geodetic> middle_place() const;
  void select(ObjectId id);
  /// Shows a changed mark without a step of the history, until commit().
  void change(DrawnMark mark);
  void commit();
  void commit(Drawing next);
  void show();
  void keep();

  UndoHistory history_;
  std::optional<Drawing> live_;  ///< the drawing while a change goes on
  Drawing shown_;                ///< as the layer shows it
  std::optional<LayerId> layer_;
  KeptDrawing kept_;
  Status kept_well_ = Done{};
  bool warned_ = false;  ///< the user knows that the marks cannot be kept
  ObjectId selected_ = ObjectId::none;
  std::size_t place_ = 0;  ///< chosen place of the selected mark
  std::optional<MarkKind> sketch_;
  PlacePath path_{context_};
  MarkLook look_;          ///< look of the next mark
  std::string file_;       ///< the text in the line for the file
  std::string overwrite_;  ///< an existing file that the next save replaces
  struct Held {
    std::optional<std::size_t> place;
    DrawnMark mark;  ///< before the drag
    Geodetic from;
  };
  std::optional<Held> held_;  ///< while a handle is dragged
};

}  // namespace terrella
