#include "render/objects/label_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>

#include "geo/split_position.h"
#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

constexpr float kLeastReach_px = 40.0F;  // reach of a text, up or down, for which labels are pulled towards the eye
constexpr float kMargin_px = 2.0F;       // margin around a text that stays free
constexpr float kLeastShare = 0.5F;      // least share of a place's depth at which its text lies
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
  auto lines = GlyphLines::create(std::move(font));
  if (!lines) return lines.error();
  pass->lines_ = *std::move(lines);
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
  gl::float_attribute(array, 5, 0, 2, offsetof(Character, depth_reach));
  gl::float_attribute(array, 6, 0, 2, offsetof(Character, ink_halo));
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

bool LabelPass::in_sight(const KeptLabel& label, const View& view, const LabelSight& sight) {
  if (!sight.shown || !label.visible) return false;
  const bool chosen = label.object.through_surface && sight.chosen_above_ground;
  if (!is_underground(label.object) && !sight.above_ground && !chosen) return false;
  return !is_behind(label.place_m, view.eye.xyz_m, sight.hiding_half_axes_m);
}

void LabelPass::place(const View& view, const LabelSight& sight, std::span<const DrawnLayer> layers,
                      ShownLabels& shown) {
  merge(layers);
  lines_->with_room([&] { choose(view, sight, shown); });
  std::vector<Character> all;
  for (std::size_t k = 0; k < characters_.size(); ++k) {
    first_[k] = all.size();
    all.insert(all.end(), characters_[k].begin(), characters_[k].end());
  }
  first_.back() = all.size();
  buffer_.fill(all.data(), all.size() * sizeof(Character));
}

void LabelPass::choose(const View& view, const LabelSight& sight, ShownLabels& shown) {
  for (auto& characters : characters_) characters.clear();
  shown = {.picture = view.viewport};
  Page page{view, sight, shown, LabelRoom(view.viewport)};
  const glm::dvec2 size(view.viewport.width_px, view.viewport.height_px);
  for (const LabelRef& ref : order_) {
    const KeptLabel& label = ref.layer->labels()[ref.index];
    const auto at = project(view, Ecef{label.place_m});
    const bool is_near =
        at && glm::all(glm::greaterThanEqual(*at, -0.5 * size)) && glm::all(glm::lessThanEqual(*at, 1.5 * size));
    if (is_near && in_sight(label, view, sight)) try_label(ref, *at, page);
  }
}

void LabelPass::try_label(const LabelRef& ref, glm::dvec2 at_px, Page& page) {
  const KeptLabel& label = ref.layer->labels()[ref.index];
  const float scale = page.sight.pixel_scale;
  const LineLook look = line_look(label.object.look, scale);
  const double away_m = glm::length(label.place_m - page.view.eye.xyz_m);
  const auto radius_px = static_cast<float>(label.object.radius_m / away_m * page.view.pixels_per_radian());
  const float half_height_px = lines_->half_height_px(look);
  TextWay way = text_way(label.object.look.anchor, std::max(0.5F * label.object.size_px, radius_px / scale),
                         half_height_px / scale);
  way.near_px *= scale;
  way.down_px *= scale;
  const int halo_px = halo_margin_px(look.glyphs);
  const glm::vec2 place(at_px), margin(std::max(scale * kMargin_px, float(halo_px))), up(0.0F, half_height_px);
  const glm::vec2 begin = place + glm::vec2(way.near_px, way.down_px);
  // Most labels of a crowd have no room where their text begins, so their text need not be measured.
  if (!page.room.is_free({begin - up - margin, begin + up + margin})) return;
  const GlyphLine& line = lines_->line(label.text, look);
  if (!line.is_whole) return;
  const float left_px = left_edge_px(way, line.width_px, at_px, page);
  const glm::vec2 from = place + glm::vec2(left_px, way.down_px);
  const LabelBox text{from - up, from + glm::vec2(line.width_px, 0.0F) + up};
  if (!page.room.take({text.low_px - margin, text.high_px + margin})) return;
  const bool over_ground = page.sight.limb != nullptr && !is_underground(label.object);
  const float share = over_ground ? share_before_ground(page.view, *page.sight.limb, label.place_m, text) : 1.0F;
  const float reach_px = std::max(scale * kLeastReach_px, std::abs(way.down_px) + half_height_px);
  const float baseline_px = -drop_px(look) - way.down_px;
  put(label, ref.layer->drawn(label.object.color, label), {line, halo_px, {left_px, baseline_px}, {share, reach_px}});
  page.shown.labels.push_back({ref.layer->serial(), ref.index, text});
}

// A text beside a marker turns to its other side where it would reach over the limb.
float LabelPass::left_edge_px(const TextWay& way, float width_px, glm::dvec2 at_px, const Page& page) {
  if (way.side == 0.0F) return -0.5F * width_px;
  const auto is_over_limb = [&](float x_px) {
    const Ellipsoid* const limb = page.sight.limb;
    return limb != nullptr && is_beside_planet(page.view, *limb, at_px + glm::dvec2(x_px, 0.0));
  };
  const float far_px = way.near_px + way.side * width_px;
  const bool turned = is_over_limb(far_px) && !is_over_limb(0.0F) && !is_over_limb(-far_px);
  return turned ? std::min(-way.near_px, -far_px) : std::min(way.near_px, far_px);
}

// The halos of a text lie under all its letters, because a halo reaches over the letters beside its own.
void LabelPass::put(const KeptLabel& label, const ObjectColor& color, const Shown& text) {
  const SplitPosition p = split_position(label.place_m);
  const ObjectColor& halo = label.object.look.halo;
  auto& characters = characters_[(is_underground(label.object) ? 0U : 2U) + (label.object.through_surface ? 1U : 0U)];
  const auto add = [&](short inset, const ObjectColor& drawn, const glm::vec2& ink_halo) {
    for (const auto& [glyph, origin_px] : text.line.glyphs) {
      if (glyph.width == 0) continue;
      const std::array<short, 4> atlas_px = {short(glyph.x + inset), short(glyph.y + inset),
                                             short(glyph.width - 2 * inset), short(glyph.height - 2 * inset)};
      const glm::vec2 offset(std::round(text.corner_px.x + origin_px.x) + glyph.left + inset,
                             std::round(text.corner_px.y + origin_px.y) + glyph.top - glyph.height + inset);
      characters.push_back({p.high, p.low, offset, atlas_px, drawn, text.depth_reach, ink_halo});
    }
  };
  if (text.halo_margin_px > 0) {
    add(0, {halo.red, halo.green, halo.blue, color.alpha}, {0.0F, float(halo.alpha) / 255.0F});
  }
  add(static_cast<short>(text.halo_margin_px), color, {1.0F, 0.0F});
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
  glBindTextureUnit(0, lines_->texture());
  glBindSampler(0, 0);
  glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(to - from),
                                    static_cast<GLuint>(from));
  return 1;
}

}  // namespace terrella
