#include "apps/viewer/tools/map_texts.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <utility>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/tools/map_data.h"
#include "base/code_points.h"

namespace terrella {
namespace {

/// Letters stand on whole pixels, so room between them is even if it is whole pixels.
LineLook look_at(const MapName& name, double scale) {
  LineLook look = line_look(name.look, std::min(static_cast<float>(scale), kMostLineScale));
  look.spacing_64ths = (look.spacing_64ths + 32) / 64 * 64;
  return look;
}

gl::Texture view_of(GLuint atlas, GLenum channel) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glTextureView(name, GL_TEXTURE_2D, atlas, GL_RG8, 0, 1, 0, 1);
  const GLint swizzle[] = {GL_ONE, GL_ONE, GL_ONE, static_cast<GLint>(channel)};
  glTextureParameteriv(name, GL_TEXTURE_SWIZZLE_RGBA, swizzle);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return gl::Texture(name);
}

}  // namespace

std::unique_ptr<MapTexts> MapTexts::create(std::vector<std::byte> font) {
  auto lines = GlyphLines::create(std::move(font));
  if (!lines) return nullptr;
  std::unique_ptr<MapTexts> texts(new MapTexts);
  texts->lines_ = *std::move(lines);
  return texts;
}

void MapTexts::view_atlas() {
  ink_ = view_of(lines_->texture(), GL_RED);
  halo_ = view_of(lines_->texture(), GL_GREEN);
}

bool MapTexts::can_write(const std::u32string& text) const {
  return std::ranges::none_of(text, [this](char32_t letter) { return lines_->without_font().contains(letter); });
}

const GlyphLine& MapTexts::line_of(const MapName& name, const LineLook& look) {
  const std::u32string text = code_points(name.text);
  const GlyphLine& line = lines_->line(text, look);
  if (can_write(text)) return line;
  const std::u32string plain = code_points(without_marks(name.text));
  const GlyphLine& plain_line = lines_->line(plain, look);
  return can_write(plain) ? plain_line : lines_->line({}, look);
}

glm::dvec2 MapTexts::size_px(const MapName& name, double scale) {
  const LineLook look = look_at(name, scale);
  return {line_of(name, look).width_px, 2.0F * lines_->half_height_px(look)};
}

void MapTexts::draw(ImDrawList* list, std::span<const MapText> texts, double scale, double unit_px) {
  for (const Layer layer : {Layer::halo, Layer::ink}) {
    const GLuint texture = layer == Layer::halo ? halo_.name() : ink_.name();
    list->PushTextureID(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)));
    for (const MapText& text : texts) draw_layer(list, text, layer, scale, unit_px);
    list->PopTextureID();
  }
}

void MapTexts::draw_layer(ImDrawList* list, const MapText& text, Layer layer, double scale, double unit_px) {
  const LineLook look = look_at(*text.name, scale);
  const ObjectColor& color = layer == Layer::halo ? text.name->look.halo : text.name->color;
  const ImU32 drawn = IM_COL32(color.red, color.green, color.blue, color.alpha);
  const glm::dvec2 pen = text.low_px + glm::dvec2(0.0, std::round(lines_->half_height_px(look) + drop_px(look)));
  const float texel = 1.0F / static_cast<float>(lines_->side_px());
  for (const auto& [glyph, origin_px] : line_of(*text.name, look).glyphs) {
    if (glyph.width == 0) continue;
    const glm::dvec2 size(glyph.width, glyph.height);
    const glm::dvec2 low =
        pen + glm::dvec2(std::round(origin_px.x) + float(glyph.left), -std::round(origin_px.y) - float(glyph.top));
    const ImVec2 from{glyph.x * texel, glyph.y * texel};
    list->PrimReserve(6, 4);
    list->PrimRectUV(to_ui(low, unit_px), to_ui(low + size, unit_px), from,
                     {from.x + glyph.width * texel, from.y + glyph.height * texel}, drawn);
  }
}

}  // namespace terrella
