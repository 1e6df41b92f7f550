#include "render/objects/mesh_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "render/gl/storage.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

constexpr GLint kMeshBiasUniform = 1;
constexpr GLint kMeshColorUniform = 3;
constexpr GLint kMeshCutoffUniform = 4;
constexpr GLuint kStandBinding = 1;

gl::Texture texture_of(const std::uint8_t* rgba, int width_px, int height_px) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  const int levels = 1 + static_cast<int>(std::log2(std::max(width_px, height_px)));
  glTextureStorage2D(texture.name(), levels, GL_SRGB8_ALPHA8, width_px, height_px);
  if (!gl::has_storage(texture)) return {};
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.name(), 0, 0, 0, width_px, height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  glGenerateTextureMipmap(texture.name());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return texture;
}

}  // namespace

Result<std::unique_ptr<MeshPass>> MeshPass::create(DepthMode depth) {
  std::unique_ptr<MeshPass> pass(new MeshPass);
  if (Status s = build_object_program(pass->program_, "object_mesh.vert", "object_mesh.frag", depth); !s)
    return s.error();
  constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
  pass->white_ = texture_of(kWhite.data(), 1, 1);
  return pass;
}

MeshPass::Part MeshPass::upload(const MeshPart& part) {
  Part made;
  made.vertices = buffer_of(part.vertices);
  made.indices = buffer_of(part.indices);
  made.count = static_cast<GLsizei>(part.indices.size());
  made.color_linear = part.color_linear;
  made.cutoff = part.cutoff;
  made.translucent = part.translucent;
  made.array = gl::make_vertex_array();
  const GLuint array = made.array.name();
  gl::float_attribute(array, 0, 0, 3, offsetof(MeshVertex, position_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(MeshVertex, normal));
  gl::float_attribute(array, 2, 0, 2, offsetof(MeshVertex, uv));
  gl::float_attribute(array, 3, 0, 4, offsetof(MeshVertex, color_linear));
  gl::float_attribute(array, 4, kStandBinding, 3, offsetof(MeshStand, high_m));
  gl::float_attribute(array, 5, kStandBinding, 3, offsetof(MeshStand, low_m));
  for (GLuint k = 0; k < 3; ++k) {
    gl::float_attribute(array, 6 + k, kStandBinding, 3, offsetof(MeshStand, ecef_from_model) + k * sizeof(glm::vec3));
  }
  gl::color_attribute(array, 9, kStandBinding, offsetof(MeshStand, tint));
  glVertexArrayVertexBuffer(array, 0, made.vertices.name(), 0, sizeof(MeshVertex));
  glVertexArrayBindingDivisor(array, kStandBinding, 1);
  glVertexArrayElementBuffer(array, made.indices.name());
  return made;
}

bool MeshPass::upload(std::shared_ptr<const MeshModel> model, Model& made) const {
  std::map<const MeshTexture*, GLuint> textures;
  for (const MeshPart& part : model->parts) {
    const Part& put = made.parts.emplace_back(upload(part));
    if (!gl::has_storage(put.vertices, part.vertices.size() * sizeof(MeshVertex)) ||
        !gl::has_storage(put.indices, part.indices.size() * sizeof(std::uint32_t))) {
      return false;
    }
    made.parts.back().texture = white_.name();
    if (!part.texture) continue;
    const auto [found, first] = textures.try_emplace(part.texture.get(), 0);
    if (first) {
      made.textures.push_back(texture_of(part.texture->rgba.data(), part.texture->width_px, part.texture->height_px));
      found->second = made.textures.back().name();
    }
    if (found->second == 0) return false;
    made.parts.back().texture = found->second;
  }
  made.model = std::move(model);
  return true;
}

bool MeshPass::upload(const DrawnLayer& layer) {
  bool has_memory = true;
  for (const ModelStands& stands : layer.objects->batches().models) {
    const auto [found, first] = models_.try_emplace(stands.model.get());
    found->second.used = true;
    if (!first || upload(stands.model, found->second)) continue;
    models_.erase(found);
    has_memory = false;
  }
  return has_memory;
}

void MeshPass::free_unused() {
  std::erase_if(models_, [](const auto& model) { return !model.second.used; });
  for (auto& [model, made] : models_) made.used = false;
}

int MeshPass::draw(const DrawnLayer& layer, const ObjectDraw& draw) const {
  glProgramUniform1f(program_.name(), kMeshBiasUniform, draw.depth_bias);
  DrawState state = draw.state.with(program_.name());
  int calls = 0;
  const auto [first, end] = buckets_of(draw.part, true, draw.choice);  // each part of a model states its own opacity
  const std::vector<ModelStands>& models = layer.objects->batches().models;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const Model& model = models_.at(models[k].model.get());
    for (std::size_t bucket = first; bucket < end; ++bucket) {
      const std::size_t count = models[k].stands.bucket(bucket).items.size();
      if (count == 0) continue;
      const Places places{layer.buffers->stands[k][bucket].name(), static_cast<GLsizei>(count),
                          static_cast<float>(layer.objects->opacity())};
      if (draw.opaque) {
        calls += draw_parts(model, places, true, state);
        continue;
      }
      // Faces away from the eye are drawn first. For convex models this is back to front for every order of triangles.
      for (const GLenum left_out : {GL_FRONT, GL_BACK}) {
        state.cull = left_out;
        calls += draw_parts(model, places, false, state);
      }
    }
  }
  return calls;
}

int MeshPass::draw_parts(const Model& model, const Places& places, bool opaque, const DrawState& state) {
  int calls = 0;
  apply(state);
  for (const Part& part : model.parts) {
    const bool translucent = part.translucent || places.opacity < 1.0F;
    if (translucent == opaque) continue;
    const glm::vec4& color = part.color_linear;
    glUniform4f(kMeshColorUniform, color.x, color.y, color.z, color.w * places.opacity);
    glUniform2f(kMeshCutoffUniform, part.cutoff * places.opacity, translucent ? 1.0F : 0.0F);
    glBindTextureUnit(0, part.texture);
    glBindSampler(0, 0);
    glVertexArrayVertexBuffer(part.array.name(), kStandBinding, places.buffer, 0, sizeof(MeshStand));
    glBindVertexArray(part.array.name());
    glDrawElementsInstanced(GL_TRIANGLES, part.count, GL_UNSIGNED_INT, nullptr, places.count);
    ++calls;
  }
  return calls;
}

}  // namespace terrella
