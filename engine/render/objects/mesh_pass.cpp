#include "render/objects/mesh_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "geo/split_position.h"
#include "render/gl/shader_library.h"
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
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.name(), 0, 0, 0, width_px, height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  glGenerateTextureMipmap(texture.name());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return texture;
}

/// Returns the directions of a model's x (left), y (up) and z (forward) at its place. Each is as long as a metre of the
/// model.
std::array<glm::vec3, 3> axes_of(const MeshObject& mesh) {
  const double sin_lat = std::sin(mesh.place.lat.rad()), cos_lat = std::cos(mesh.place.lat.rad());
  const double sin_lon = std::sin(mesh.place.lon.rad()), cos_lon = std::cos(mesh.place.lon.rad());
  const glm::dvec3 up(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat), east(-sin_lon, cos_lon, 0.0);
  const glm::dvec3 north(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
  const double s = std::sin(mesh.heading.rad()), c = std::cos(mesh.heading.rad());
  const glm::dvec3 forward = s * east + c * north, left = s * north - c * east;
  return {glm::vec3(mesh.scale * left), glm::vec3(mesh.scale * up), glm::vec3(mesh.scale * forward)};
}

}  // namespace

Result<std::unique_ptr<MeshPass>> MeshPass::create(DepthMode depth) {
  std::unique_ptr<MeshPass> pass(new MeshPass);
  if (Status s =
          build_into(pass->program_,
                     {{GL_VERTEX_SHADER,
                       {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", "object_mesh.vert"}},
                      {GL_FRAGMENT_SHADER,
                       {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", "object_mesh.frag"}}},
                     {depth_define(depth)});
      !s)
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
  gl::float_attribute(array, 4, kStandBinding, 3, offsetof(Stand, high_m));
  gl::float_attribute(array, 5, kStandBinding, 3, offsetof(Stand, low_m));
  for (GLuint k = 0; k < 3; ++k) {
    gl::float_attribute(array, 6 + k, kStandBinding, 3, offsetof(Stand, ecef_from_model) + k * sizeof(glm::vec3));
  }
  glVertexArrayVertexBuffer(array, 0, made.vertices.name(), 0, sizeof(MeshVertex));
  glVertexArrayBindingDivisor(array, kStandBinding, 1);
  glVertexArrayElementBuffer(array, made.indices.name());
  return made;
}

MeshPass::Model MeshPass::upload(std::shared_ptr<const MeshModel> model) {
  Model made;
  std::map<const MeshTexture*, GLuint> textures;
  for (const MeshPart& part : model->parts) {
    made.parts.push_back(upload(part));
    made.parts.back().texture = white_.name();
    if (!part.texture) continue;
    const auto [found, first] = textures.try_emplace(part.texture.get(), 0);
    if (first) {
      made.textures.push_back(texture_of(part.texture->rgba.data(), part.texture->width_px, part.texture->height_px));
      found->second = made.textures.back().name();
    }
    made.parts.back().texture = found->second;
  }
  made.model = std::move(model);
  return made;
}

void MeshPass::Model::stand_at(const std::array<std::vector<Stand>, Batch<char>::kBuckets>& buckets) {
  std::vector<Stand> all;
  for (std::size_t k = 0; k < buckets.size(); ++k) {
    ranges.first[k] = all.size();
    all.insert(all.end(), buckets[k].begin(), buckets[k].end());
  }
  ranges.first.back() = all.size();
  stands = buffer_of(all);
  for (const Part& part : parts) {
    glVertexArrayVertexBuffer(part.array.name(), kStandBinding, stands.name(), 0, sizeof(Stand));
  }
}

void MeshPass::set_meshes(const std::vector<MeshObject>& meshes, const Ellipsoid& ellipsoid) {
  std::map<const MeshModel*, std::array<std::vector<Stand>, Batch<char>::kBuckets>> stands_of;
  std::vector<Model> models;
  for (const MeshObject& mesh : meshes) {
    if (!mesh.model) continue;
    const auto [stands, first] = stands_of.try_emplace(mesh.model.get());
    if (first) {
      const auto known = std::ranges::find(models_, mesh.model, &Model::model);
      models.push_back(known != models_.end() ? std::move(*known) : upload(mesh.model));
    }
    const ObjectPart part = is_underground(mesh) ? ObjectPart::underground : ObjectPart::above_ground;
    const SplitPosition p = split_position(ellipsoid.to_ecef(mesh.place).xyz_m);
    stands->second[Batch<char>::bucket(part, true, mesh.through_surface)].push_back({p.high, p.low, axes_of(mesh)});
  }
  for (Model& model : models) model.stand_at(stands_of.at(model.model.get()));
  models_ = std::move(models);
}

bool MeshPass::has(ObjectPart part) const {
  for (const Model& model : models_) {
    if (model.ranges.range(part, true, ObjectChoice::all).count > 0) return true;
  }
  return false;
}

int MeshPass::draw(const ObjectDraw& draw) const {
  glProgramUniform1f(program_.name(), kMeshBiasUniform, draw.depth_bias);
  DrawState state = draw.state.with(program_.name());
  int calls = 0;
  for (const Model& model : models_) {
    const auto range = model.ranges.range(draw.part, true, draw.choice);
    if (range.count == 0) continue;
    if (draw.opaque) {
      calls += draw_parts(model, range.first, range.count, true, state);
      continue;
    }
    // Faces away from the eye are drawn first. For convex models this is back to front for every order of triangles.
    for (const GLenum left_out : {GL_FRONT, GL_BACK}) {
      state.cull = left_out;
      calls += draw_parts(model, range.first, range.count, false, state);
    }
  }
  return calls;
}

int MeshPass::draw_parts(const Model& model, std::size_t first, std::size_t count, bool opaque,
                         const DrawState& state) const {
  int calls = 0;
  apply(state);
  for (const Part& part : model.parts) {
    if (part.translucent == opaque) continue;
    glUniform4f(kMeshColorUniform, part.color_linear.x, part.color_linear.y, part.color_linear.z, part.color_linear.w);
    glUniform2f(kMeshCutoffUniform, part.cutoff, part.translucent ? 1.0F : 0.0F);
    glBindTextureUnit(0, part.texture);
    glBindSampler(0, 0);
    glBindVertexArray(part.array.name());
    glDrawElementsInstancedBaseInstance(GL_TRIANGLES, part.count, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(count),
                                        static_cast<GLuint>(first));
    ++calls;
  }
  return calls;
}

}  // namespace terrella
