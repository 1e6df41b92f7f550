#include "render/surface/patch_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numbers>
#include <span>

#include "render/gl/vertex_attribute.h"
#include "render/surface/slope_textures.h"

namespace terrella {
namespace {

// A pixel with a smaller footprint lies within one bilinear cell, so one tap at full precision suffices.
constexpr double kMagnifiedFootprint_texels = 0.7;
// In the pole bands (PatchSelectionOptions::band) pixels are long without a slant. Three taps on pixels longer than
// this would leave more error there than elsewhere: 0.49 levels in place of 0.40 where the whole cap is in view, whose
// pixels are about four texels long. Up to three texels, seven taps lower the error by no more than 0.01 levels.
constexpr double kBesidePole_rad = 0.05 * std::numbers::pi;
constexpr double kBesidePole_texels = 3.0;
// Three taps of a pixel suffice up to this length, and seven up to that.
constexpr double kThreeTaps_texels = 2.0, kSevenTaps_texels = 7.0;
// City lights shine under a Sun lower than this (lamplight() of shaders/frame.glsl begins at 0).
constexpr double kLampsOn_rad = 0.001;
// Geodetic normals differ by up to a/b times as much as the axes of a patch's cone: 1.11 on Saturn.
constexpr double kNormalsOverCone = 1.2;
gl::Sampler sampler(GLenum minify, GLenum wrap) {
  gl::Sampler s = gl::make_sampler();
  glSamplerParameteri(s.name(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(s.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
  return s;
}

}  // namespace

std::unique_ptr<PatchPass> PatchPass::create(const RenderOptions& options, bool has_relief) {
  std::unique_ptr<PatchPass> pass(new PatchPass(options, has_relief));
  pass->set_up_vertex_arrays();
  pass->set_up_samplers();
  return pass;
}

void PatchPass::set_relief(bool has_relief) {
  if (has_relief_ == has_relief) return;
  has_relief_ = has_relief;
  set_up_vertex_arrays();
}

void PatchPass::set_up_vertex_arrays() {
  vertex_array_ = make_vertex_array();
  stack_array_ = make_stack_array();
  ground_array_ = make_vertex_array();
  add_ground_attribute(ground_array_);
}

gl::VertexArray PatchPass::make_vertex_array() const {
  gl::VertexArray made = gl::make_vertex_array();
  const GLuint array = made.name();
  glVertexArrayBindingDivisor(array, 1, 1);
  gl::float_attribute(array, 0, 0, 3, offsetof(PatchVertex, position_high_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(PatchVertex, position_low_m));
  gl::float_attribute(array, 2, 0, 3, offsetof(PatchVertex, direction));
  gl::float_attribute(array, 3, 0, 2, offsetof(PatchVertex, offset_deg));
  gl::float_attribute(array, 4, 1, 4, offsetof(PatchDraw, center_and_scale));
  gl::float_attribute(array, 5, 1, 4, offsetof(PatchDraw, frame));
  gl::float_attribute(array, 6, 1, 4, offsetof(PatchDraw, row));
  gl::uint_attribute(array, 7, 1, 4, offsetof(PatchDraw, window));
  if (!has_relief_) return made;
  gl::float_attribute(array, 8, 2, 2, 0);
  glVertexArrayBindingDivisor(array, 3, 1);
  gl::float_attribute(array, 9, 3, 4, offsetof(SlopeDraw, center_and_scale));
  gl::uint_attribute(array, 10, 3, 4, offsetof(SlopeDraw, window));
  return made;
}

void PatchPass::set_up_samplers() {
  bilinear_ = sampler(GL_LINEAR, GL_CLAMP_TO_EDGE);
  // No look-up leaves the slot, so the wrap mode changes no texel. Mesa's software rasteriser filters in float with
  // this mode, but with eight bits with the common modes.
  precise_ = sampler(GL_LINEAR, GL_MIRRORED_REPEAT);
  mipmapped_ = sampler(GL_LINEAR_MIPMAP_LINEAR, GL_CLAMP_TO_EDGE);
}

PatchLayer::Program PatchPass::program_for(const SelectedPatch& patch) const {
  using enum PatchLayer::Program;
  switch (options_.texturing) {
    case Texturing::exact:
      return polar_for(patch);
    case Texturing::automatic:
      if (patch.in_band) return polar_for(patch);
      break;
    case Texturing::paper:
      if (patch.node->min_colatitude_rad < scene_.paper_band * std::numbers::pi) return paper;
      break;
    case Texturing::vertex:
      break;
  }
  if (patch.footprint_texels < kMagnifiedFootprint_texels) return magnified;
  const bool beside_pole = patch.node->min_colatitude_rad < kBesidePole_rad;
  const double plain_texels =
      beside_pole ? std::min(kBesidePole_texels, scene_.plain_footprint_texels) : scene_.plain_footprint_texels;
  if (patch.footprint_texels <= plain_texels) return plain;
  return beside_pole && patch.footprint_texels <= most_of_seven() ? seven_taps : oblique;
}

PatchLayer::Program PatchPass::polar_for(const SelectedPatch& patch) const {
  using enum PatchLayer::Program;
  if (patch.footprint_texels <= kThreeTaps_texels) return polar_short;
  // At the limb of a lit picture pixels may be far longer than the estimate for the middle of the patch.
  if (scene_.plain_footprint_texels < kPlainFootprint_texels) return polar_long;
  return patch.footprint_texels <= most_of_seven() ? polar : polar_long;
}

int PatchPass::variant_for(const SelectedPatch& patch) const {
  return 2 * program_for(patch) + (is_dark(patch.body()) ? 1 : 0);
}

int PatchPass::limb_variant_for(const SelectedPatch& patch) const {
  const bool polar = patch.in_band || options_.texturing == Texturing::exact;
  return 2 * (polar ? PatchLayer::polar_limb : PatchLayer::limb) + (is_dark(patch.body()) ? 1 : 0);
}

bool PatchPass::is_on_limb(const SelectedPatch& patch) const {
  const PatchNode& body = patch.body();
  return scene_.limb && scene_.limb->meets(body.cone_axis, body.cos_cone, body.sin_cone);
}

bool PatchPass::is_dark(const PatchNode& node) const {
  if (!options_.night_lights || !scene_.sun) return false;
  const double height_rad = std::asin(std::clamp(glm::dot(node.normal, *scene_.sun), -1.0, 1.0));
  const double half_rad = std::acos(std::clamp(node.cos_cone, -1.0, 1.0));
  return height_rad - kNormalsOverCone * half_rad < kLampsOn_rad;
}

// The length is an estimate for the middle of a patch. Beside the limb, where lit pictures need all taps, pixels vary.
double PatchPass::most_of_seven() const { return std::min(kSevenTaps_texels, scene_.plain_footprint_texels); }

DrawCommand PatchPass::command_of(const SelectedPatch& patch, std::size_t instance, const Vertices& vertices,
                                  std::uint64_t frame) {
  const auto& [buffers, tree, own] = vertices;
  const PatchIndices::Range range =
      buffers.indices().ranges[forward_diagonal(patch.node->id) ? 1 : 0][patch.coarse_sides];
  const int place = buffers.place_of(tree, own ? *patch.node : *patch.surface, frame);
  return {range.count, 1, range.first, place * buffers.vertices_per_patch(), static_cast<GLuint>(instance)};
}

DrawCommand PatchPass::limb_of(DrawCommand patch, const PatchBuffers& buffers,
                               std::vector<std::uint16_t>& indices) const {
  const auto first = static_cast<GLuint>(indices.size());
  const std::span<const glm::vec3> points = buffers.points(patch.base_vertex / buffers.vertices_per_patch());
  for (std::uint32_t i = patch.first_index; i < patch.first_index + patch.count; i += 3) {
    const std::uint16_t* corner = buffers.indices().indices.data() + i;
    if (!scene_.limb->holds(points[corner[0]]) && !scene_.limb->holds(points[corner[1]]) &&
        !scene_.limb->holds(points[corner[2]]))
      continue;
    indices.insert(indices.end(), corner, corner + 3);
  }
  patch.first_index = first;
  patch.count = static_cast<GLuint>(indices.size()) - first;
  return patch;
}

void PatchPass::upload(PatchLayer& layer, const Vertices& vertices, const std::vector<SelectedPatch>& patches,
                       const TileCoverage& coverage, const std::vector<bool>& own, std::uint64_t frame) const {
  std::vector<DrawCommand> by_program[kVariants];
  std::vector<std::uint16_t> limb_indices;
  layer.triangles = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const SelectedPatch& patch = patches[k];
    if (!own.empty() && !own[k]) continue;
    const DrawCommand whole = command_of(patch, k, vertices, frame);
    by_program[variant_for(patch)].push_back(whole);
    layer.triangles += whole.count / 3;
    if (!is_on_limb(patch)) continue;
    const DrawCommand limb = limb_of(whole, vertices.buffers, limb_indices);
    if (limb.count == 0) continue;
    by_program[limb_variant_for(patch)].push_back(limb);
    layer.triangles += limb.count / 3;
  }
  std::vector<DrawCommand> commands;
  for (int p = 0; p < kVariants; ++p) {
    layer.first_command[p] = static_cast<int>(commands.size());
    commands.insert(commands.end(), by_program[p].begin(), by_program[p].end());
  }
  layer.first_command[kVariants] = static_cast<int>(commands.size());
  if (!layer.draws) {
    layer.draws = gl::make_buffer();
    layer.commands = gl::make_buffer();
    layer.cells = gl::make_buffer();
    layer.limb_indices = gl::make_buffer();
    layer.cells_texture = gl::make_texture(GL_TEXTURE_BUFFER);
  }
  stream(layer.commands, commands);
  stream(layer.limb_indices, limb_indices);
  stream(layer.draws, coverage.draws);
  stream(layer.cells, coverage.cells);
  glTextureBuffer(layer.cells_texture.name(), GL_R32UI, layer.cells.name());
}

void PatchPass::bind_vertices(const gl::VertexArray& vertex_array, const PatchLayer& layer,
                              const PatchBuffers& vertices) const {
  const GLuint array = vertex_array.name();
  glVertexArrayElementBuffer(array, vertices.index_buffer());
  glVertexArrayVertexBuffer(array, 0, vertices.vertex_buffer(), 0, sizeof(PatchVertex));
  glVertexArrayVertexBuffer(array, 1, layer.draws.name(), 0, sizeof(PatchDraw));
  if (has_relief_) {
    // Programs without light on relief read no slopes.
    const bool slopes = static_cast<bool>(layer.slope_draws);
    glVertexArrayVertexBuffer(array, 2, vertices.height_offset_buffer(), 0, sizeof(glm::vec2));
    glVertexArrayVertexBuffer(array, 3, slopes ? layer.slope_draws.name() : layer.draws.name(), 0, sizeof(SlopeDraw));
  }
  glBindVertexArray(array);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, layer.commands.name());
}

void PatchPass::draw_commands(int first, int last, FrameCounts& counts) {
  if (first == last) return;
  const auto offset = static_cast<std::uintptr_t>(first) * sizeof(DrawCommand);
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset), last - first, 0);
  ++counts.draw_calls;
}

void PatchPass::draw(const PatchLayer& layer, const PatchBuffers& vertices, const TileTextures& tiles, LayerRole role,
                     const DrawState& state, FrameCounts& counts, Limb limb) const {
  const bool numbers = layer.numbers != nullptr;
  const TexelKind kind = kind_of(layer.numbers);
  const ProgramSet& set = sets_[set_index(role, kind, light_of(role, kind))];
  if (scene_.air != nullptr) scene_.air->bind_ground();
  glBindTextureUnit(1, layer.cells_texture.name());
  glBindSampler(1, 0);
  for (GLuint unit : {0U, 2U, 3U}) glBindTextureUnit(unit, tiles.texture());
  glBindSampler(0, bilinear_.name());
  glBindSampler(2, mipmapped_.name());
  glBindSampler(3, precise_.name());
  if (numbers) layer.numbers->bind();
  bind_vertices(vertex_array_, layer, vertices);
  // The limb comes first: it lies before the ground that whole patches have there.
  for (int k = 0; k < kVariants; ++k) {
    const int p = (k + PatchLayer::kWholeVariants) % kVariants;
    if (layer.first_command[p] == layer.first_command[p + 1]) continue;
    const bool whole = p < PatchLayer::kWholeVariants;
    if (!whole && limb == Limb::flat) continue;
    glVertexArrayElementBuffer(vertex_array_.name(), whole ? vertices.index_buffer() : layer.limb_indices.name());
    const GLuint program = set.programs[p].name();
    assert(program != 0);
    if (numbers) {
      glProgramUniform4fv(program, NumberColors::kUniformPlace, 1, glm::value_ptr(layer.numbers->uniform()));
      glProgramUniform4fv(program, NumberColors::kLinesPlace, 1, glm::value_ptr(layer.numbers->lines()));
    }
    apply(state.with(program));
    draw_commands(layer.first_command[p], layer.first_command[p + 1], counts);
  }
  counts.triangles += layer.triangles;
}

void PatchPass::draw_whole(Whole what, const PatchLayer& layer, const PatchBuffers& vertices, const DrawState& state,
                           FrameCounts& counts) {
  if (what == Whole::air) scene_.air->bind_ground();
  bind_vertices(vertex_array_, layer, vertices);
  const int* first = layer.first_command;
  apply(state.with(whole_program(what, false).name()));
  draw_commands(first[0], first[PatchLayer::kWholeVariants], counts);
  if (first[PatchLayer::kWholeVariants] == first[kVariants]) return;
  glVertexArrayElementBuffer(vertex_array_.name(), layer.limb_indices.name());
  apply(state.with(whole_program(what, true).name()));
  draw_commands(first[PatchLayer::kWholeVariants], first[kVariants], counts);
}

}  // namespace terrella
