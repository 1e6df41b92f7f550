#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "objects/object_batches.h"
#include "render/gl/gl_handle.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws triangle meshes. Each model is stored once, and drawn once for all its places. thread: main
class MeshPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<MeshPass>> create(DepthMode depth);

  /// Uploads the models of a layer that are not on the GPU yet. False if the driver has no memory for them; the layer
  /// cannot be drawn then.
  [[nodiscard]] bool upload(const DrawnLayer& layer);
  /// Frees the models of which no layer was uploaded since the last call.
  void free_unused();
  /// Returns the draw calls made: one for each opaque material of each model, two for each translucent one: faces away
  /// from the eye, then towards it.
  [[nodiscard]] int draw(const DrawnLayer& layer, const ObjectDraw& draw) const;

 private:
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
    bool used = false;
  };
  /// The places of a model that one draw takes.
  struct Places {
    GLuint buffer;
    GLsizei count;
    float opacity;  ///< factor of alpha of all parts
  };

  MeshPass() = default;
  [[nodiscard]] static int draw_parts(const Model& model, const Places& places, bool opaque, const DrawState& state);
  /// False if the driver has no memory for the model.
  [[nodiscard]] bool upload(std::shared_ptr<const MeshModel> model, Model& made) const;
  [[nodiscard]] static Part upload(const MeshPart& part);

  gl::Program program_;
  gl::Texture white_;
  std::unordered_map<const MeshModel*, Model> models_;
};

}  // namespace terrella
