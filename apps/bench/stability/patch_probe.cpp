#include "apps/bench/stability/patch_probe.h"

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "render/frame_camera.h"
#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella::bench {
namespace {

constexpr int kSegments = 24;

TileGrid grid_to(int max_level) {
  TileGrid grid;
  grid.max_level = max_level;
  return grid;
}

Result<gl::Program> window_program(ShaderFunctions functions) {
  return build_program({{GL_VERTEX_SHADER, {"frame.glsl", "patch.vert"}},
                        {GL_FRAGMENT_SHADER,
                         {"frame.glsl", "functions.glsl", "air.glsl", "patch_common.glsl", "patch_taps.glsl",
                          "patch_exact_point.glsl", "probe_window.frag"}}},
                       {depth_define(DepthMode::reversed), functions_define(functions)});
}

// A program without a fragment stage only records vertices.
Result<gl::Program> feedback_program() {
  return build_program({{GL_VERTEX_SHADER, {"frame.glsl", "patch.vert"}}}, {depth_define(DepthMode::reversed)},
                       {"gl_Position"});
}

gl::Texture target(GLenum format, Viewport size) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.width_px, size.height_px);
  return texture;
}

template <class T>
std::vector<T> read(const gl::Texture& texture, GLenum format, GLenum type, std::size_t count) {
  std::vector<T> all(count);
  glGetTextureImage(texture.name(), 0, format, type, static_cast<GLsizei>(count * sizeof(T)), all.data());
  return all;
}

void set_state(Viewport size) {
  glViewport(0, 0, size.width_px, size.height_px);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  for (const GLenum state : {GL_BLEND, GL_STENCIL_TEST, GL_SCISSOR_TEST}) glDisable(state);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
}

}  // namespace

PatchScene::PatchScene(const Camera& camera, Viewport size, int max_level, const Body& body)
    : tree(body.ellipsoid, grid_to(max_level), kSegments), view(make_view(camera, body.ellipsoid, size)) {
  select_patches(tree, view, {}, patches);
  for (const SelectedPatch& patch : patches) {
    const std::vector<PatchVertex> more = patch_vertices(tree, *patch.node);
    vertices.insert(vertices.end(), more.begin(), more.end());
  }
}

std::size_t PatchScene::vertices_per_patch() const {
  return static_cast<std::size_t>(kSegments + 1) * static_cast<std::size_t>(kSegments + 1);
}

glm::dvec3 PatchScene::position_m(std::size_t vertex) const {
  return glm::dvec3(vertices[vertex].position_high_m) + glm::dvec3(vertices[vertex].position_low_m);
}

