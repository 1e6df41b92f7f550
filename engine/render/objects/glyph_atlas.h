#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>

#include "base/result.h"
#include "geo/objects.h"
#include "render/gl/gl_handle.h"
#include "text/text_shaper.h"

namespace terrella {

/// Place of a glyph's picture, including its halo, in the atlas and relative to the glyph's origin, pixels.
struct Glyph {
  short x = 0, y = 0, width = 0, height = 0;
  short left = 0, top = 0;  ///< upper left corner, right of and above the origin
};

/// Looks of glyphs. Each look has its own pictures.
struct GlyphLook {
  int text_px = 0;      ///< size of the font
  int halo_fifths = 0;  ///< reach of the halo past the ink, fifths of a pixel; 0: none
  int blur_fifths = 0;  ///< width over which the halo fades at its end, fifths of a pixel
  TextWeight weight = TextWeight::regular;
  bool slanted = false;
  auto operator<=>(const GlyphLook&) const = default;
};

/// Returns the pixels by which a glyph's picture reaches past its ink, for the halo.
[[nodiscard]] int halo_margin_px(const GlyphLook& look);
/// Returns the pixels by which bold letters need more room than the font gives them.
[[nodiscard]] float extra_room_px(const GlyphLook& look);
/// Returns the pixels by which a slanted glyph lies to the right if its origin is raised.
[[nodiscard]] float lean_px(const GlyphLook& look, float raised_px);

/// The glyphs of fonts at some sizes. FreeType draws each into a texture when it is first requested: red is the covered
/// fraction of the pixel, green the halo. thread: main
class GlyphAtlas {
 public:
  /// Sides of the texture: at first, and at most. Labels do not overlap, so the letters of a picture of 4096 px hardly
  /// need more room.
  static constexpr int kSide_px = 1024, kMostSide_px = 4096;

  [[nodiscard]] static Result<std::unique_ptr<GlyphAtlas>> create();

  /// Returns the picture of a glyph: an empty one if the atlas is full, or if the glyph has no ink. The shaper has the
  /// size of the look.
  [[nodiscard]] Glyph glyph(const TextShaper& shaper, const ShapedGlyph& shaped, const GlyphLook& look);
  /// True once a glyph had no room. The atlas then keeps what it has until clear().
  [[nodiscard]] bool is_full() const { return full_; }
  void clear();
  /// Makes the empty atlas twice as wide and high. False if the atlas is as large as it may be.
  [[nodiscard]] bool grow();
  [[nodiscard]] GLuint texture() const { return texture_.name(); }
  [[nodiscard]] int side_px() const { return side_px_; }

 private:
  GlyphAtlas() = default;
  [[nodiscard]] bool make_texture(int side_px);
  [[nodiscard]] Glyph draw(const FT_FaceRec_& face, const GlyphLook& look);
  bool find_room(Glyph& glyph);

  gl::Texture texture_;
  int side_px_ = 0;
  std::map<std::tuple<std::uint32_t, std::uint32_t, GlyphLook>, Glyph> glyphs_;  ///< by font and index
  int row_x_ = 0, row_y_ = 0, row_height_ = 0;
  bool full_ = false;
};

}  // namespace terrella
