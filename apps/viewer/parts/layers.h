#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "apps/viewer/feature_list/feature_list.h"
#include "apps/viewer/offline/keep_offline.h"
#include "apps/viewer/panels/layer_panel.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/parts/part.h"
#include "apps/viewer/profile/profile_samples.h"
#include "apps/viewer/timeline/timeline.h"
#include "apps/viewer/tools/dropped_files.h"
#include "apps/viewer/tools/value_query.h"
#include "apps/viewer/undo/layer_steps.h"

namespace terrella {

/// Shows, fades, sorts, adds and removes the globe's layers. Owns the rows of the layer panel and the files being
/// opened. thread: main for every call
class Layers : public Panel {
 public:
  /// `rows`, the globe's layers: heights, imagery from bottom to top, objects. `heights`, the globe's heights. `files`,
  /// options for opening files. `switches`, further rows, which only switch something on and off.
  Layers(const ViewerContext& context, std::vector<LayerRow> rows, std::optional<ElevationSource> heights,
         const SourceOptions& files, std::vector<LayerSwitch> switches);

  /// Opens a file or an address in the background and adds it as a layer. A model stands in the middle of the picture.
  void open(SourceOptions said);
  /// Adds the files that are open by now as layers. Call this once per frame. Returns the cuts of their pictures.
  [[nodiscard]] std::vector<std::shared_ptr<GrowingCut>> take_opened();
  /// Files of another body than the globe's that were to be opened, once.
  [[nodiscard]] std::vector<OtherBodyFile> take_other_bodies() { return std::exchange(other_bodies_, {}); }
  /// Opens no further file. Returns those that are not open yet.
  std::vector<SourceOptions> leave_off() { return files_.leave_off(); }

  /// Shows the failures of tiles in their rows, and reports the first of each row. Call this once per frame.
  void watch_tiles(const FrameStats& stats);
  /// Shows the features and clusters of objects as the camera sees them in a picture. Call this before each frame.
  void follow_view(Viewport picture);
  /// Takes back, or makes again, what the user did to looks, order and presence of layers.
  void undo();
  void redo();
  /// Notes changed looks as one step, once no item is held. Call this once per frame, after the panels.
  void note_looks();
  /// True once after a click on the button that opens a file.
  [[nodiscard]] bool take_open_wish() { return std::exchange(open_wish_, false); }

  /// The layer whose list a click has asked for, once.
  [[nodiscard]] std::optional<ListedLayer> take_list_wish() { return std::exchange(list_wish_, {}); }
  /// The layer whose tiles a click has asked to keep, once.
  [[nodiscard]] std::optional<LayerToKeep> take_keep_wish() { return std::exchange(keep_wish_, {}); }
  [[nodiscard]] bool has_objects(LayerId layer) const;

  [[nodiscard]] std::string job() const override { return files_.text(); }
  [[nodiscard]] bool changed() const override;
  bool cancel() override;
  /// The shown layers of numbers and of classes, the highest first.
  [[nodiscard]] std::vector<LegendItem> legend() const;
  /// Draws the legend of the shown layers above the `foot` units at the lower edge. A high window shows the
  /// legend before the panels, which leave it room; a low one shows it after them, where they leave room.
  void draw_legend(float foot, bool before_panels) const;
  /// Gives the shown image layers their sides of a swipe (choose_swipe_sides() of apps/open_scene). False if there are
  /// fewer than two.
  [[nodiscard]] bool choose_swipe_sides();
  /// Writes the layers into a scene, as those of a project.
  void describe(SceneOptions& scene) const;
  /// Name of a layer of objects; nullopt if the layer is hidden or has no row.
  [[nodiscard]] std::optional<std::string> shown_objects(LayerId layer) const;
  /// The shown layers of images that have instants, the highest first.
  [[nodiscard]] std::vector<TimedLayer> timed() const;
  /// Side of the finest texels of the shown images with data at a place, metres along the equator; none without one.
  [[nodiscard]] std::optional<double> finest_texel_m(const Geodetic& place) const;
  /// The highest shown layer of numbers.
  [[nodiscard]] std::optional<ProfileNumbers> shown_numbers() const;
  /// The value that the highest layer of numbers that shows at a place stores there; empty while it is not known.
  /// `x_px`: the place in the picture.
  [[nodiscard]] std::string value_at(const Geodetic& place, double x_px);

 private:
  void draw_open(float foot) override;
  /// The highest shown layer of numbers that a condition holds for; null: none.
  [[nodiscard]] const LayerRow* highest_numbers(const std::function<bool(const LayerRow&)>& is_there) const;
  void take_look(LayerRow& row, const ImageLook& look);
  void take_style(LayerRow& row);
  Status use_heights(const std::optional<ElevationSource>& heights);
  void move(std::size_t row, bool up);
  [[nodiscard]] bool move_row(std::size_t row, bool up);
  void remove(std::size_t row);
  [[nodiscard]] bool remove_row(std::size_t row);
  void add(OpenedFile file);
  /// Returns the part of the planet that the new layer has; nullopt for most of the planet, and after a failure.
  std::optional<GeoRect> add_row(OpenedFile file);
  [[nodiscard]] Status add_tiles(ImageryLayer layer, LayerRow& row);
  [[nodiscard]] Status add_heights(const ElevationSource& heights, LayerRow& row);
  [[nodiscard]] Status add_objects(ObjectFile file, LayerRow& row);
  void insert(LayerRow row);
  void check_fills();

  // Undo, in apps/viewer/undo/layers_undo.cpp.
  [[nodiscard]] static ObjectsOption described_objects(const LayerRow& row);
  [[nodiscard]] std::vector<LayerRow>::iterator row_of(unsigned key);
  void note_looks_now();
  void forget_looks();
  [[nodiscard]] RemoveStep removal_of(const LayerRow& row) const;
  void show_states(const std::vector<LayerState>& states);
  void move_back(const MoveStep& step, bool up);
  [[nodiscard]] Status bring_back(RemoveStep& step);
  [[nodiscard]] Status bring_heights_back(LayerRow row, const std::optional<ElevationSource>& heights);
  [[nodiscard]] Status read_again(LayerRow& row, const std::optional<LayerStyle::Drawn>& style);
  void sort_rows();

  std::vector<LayerRow> rows_;
  std::optional<ElevationSource> heights_;  ///< kept while the heights are hidden
  DroppedFiles files_;
  std::vector<OtherBodyFile> other_bodies_;
  std::vector<LayerSwitch> switches_;
  ValueQuery value_;
  bool open_wish_ = false;
  std::optional<ListedLayer> list_wish_;
  std::optional<LayerToKeep> keep_wish_;
  LayerSteps steps_;
};

}  // namespace terrella