Result<PatchProbe> PatchProbe::create(ShaderFunctions functions) {
  PatchProbe probe;
  Result<gl::Program> window = window_program(functions);
  if (!window) return window.error();
  Result<gl::Program> feedback = feedback_program();
  if (!feedback) return feedback.error();
  probe.window_program_ = *std::move(window);
  probe.feedback_program_ = *std::move(feedback);
  probe.triangles_ = patch_indices(kSegments);
  probe.array_ = gl::make_vertex_array();
  probe.pixel_ = target(GL_RGBA8, {1, 1});
  probe.somewhere_ = gl::make_framebuffer();
  glNamedFramebufferTexture(probe.somewhere_.name(), GL_COLOR_ATTACHMENT0, probe.pixel_.name(), 0);
  probe.indices_ = gl::make_buffer();
  probe.frame_ = gl::make_buffer();
  probe.feedback_ = gl::make_buffer();
  const auto& indices = probe.triangles_.indices;
  glNamedBufferStorage(probe.indices_.name(), static_cast<GLsizeiptr>(indices.size() * sizeof(indices[0])),
                       indices.data(), 0);
  glNamedBufferStorage(probe.frame_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  const GLuint array = probe.array_.name();
  glVertexArrayElementBuffer(array, probe.indices_.name());
  gl::float_attribute(array, 0, 0, 3, offsetof(PatchVertex, position_high_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(PatchVertex, position_low_m));
  gl::float_attribute(array, 2, 0, 3, offsetof(PatchVertex, direction));
  gl::float_attribute(array, 3, 0, 2, offsetof(PatchVertex, offset_deg));
  return probe;
}

void PatchProbe::load(PatchScene& scene) {
  scene_ = &scene;
  vertices_ = gl::make_buffer();
  glNamedBufferStorage(vertices_.name(), static_cast<GLsizeiptr>(scene.vertices.size() * sizeof(PatchVertex)),
                       scene.vertices.data(), 0);
  glVertexArrayVertexBuffer(array_.name(), 0, vertices_.name(), 0, sizeof(PatchVertex));
  glNamedBufferData(feedback_.name(), static_cast<GLsizeiptr>(scene.vertices.size() * sizeof(glm::vec4)), nullptr,
                    GL_STREAM_READ);
  const TileResidency none;
  TileCoverage coverage;
  TreeGrowth growth(scene.tree);
  cover_with_tiles(
      {.tree = scene.tree, .growth = growth, .view = scene.view, .patches = scene.patches, .residency = none},
      coverage);
  scene.tree.adopt(growth);
  draws_ = std::move(coverage.draws);
}

void PatchProbe::upload_frame(const View& view) {
  const double height_m = std::abs(scene_->tree.ellipsoid().to_geodetic(view.eye).height_m);
  const double far_m = glm::length(view.eye.xyz_m) + 1.5 * scene_->tree.ellipsoid().a_m();
  FrameBlock block = frame_of_camera(view, 0.1 * height_m, far_m);
  block.texels.w = 1.0F;
  glNamedBufferSubData(frame_.name(), 0, sizeof(block), &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.name());
  glBindVertexArray(array_.name());
}

void PatchProbe::set_patch(std::size_t patch) const {
  const PatchDraw& draw = draws_[patch];
  glVertexAttrib4fv(4, glm::value_ptr(draw.center_and_scale));
  glVertexAttrib4fv(5, glm::value_ptr(draw.frame));
  glVertexAttrib4fv(6, glm::value_ptr(draw.row));
  glVertexAttribI4ui(7, static_cast<GLuint>(patch) + 1, draw.window.y, draw.window.z, draw.window.w);
}

std::vector<glm::vec4> PatchProbe::positions(const View& view) {
  upload_frame(view);
  glBindFramebuffer(GL_FRAMEBUFFER, somewhere_.name());
  glUseProgram(feedback_program_.name());
  glEnable(GL_RASTERIZER_DISCARD);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback_.name());
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(scene_->vertices.size()));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  std::vector<glm::vec4> clip(scene_->vertices.size());
  glGetNamedBufferSubData(feedback_.name(), 0, static_cast<GLsizeiptr>(clip.size() * sizeof(glm::vec4)), clip.data());
  return clip;
}

void PatchProbe::draw_patches() {
  upload_frame(scene_->view);
  glUseProgram(window_program_.name());
  for (std::size_t k = 0; k < scene_->patches.size(); ++k) {
    set_patch(k);
    const SelectedPatch& drawn = scene_->patches[k];
    const PatchIndices::Range range = triangles_.ranges[forward_diagonal(drawn.node->id) ? 1 : 0][drawn.coarse_sides];
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_SHORT,
                             reinterpret_cast<const void*>(range.first * sizeof(std::uint16_t)),
                             static_cast<GLint>(k * scene_->vertices_per_patch()));
  }
}

std::vector<WindowPixel> PatchProbe::window_pixels() {
  const Viewport size = scene_->view.viewport;
  const gl::Texture points = target(GL_RGBA32F, size), patches = target(GL_R32UI, size);
  const gl::Texture depth = target(GL_DEPTH_COMPONENT32F, size);
  const gl::Framebuffer framebuffer = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, points.name(), 0);
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT1, patches.name(), 0);
  glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  const GLenum outputs[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(framebuffer.name(), 2, outputs);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  set_state(size);
  const GLfloat nothing_near = 0.0F;
  const GLuint no_patch[4] = {};
  glClearBufferfv(GL_DEPTH, 0, &nothing_near);
  glClearBufferuiv(GL_COLOR, 1, no_patch);
  draw_patches();
  const auto count = static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px);
  const std::vector<glm::vec4> all_points = read<glm::vec4>(points, GL_RGBA, GL_FLOAT, count);
  const std::vector<GLuint> all_patches = read<GLuint>(patches, GL_RED_INTEGER, GL_UNSIGNED_INT, count);
  std::vector<WindowPixel> pixels(count);
  for (std::size_t k = 0; k < count; ++k) pixels[k] = {all_points[k], all_patches[k]};
  return pixels;
}

}  // namespace terrella::bench
