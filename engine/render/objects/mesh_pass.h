#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "geo/objects.h"
#include "objects/object_batches.h"
#include "render/gl/gl_handle.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws triangle meshes: each model is kept once, and drawn once for all the places where it stands. thread: main
class MeshPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<MeshPass>> create(DepthMode depth);

  /// In place of those before. Those without a model are left out. Models that stay are not uploaded again.
  void set_meshes(const std::vector<MeshObject>& meshes, const Ellipsoid& ellipsoid);
  [[nodiscard]] bool has(ObjectPart part) const;
  /// Returns the draw calls made: one for each opaque material of each model, two for each translucent one: faces away
  /// from the eye, then towards it.
  [[nodiscard]] int draw(const ObjectDraw& draw) const;

 private:
  /// Where a model stands: positions as PatchVertex has them, and the model's axes in metres.
  struct Stand {
    glm::vec3 high_m, low_m;
    std::array<glm::vec3, 3> ecef_from_model;
  };
  struct Part {
    gl::VertexArray array;
    gl::Buffer vertices, indices;
    GLuint texture = 0;  ///< of the model's, or white_
    GLsizei count = 0;
    glm::vec4 color_linear;
    float cutoff = 0.0F;
    bool translucent = false;
  };
  struct Model {
    std::shared_ptr<const MeshModel> model;
    std::vector<Part> parts;
    std::vector<gl::Texture> textures;
    gl::Buffer stands;
    Batch<char> ranges;  ///< all of them opaque: a part says whether it is

    void stand_at(const std::array<std::vector<Stand>, Batch<char>::kBuckets>& buckets);
  };

  MeshPass() = default;
  [[nodiscard]] int draw_parts(const Model& model, std::size_t first, std::size_t count, bool opaque,
                               const DrawState& state) const;
  [[nodiscard]] Model upload(std::shared_ptr<const MeshModel> model);
  [[nodiscard]] static Part upload(const MeshPart& part);

  gl::Program program_;
  gl::Texture white_;
  std::vector<Model> models_;
};

}  // namespace terrella
