#include "render/surface/patch_stacks.h"

#include <algorithm>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <unordered_map>

#include "render/gl/vertex_attribute.h"
#include "render/surface/patch_pass.h"

// Stacks of layers: which layers one pass over a patch combines, and their drawing.
namespace terrella {
namespace {

/// The windows of a patch's layers in one pass, as vertex attributes.
struct StackWindow {
  glm::vec4 center_and_scale;
  glm::uvec4 window;
};
using StackWindows = std::array<StackWindow, PatchStacks::kMost>;

constexpr GLint kTexelsPlace = 0, kLookPlace = 4, kNumbersPlace = 8, kOpacityPlace = 12,
                kTonePlace = 16;  // patch_stack.glsl
constexpr GLuint kWindowsBinding = 4;

void make_buffers(PatchStacks& stacks) {
  stacks.windows = gl::make_buffer();
  stacks.commands = gl::make_buffer();
  stacks.cells = gl::make_buffer();
  stacks.limb_indices = gl::make_buffer();
  stacks.cells_texture = gl::make_texture(GL_TEXTURE_BUFFER);
}

}  // namespace

std::uint32_t StackProgram::key() const {
  std::uint32_t bits = (base ? 1U : 0U) | (night ? 2U : 0U) | static_cast<std::uint32_t>(count) << 2U;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const std::uint32_t slot = slots[k].look | (slots[k].numbers ? 16U : 0U) | (slots[k].special ? 32U : 0U);
    bits |= slot << (5U + 6U * k);
  }
  return bits | ground << 29U;
}

StackProgram StackProgram::of_key(std::uint32_t key) {
  StackProgram program{.base = (key & 1U) != 0,
                       .night = (key & 2U) != 0,
                       .ground = key >> 29U,
                       .count = static_cast<int>(key >> 2U & 7U)};
  for (std::size_t k = 0; k < program.slots.size(); ++k) {
    const std::uint32_t slot = key >> (5U + 6U * k);
    program.slots[k] = {static_cast<std::uint8_t>(slot & 15U), (slot & 16U) != 0, (slot & 32U) != 0};
  }
  return program;
}

void PatchPass::plan(std::span<const StackLayer> layers, std::size_t stacked, const GroundFrame* ground,
                     PatchStacks& out) const {
  out.groups.clear();
  out.own.assign(layers.size(), {});
  if (layers.size() < 2 && ground == nullptr) return;
  std::vector<Shown> shown(layers.front().patches->size());
  std::unordered_map<PatchId, std::uint32_t, PatchIdHash> place;
  for (std::uint32_t k = 0; k < shown.size(); ++k) {
    place[(*layers.front().patches)[k].node->id] = k;
    shown[k].emplace_back(0, k);
  }
  out.own[0].assign(shown.size(), true);
  for (std::size_t l = 1; l < layers.size(); ++l) {
    for (std::uint32_t k = 0; k < layers[l].patches->size(); ++k) {
      const auto cells = cells_of(*layers[l].coverage, k);
      const bool any = std::ranges::any_of(cells, has_tile);
      out.own[l].push_back(any);
      if (!any || l >= stacked) continue;
      Shown& there = shown[place.at((*layers[l].patches)[k].surface->id)];
      if (layers[l].hides && std::ranges::all_of(cells, has_tile)) {
        for (const auto& [layer, patch] : there) {
          out.own[layer][patch] = layer == 0;
        }
        there.clear();
      }
      there.emplace_back(static_cast<std::uint16_t>(l), k);
    }
  }
  for (std::uint32_t k = 0; k < shown.size(); ++k) {
    const unsigned look = ground != nullptr ? ground->windows[k].z : 0U;
    if (look == 0 && shown[k].size() < 2 && shown[k].front().first == 0) continue;
    out.own[0][k] = false;
    for (const auto& [layer, patch] : shown[k]) out.own[layer][patch] = false;
    add_groups(layers, k, shown[k], true, look, out);
    if (is_on_limb((*layers.front().patches)[k])) add_groups(layers, k, shown[k], false, look, out);
  }
  std::ranges::sort(out.groups, {},
                    [](const PatchStacks::Group& g) { return std::tuple_cat(g.batch(), std::tie(g.patch)); });
}

