#include "render/objects/glyph_atlas.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr int kHalo_px = 2;
constexpr float kHaloReach_px = 2.4F;
constexpr float kFixed = 64.0F;  // FreeType's fixed-point unit: 1/64 pixel

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

Result<std::unique_ptr<GlyphAtlas>> GlyphAtlas::create(std::vector<std::byte> font, int size_px) {
  std::unique_ptr<GlyphAtlas> atlas(new GlyphAtlas);
  atlas->font_ = std::move(font);
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return Error{"FreeType cannot be started"};
  atlas->library_ = {library, &FT_Done_FreeType};
  FT_Face face = nullptr;
  if (FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(atlas->font_.data()),
                         static_cast<FT_Long>(atlas->font_.size()), 0, &face) != 0) {
    return Error{"the labels' font is not a font that FreeType reads"};
  }
  atlas->face_ = {face, &FT_Done_Face};
  if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size_px)) != 0) {
    return Error{"the labels' font has no such size"};
  }
  atlas->texture_ = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(atlas->texture_.name(), 1, GL_RG8, kSide_px, kSide_px);
  if (!gl::has_storage(atlas->texture_)) return Error{"the driver has no memory for the letters of labels"};
  glTextureParameteri(atlas->texture_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(atlas->texture_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return atlas;
}

const Glyph& GlyphAtlas::glyph(char32_t character) {
  const auto [found, is_new] = glyphs_.try_emplace(character);
  Glyph& glyph = found->second;
  if (is_new && FT_Load_Char(face_.get(), character, FT_LOAD_RENDER) == 0) draw(glyph);
  return glyph;
}

void GlyphAtlas::draw(Glyph& glyph) {
  const FT_GlyphSlot slot = face_->glyph;
  const FT_Bitmap& ink = slot->bitmap;
  glyph.advance = float(slot->advance.x) / kFixed;
  if (ink.width == 0 || ink.rows == 0 || ink.pixel_mode != FT_PIXEL_MODE_GRAY) return;
  glyph.width = static_cast<short>(ink.width + 2 * kHalo_px);
  glyph.height = static_cast<short>(ink.rows + 2 * kHalo_px);
  glyph.left = static_cast<short>(slot->bitmap_left - kHalo_px);
  glyph.top = static_cast<short>(slot->bitmap_top + kHalo_px);
  if (!find_room(glyph)) {
    glyph.width = glyph.height = 0;
    return;
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

float GlyphAtlas::kerning(char32_t left, char32_t right) const {
  FT_Vector between{};
  FT_Face face = face_.get();
  if (FT_Get_Kerning(face, FT_Get_Char_Index(face, left), FT_Get_Char_Index(face, right), FT_KERNING_DEFAULT,
                     &between) != 0) {
    return 0.0F;
  }
  return float(between.x) / kFixed;
}

int GlyphAtlas::ascent_px() const { return static_cast<int>(face_->size->metrics.ascender / 64); }
int GlyphAtlas::descent_px() const { return static_cast<int>(-face_->size->metrics.descender / 64); }

}  // namespace terrella
