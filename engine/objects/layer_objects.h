#pragma once

#include <functional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geo/object_edits.h"
#include "objects/cut_objects.h"
#include "objects/ground/on_ground.h"
#include "objects/kept_objects.h"
#include "objects/layer_batches.h"
#include "objects/object_index.h"
#include "view/ground.h"

namespace terrella {

/// The objects of one layer, kept in the layout for the GPU. The cost of an edit depends on the edited objects alone.
/// Jobs, which any thread may do, cut lines and areas. These are drawn once place() has their cuts. thread: any, but
/// one call at a time
class LayerObjects {
 public:
  LayerObjects(ObjectScene scene, const Ground& ground, double opacity, ObjectColor selected_color);

  void add(ObjectScene scene);
  /// Removes all parts of a feature; false if there is none.
  bool remove(ObjectId id);
  bool move(const ObjectMove& move);
  bool change(const ObjectChange& change);
  bool set_text(const ObjectText& text);
  /// False if the feature has not one line. ask_for_grown() puts what has grown into the next job.
  bool grow(const LineGrowth& growth);
  /// False if the feature has not one line or area.
  bool reshape(const ObjectShape& shape);
  void set_selected_color(ObjectColor color);
  /// Sets the factor of alpha of all objects.
  void set_opacity(double opacity);

  /// Returns the lines and areas to be cut that no job had before.
  [[nodiscard]] CutJob take_job();
  void place(CutObjects cut);
  void ask_for_grown();

  /// True if the height of an object depends on the ground's.
  [[nodiscard]] bool stands_on_ground() const { return on_ground_ > 0; }
  /// Takes the ground, and moves the objects that stand on it to its height, if the ground `has_changed` under them.
  /// Lines and areas over the ground are to be cut anew. Costs a little for each object that stands on the ground.
  /// thread: as Ground's
  void follow(const Ground& ground, const std::function<bool(const Geodetic&)>& has_changed);

  [[nodiscard]] bool empty() const { return live_ == 0; }
  /// Areas that are drawn without their fill.
  [[nodiscard]] std::vector<MissingFill> missing_fills() const;
  /// Frees the memory of removed objects if it is large, and sorts spheres. Call it before drawing.
  void tidy();
  [[nodiscard]] LayerBatches& batches() { return batches_; }
  [[nodiscard]] const LayerBatches& batches() const { return batches_; }

  /// Data of a feature; null if the layer does not have the feature, or it has no data.
  [[nodiscard]] const ObjectFeature* feature(ObjectId id) const;

  [[nodiscard]] bool has(ObjectPart part) const;  ///< true if cut objects have this part to draw

  [[nodiscard]] std::uint64_t serial() const { return serial_; }  ///< changes when the indices of objects change

  // Labels.
  [[nodiscard]] const std::vector<KeptLabel>& labels() const { return labels_; }
  /// Indices of the labels, the highest priority first.
  [[nodiscard]] const std::vector<std::uint32_t>& label_order() const { return label_order_; }
  [[nodiscard]] std::uint64_t label_version() const { return label_version_; }  ///< counts changes of label_order()

  [[nodiscard]] double opacity() const { return opacity_; }
  /// The colour in which an object is drawn; alpha 0: it is not drawn.
  [[nodiscard]] ObjectColor drawn(ObjectColor color, const Kept& kept) const;

  /// Picks as pick_object() does, by a spatial index that the first pick makes. `labels` are indices of the labels that
  /// the pixel shows. thread: as Ground's
  [[nodiscard]] std::optional<PickedObject> pick(const View& view, const Ground& ground, glm::dvec2 pixel_px,
                                                 const PickOptions& options, std::span<const std::uint32_t> labels);

