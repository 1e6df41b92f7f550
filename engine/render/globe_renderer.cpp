#include "render/globe_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "render/shader_library.h"

namespace terrella {
namespace {

/// glMultiDrawElementsIndirect's record.
struct DrawCommand {
  GLuint count;
  GLuint instances;
  GLuint first_index;
  GLint base_vertex;
  GLuint base_instance;
};

// Three taps over the pixel serve footprints of up to this many texels well enough (shaders/patch_plain.frag).
constexpr double kPlainFootprint_texels = 12.0;
// Under this many texels a pixel lies within one bilinear cell, and one tap at full precision says all.
constexpr double kMagnifiedFootprint_texels = 0.7;

std::string_view depth_define(DepthMode mode) {
  switch (mode) {
    case DepthMode::logarithmic:
      return "DEPTH_LOGARITHMIC";
    case DepthMode::standard:
      return "DEPTH_STANDARD";
    case DepthMode::reversed:
      break;
  }
  return "DEPTH_REVERSED";
}

Result<gl::Program> patch_program(std::initializer_list<std::string_view> fragment, DepthMode depth) {
  return build_program({{GL_VERTEX_SHADER, {"frame.glsl", "patch.vert"}}, {GL_FRAGMENT_SHADER, fragment}},
                       {depth_define(depth)});
}

gl::Sampler sampler(GLenum minify, GLenum wrap) {
  gl::Sampler s = gl::make_sampler();
  glSamplerParameteri(s.name(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(s.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
  return s;
}

template <class T>
void stream(const gl::Buffer& buffer, const std::vector<T>& data) {
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

bool inside_body(const Ellipsoid& e, const Ecef& eye) {
  const glm::dvec3 q = eye.xyz_m / glm::dvec3(e.a_m(), e.a_m(), e.b_m());
  return glm::dot(q, q) < 1.0;
}

}  // namespace

Result<std::unique_ptr<GlobeRenderer>> GlobeRenderer::create(const RenderOptions& options, PatchTree& tree) {
  std::unique_ptr<GlobeRenderer> renderer(new GlobeRenderer(options, tree));
  if (const Status built = renderer->build_programs(); !built) return built.error();
  Result<std::unique_ptr<LimbPass>> limb = LimbPass::create();
  if (!limb) return limb.error();
  renderer->limb_ = std::move(*limb);
  renderer->set_up_vertex_array();
  renderer->set_up_samplers();
  return renderer;
}

Status GlobeRenderer::build_programs() {
  const auto build = [this](PatchProgram which, std::initializer_list<std::string_view> files) -> Status {
    Result<gl::Program> program = patch_program(files, options_.depth);
    if (!program) return program.error();
    programs_[which] = std::move(*program);
    return Done{};
  };
  if (options_.texturing == Texturing::exact || options_.texturing == Texturing::automatic) {
    Status s = build(polar, {"frame.glsl", "patch_common.glsl", "patch_exact_point.glsl", "patch_polar.frag"});
    if (!s || options_.texturing == Texturing::exact) return s;
  }
  if (Status s = build(magnified, {"frame.glsl", "patch_common.glsl", "patch_magnified.frag"}); !s) return s;
  if (Status s = build(plain, {"frame.glsl", "patch_common.glsl", "patch_plain.frag"}); !s) return s;
  if (Status s = build(oblique, {"frame.glsl", "patch_common.glsl", "patch_oblique.frag"}); !s) return s;
  if (options_.texturing == Texturing::paper) {
    return build(paper, {"frame.glsl", "patch_common.glsl", "patch_exact_point.glsl", "patch_paper.frag"});
  }
  return Done{};
}

void GlobeRenderer::set_up_vertex_array() {
  vertex_array_ = gl::make_vertex_array();
  frame_block_ = gl::make_buffer();
  draws_ = gl::make_buffer();
  commands_ = gl::make_buffer();
  cells_ = gl::make_buffer();
  glNamedBufferStorage(frame_block_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  const GLuint array = vertex_array_.name();
  glVertexArrayElementBuffer(array, patches_.index_buffer());
  glVertexArrayVertexBuffer(array, 1, draws_.name(), 0, sizeof(PatchDraw));
  glVertexArrayBindingDivisor(array, 1, 1);
  const auto attribute = [array](GLuint index, GLuint binding, GLint size, std::size_t offset) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, index, binding);
  };
  attribute(0, 0, 3, offsetof(PatchVertex, position_high_m));
  attribute(1, 0, 3, offsetof(PatchVertex, position_low_m));
  attribute(2, 0, 3, offsetof(PatchVertex, direction));
  attribute(3, 0, 2, offsetof(PatchVertex, offset_deg));
  attribute(4, 1, 4, offsetof(PatchDraw, center_and_scale));
  attribute(5, 1, 4, offsetof(PatchDraw, frame));
  attribute(6, 1, 4, offsetof(PatchDraw, row));
  glEnableVertexArrayAttrib(array, 7);
  glVertexArrayAttribIFormat(array, 7, 4, GL_UNSIGNED_INT, offsetof(PatchDraw, window));
  glVertexArrayAttribBinding(array, 7, 1);
}

void GlobeRenderer::set_up_samplers() {
  bilinear_ = sampler(GL_LINEAR, GL_CLAMP_TO_EDGE);
  // No look-up leaves the slot, so the wrap mode changes no texel; but Mesa's software rasteriser blends texels with
  // eight bits for the common modes and in float for this one.
  precise_ = sampler(GL_LINEAR, GL_MIRRORED_REPEAT);
  mipmapped_ = sampler(GL_LINEAR_MIPMAP_LINEAR, GL_CLAMP_TO_EDGE);
  cells_texture_ = gl::make_texture(GL_TEXTURE_BUFFER);
}

void GlobeRenderer::resize(Viewport viewport) {
  if (size_.width_px == viewport.width_px && size_.height_px == viewport.height_px) return;
  size_ = viewport;
  color_ = gl::make_texture(GL_TEXTURE_2D);
  depth_ = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(color_.name(), 1, GL_RGBA8, viewport.width_px, viewport.height_px);
  glTextureStorage2D(depth_.name(), 1, GL_DEPTH_COMPONENT32F, viewport.width_px, viewport.height_px);
  glTextureParameteri(color_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  framebuffer_ = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
}

void GlobeRenderer::upload_frame(const FrameInput& input, const SlotLayout& layout, int mips) {
  const View& view = input.view;
  const Ellipsoid& e = tree_.ellipsoid();
  const double height = std::abs(e.to_geodetic(view.eye).height_m);
  const double near_m = std::max(0.1 * height, 0.05);
  const double far_m = glm::length(view.eye.xyz_m) + 1.5 * e.a_m();
  const SplitPosition eye = split_position(view.eye.xyz_m);
  FrameBlock block;
  block.view_from_ecef = glm::mat4(glm::mat3(view_from_ecef_rotation(view)));
  block.eye_high_ecef = glm::vec4(eye.high, 0.0F);
  block.eye_low_ecef = glm::vec4(eye.low, 0.0F);
  block.clip_scale = glm::vec4(1.0 / (view.tan_half_fov_y * view.aspect()), 1.0 / view.tan_half_fov_y, near_m, far_m);
  block.sun_ecef = glm::vec4(glm::vec3(input.sun), input.lit ? 1.0F : 0.0F);
  const double polar_scale = tree_.grid().latitude == LatitudeKind::centric ? e.one_minus_e2() : 1.0;
  block.texels = glm::vec4(double(layout.tile_px) / layout.slot_px(), layout.slot_px(), mips, polar_scale);
  block.paper = glm::vec4(options_.paper_a, options_.paper_band,
                          tree_.grid().projection == Projection::equal_area ? 1.0 : 0.0, 0.0);
  glNamedBufferSubData(frame_block_.name(), 0, sizeof(block), &block);
}

GlobeRenderer::PatchProgram GlobeRenderer::program_for(const SelectedPatch& patch) const {
  switch (options_.texturing) {
    case Texturing::exact:
      return polar;
    case Texturing::automatic:
      if (patch.in_band) return polar;
      break;
    case Texturing::paper:
      if (patch.node->min_colatitude_rad < options_.paper_band * 3.14159265358979) return paper;
      break;
    case Texturing::vertex:
      break;
  }
  if (patch.footprint_texels < kMagnifiedFootprint_texels) return magnified;
  return patch.footprint_texels > kPlainFootprint_texels ? oblique : plain;
}

void GlobeRenderer::upload_draws(const FrameInput& input, FrameCounts& counts) {
  std::vector<DrawCommand> by_program[kPatchPrograms];
  const auto& patches = *input.patches;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const SelectedPatch& patch = patches[k];
    const PatchIndices::Range range =
        patches_.indices().ranges[forward_diagonal(patch.node->id) ? 1 : 0][patch.coarse_sides];
    const int place = patches_.place_of(*patch.node, input.frame);
    by_program[program_for(patch)].push_back(
        {range.count, 1, range.first, place * patches_.vertices_per_patch(), static_cast<GLuint>(k)});
    counts.triangles += range.count / 3;
  }
  std::vector<DrawCommand> commands;
  for (int p = 0; p < kPatchPrograms; ++p) {
    first_command_[p] = static_cast<int>(commands.size());
    commands.insert(commands.end(), by_program[p].begin(), by_program[p].end());
  }
  first_command_[kPatchPrograms] = static_cast<int>(commands.size());
  stream(commands_, commands);
  stream(draws_, input.coverage->draws);
  stream(cells_, input.coverage->cells);
  glTextureBuffer(cells_texture_.name(), GL_R32UI, cells_.name());
}

void GlobeRenderer::bind_state(const FrameInput& input, TileTextures& tiles) const {
  const bool reversed = options_.depth == DepthMode::reversed;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, size_.width_px, size_.height_px);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glDepthMask(GL_TRUE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClearDepth(reversed ? 0.0 : 1.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(reversed ? GL_GREATER : GL_LESS);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glCullFace(inside_body(tree_.ellipsoid(), input.view.eye) ? GL_FRONT : GL_BACK);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  glBindTextureUnit(1, cells_texture_.name());
  glBindSampler(1, 0);
  for (GLuint unit : {0U, 2U, 3U}) glBindTextureUnit(unit, tiles.texture());
  glBindSampler(0, bilinear_.name());
  glBindSampler(2, mipmapped_.name());
  glBindSampler(3, precise_.name());
}

void GlobeRenderer::draw_patches(FrameCounts& counts) const {
  glVertexArrayVertexBuffer(vertex_array_.name(), 0, patches_.vertex_buffer(), 0, sizeof(PatchVertex));
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
  for (int p = 0; p < kPatchPrograms; ++p) {
    const int count = first_command_[p + 1] - first_command_[p];
    if (count == 0) continue;
    glUseProgram(programs_[p].name());
    const auto offset = static_cast<std::uintptr_t>(first_command_[p]) * sizeof(DrawCommand);
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset), count, 0);
    ++counts.draw_calls;
  }
}

FrameCounts GlobeRenderer::draw(const FrameInput& input, TileTextures& tiles, const SlotLayout& layout,
                                GLuint framebuffer) {
  FrameCounts counts;
  resize(input.view.viewport);
  upload_frame(input, layout, tiles.mips());
  upload_draws(input, counts);
  bind_state(input, tiles);
  draw_patches(counts);
  glBlitNamedFramebuffer(framebuffer_.name(), framebuffer, 0, 0, size_.width_px, size_.height_px, 0, 0, size_.width_px,
                         size_.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  counts.draw_calls += limb_->draw(input.view, tree_.ellipsoid(), color_.name());
  return counts;
}

}  // namespace terrella
