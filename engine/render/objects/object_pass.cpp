#include "render/objects/object_pass.h"

#include <cstddef>

#include "render/gl/shader_library.h"
#include "render/objects/object_common.h"

namespace terrella {
namespace {

// Fraction of the distance by which objects on the ground are drawn nearer. It exceeds the steps of the depth buffer
// and the sag of the ground's mesh under the ellipsoid.
constexpr float kGroundBias = 1.0e-4F;
}  // namespace

Result<std::unique_ptr<ObjectPass>> ObjectPass::create(DepthMode depth) {
  std::unique_ptr<ObjectPass> pass(new ObjectPass);
  if (const Status built = pass->build_programs(depth); !built) return built.error();
  Result<std::unique_ptr<SpherePass>> spheres = SpherePass::create(depth);
  if (!spheres) return spheres.error();
  pass->spheres_ = std::move(*spheres);
  pass->depth_ = depth;
  pass->set_up_arrays();
  return pass;
}

Status ObjectPass::build_programs(DepthMode depth) {
  const auto build = [depth](gl::Program& program, std::string_view vertex, std::string_view fragment) {
    return build_into(
        program,
        {{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", vertex}},
         {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", fragment}}},
        {depth_define(depth)});
  };
  if (Status s = build(fill_, "object_fill.vert", "object_fill.frag"); !s) return s;
  if (Status s = build(line_, "object_line.vert", "object_line.frag"); !s) return s;
  return build(marker_, "object_marker.vert", "object_marker.frag");
}

void ObjectPass::set_up_arrays() {
  marker_array_ = dot_array(1);
  fill_array_ = gl::make_vertex_array();
  gl::float_attribute(fill_array_.name(), 0, 0, 3, offsetof(FillVertex, high_m));
  gl::float_attribute(fill_array_.name(), 1, 0, 3, offsetof(FillVertex, low_m));
  gl::color_attribute(fill_array_.name(), 2, 0, offsetof(FillVertex, color));
  line_array_ = gl::make_vertex_array();
  const GLuint lines = line_array_.name();
  for (GLuint k = 0; k < 4; ++k) {  // the previous vertex, this one, the next and the one after that
    gl::float_attribute(lines, 2 * k, k, 3, offsetof(LineVertex, high_m));
    gl::float_attribute(lines, 2 * k + 1, k, 3, offsetof(LineVertex, low_m));
    glVertexArrayBindingDivisor(lines, k, 1);
  }
  gl::float_attribute(lines, 8, 1, 1, offsetof(LineVertex, width_px));
  gl::color_attribute(lines, 9, 1, offsetof(LineVertex, color));
}

void ObjectPass::set_objects(const ObjectBatches& batches) {
  fill_vertices_ = buffer_of(batches.fill_vertices);
  fill_indices_ = buffer_of(batches.fill_indices.items);
  spheres_->set_spheres(batches.spheres);
  lines_ = buffer_of(batches.lines.items);
  markers_ = buffer_of(batches.markers.items);
  fill_ranges_ = ranges_of(batches.fill_indices);
  line_ranges_ = ranges_of(batches.lines);
  marker_ranges_ = ranges_of(batches.markers);
  glVertexArrayVertexBuffer(fill_array_.name(), 0, fill_vertices_.name(), 0, sizeof(FillVertex));
  glVertexArrayElementBuffer(fill_array_.name(), fill_indices_.name());
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
    for (const Ranges* ranges : {&fill_ranges_, &spheres_->ranges(), &line_ranges_, &marker_ranges_}) {
      if (ranges->range(part, opaque, ObjectChoice::all).count > 0) return true;
    }
  }
  return false;
}

int ObjectPass::draw(ObjectPart part, const FrameBlock& frame, Viewport viewport, const DrawState& state,
                     ObjectChoice choice, double hiding_radius_m) {
  if (!has(part)) return 0;
  const float bias = part == ObjectPart::above_ground ? kGroundBias : 0.0F;
  for (const gl::Program* program : {&fill_, &line_, &marker_}) {
    set_object_uniforms(*program, viewport, bias, hiding_radius_m);
  }
  ObjectDraw opaque{part, true, choice, bias, state};
  opaque.state.cull.reset();
  opaque.state.blend = {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
  ObjectDraw translucent = opaque;
  translucent.opaque = false;
  if (translucent.state.depth) translucent.state.depth->write = false;
  // Areas lie on the ground: everything else is over them.
  int calls = draw_fills(opaque) + draw_fills(translucent);
  for (const ObjectDraw& draw : {opaque, translucent}) {
    if (meshes_) calls += meshes_->draw(draw);
    calls += spheres_->draw(draw, frame, viewport, hiding_radius_m);
    calls += draw_lines(draw);
    calls += draw_markers(draw);
  }
  return labels_ ? calls + labels_->draw(translucent, viewport) : calls;
}

int ObjectPass::draw_fills(const ObjectDraw& draw) const {
  const auto range = fill_ranges_.range(draw.part, draw.opaque, draw.choice);
  if (range.count == 0) return 0;
  apply(draw.state.with(fill_.name()));
  glBindVertexArray(fill_array_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(range.first * sizeof(std::uint32_t)));
  return 1;
}

int ObjectPass::draw_markers(const ObjectDraw& draw) const {
  const auto range = marker_ranges_.range(draw.part, draw.opaque, draw.choice);
  if (range.count == 0) return 0;
  apply(draw.state.with(marker_.name()));
  glBindVertexArray(marker_array_.name());
  glDrawArraysInstancedBaseInstance(GL_TRIANGLES, 0, 3, static_cast<GLsizei>(range.count),
                                    static_cast<GLuint>(range.first));
  return 1;
}

int ObjectPass::draw_lines(const ObjectDraw& draw) const {
  constexpr std::size_t kVerticesOfAPiece = 4;
  const auto range = line_ranges_.range(draw.part, draw.opaque, draw.choice);
  if (range.count < kVerticesOfAPiece) return 0;
  apply(draw.state.with(line_.name()));
  glBindVertexArray(line_array_.name());
  glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(range.count - kVerticesOfAPiece + 1),
                                    static_cast<GLuint>(range.first));
  return 1;
}

}  // namespace terrella
