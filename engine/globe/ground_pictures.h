#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "geo/camera.h"
#include "globe/ground_painter.h"
#include "render/objects/layer_buffers.h"
#include "render/surface/ground_textures.h"
#include "render/surface/patch_ground.h"
#include "surface/selected_patch.h"

namespace terrella {

/// Lines and areas on the ground in one view. thread: main
struct ViewGround {
  struct Want {
    PatchId id;
    double stretch = 1.0;
    bool urgent = false;  ///< nothing is shown in its place
  };
  GroundFrame frame;
  PatchGround gpu;
  std::vector<Want> wants;    ///< pictures that the last frame needs and that are not there or out of date
  std::uint64_t planned = 0;  ///< number of the last GroundPictures::plan(); 0: none
  double pixels = 0.0;        ///< size of the view
  int coarser = 0;            ///< steps by which pictures are coarser for lack of room
  int left_out = 0;           ///< squares without a picture for lack of room
};

/// A view's patches, for GroundPictures::plan().
struct GroundView {
  const View& view;
  const PatchTree& tree;
  const std::vector<SelectedPatch>& patches;
  bool has_relief = false;
  double clearance_m = 0.0;  ///< least distance of the ground from the eye
  double pixel_scale = 1.0;  ///< pixels of the view for each pixel of a size
};

/// The pictures of what lies on the ground: those that views need, at about a texel a pixel. Workers paint them. Until
/// a picture is there, its earlier state is shown, or finer or coarser pictures of the same ground. Pictures beyond the
/// budget are evicted, the one that was needed longest ago first. thread: main (of the context)
class GroundPictures {
 public:
  /// Longer patches than this would need too many pictures.
  static constexpr double kMostPatch_px = 32.0 * GroundPicture::kInner_px;

  GroundPictures(std::size_t budget_bytes, std::shared_ptr<ArrivalBell> bell)
      : textures_(budget_bytes), painter_(std::move(bell)) {}

  /// Sets the budget of textures. Pictures that need more are painted again.
  void set_budget(std::size_t bytes);
  /// Takes the layers that are drawn, the lowest first, and their changes. Returns true if anything has changed.
  bool follow(const std::vector<DrawnLayer>& layers);
  /// True if nothing lies on the ground.
  [[nodiscard]] bool empty() const { return layers_.empty(); }
  /// Uploads the pictures that workers have painted. Returns their number.
  std::size_t take_painted();
  [[nodiscard]] bool has_news() const { return painter_.has_news(); }
  /// Decides what a frame of a view shows.
  void plan(const GroundView& view, ViewGround& out);
  /// Lets workers paint what views want. Views that have not been planned for long do not count.
  void ask(const std::vector<const ViewGround*>& views);
  [[nodiscard]] std::size_t bytes() const { return textures_.bytes(); }
  [[nodiscard]] bool memory_refused() const { return textures_.memory_refused(); }

 private:
  struct Entry {
    GroundSlots slots;
    bool made = false;
    float reach_px = 0.0F;
    double stretch = 0.0;
    std::uint64_t revision = 0, changed = 0;  ///< content; last change under it
    std::uint64_t needed = 0, shown = 0;      ///< last plan that needs it; that shows it, perhaps in place of another
    [[nodiscard]] bool serves(double least_stretch) const {
      return made && changed <= revision && stretch >= least_stretch;
    }
  };
  using Boxes = std::array<FaceBox, kCubeFaces>;
  struct Layer {
    std::uint64_t serial = 0;
    Boxes boxes;  ///< around all its objects
    const GroundBatch* batch = nullptr;
  };
  class Planner;

  void mark(CubeFace face, const FaceBox& box);
  void mark(const Boxes& boxes);
  [[nodiscard]] bool meets(const PatchId& id);
  [[nodiscard]] GroundJob job(const ViewGround::Want& want) const;
  [[nodiscard]] bool is_needed(const Entry& entry) const { return entry.needed + turns(views_) > plans_; }
  /// Pictures that a view of this size may need.
  [[nodiscard]] std::size_t room(double pixels) const;
  /// Plans of all views in which a view that is drawn has one.
  [[nodiscard]] static std::size_t turns(std::size_t views) { return views < 2 ? 1 : 4 * views; }
  void forget_all();  ///< all pictures are gone from the textures
  bool put(const GroundPicture& picture, Entry& entry);
  bool evict();

  GroundTextures textures_;
  GroundPainter painter_;
  std::vector<Layer> layers_;
  std::unordered_map<PatchId, Entry, PatchIdHash> entries_;
  std::unordered_map<PatchId, bool, PatchIdHash> meets_;  ///< answers since the last change
  std::uint64_t revision_ = 1, plans_ = 0;
  std::size_t views_ = 1;  ///< views that share the room, by their pixels
  double pixels_ = 0.0;    ///< sum over these views
};

}  // namespace terrella
