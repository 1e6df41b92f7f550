#include "render/objects/glyph_atlas.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr int kHalo_px = 2;
constexpr float kHaloReach_px = 2.4F;

/// Returns the strength of the halo: that of the strongest nearby pixel, weakened by its distance.
std::uint8_t halo_at(const FT_Bitmap& ink, int x, int y) {
  float strongest = 0.0F;
  for (int dy = -kHalo_px; dy <= kHalo_px; ++dy) {
    for (int dx = -kHalo_px; dx <= kHalo_px; ++dx) {
      const int px = x + dx, py = y + dy;
      if (px < 0 || py < 0 || px >= int(ink.width) || py >= int(ink.rows)) continue;
      const float part = std::clamp(kHaloReach_px - std::hypot(float(dx), float(dy)), 0.0F, 1.0F);
      strongest = std::max(strongest, part * float(ink.buffer[py * ink.pitch + px]));
    }
  }
  return static_cast<std::uint8_t>(strongest);
}

}  // namespace

Result<std::unique_ptr<GlyphAtlas>> GlyphAtlas::create() {
  std::unique_ptr<GlyphAtlas> atlas(new GlyphAtlas);
  atlas->texture_ = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(atlas->texture_.name(), 1, GL_RG8, kSide_px, kSide_px);
  if (!gl::has_storage(atlas->texture_)) return Error{"the driver has no memory for the letters of labels"};
  glTextureParameteri(atlas->texture_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(atlas->texture_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return atlas;
}

Glyph GlyphAtlas::glyph(const TextShaper& shaper, const ShapedGlyph& shaped) {
  const auto [found, is_new] = glyphs_.try_emplace(std::uint64_t{shaped.font} << 32U | shaped.index);
  const FT_Face face = shaper.face(shaped.font);
  if (is_new && FT_Load_Glyph(face, shaped.index, FT_LOAD_RENDER) == 0) found->second = draw(*face);
  return found->second;
}

void GlyphAtlas::clear() {
  glyphs_.clear();
  row_x_ = row_y_ = row_height_ = 0;
  full_ = false;
}

Glyph GlyphAtlas::draw(const FT_FaceRec_& face) {
  Glyph glyph;
  const FT_Bitmap& ink = face.glyph->bitmap;
  if (ink.width == 0 || ink.rows == 0 || ink.pixel_mode != FT_PIXEL_MODE_GRAY) return glyph;
  glyph.width = static_cast<short>(ink.width + 2 * kHalo_px);
  glyph.height = static_cast<short>(ink.rows + 2 * kHalo_px);
  glyph.left = static_cast<short>(face.glyph->bitmap_left - kHalo_px);
  glyph.top = static_cast<short>(face.glyph->bitmap_top + kHalo_px);
  if (!find_room(glyph)) {
    full_ = true;
    return {};
  }
  std::vector<std::uint8_t> texels;
  for (int y = -kHalo_px; y < int(ink.rows) + kHalo_px; ++y) {
    for (int x = -kHalo_px; x < int(ink.width) + kHalo_px; ++x) {
      const bool within = x >= 0 && y >= 0 && x < int(ink.width) && y < int(ink.rows);
      texels.push_back(within ? ink.buffer[y * ink.pitch + x] : std::uint8_t{0});
      texels.push_back(halo_at(ink, x, y));
    }
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.name(), 0, glyph.x, glyph.y, glyph.width, glyph.height, GL_RG, GL_UNSIGNED_BYTE,
                      texels.data());
  return glyph;
}

bool GlyphAtlas::find_room(Glyph& glyph) {
  if (row_x_ + glyph.width > kSide_px) {
    row_y_ += row_height_;
    row_x_ = row_height_ = 0;
  }
  if (glyph.width > kSide_px || row_y_ + glyph.height > kSide_px) return false;
  glyph.x = static_cast<short>(row_x_);
  glyph.y = static_cast<short>(row_y_);
  row_x_ += glyph.width;
  row_height_ = std::max(row_height_, int(glyph.height));
  return true;
}

}  // namespace terrella
