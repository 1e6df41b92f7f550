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
constexpr float kGap_px = 4.0F;             // gap between a marker and its text
constexpr float kMargin_px = 2.0F;          // margin around a text that stays free
constexpr std::size_t kMostLines = 10'000;  // texts that are kept
constexpr float kLeastShare = 0.5F;         // least share of a place's depth at which its text lies
constexpr GLint kLabelViewportUniform = 0;
constexpr GLint kLabelBiasUniform = 1;

/// Returns the share of a place's depth at which a text hides behind no ground of a planet's ellipsoid: towards the
/// middle of the disc the ground is nearer than the place, near the limb by much.
float share_before_ground(const View& view, const Ellipsoid& planet, const glm::dvec3& place_m, const LabelBox& text) {
  const double depth_m = glm::dot(place_m - view.eye.xyz_m, view.forward);
  double share = 1.0;
  for (const float x : {text.low_px.x, text.high_px.x}) {
    for (const float y : {text.low_px.y, text.high_px.y}) {
      const EcefDir ray = pixel_ray(view, {x, y});
      const auto away_m = planet.intersect_m(view.eye, ray);
      if (away_m) share = std::min(share, *away_m * glm::dot(ray.xyz, view.forward) / depth_m);
    }
  }
  return std::max(static_cast<float>(share), kLeastShare);
}

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
  auto shaper = TextShaper::create(std::move(font), kText_px);
  if (!shaper) return shaper.error();
  pass->shaper_ = std::move(*shaper);
  auto atlas = GlyphAtlas::create();
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
  gl::float_attribute(array, 5, 0, 1, offsetof(Character, depth_share));
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

const LabelPass::Line& LabelPass::line_of(const std::u32string& text) {
  const auto [found, is_new] = lines_.try_emplace(text);
  Line& line = found->second;
  if (!is_new) return line;
  const ShapedText shaped = shaper_->shape(text);
  line.width_px = shaped.width_px;
  for (const ShapedGlyph& glyph : shaped.glyphs) {
    line.glyphs.emplace_back(atlas_->glyph(*shaper_, glyph), glm::vec2(glyph.x_px, glyph.y_px));
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
  if (atlas_->is_full() || lines_.size() > kMostLines) {
    lines_.clear();
    atlas_->clear();
  }
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
    const float gap_px = std::round(std::max(0.5F * label.object.size_px, radius_px)) + kGap_px;
    const glm::vec2 place(*at), margin(kMargin_px),
        up(0.0F, 0.5F * float(shaper_->ascent_px() + shaper_->descent_px()));
    const glm::vec2 begin = place + glm::vec2(gap_px, 0.0F);
    // Most labels of a crowd have no room where their text begins, so their text need not be measured.
    if (!room.is_free({begin - up - margin, begin + up + margin})) continue;
    const Line& line = line_of(label.text);
    const auto is_over_limb = [&](float x_px) {
      return sight.limb != nullptr && is_beside_planet(view, *sight.limb, *at + glm::dvec2(x_px, 0.0));
    };
    const float wide_px = gap_px + line.width_px;
    const bool turned = is_over_limb(wide_px) && !is_over_limb(0.0F) && !is_over_limb(-wide_px);
    const float left_px = turned ? -wide_px : gap_px;
    const glm::vec2 from = place + glm::vec2(left_px, 0.0F);
    const LabelBox text{from - up, from + glm::vec2(line.width_px, 0.0F) + up};
    if (!room.take({text.low_px - margin, text.high_px + margin})) continue;
    const bool over_ground = sight.limb != nullptr && !is_underground(label.object);
    put(label, ref.layer->drawn(label.object.color, label), line, left_px,
        over_ground ? share_before_ground(view, *sight.limb, label.place_m, text) : 1.0F);
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

void LabelPass::put(const KeptLabel& label, const ObjectColor& color, const Line& line, float left_px,
                    float depth_share) {
  const SplitPosition p = split_position(label.place_m);
  auto& characters = characters_[(is_underground(label.object) ? 0U : 2U) + (label.object.through_surface ? 1U : 0U)];
  // Centres a small letter vertically on the place.
  const float pen_y_px = -std::round(0.35F * float(kText_px));
  for (const auto& [glyph, origin_px] : line.glyphs) {
    if (glyph.width == 0) continue;
    const glm::vec2 offset(std::round(left_px + origin_px.x) + glyph.left,
                           std::round(pen_y_px + origin_px.y) + glyph.top - glyph.height);
    characters.push_back({p.high, p.low, offset, {glyph.x, glyph.y, glyph.width, glyph.height}, color, depth_share});
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
