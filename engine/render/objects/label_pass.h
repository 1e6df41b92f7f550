#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "geo/objects.h"
#include "objects/label_layout.h"
#include "objects/object_batches.h"
#include "render/gl/stream_buffer.h"
#include "render/objects/glyph_lines.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Conditions, other than labels in front, under which labels are hidden.
struct LabelSight {
  glm::dvec3 hiding_half_axes_m{0.0};  ///< half axes of an opaque ellipsoid that hides labels; 0: none
  const Ellipsoid* limb = nullptr;     ///< texts stay within its disc where they can; null: anywhere
  bool shown = true;
  float pixel_scale = 1.0F;         ///< pixels of the picture for each pixel of a label's sizes
  bool above_ground = true;         ///< true: all labels over the ground are visible
  bool chosen_above_ground = true;  ///< the same for labels with through_surface
};

/// The labels that a frame of one view showed. A plain value.
struct ShownLabels {
  struct Label {
    std::uint64_t layer;  ///< LayerObjects::serial()
    std::uint32_t index;
    LabelBox box;
  };
  Viewport picture{0, 0};
  std::vector<Label> labels = {};

  /// Returns the labels of a layer whose texts cover a pixel, if the frame had this size.
  [[nodiscard]] std::vector<std::uint32_t> at(const LayerObjects& layer, glm::dvec2 pixel_px, Viewport viewport) const;
};

/// Draws texts beside their places, on the other side where they would reach over the limb: antialiased, with a halo,
/// before the ground that they cover. If labels would overlap, only the label with the highest priority is drawn. The
/// choice is made once per frame, so that both eyes show the same labels. Texts of any script are shaped (TextShaper)
/// once, and their lines are kept. A label whose letters find no room in the largest atlas is not shown. thread: main
class LabelPass {
 public:
  /// Limits: labels looked at, highest priority first, and characters per label.
  static constexpr std::size_t kMostLabels = 100'000;
  static constexpr std::size_t kMostCharacters = kMostLabelCharacters;

  [[nodiscard]] static Result<std::unique_ptr<LabelPass>> create(DepthMode depth, std::vector<std::byte> font);

  /// Chooses the labels of the frame: by priority over all layers; on a tie, by the order of layers.
  void place(const View& view, const LabelSight& sight, std::span<const DrawnLayer> layers, ShownLabels& shown);
  /// Returns the draw calls made.
  [[nodiscard]] int draw(const ObjectDraw& draw, Viewport viewport) const;
  /// Letters of labels that no font has, so far.
  [[nodiscard]] const std::set<char32_t>& without_font() const { return lines_->without_font(); }

 private:
  struct Character {
    glm::vec3 high_m, low_m;
    glm::vec2 offset_px;  ///< offset of the picture's lower left corner from the place, y up
    std::array<short, 4> atlas_px;
    ObjectColor color;
    /// Share of the place's depth at which the text lies, and pixels that the text reaches from its place, up or down.
    glm::vec2 depth_reach;
    glm::vec2 ink_halo;  ///< factors of the glyph's ink and halo, one of them 0
  };
  /// A text that is shown.
  struct Shown {
    const GlyphLine& line;
    int halo_margin_px;
    glm::vec2 corner_px;  ///< beginning of its baseline, right of and above the place of its label
    glm::vec2 depth_reach;
  };
  /// A picture while its labels are chosen.
  struct Page {
    const View& view;
    const LabelSight& sight;
    ShownLabels& shown;
    LabelRoom room;
  };
  /// A label of a layer.
  struct LabelRef {
    const LayerObjects* layer;
    std::uint32_t index;
  };

  LabelPass() = default;
  void set_up_array();
  [[nodiscard]] static bool in_sight(const KeptLabel& label, const View& view, const LabelSight& sight);
  void merge(std::span<const DrawnLayer> layers);
  void choose(const View& view, const LabelSight& sight, ShownLabels& shown);
  void try_label(const LabelRef& ref, glm::dvec2 at_px, Page& page);
  [[nodiscard]] static float left_edge_px(const TextWay& way, float width_px, glm::dvec2 at_px, const Page& page);
  void put(const KeptLabel& label, const ObjectColor& color, const Shown& text);

  gl::Program program_;
  gl::VertexArray array_;
  std::unique_ptr<GlyphLines> lines_;
  std::vector<LabelRef> order_;                                  ///< labels in the order of placing
  std::vector<std::pair<std::uint64_t, std::uint64_t>> merged_;  ///< serials of the layers in order_, and versions
  std::array<std::vector<Character>, 4> characters_;
  StreamBuffer buffer_;
  std::array<std::size_t, 5> first_{};  ///< first character of each of those four ranges, and the end
};

}  // namespace terrella
