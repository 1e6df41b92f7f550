#include "render/object_pass.h"

#include <cstddef>

#include "render/gl_driver.h"
#include "render/shader_library.h"
#include "render/vertex_attribute.h"

namespace terrella {
namespace {

// Part of its distance that what lies on the ground is drawn nearer: more than depth's own steps, and than the ground's
// mesh lies under the ellipsoid.
constexpr float kGroundBias = 1.0e-4F;
// Fewer spheres are drawn as triangles on software GL too.
constexpr std::size_t kFewestSplats = 2048;
constexpr GLint kViewportUniform = 0;
constexpr GLint kBiasUniform = 1;
constexpr GLint kHidingUniform = 2;

void color_attribute(GLuint array, GLuint index, GLuint binding, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, 4, GL_UNSIGNED_BYTE, GL_TRUE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

gl::VertexArray dot_array() {
  gl::VertexArray array = gl::make_vertex_array();
  gl::float_attribute(array.name(), 0, 0, 3, offsetof(DotInstance, high_m));
  gl::float_attribute(array.name(), 1, 0, 3, offsetof(DotInstance, low_m));
  gl::float_attribute(array.name(), 2, 0, 1, offsetof(DotInstance, size));
  color_attribute(array.name(), 3, 0, offsetof(DotInstance, color));
  glVertexArrayBindingDivisor(array.name(), 0, 1);
  return array;
}

template <class T>
gl::Buffer buffer_of(const std::vector<T>& items) {
  if (items.empty()) return {};
  gl::Buffer buffer = gl::make_buffer();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(items.size() * sizeof(T)), items.data(), 0);
  return buffer;
}

template <class T>
Batch<char> ranges_of(const Batch<T>& batch) {
  return {{}, batch.first};
}

}  // namespace

Result<std::unique_ptr<ObjectPass>> ObjectPass::create(DepthMode depth, SpherePath path) {
  std::unique_ptr<ObjectPass> pass(new ObjectPass);
  if (const Status built = pass->build_programs(depth); !built) return built.error();
  pass->splat_ = path == SpherePath::splats || (path == SpherePath::automatic && is_software_gl());
  pass->fewest_splats_ = path == SpherePath::splats ? 1 : kFewestSplats;
  if (pass->splat_) {
    if (const Status built = pass->splats_.create(depth); !built) return built.error();
  }
  pass->depth_ = depth;
  pass->set_up_arrays();
  return pass;
}

Status ObjectPass::build_programs(DepthMode depth) {
  const auto build = [depth](gl::Program& program, std::string_view vertex, std::string_view fragment) -> Status {
    auto built = build_program({{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", vertex}},
                                {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", fragment}}},
                               {depth_define(depth)});
    if (!built) return built.error();
    program = std::move(*built);
    return Done{};
  };
  if (Status s = build(fill_, "object_fill.vert", "object_fill.frag"); !s) return s;
  if (Status s = build(sphere_, "object_sphere.vert", "object_sphere.frag"); !s) return s;
  if (Status s = build(line_, "object_line.vert", "object_line.frag"); !s) return s;
  return build(marker_, "object_marker.vert", "object_marker.frag");
}

void ObjectPass::set_up_arrays() {
  sphere_array_ = dot_array();
  marker_array_ = dot_array();
  fill_array_ = gl::make_vertex_array();
  gl::float_attribute(fill_array_.name(), 0, 0, 3, offsetof(FillVertex, high_m));
  gl::float_attribute(fill_array_.name(), 1, 0, 3, offsetof(FillVertex, low_m));
  color_attribute(fill_array_.name(), 2, 0, offsetof(FillVertex, color));
  line_array_ = gl::make_vertex_array();
  const GLuint lines = line_array_.name();
  for (GLuint k = 0; k < 4; ++k) {  // the vertex before, this one, the next and the one after that
    gl::float_attribute(lines, 2 * k, k, 3, offsetof(LineVertex, high_m));
    gl::float_attribute(lines, 2 * k + 1, k, 3, offsetof(LineVertex, low_m));
    glVertexArrayBindingDivisor(lines, k, 1);
  }
  gl::float_attribute(lines, 8, 1, 1, offsetof(LineVertex, width_px));
  color_attribute(lines, 9, 1, offsetof(LineVertex, color));
}

void ObjectPass::set_objects(const ObjectBatches& batches) {
  fill_vertices_ = buffer_of(batches.fill_vertices);
  fill_indices_ = buffer_of(batches.fill_indices.items);
  spheres_ = buffer_of(batches.spheres.items);
  lines_ = buffer_of(batches.lines.items);
  markers_ = buffer_of(batches.markers.items);
  fill_ranges_ = ranges_of(batches.fill_indices);
  sphere_ranges_ = ranges_of(batches.spheres);
  line_ranges_ = ranges_of(batches.lines);
  marker_ranges_ = ranges_of(batches.markers);
  if (splat_) splats_.set_spheres(batches.spheres);
  glVertexArrayVertexBuffer(fill_array_.name(), 0, fill_vertices_.name(), 0, sizeof(FillVertex));
  glVertexArrayElementBuffer(fill_array_.name(), fill_indices_.name());
  glVertexArrayVertexBuffer(sphere_array_.name(), 0, spheres_.name(), 0, sizeof(DotInstance));
  glVertexArrayVertexBuffer(marker_array_.name(), 0, markers_.name(), 0, sizeof(DotInstance));
  for (GLuint k = 0; k < 4; ++k) {
    glVertexArrayVertexBuffer(line_array_.name(), k, lines_.name(), static_cast<GLintptr>(k * sizeof(LineVertex)),
                              sizeof(LineVertex));
  }
}

Status ObjectPass::set_labels(const std::vector<LabelObject>& labels, const Ellipsoid& ellipsoid) {
  has_labels_above_ = has_labels_underground_ = false;
  if (font_.empty() || (labels.empty() && !labels_)) return Done{};
  if (!labels_) {
    auto made = LabelPass::create(depth_, font_);
    if (!made) return made.error();
    labels_ = std::move(*made);
  }
  for (const LabelObject& label : labels) (is_underground(label) ? has_labels_underground_ : has_labels_above_) = true;
  labels_->set_labels(labels, ellipsoid);
  return Done{};
}

Status ObjectPass::set_meshes(const std::vector<MeshObject>& meshes, const Ellipsoid& ellipsoid) {
  if (meshes.empty() && !meshes_) return Done{};
  if (!meshes_) {
    auto made = MeshPass::create(depth_);
    if (!made) return made.error();
    meshes_ = std::move(*made);
  }
  meshes_->set_meshes(meshes, ellipsoid);
  return Done{};
}

bool ObjectPass::has(ObjectPart part) const {
  if (part == ObjectPart::above_ground ? has_labels_above_ : has_labels_underground_) return true;
  if (meshes_ && meshes_->has(part)) return true;
  for (const bool opaque : {true, false}) {
    for (const Ranges* ranges : {&fill_ranges_, &sphere_ranges_, &line_ranges_, &marker_ranges_}) {
      if (ranges->range(part, opaque, ObjectChoice::all).count > 0) return true;
    }
  }
  return false;
}

int ObjectPass::draw(ObjectPart part, const FrameBlock& frame, Viewport viewport, ObjectChoice choice,
                     double hiding_radius_m) {
  if (!has(part)) return 0;
  const float bias = part == ObjectPart::above_ground ? kGroundBias : 0.0F;
  for (const gl::Program* program : {&fill_, &sphere_, &line_, &marker_}) {
    glProgramUniform2f(program->name(), kViewportUniform, float(viewport.width_px), float(viewport.height_px));
    glProgramUniform1f(program->name(), kBiasUniform, bias);
  }
  for (const gl::Program* program : {&sphere_, &marker_}) {
    glProgramUniform1f(program->name(), kHidingUniform, static_cast<float>(hiding_radius_m));
  }
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  int calls = 0;
  // Areas lie on the ground: everything else is over them.
  for (const bool opaque : {true, false}) {
    glDepthMask(opaque ? GL_TRUE : GL_FALSE);
    calls += draw_fills(part, opaque, choice);
  }
  for (const bool opaque : {true, false}) {
    glDepthMask(opaque ? GL_TRUE : GL_FALSE);
    if (meshes_) calls += meshes_->draw(part, opaque, choice, bias);
    calls += draw_spheres(part, opaque, choice, frame, viewport, hiding_radius_m);
    calls += draw_lines(part, opaque, choice);
    calls += draw_dots(marker_ranges_, marker_array_, marker_, part, opaque, choice);
  }
  if (labels_) {
    calls += labels_->draw(part, choice, viewport, bias);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return calls;
}

int ObjectPass::draw_fills(ObjectPart part, bool opaque, ObjectChoice choice) const {
  const auto range = fill_ranges_.range(part, opaque, choice);
  if (range.count == 0) return 0;
  glUseProgram(fill_.name());
  glBindVertexArray(fill_array_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(range.first * sizeof(std::uint32_t)));
  return 1;
}

int ObjectPass::draw_dots(const Ranges& ranges, const gl::VertexArray& array, const gl::Program& program,
                          ObjectPart part, bool opaque, ObjectChoice choice) const {
  const auto range = ranges.range(part, opaque, choice);
  if (range.count == 0) return 0;
  glUseProgram(program.name());
  glBindVertexArray(array.name());
  glDrawArraysInstancedBaseInstance(GL_TRIANGLES, 0, 3, static_cast<GLsizei>(range.count),
                                    static_cast<GLuint>(range.first));
  return 1;
}

int ObjectPass::draw_spheres(ObjectPart part, bool opaque, ObjectChoice choice, const FrameBlock& frame,
                             Viewport viewport, double hiding_radius_m) {
  const auto range = sphere_ranges_.range(part, opaque, choice);
  if (!splat_ || !opaque || range.count < fewest_splats_ ||
      !splats_.prepare(range.first, range.count, frame, viewport, hiding_radius_m)) {
    return draw_dots(sphere_ranges_, sphere_array_, sphere_, part, opaque, choice);
  }
  int calls = 0;
  if (splats_.large_count() > 0) {
    glUseProgram(sphere_.name());
    glBindVertexArray(sphere_array_.name());
    glVertexArrayVertexBuffer(sphere_array_.name(), 0, splats_.large_buffer(), 0, sizeof(DotInstance));
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, splats_.large_count());
    glVertexArrayVertexBuffer(sphere_array_.name(), 0, spheres_.name(), 0, sizeof(DotInstance));
    calls = 1;
  }
  return calls + splats_.draw(viewport);
}

int ObjectPass::draw_lines(ObjectPart part, bool opaque, ObjectChoice choice) const {
  constexpr std::size_t kVerticesOfAPiece = 4;
  const auto range = line_ranges_.range(part, opaque, choice);
  if (range.count < kVerticesOfAPiece) return 0;
  glUseProgram(line_.name());
  glBindVertexArray(line_array_.name());
  glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(range.count - kVerticesOfAPiece + 1),
                                    static_cast<GLuint>(range.first));
  return 1;
}

}  // namespace terrella