void PatchPass::add_groups(std::span<const StackLayer> layers, std::uint32_t patch, const Shown& shown, bool whole,
                           unsigned ground, PatchStacks& out) const {
  const auto most = static_cast<std::size_t>(has_relief_ ? PatchStacks::kMostWithRelief : PatchStacks::kMost);
  const bool night = is_dark((*layers.front().patches)[patch].body());
  for (std::size_t from = 0; from < shown.size(); from += most) {
    PatchStacks::Group group{.pass = static_cast<int>(from / most), .whole = whole, .patch = patch};
    const std::size_t count = std::min(most, shown.size() - from);
    StackProgram program{.base = shown[from].first == 0, .night = night, .count = static_cast<int>(count)};
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [layer, own_patch] = shown[from + k];
      const StackLayer& l = layers[layer];
      group.layers[k] = layer;
      group.places[k] = own_patch;
      const SelectedPatch& own = (*l.patches)[own_patch];
      const int variant = whole ? variant_for(own) : limb_variant_for(own);
      program.slots[k] = {static_cast<std::uint8_t>(variant / 2), l.numbers != nullptr, l.special};
    }
    if (from + count == shown.size()) program.ground = ground;
    group.program = program.key();
    out.groups.push_back(group);
  }
}

void PatchPass::upload(PatchStacks& stacks, std::span<const StackLayer> layers, const Vertices& base,
                       std::uint64_t frame) const {
  stacks.batches.clear();
  stacks.triangles = 0;
  if (stacks.groups.empty()) return;
  std::vector<WindowCell> cells;
  std::vector<std::uint32_t> first_cell;
  for (const StackLayer& layer : layers) {
    first_cell.push_back(static_cast<std::uint32_t>(cells.size()));
    cells.insert(cells.end(), layer.coverage->cells.begin(), layer.coverage->cells.end());
  }
  const std::vector<SelectedPatch>& patches = *layers.front().patches;
  std::vector<StackWindows> windows(patches.size() * static_cast<std::size_t>(stacks.groups.back().pass + 1));
  std::vector<DrawCommand> commands;
  std::vector<std::uint16_t> limb_indices;
  for (const PatchStacks::Group& group : stacks.groups) {
    const SelectedPatch& patch = patches[group.patch];
    StackWindows& at = windows[static_cast<std::size_t>(group.pass) * patches.size() + group.patch];
    const int count = StackProgram::of_key(group.program).count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const std::size_t l = group.layers[k];
      const PatchDraw& draw = layers[l].coverage->draws[group.places[k]];
      at[k] = {draw.center_and_scale, draw.window};
      at[k].window.x += first_cell[l];
    }
    if (stacks.batches.empty() || stacks.batches.back().first.batch() != group.batch()) {
      stacks.batches.push_back({group, static_cast<int>(commands.size()), 0});
    }
    DrawCommand command = command_of(patch, group.patch, base, frame);
    if (!group.whole) command = limb_of(command, base.buffers, limb_indices);
    commands.push_back(command);
    stacks.batches.back().to = static_cast<int>(commands.size());
    stacks.triangles += commands.back().count / 3;
  }
  if (!stacks.windows) make_buffers(stacks);
  stream(stacks.windows, windows);
  stream(stacks.commands, commands);
  stream(stacks.limb_indices, limb_indices);
  stream(stacks.cells, cells);
  glTextureBuffer(stacks.cells_texture.name(), GL_R32UI, stacks.cells.name());
}