 private:
  // layer_objects.cpp
  /// Calls use(part) for the parts of a feature; false if there is none. Forgets removed parts.
  template <class Use>
  bool each_part(ObjectId id, Use use) {
    const auto found = parts_.find(static_cast<std::uint64_t>(id));
    if (found == parts_.end()) return false;
    for (PartRef* at = &found->second; *at;) {
      Kept& object = kept(*at);
      if (object.removed) {
        *at = object.next;
        continue;
      }
      use(*at);
      at = &object.next;
    }
    return true;
  }
  template <class Object, class List>
  std::uint32_t keep(ObjectKind kind, Object object, List& list);
  void add(PointObject point);
  void add(MeshObject mesh);
  void add(LabelObject label);
  void link(PartRef part, ObjectId id);
  [[nodiscard]] Kept& kept(PartRef part) { return const_cast<Kept&>(std::as_const(*this).kept(part)); }
  [[nodiscard]] const Kept& kept(PartRef part) const;
  void take_away(PartRef part);
  void order_labels(std::size_t first);
  void forget_removed();
  // layer_slots.cpp, layer_cuts.cpp and solid/layer_solids.cpp: objects in the batches
  [[nodiscard]] std::size_t bucket_of(bool underground, const ObjectColor& color, bool chosen) const;
  [[nodiscard]] std::size_t bucket_of(const KeptPoint& point) const;
  [[nodiscard]] std::size_t bucket_of(const KeptLine& line) const;
  [[nodiscard]] std::size_t casing_bucket(const KeptLine& line) const;
  [[nodiscard]] std::size_t outline_bucket(const KeptArea& area) const;
  [[nodiscard]] std::size_t fill_bucket(const KeptArea& area) const;
  void drop(PartRef part);
  void draw(KeptPoint& point);
  void draw_icon(KeptPoint& point);
  void draw(KeptLine& line);
  void draw(KeptArea& area);
  void draw(KeptMesh& mesh);
  void draw_solid(KeptArea& area);
  /// Returns an area's triangles as indices of its own vertices.
  [[nodiscard]] static std::vector<std::uint32_t> own_triangles(const LayerBatches& batches, const KeptArea& area);
  void put_fill(KeptArea& area, std::span<const FillVertex> fill, std::vector<std::uint32_t> triangles);
  void color_line(SlotBatch<LineVertex>& lines, Slot& slot, std::size_t bucket, const ObjectColor& color,
                  float width_px);
  void place(LineCut& cut);
  void place(AreaCut& cut);
  void ask_for(std::uint32_t index, KeptLine& line);
  void ask_for(std::uint32_t index, KeptArea& area);
  void place_all_again();
  void sort_spheres();
  [[nodiscard]] DotInstance dot(const KeptPoint& point) const;
  [[nodiscard]] IconInstance icon(const KeptPoint& point) const;
  [[nodiscard]] MeshStand stand(const KeptMesh& mesh) const;
  // layer_ground.cpp: objects on the ground
  void cut_again_on_other_ground();
  void put_on_ground(KeptOnGround& kept, GroundObject object);
  static void put(SlotBatch<LineVertex>& lines, Slot& slot, std::size_t bucket, std::span<const LineVertex> vertices);
  [[nodiscard]] glm::dvec3 place_of(const Geodetic& place, HeightMode mode) const;
  /// Shares the object if its heights do not depend on the ground.
  template <class Shape>
  [[nodiscard]] std::shared_ptr<const Shape> as_cut(const std::shared_ptr<Shape>& shape) const {
    if (shape->heights == HeightMode::absolute) return shape;
    return std::make_shared<Shape>(cut_shape(*shape, ground_));
  }
  [[nodiscard]] HeightMode mode_of(PartRef part) const;
  [[nodiscard]] bool depends_on_ground(PartRef part) const;
  void follow(PartRef part, const std::function<bool(const Geodetic&)>& has_changed);
  // layer_edits.cpp
  void change_part(PartRef part, const ObjectChange& change);
  void draw_again(PartRef part);
  // track/layer_tracks.cpp
  /// The line or the area of a feature; none if it has not exactly one of them.
  [[nodiscard]] PartRef only_part(ObjectId id);
  [[nodiscard]] KeptTrack* track_of(ObjectId id);
  [[nodiscard]] std::uint32_t add_track_part(std::uint32_t like, std::vector<Geodetic> places);
  [[nodiscard]] static std::vector<Geodetic>& own_places(KeptLine& line);
  void append(KeptTrack& track, const Geodetic& place);
  void drop_first(KeptTrack& track, std::size_t count);
  void divide_first(KeptTrack& track);
  void note_grown(std::uint32_t index);
  void join(KeptLine& line);
  void forget_removed_lines();
  // track/layer_arrows.cpp
  void add_arrows(std::uint32_t line);
  void set_arrow(std::uint32_t point, std::span<const Geodetic> places);
  static void change_arrow(KeptPoint& arrow, const ObjectChange& change);
  void find_arrows(ObjectId id, KeptTrack& track);
  // layer_pick.cpp
  void index_all();
  void index_part(PartRef part);
  void take(PartRef part, ObjectPicker& picker);

  std::uint64_t serial_;
  Ellipsoid ellipsoid_;
  double opacity_;
  ObjectColor selected_color_;
  std::vector<KeptPoint> points_;
  std::vector<KeptLine> lines_;
  std::vector<KeptArea> areas_;
  std::vector<KeptMesh> meshes_;
  std::vector<KeptLabel> labels_;
  std::array<std::uint32_t, 5> numbers_{};            ///< per kind: objects that were ever added
  std::unordered_map<std::uint64_t, PartRef> parts_;  ///< first part of each id
  std::size_t live_ = 0, removed_ = 0;
  std::vector<std::uint32_t> label_order_;
  std::uint64_t label_version_ = 0;
  std::array<std::size_t, 2> label_counts_{};  ///< above ground, underground
  LayerBatches batches_;
  std::vector<std::uint32_t> sphere_points_;  ///< per sphere in the groups: index of its point
  Angle length_{};                            ///< length of all lines and outlines together
  std::size_t triangles_ = 0;                 ///< triangles of all fills
  CutJob job_;
  std::unordered_map<std::uint64_t, KeptTrack> tracks_;
  std::vector<std::uint32_t> grown_;      ///< lines that grew and that no job has
  std::vector<std::uint32_t> unindexed_;  ///< lines that grew since the last pick
  std::size_t jobs_out_ = 0;              ///< taken, and not placed
  std::size_t replaced_ = 0;              ///< areas whose earlier cut is still in the batches
  Ground ground_;
  std::size_t on_ground_ = 0;
  std::unique_ptr<ObjectIndex> index_;
  double most_reach_px_ = 0.0;  ///< largest half width of markers and lines
};

}  // namespace terrella
