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

/// Draws triangle meshes. Each model is stored once, and drawn once for all its places. thread: main
class MeshPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<MeshPass>> create(DepthMode depth);

  /// Replaces all meshes. Skips meshes without a model. Does not upload again models that stay.
  void set_meshes(const std::vector<MeshObject>& meshes, const Ellipsoid& ellipsoid);
  [[nodiscard]] bool has(ObjectPart part) const;
  /// Returns the draw calls made: one for each opaque material of each model, two for each translucent one: faces away
  /// from the eye, then towards it.
  [[nodiscard]] int draw(const ObjectDraw& draw) const;

 private:
  /// One place of a model: its position, split as in PatchVertex, and the model's axes, metres.
  struct Stand {
    glm::vec3 high_m, low_m;
    std::array<glm::vec3, 3> ecef_from_model;
  };
  struct Part {
    gl::VertexArray array;
    gl::Buffer vertices, indices;
    GLuint texture = 0;  ///< texture of the model, or white_
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
    Batch<char> ranges;  ///< sorted as if all were opaque: each part of a model states its own opacity

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