// The instances are those of the base layer, whose windows give way to those of the stack's layers.
gl::VertexArray PatchPass::make_stack_array() const {
  gl::VertexArray made = make_vertex_array();
  const GLuint array = made.name();
  glVertexArrayBindingDivisor(array, kWindowsBinding, 1);
  // Slopes have the attributes 9 and 10.
  constexpr std::array<std::array<GLuint, 2>, PatchStacks::kMost> kPlaces{{{4, 7}, {11, 12}, {13, 14}, {9, 10}}};
  add_ground_attribute(made);
  const int count = has_relief_ ? PatchStacks::kMostWithRelief : PatchStacks::kMost;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const std::size_t at = k * sizeof(StackWindow);
    gl::float_attribute(array, kPlaces[k][0], kWindowsBinding, 4, at + offsetof(StackWindow, center_and_scale));
    gl::uint_attribute(array, kPlaces[k][1], kWindowsBinding, 4, at + offsetof(StackWindow, window));
  }
  return made;
}

void PatchPass::bind_stack(const PatchStacks::Group& group, std::span<const StackLayer> layers, GLuint program) const {
  const int count = StackProgram::of_key(group.program).count;
  std::array<glm::vec4, PatchStacks::kMost> texels{}, look{}, numbers{}, lines{}, tone{};
  std::array<float, PatchStacks::kMost> opacity{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const StackLayer& layer = layers[group.layers[k]];
    texels[k] = layer.texels;
    look[k] = layer.look;
    tone[k] = layer.tone;
    opacity[k] = layer.opacity;
    glBindTextureUnit(PatchStacks::kTileUnits[k], layer.tiles->texture());
    glBindSampler(PatchStacks::kTileUnits[k], precise_.name());
    if (layer.numbers == nullptr) continue;
    numbers[k] = layer.numbers->uniform();
    lines[k] = layer.numbers->lines();
    layer.numbers->bind(PatchStacks::kColorUnits[k]);
  }
  glProgramUniform4fv(program, kTexelsPlace, count, glm::value_ptr(texels[0]));
  glProgramUniform4fv(program, kLookPlace, count, glm::value_ptr(look[0]));
  glProgramUniform4fv(program, kNumbersPlace, count, glm::value_ptr(numbers[0]));
  glProgramUniform4fv(program, NumberColors::kLinesPlace, count, glm::value_ptr(lines[0]));
  glProgramUniform4fv(program, kTonePlace, count, glm::value_ptr(tone[0]));
  glProgramUniform1fv(program, kOpacityPlace, count, opacity.data());
}

void PatchPass::draw_stacks(const PatchStacks& stacks, bool first_pass, std::span<const StackLayer> layers,
                            const PatchLayer& base, const PatchBuffers& vertices, const GroundDraw& ground,
                            const DrawState& state, FrameCounts& counts) const {
  if (stacks.batches.empty()) return;
  if (scene_.air != nullptr) scene_.air->bind_ground();
  glBindTextureUnit(1, stacks.cells_texture.name());
  glBindSampler(1, 0);
  bind_vertices(stack_array_, base, vertices);
  if (ground.frame != nullptr) bind_ground(stack_array_, ground);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, stacks.commands.name());
  for (const PatchStacks::Batch& batch : stacks.batches) {
    if ((batch.first.pass == 0) != first_pass) continue;
    const std::size_t before = static_cast<std::size_t>(batch.first.pass) * layers.front().patches->size();
    glVertexArrayVertexBuffer(stack_array_.name(), kWindowsBinding, stacks.windows.name(),
                              static_cast<GLintptr>(before * sizeof(StackWindows)), sizeof(StackWindows));
    glVertexArrayElementBuffer(stack_array_.name(),
                               batch.first.whole ? vertices.index_buffer() : stacks.limb_indices.name());
    const GLuint program = stack_programs_.at(stack_place(batch.first.program)).name();
    bind_stack(batch.first, layers, program);
    if (batch.first.program >> 29U != 0) set_points(program, vertices);
    apply(state.with(program));
    draw_commands(batch.from, batch.to, counts);
  }
  if (first_pass) counts.triangles += stacks.triangles;
}

}  // namespace terrella
