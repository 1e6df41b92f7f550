#include "render/surface/patch_ground.h"

#include <map>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"
#include "render/surface/patch_pass.h"

// Lines and areas on the ground, from pictures of the patches.
namespace terrella {
namespace {

constexpr GLuint kGroundBinding = 5, kGroundAttribute = 15;
constexpr GLint kPointsPlace = 20;              // patch.vert
constexpr GLuint kFillUnit = 0, kLineUnit = 2;  // patch_ground.glsl
constexpr std::uint32_t kAtLimb = 8;

void make_buffers(PatchGround& ground) {
  ground.windows = gl::make_buffer();
  ground.cells = gl::make_buffer();
  ground.commands = gl::make_buffer();
  ground.limb_indices = gl::make_buffer();
  ground.cells_texture = gl::make_texture(GL_TEXTURE_BUFFER);
}

}  // namespace

void PatchPass::add_ground_attribute(const gl::VertexArray& array) {
  glVertexArrayBindingDivisor(array.name(), kGroundBinding, 1);
  gl::uint_attribute(array.name(), kGroundAttribute, kGroundBinding, 4, 0);
}

void PatchPass::bind_ground(const gl::VertexArray& array, const GroundDraw& ground) const {
  glBindTextureUnit(ground_cells_unit(), ground.gpu->cells_texture.name());
  glBindSampler(ground_cells_unit(), 0);
  ground.frame->textures->bind(kFillUnit, kLineUnit);
  glVertexArrayVertexBuffer(array.name(), kGroundBinding, ground.gpu->windows.name(), 0, sizeof(glm::uvec4));
}

void PatchPass::set_points(GLuint program, const PatchBuffers& vertices) {
  glProgramUniform1i(program, kPointsPlace, vertices.segments() + 1);
}

Status PatchPass::prepare_ground(const GroundFrame& ground, const std::vector<SelectedPatch>& patches) {
  const auto make = [this](std::uint32_t look) -> Status {
    gl::Program& place = ground_programs_[ground_place(look)];
    if (place) return Done{};
    return build(place, {"frame.glsl", "air.glsl", "patch_ground.glsl", "patch_ground.frag"}, LayerRole::base,
                 TexelKind::pictures, {.limb = (look & kAtLimb) != 0, .ground_alone = true, .ground = look & ~kAtLimb});
  };
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const std::uint32_t look = ground.windows[k].z;
    if (look == 0) continue;
    if (Status made = make(look); !made) return made;
    if (Status made = is_on_limb(patches[k]) ? make(look | kAtLimb) : Done{}; !made) return made;
  }
  return Done{};
}

void PatchPass::upload_ground(PatchGround& out, const GroundFrame& ground, const Vertices& vertices,
                              const std::vector<SelectedPatch>& patches, std::uint64_t frame) const {
  out.batches.clear();
  if (ground.empty()) return;
  std::map<std::uint32_t, std::vector<DrawCommand>> by_look;
  std::vector<std::uint16_t> limb_indices;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const std::uint32_t look = ground.windows[k].z;
    if (look == 0) continue;
    const DrawCommand whole = command_of(patches[k], k, vertices, frame);
    by_look[look].push_back(whole);
    if (!is_on_limb(patches[k])) continue;
    const DrawCommand limb = limb_of(whole, vertices.buffers, limb_indices);
    if (limb.count > 0) by_look[look | kAtLimb].push_back(limb);
  }
  std::vector<DrawCommand> commands;
  for (const auto& [look, some] : by_look) {
    const int from = static_cast<int>(commands.size());
    commands.insert(commands.end(), some.begin(), some.end());
    out.batches.push_back({look, from, static_cast<int>(commands.size())});
  }
  if (!out.windows) make_buffers(out);
  stream(out.windows, ground.windows);
  stream(out.cells, ground.cells);
  stream(out.commands, commands);
  stream(out.limb_indices, limb_indices);
  glTextureBuffer(out.cells_texture.name(), GL_RGB32UI, out.cells.name());
}

void PatchPass::draw_ground(const GroundDraw& ground, const PatchLayer& base, const PatchBuffers& vertices,
                            const DrawState& state, FrameCounts& counts) const {
  if (ground.gpu->batches.empty()) return;
  if (scene_.air != nullptr) scene_.air->bind_ground();
  bind_vertices(ground_array_, base, vertices);
  bind_ground(ground_array_, ground);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, ground.gpu->commands.name());
  for (const PatchGround::Batch& batch : ground.gpu->batches) {
    const bool limb = (batch.look & kAtLimb) != 0;
    glVertexArrayElementBuffer(ground_array_.name(), limb ? ground.gpu->limb_indices.name() : vertices.index_buffer());
    const GLuint program = ground_programs_.at(ground_place(batch.look)).name();
    set_points(program, vertices);
    apply(state.with(program));
    draw_commands(batch.from, batch.to, counts);
  }
}

}  // namespace terrella
