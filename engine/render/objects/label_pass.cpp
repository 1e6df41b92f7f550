#include "render/objects/label_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <iterator>

#include "geo/split_position.h"
#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

constexpr int kText_px = 15;
constexpr float kGap_px = 4.0F;     // gap between a marker and its text
constexpr float kMargin_px = 2.0F;  // margin around a text that stays free
constexpr GLint kLabelViewportUniform = 0;
constexpr GLint kLabelBiasUniform = 1;

}  // namespace

std::vector<std::uint32_t> ShownLabels::at(const LayerObjects& layer, glm::dvec2 pixel_px, Viewport viewport) const {
  std::vector<std::uint32_t> found;
  if (viewport != picture) return found;
  const glm::vec2 p(pixel_px);
  for (const Label& label : labels) {
    const glm::vec2 &low = label.box.low_px, &high = label.box.high_px;
    const bool inside = p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y;
    if (inside && label.layer == layer.serial()) found.push_back(label.index);
  }
  return found;
}

Result<std::unique_ptr<LabelPass>> LabelPass::create(DepthMode depth, std::vector<std::byte> font) {
  std::unique_ptr<LabelPass> pass(new LabelPass);
  auto atlas = GlyphAtlas::create(std::move(font), kText_px);
  if (!atlas) return atlas.error();
  pass->atlas_ = std::move(*atlas);
  if (Status s = build_into(pass->program_,
                            {{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", "object_label.vert"}},
                             {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", "object_label.frag"}}},
                            {depth_define(depth)});
      !s)
    return s.error();
  pass->set_up_array();
  return pass;
}

void LabelPass::set_up_array() {
  array_ = gl::make_vertex_array();
  const GLuint array = array_.name();
  gl::float_attribute(array, 0, 0, 3, offsetof(Character, high_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(Character, low_m));
  gl::float_attribute(array, 2, 0, 2, offsetof(Character, offset_px));
  glEnableVertexArrayAttrib(array, 3);
  glVertexArrayAttribFormat(array, 3, 4, GL_SHORT, GL_FALSE, offsetof(Character, atlas_px));
  glVertexArrayAttribBinding(array, 3, 0);
  glEnableVertexArrayAttrib(array, 4);
  glVertexArrayAttribFormat(array, 4, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Character, color));
  glVertexArrayAttribBinding(array, 4, 0);
  glVertexArrayBindingDivisor(array, 0, 1);
}

// Each layer keeps its labels in order. They are merged again only if labels come or go.
void LabelPass::merge(std::span<const DrawnLayer> layers) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> now;
  for (const DrawnLayer& layer : layers) now.emplace_back(layer.objects->serial(), layer.objects->label_version());
  if (now == merged_) return;
  merged_ = std::move(now);
  order_.clear();
  const auto before = [](const LabelRef& a, const LabelRef& b) {
    return a.layer->labels()[a.index].object.priority > b.layer->labels()[b.index].object.priority;
  };
  for (const DrawnLayer& layer : layers) {
    const auto old = std::ssize(order_);
    for (const std::uint32_t k : layer.objects->label_order()) {
      if (!layer.objects->labels()[k].removed) order_.push_back({layer.objects, k});
    }
    std::inplace_merge(order_.begin(), order_.begin() + old, order_.end(), before);
  }
  order_.resize(std::min(order_.size(), kMostLabels));
}

LabelPass::Line LabelPass::line_of(const std::u32string& text) {
  Line line;
  char32_t before = 0;
  for (const char32_t character : text) {
    const Glyph& glyph = atlas_->glyph(character);
    if (before != 0) line.width_px += atlas_->kerning(before, character);
    line.glyphs.emplace_back(glyph, line.width_px);
    line.width_px += glyph.advance;
    before = character;
  }
  return line;
}

bool LabelPass::in_sight(const KeptLabel& label, const View& view, const LabelSight& sight) {
  if (!sight.shown || !label.visible) return false;
  const bool chosen = label.object.through_surface && sight.chosen_above_ground;
  if (!is_underground(label.object) && !sight.above_ground && !chosen) return false;
  return !is_behind(label.place_m, view.eye.xyz_m, sight.hiding_half_axes_m);
}

void LabelPass::place(const View& view, const LabelSight& sight, std::span<const DrawnLayer> layers,
                      ShownLabels& shown) {
  merge(layers);
  LabelRoom room(view.viewport);
  for (auto& characters : characters_) characters.clear();
  shown = {.picture = view.viewport};
  const double focal_px = view.pixels_per_radian();
  for (const LabelRef& ref : order_) {
    const KeptLabel& label = ref.layer->labels()[ref.index];
    const auto at = project(view, Ecef{label.place_m});
    if (!at || at->x < -0.5 * view.viewport.width_px || at->x > view.viewport.width_px || at->y < 0.0 ||
        at->y > view.viewport.height_px || !in_sight(label, view, sight)) {
      continue;
    }
    const double away_m = glm::length(label.place_m - view.eye.xyz_m);
    const auto radius_px = static_cast<float>(label.object.radius_m / away_m * focal_px);
    const float right_px = std::round(std::max(0.5F * label.object.size_px, radius_px)) + kGap_px;
    const glm::vec2 from = glm::vec2(*at) + glm::vec2(right_px, 0.0F);
    const glm::vec2 margin(kMargin_px), up(0.0F, 0.5F * float(atlas_->ascent_px() + atlas_->descent_px()));
    // Most labels of a crowd have no room where their text begins, so their text need not be measured.
    if (!room.is_free({from - up - margin, from + up + margin})) continue;
    const Line line = line_of(label.text);
    const LabelBox text{from - up, from + glm::vec2(line.width_px, 0.0F) + up};
    if (!room.take({text.low_px - margin, text.high_px + margin})) continue;
    put(label, ref.layer->drawn(label.object.color, label), line, right_px);
    shown.labels.push_back({ref.layer->serial(), ref.index, text});
  }
  std::vector<Character> all;
  for (std::size_t k = 0; k < characters_.size(); ++k) {
    first_[k] = all.size();
    all.insert(all.end(), characters_[k].begin(), characters_[k].end());
  }
  first_.back() = all.size();
  buffer_.fill(all.data(), all.size() * sizeof(Character));
}

void LabelPass::put(const KeptLabel& label, const ObjectColor& color, const Line& line, float right_px) {
  const SplitPosition p = split_position(label.place_m);
  auto& characters = characters_[(is_underground(label.object) ? 0U : 2U) + (label.object.through_surface ? 1U : 0U)];
  // Centres a small letter vertically on the place.
  const float pen_y_px = -std::round(0.35F * float(kText_px));
  for (const auto& [glyph, pen_px] : line.glyphs) {
    if (glyph.width == 0) continue;
    const glm::vec2 offset(std::round(right_px + pen_px) + glyph.left, pen_y_px + glyph.top - glyph.height);
    characters.push_back({p.high, p.low, offset, {glyph.x, glyph.y, glyph.width, glyph.height}, color});
  }
}

int LabelPass::draw(const ObjectDraw& draw, Viewport viewport) const {
  const std::size_t base = draw.part == ObjectPart::above_ground ? 2 : 0;
  const std::size_t from = first_[base + (draw.choice == ObjectChoice::chosen ? 1U : 0U)];
  const std::size_t to = first_[base + (draw.choice == ObjectChoice::others ? 1U : 2U)];
  if (from >= to) return 0;
  glProgramUniform2f(program_.name(), kLabelViewportUniform, float(viewport.width_px), float(viewport.height_px));
  glProgramUniform1f(program_.name(), kLabelBiasUniform, draw.depth_bias);
  apply(draw.state.with(program_.name()));
  glVertexArrayVertexBuffer(array_.name(), 0, buffer_.name(), 0, sizeof(Character));
  glBindVertexArray(array_.name());
  glBindTextureUnit(0, atlas_->texture());
  glBindSampler(0, 0);
  glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(to - from),
                                    static_cast<GLuint>(from));
  return 1;
}

}  // namespace terrella
