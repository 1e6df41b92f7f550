#include "render/objects/glyph_lines.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

constexpr int kFirstText_px = 15;
constexpr float kFixed = 64.0F;

}  // namespace

LineLook line_look(const LabelLook& look, float scale) {
  const auto text_px =
      static_cast<int>(std::max(std::lround(scale * std::clamp(look.text_px, kLeastText_px, kMostText_px)), 1L));
  const auto fifths = [&](float px) {
    return look.halo.alpha > 0 ? static_cast<int>(std::lround(5.0F * scale * px)) : 0;
  };
  return {{text_px, fifths(look.halo_px), fifths(look.halo_blur_px), look.weight, look.slanted},
          static_cast<int>(std::lround(kFixed * look.letter_spacing_em * float(text_px)))};
}

float drop_px(const LineLook& look) { return std::round(0.35F * float(look.glyphs.text_px)); }

Result<std::unique_ptr<GlyphLines>> GlyphLines::create(std::vector<std::byte> font) {
  std::unique_ptr<GlyphLines> lines(new GlyphLines);
  auto shaper = TextShaper::create(std::move(font), kFirstText_px);
  if (!shaper) return shaper.error();
  lines->shaper_ = *std::move(shaper);
  auto atlas = GlyphAtlas::create();
  if (!atlas) return atlas.error();
  lines->atlas_ = *std::move(atlas);
  return lines;
}

const GlyphLine& GlyphLines::line(const std::u32string& text, const LineLook& look) {
  const auto [found, is_new] = lines_[look].try_emplace(text);
  GlyphLine& line = found->second;
  if (!is_new) return line;
  ++line_count_;
  shaper_->set_size(look.glyphs.text_px);
  const ShapedText shaped = shaper_->shape(text, float(look.spacing_64ths) / kFixed + extra_room_px(look.glyphs));
  line.width_px = shaped.width_px;
  for (const ShapedGlyph& glyph : shaped.glyphs) {
    const glm::vec2 origin(glyph.x_px + lean_px(look.glyphs, glyph.y_px), glyph.y_px);
    line.glyphs.emplace_back(atlas_->glyph(*shaper_, glyph, look.glyphs), origin);
  }
  line.is_whole = !atlas_->is_full();
  return line;
}

float GlyphLines::measure_half_height_px(int text_px) {
  shaper_->set_size(text_px);
  const float half_px = 0.5F * float(shaper_->ascent_px() + shaper_->descent_px());
  return half_heights_px_[static_cast<std::size_t>(text_px)] = half_px;
}

void GlyphLines::forget() {
  lines_.clear();
  line_count_ = 0;
  atlas_->clear();
}

}  // namespace terrella
