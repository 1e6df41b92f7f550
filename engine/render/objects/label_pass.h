#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "geo/objects.h"
#include "objects/object_batches.h"
#include "render/gl/stream_buffer.h"
#include "render/objects/glyph_atlas.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// What keeps labels from being seen besides each other.
struct LabelSight {
  glm::dvec3 hiding_half_axes_m{0.0};  ///< of an opaque ellipsoid; 0: none
  bool shown = true;
  bool above_ground = true;         ///< whether those over the ground are seen
  bool chosen_above_ground = true;  ///< of those, the ones with through_surface
};

/// Draws texts beside their places: antialiased, with a dark halo, the same size everywhere, as deep as their markers.
/// Where two would overlap the one with less priority is left out; those that stay are chosen once for a frame, so that
/// two eyes see the same. Left to right with kerning; no shaping. thread: main (of the context)
class LabelPass {
 public:
  /// At most so many labels are looked at, those of the highest priority, and of each text so many characters.
  static constexpr std::size_t kMostLabels = 100'000;
  static constexpr std::size_t kMostCharacters = 96;

  [[nodiscard]] static Result<std::unique_ptr<LabelPass>> create(DepthMode depth, std::vector<std::byte> font);

  void set_labels(const std::vector<LabelObject>& labels, const Ellipsoid& ellipsoid);
  /// Chooses what is shown in the frame.
  void place(const View& view, const LabelSight& sight);
  /// Returns the draw calls made.
  [[nodiscard]] int draw(const ObjectDraw& draw, Viewport viewport) const;
  [[nodiscard]] std::size_t shown() const { return shown_; }

 private:
  struct Character {
    glm::vec3 high_m, low_m;
    glm::vec2 offset_px;  ///< of the picture's lower left corner from the place, y up
    std::array<short, 4> atlas_px;
    ObjectColor color;
  };
  struct Line {
    std::vector<std::pair<Glyph, float>> glyphs;  ///< and where their pen stands
    float width_px = 0.0F;
  };
  struct Label {
    glm::dvec3 place_m;
    std::u32string text;
    double radius_m;
    float size_px;
    ObjectColor color;
    bool underground, chosen;
  };

  LabelPass() = default;
  void set_up_array();
  [[nodiscard]] Line line_of(const std::u32string& text);
  [[nodiscard]] static bool in_sight(const Label& label, const View& view, const LabelSight& sight);
  void put(const Label& label, const Line& line, float right_px);

  gl::Program program_;
  gl::VertexArray array_;
  std::unique_ptr<GlyphAtlas> atlas_;
  std::vector<Label> labels_;  ///< the one to be placed first at the front
  std::array<std::vector<Character>, 4> characters_;
  StreamBuffer buffer_;
  std::array<std::size_t, 5> first_{};  ///< character of each of those four, and the end
  std::size_t shown_ = 0;
};

}  // namespace terrella
