#include "render/objects/glyph_atlas.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr float kFaintInk = 0.25F;  // fainter ink has a fainter halo
// Growth of the width of upright strokes, em. Level ones grow by half. Those of DejaVu Sans are 0.09 em wide.
constexpr float kBold_em = 0.05F, kLight_em = -0.02F;
constexpr float kSlant = 0.2126F;    // tangent of 12 degrees
constexpr float kMiddle_em = 0.35F;  // height at which a slanted letter stays in place

float growth_px(const GlyphLook& look) {
  const float em = look.weight == TextWeight::bold ? kBold_em : look.weight == TextWeight::light ? kLight_em : 0.0F;
  return em * float(look.text_px);
}

/// Gives an outline its weight around the middles of its strokes, and its slant.
void restyle(FT_Outline& outline, const GlyphLook& look) {
  const auto fixed = [](float px) { return static_cast<FT_Pos>(std::lround(64.0F * px)); };
  const FT_Pos wider = fixed(growth_px(look)), higher = fixed(0.5F * growth_px(look));
  if (wider != 0) {
    FT_Outline_EmboldenXY(&outline, wider, higher);
    FT_Outline_Translate(&outline, -wider / 2, -higher / 2);
  }
  if (look.slanted) {
    const FT_Matrix shear{0x10000, std::lround(65536.0F * kSlant), 0, 0x10000};
    FT_Outline_Transform(&outline, &shear);
    FT_Outline_Translate(&outline, -fixed(kSlant * kMiddle_em * float(look.text_px)), 0);
  }
}

/// Returns the strength of the halo, 0 to 1, for each texel of a picture that reaches `margin` pixels past the ink. The
/// edge of the ink lies within the pixels that it covers in part. Where the reach ends, the strength falls over a
/// pixel and the blur.
std::vector<float> halo_of(const FT_Bitmap& ink, int margin, const GlyphLook& look) {
  const int wide = int(ink.width) + 2 * margin, high = int(ink.rows) + 2 * margin;
  std::vector<float> halo(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
  if (look.halo_fifths == 0) return halo;
  const float reach_px = float(look.halo_fifths) / 5.0F, fade_px = 1.0F + float(look.blur_fifths) / 5.0F;
  for (int dy = -margin; dy <= margin; ++dy) {
    for (int dx = -margin; dx <= margin; ++dx) {
      const float left_px = reach_px - std::hypot(float(dx), float(dy));
      if (left_px <= -1.0F) continue;
      for (int y = 0; y < int(ink.rows); ++y) {
        const std::uint8_t* const from = ink.buffer + static_cast<std::ptrdiff_t>(y) * ink.pitch;
        float* const to = halo.data() + static_cast<std::ptrdiff_t>(y + margin + dy) * wide + margin + dx;
        for (int x = 0; x < int(ink.width); ++x) {
          const float covered = float(from[x]) / 255.0F;
          to[x] = std::max(to[x], std::min({1.0F, covered / kFaintInk, (left_px + covered) / fade_px}));
        }
      }
    }
  }
  return halo;
}

}  // namespace

int halo_margin_px(const GlyphLook& look) { return (look.halo_fifths + 4) / 5; }

float extra_room_px(const GlyphLook& look) { return std::round(std::max(growth_px(look), 0.0F)); }

float lean_px(const GlyphLook& look, float raised_px) { return look.slanted ? kSlant * raised_px : 0.0F; }

Result<std::unique_ptr<GlyphAtlas>> GlyphAtlas::create() {
  std::unique_ptr<GlyphAtlas> atlas(new GlyphAtlas);
  if (!atlas->make_texture(kSide_px)) return Error{"the driver has no memory for the letters of labels"};
  return atlas;
}

bool GlyphAtlas::make_texture(int side_px) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RG8, side_px, side_px);
  if (!gl::has_storage(texture)) return false;
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  texture_ = std::move(texture);
  side_px_ = side_px;
  return true;
}

Glyph GlyphAtlas::glyph(const TextShaper& shaper, const ShapedGlyph& shaped, const GlyphLook& look) {
  const auto [found, is_new] = glyphs_.try_emplace({shaped.font, shaped.index, look});
  const FT_Face face = shaper.face(shaped.font);
  if (is_new && FT_Load_Glyph(face, shaped.index, FT_LOAD_DEFAULT) == 0) {
    if (face->glyph->format == FT_GLYPH_FORMAT_OUTLINE) restyle(face->glyph->outline, look);
    if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) == 0) found->second = draw(*face, look);
  }
  return found->second;
}

void GlyphAtlas::clear() {
  glyphs_.clear();
  row_x_ = row_y_ = row_height_ = 0;
  full_ = false;
}

bool GlyphAtlas::grow() {
  GLint most_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
  const int side_px = 2 * side_px_;
  if (side_px > std::min(kMostSide_px, int(most_px)) || !make_texture(side_px)) return false;
  clear();
  return true;
}

Glyph GlyphAtlas::draw(const FT_FaceRec_& face, const GlyphLook& look) {
  Glyph glyph;
  const FT_Bitmap& ink = face.glyph->bitmap;
  if (ink.width == 0 || ink.rows == 0 || ink.pixel_mode != FT_PIXEL_MODE_GRAY) return glyph;
  const int margin = halo_margin_px(look);
  glyph.width = static_cast<short>(int(ink.width) + 2 * margin);
  glyph.height = static_cast<short>(int(ink.rows) + 2 * margin);
  glyph.left = static_cast<short>(face.glyph->bitmap_left - margin);
  glyph.top = static_cast<short>(face.glyph->bitmap_top + margin);
  if (!find_room(glyph)) {
    full_ = true;
    return {};
  }
  const std::vector<float> halo = halo_of(ink, margin, look);
  std::vector<std::uint8_t> texels;
  texels.reserve(2 * halo.size());
  for (int y = -margin; y < int(ink.rows) + margin; ++y) {
    for (int x = -margin; x < int(ink.width) + margin; ++x) {
      const bool within = x >= 0 && y >= 0 && x < int(ink.width) && y < int(ink.rows);
      texels.push_back(within ? ink.buffer[y * ink.pitch + x] : std::uint8_t{0});
      texels.push_back(static_cast<std::uint8_t>(std::lround(255.0F * halo[texels.size() / 2])));
    }
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.name(), 0, glyph.x, glyph.y, glyph.width, glyph.height, GL_RG, GL_UNSIGNED_BYTE,
                      texels.data());
  return glyph;
}

bool GlyphAtlas::find_room(Glyph& glyph) {
  if (row_x_ + glyph.width > side_px_) {
    row_y_ += row_height_;
    row_x_ = row_height_ = 0;
  }
  if (glyph.width > side_px_ || row_y_ + glyph.height > side_px_) return false;
  glyph.x = static_cast<short>(row_x_);
  glyph.y = static_cast<short>(row_y_);
  row_x_ += glyph.width;
  row_height_ = std::max(row_height_, int(glyph.height));
  return true;
}

}  // namespace terrella
