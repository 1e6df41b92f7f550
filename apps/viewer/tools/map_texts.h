#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "objects/map_labels.h"
#include "render/gl/gl_handle.h"
#include "render/objects/glyph_lines.h"

struct ImDrawList;

namespace terrella {

/// A name and the upper left corner of its text in framebuffer pixels.
struct MapText {
  const MapName* name = nullptr;
  glm::dvec2 low_px{0.0};
};

/// Draws names in their looks, in any script, within a frame of Dear ImGui. A name with a letter that no font has is
/// written without marks, or not at all. `scale`: framebuffer pixels per pixel of a look. thread: main
class MapTexts {
 public:
  /// `font` contains the bytes of a font file. Null if the font cannot be read.
  [[nodiscard]] static std::unique_ptr<MapTexts> create(std::vector<std::byte> font);

  /// Calls a function that measures all names of a frame, again if their letters had no room.
  template <class Measure>
  void with_room(const Measure& measure) {
    int calls = 0;
    lines_->with_room([&] { ++calls, measure(); });
    if (calls > 1 || !ink_) view_atlas();
  }
  /// Returns the width and height of a name in framebuffer pixels, 0 if the name cannot be written.
  [[nodiscard]] glm::dvec2 size_px(const MapName& name, double scale);
  /// Draws names that with_room() measured. `unit_px`: framebuffer pixels per unit of the window.
  void draw(ImDrawList* list, std::span<const MapText> texts, double scale, double unit_px);

 private:
  MapTexts() = default;
  [[nodiscard]] bool can_write(const std::u32string& text) const;
  [[nodiscard]] const GlyphLine& line_of(const MapName& name, const LineLook& look);
  void view_atlas();
  enum class Layer { halo, ink };
  void draw_layer(ImDrawList* list, const MapText& text, Layer layer, double scale, double unit_px);

  std::unique_ptr<GlyphLines> lines_;
  gl::Texture ink_, halo_;  ///< the atlas as white with the opacity of ink or halo
};

}  // namespace terrella
