#include "render/objects/object_pass.h"

#include <algorithm>
#include <cstddef>

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
  if (Status s = build_object_program(fill_, "object_fill.vert", "object_fill.frag", depth); !s) return s;
  if (Status s = build_object_program(line_, "object_line.vert", "object_line.frag", depth); !s) return s;
  return build_object_program(marker_, "object_marker.vert", "object_marker.frag", depth);
}

void ObjectPass::set_up_arrays() {
  marker_array_ = dot_array(1);
  fill_array_ = gl::make_vertex_array();
  gl::float_attribute(fill_array_.name(), 0, 0, 3, offsetof(FillVertex, high_m));
  gl::float_attribute(fill_array_.name(), 1, 0, 3, offsetof(FillVertex, low_m));
  gl::color_attribute(fill_array_.name(), 2, 0, offsetof(FillVertex, color));
  line_array_ = line_pieces_array();
}

void ObjectPass::set_layers(std::vector<DrawnLayer> layers) {
  given_ = std::move(layers);
  layers_ = given_;
  planned_.clear();
}

Status ObjectPass::prepare() {
  for (const DrawnLayer& layer : given_) {
    if (!labels_ && !font_.empty() && !layer.objects->labels().empty()) {
      auto made = LabelPass::create(depth_, font_);
      if (!made) return made.error();
      labels_ = std::move(*made);
    }
    if (!meshes_ && !layer.objects->batches().models.empty()) {
      auto made = MeshPass::create(depth_);
      if (!made) return made.error();
      meshes_ = std::move(*made);
    }
    if (!solids_ && SolidPass::is_needed(layer)) {
      auto made = SolidPass::create(depth_);
      if (!made) return made.error();
      solids_ = std::move(*made);
    }
    if (!icons_ && !layer.objects->batches().icon_images.empty()) {
      auto made = IconPass::create(depth_);
      if (!made) return made.error();
      icons_ = std::move(*made);
    }
  }
  return Done{};
}

std::u32string ObjectPass::without_font() const {
  return labels_ ? std::u32string(labels_->without_font().begin(), labels_->without_font().end()) : std::u32string();
}

void ObjectPass::upload() {
  std::vector<DrawnLayer> on_gpu;
  for (const DrawnLayer& layer : given_) {
    if (layer.buffers->follow(*layer.objects) && (!meshes_ || meshes_->upload(layer))) on_gpu.push_back(layer);
  }
  if (meshes_) meshes_->free_unused();
  if (on_gpu.size() != layers_.size() || on_gpu.size() < given_.size()) planned_.clear();
  layers_ = std::move(on_gpu);
  plan_fills();
}

// Areas of all layers are drawn from the lowest to the highest, so that translucent areas seen from above are blended
// in the right order. Areas of equal height keep the order of their layers.
void ObjectPass::plan_fills() {
  std::vector<std::uint64_t> versions;
  for (const DrawnLayer& layer : layers_) versions.push_back(layer.objects->batches().fill_version);
  if (versions == planned_) return;
  planned_ = std::move(versions);
  for (std::size_t bucket = 0; bucket < fills_.size(); ++bucket) {
    std::vector<FillDraw> all;
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      for (const FillRun& run : layers_[k].objects->batches().fill_runs[bucket]) all.push_back({k, run});
    }
    std::ranges::stable_sort(all, {}, [](const FillDraw& draw) { return draw.run.height_m; });
    std::vector<FillDraw>& fills = fills_[bucket];
    fills.clear();
    for (const FillDraw& draw : all) {
      const bool goes_on = !fills.empty() && fills.back().layer == draw.layer &&
                           fills.back().run.first + fills.back().run.count == draw.run.first;
      if (goes_on) {
        fills.back().run.count += draw.run.count;
      } else {
        fills.push_back(draw);
      }
    }
  }
}

bool ObjectPass::has(ObjectPart part) const {
  return std::ranges::any_of(layers_, [part](const DrawnLayer& layer) { return layer.objects->has(part); });
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
    ObjectDraw casing = draw;
    if (casing.state.depth) casing.state.depth->write = false;  // all lines are over it
    for (const DrawnLayer& layer : layers_) calls += solids_ ? solids_->draw(layer, draw) : 0;
    for (const DrawnLayer& layer : layers_) calls += meshes_ ? meshes_->draw(layer, draw) : 0;
    for (const DrawnLayer& layer : layers_) calls += spheres_->draw(layer, draw, frame, viewport, hiding_radius_m);
    for (const DrawnLayer& layer : layers_) {
      calls += draw_lines(layer.objects->batches().casings, layer.buffers->casings, casing);
    }
    for (const DrawnLayer& layer : layers_) {
      calls += draw_lines(layer.objects->batches().lines, layer.buffers->lines, draw);
    }
    for (const DrawnLayer& layer : layers_) calls += draw_markers(layer, draw);
    for (const DrawnLayer& layer : layers_) calls += icons_ ? icons_->draw(layer, draw, viewport, hiding_radius_m) : 0;
  }
  return labels_ ? calls + labels_->draw(translucent, viewport) : calls;
}

int ObjectPass::draw_fills(const ObjectDraw& draw) const {
  int calls = 0;
  const auto [first, end] = buckets_of(draw.part, draw.opaque, draw.choice);
  for (std::size_t bucket = first; bucket < end; ++bucket) {
    for (const auto& [layer, run] : fills_[bucket]) {
      const LayerBuffers& buffers = *layers_[layer].buffers;
      if (calls++ == 0) apply(draw.state.with(fill_.name()));
      glBindVertexArray(fill_array_.name());
      glVertexArrayVertexBuffer(fill_array_.name(), 0, buffers.fill_vertices[bucket].name(), 0, sizeof(FillVertex));
      glVertexArrayElementBuffer(fill_array_.name(), buffers.fill_indices[bucket].name());
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(run.first * sizeof(std::uint32_t)));
    }
  }
  return calls;
}

int ObjectPass::draw_markers(const DrawnLayer& layer, const ObjectDraw& draw) const {
  int calls = 0;
  const auto [first, end] = buckets_of(draw.part, draw.opaque, draw.choice);
  for (std::size_t bucket = first; bucket < end; ++bucket) {
    const std::size_t count = layer.objects->batches().markers.bucket(bucket).items.size();
    if (count == 0) continue;
    if (calls++ == 0) apply(draw.state.with(marker_.name()));
    glBindVertexArray(marker_array_.name());
    glVertexArrayVertexBuffer(marker_array_.name(), 0, layer.buffers->markers[bucket].name(), 0, sizeof(DotInstance));
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, static_cast<GLsizei>(count));
  }
  return calls;
}

int ObjectPass::draw_lines(const SlotBatch<LineVertex>& lines, const LayerBuffers::Buckets& buffers,
                           const ObjectDraw& draw) const {
  int calls = 0;
  const auto [first, end] = buckets_of(draw.part, draw.opaque, draw.choice);
  for (std::size_t bucket = first; bucket < end; ++bucket) {
    const std::size_t count = lines.bucket(bucket).items.size();
    if (count < kVerticesOfAPiece) continue;
    if (calls++ == 0) apply(draw.state.with(line_.name()));
    bind_line_pieces(line_array_, buffers[bucket].name());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count - kVerticesOfAPiece + 1));
  }
  return calls;
}

}  // namespace terrella
