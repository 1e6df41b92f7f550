#include "tests/gl/gl_dump.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace terrella::test {
namespace {

struct Named {
  GLenum name;
  const char* text;
  std::size_t count = 1;
};
// A value of GL and its name.
#define GL_NAME(name) name, #name

constexpr Named kValues[] = {
    {GL_NAME(GL_ACTIVE_TEXTURE)},
    {GL_NAME(GL_ARRAY_BUFFER_BINDING)},
    {GL_NAME(GL_ATOMIC_COUNTER_BUFFER_BINDING)},
    {GL_NAME(GL_BLEND_COLOR), 4},
    {GL_NAME(GL_CLIP_DEPTH_MODE)},
    {GL_NAME(GL_CLIP_ORIGIN)},
    {GL_NAME(GL_COLOR_CLEAR_VALUE), 4},
    {GL_NAME(GL_COPY_READ_BUFFER_BINDING)},
    {GL_NAME(GL_COPY_WRITE_BUFFER_BINDING)},
    {GL_NAME(GL_CULL_FACE_MODE)},
    {GL_NAME(GL_CURRENT_PROGRAM)},
    {GL_NAME(GL_DEPTH_CLEAR_VALUE)},
    {GL_NAME(GL_DEPTH_FUNC)},
    {GL_NAME(GL_DEPTH_WRITEMASK)},
    {GL_NAME(GL_DISPATCH_INDIRECT_BUFFER_BINDING)},
    {GL_NAME(GL_DRAW_BUFFER)},
    {GL_NAME(GL_DRAW_FRAMEBUFFER_BINDING)},
    {GL_NAME(GL_DRAW_INDIRECT_BUFFER_BINDING)},
    {GL_NAME(GL_ELEMENT_ARRAY_BUFFER_BINDING)},
    {GL_NAME(GL_FRONT_FACE)},
    {GL_NAME(GL_LINE_WIDTH)},
    {GL_NAME(GL_LOGIC_OP_MODE)},
    {GL_NAME(GL_PATCH_VERTICES)},
    {GL_NAME(GL_PIXEL_PACK_BUFFER_BINDING)},
    {GL_NAME(GL_PIXEL_UNPACK_BUFFER_BINDING)},
    {GL_NAME(GL_POINT_SIZE)},
    {GL_NAME(GL_POINT_SPRITE_COORD_ORIGIN)},
    {GL_NAME(GL_POINT_FADE_THRESHOLD_SIZE)},
    {GL_NAME(GL_POLYGON_MODE)},
    {GL_NAME(GL_POLYGON_OFFSET_FACTOR)},
    {GL_NAME(GL_POLYGON_OFFSET_UNITS)},
    {GL_NAME(GL_PRIMITIVE_RESTART_INDEX)},
    {GL_NAME(GL_PROGRAM_PIPELINE_BINDING)},
    {GL_NAME(GL_PROVOKING_VERTEX)},
    {GL_NAME(GL_READ_BUFFER)},
    {GL_NAME(GL_READ_FRAMEBUFFER_BINDING)},
    {GL_NAME(GL_RENDERBUFFER_BINDING)},
    {GL_NAME(GL_SAMPLE_COVERAGE_INVERT)},
    {GL_NAME(GL_SAMPLE_COVERAGE_VALUE)},
    {GL_NAME(GL_SHADER_STORAGE_BUFFER_BINDING)},
    {GL_NAME(GL_STENCIL_BACK_FAIL)},
    {GL_NAME(GL_STENCIL_BACK_FUNC)},
    {GL_NAME(GL_STENCIL_BACK_PASS_DEPTH_FAIL)},
    {GL_NAME(GL_STENCIL_BACK_PASS_DEPTH_PASS)},
    {GL_NAME(GL_STENCIL_BACK_REF)},
    {GL_NAME(GL_STENCIL_BACK_VALUE_MASK)},
    {GL_NAME(GL_STENCIL_BACK_WRITEMASK)},
    {GL_NAME(GL_STENCIL_CLEAR_VALUE)},
    {GL_NAME(GL_STENCIL_FAIL)},
    {GL_NAME(GL_STENCIL_FUNC)},
    {GL_NAME(GL_STENCIL_PASS_DEPTH_FAIL)},
    {GL_NAME(GL_STENCIL_PASS_DEPTH_PASS)},
    {GL_NAME(GL_STENCIL_REF)},
    {GL_NAME(GL_STENCIL_VALUE_MASK)},
    {GL_NAME(GL_STENCIL_WRITEMASK)},
    {GL_NAME(GL_TRANSFORM_FEEDBACK_BINDING)},
    {GL_NAME(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING)},
    {GL_NAME(GL_UNIFORM_BUFFER_BINDING)},
    {GL_NAME(GL_VERTEX_ARRAY_BINDING)},
    {GL_NAME(GL_PACK_ALIGNMENT)},
    {GL_NAME(GL_PACK_IMAGE_HEIGHT)},
    {GL_NAME(GL_PACK_LSB_FIRST)},
    {GL_NAME(GL_PACK_ROW_LENGTH)},
    {GL_NAME(GL_PACK_SKIP_IMAGES)},
    {GL_NAME(GL_PACK_SKIP_PIXELS)},
    {GL_NAME(GL_PACK_SKIP_ROWS)},
    {GL_NAME(GL_PACK_SWAP_BYTES)},
    {GL_NAME(GL_UNPACK_ALIGNMENT)},
    {GL_NAME(GL_UNPACK_IMAGE_HEIGHT)},
    {GL_NAME(GL_UNPACK_LSB_FIRST)},
    {GL_NAME(GL_UNPACK_ROW_LENGTH)},
    {GL_NAME(GL_UNPACK_SKIP_IMAGES)},
    {GL_NAME(GL_UNPACK_SKIP_PIXELS)},
    {GL_NAME(GL_UNPACK_SKIP_ROWS)},
    {GL_NAME(GL_UNPACK_SWAP_BYTES)},
};

constexpr Named kDumpedSwitches[] = {
    {GL_NAME(GL_CLIP_DISTANCE0)},
    {GL_NAME(GL_CLIP_DISTANCE1)},
    {GL_NAME(GL_CLIP_DISTANCE7)},
    {GL_NAME(GL_COLOR_LOGIC_OP)},
    {GL_NAME(GL_CULL_FACE)},
    {GL_NAME(GL_DEPTH_CLAMP)},
    {GL_NAME(GL_DEPTH_TEST)},
    {GL_NAME(GL_DITHER)},
    {GL_NAME(GL_FRAMEBUFFER_SRGB)},
    {GL_NAME(GL_LINE_SMOOTH)},
    {GL_NAME(GL_MULTISAMPLE)},
    {GL_NAME(GL_POLYGON_OFFSET_FILL)},
    {GL_NAME(GL_POLYGON_OFFSET_LINE)},
    {GL_NAME(GL_POLYGON_OFFSET_POINT)},
    {GL_NAME(GL_POLYGON_SMOOTH)},
    {GL_NAME(GL_PRIMITIVE_RESTART)},
    {GL_NAME(GL_PRIMITIVE_RESTART_FIXED_INDEX)},
    {GL_NAME(GL_PROGRAM_POINT_SIZE)},
    {GL_NAME(GL_RASTERIZER_DISCARD)},
    {GL_NAME(GL_SAMPLE_ALPHA_TO_COVERAGE)},
    {GL_NAME(GL_SAMPLE_ALPHA_TO_ONE)},
    {GL_NAME(GL_SAMPLE_COVERAGE)},
    {GL_NAME(GL_SAMPLE_MASK)},
    {GL_NAME(GL_SAMPLE_SHADING)},
    {GL_NAME(GL_STENCIL_TEST)},
    {GL_NAME(GL_TEXTURE_CUBE_MAP_SEAMLESS)},
};

constexpr Named kOfDrawBuffers[] = {
    {GL_NAME(GL_BLEND_DST_ALPHA)},    {GL_NAME(GL_BLEND_DST_RGB)},   {GL_NAME(GL_BLEND_EQUATION_ALPHA)},
    {GL_NAME(GL_BLEND_EQUATION_RGB)}, {GL_NAME(GL_BLEND_SRC_ALPHA)}, {GL_NAME(GL_BLEND_SRC_RGB)},
    {GL_NAME(GL_COLOR_WRITEMASK), 4},
};
constexpr Named kOfViewports[] = {
    {GL_NAME(GL_DEPTH_RANGE), 2}, {GL_NAME(GL_SCISSOR_BOX), 4}, {GL_NAME(GL_VIEWPORT), 4}};
constexpr Named kOfBlocks[] = {{GL_NAME(GL_UNIFORM_BUFFER_BINDING)},
                               {GL_NAME(GL_SHADER_STORAGE_BUFFER_BINDING)},
                               {GL_NAME(GL_ATOMIC_COUNTER_BUFFER_BINDING)}};
constexpr Named kOfUnits[] = {
    {GL_NAME(GL_SAMPLER_BINDING)},
    {GL_NAME(GL_TEXTURE_BINDING_1D)},
    {GL_NAME(GL_TEXTURE_BINDING_1D_ARRAY)},
    {GL_NAME(GL_TEXTURE_BINDING_2D)},
    {GL_NAME(GL_TEXTURE_BINDING_2D_ARRAY)},
    {GL_NAME(GL_TEXTURE_BINDING_2D_MULTISAMPLE)},
    {GL_NAME(GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY)},
    {GL_NAME(GL_TEXTURE_BINDING_3D)},
    {GL_NAME(GL_TEXTURE_BINDING_BUFFER)},
    {GL_NAME(GL_TEXTURE_BINDING_CUBE_MAP)},
    {GL_NAME(GL_TEXTURE_BINDING_CUBE_MAP_ARRAY)},
    {GL_NAME(GL_TEXTURE_BINDING_RECTANGLE)},
};
constexpr GLuint kDumpedUnits = 16, kDumpedBuffers = 8, kDumpedViewports = 4, kDumpedBlocks = 4;

using Four = std::array<double, 4>;
std::vector<double> first(const Four& values, std::size_t count) { return {values.begin(), values.begin() + count}; }

void dump_indexed(GlDump& dump, const Named& value, GLuint index) {
  Four values{};
  glGetDoublei_v(value.name, index, values.data());
  dump[fmt::format("{}[{}]", value.text, index)] = first(values, value.count);
}

}  // namespace

GlDump dump_gl_state() {
  GlDump dump;
  Four values{};
  for (const Named& value : kValues) {
    glGetDoublev(value.name, values.data());
    dump[value.text] = first(values, value.count);
  }
  for (const Named& value : kDumpedSwitches) dump[value.text] = {double(glIsEnabled(value.name))};
  for (GLuint k = 0; k < kDumpedBuffers; ++k) {
    for (const Named& value : kOfDrawBuffers) dump_indexed(dump, value, k);
    dump[fmt::format("GL_BLEND[{}]", k)] = {double(glIsEnabledi(GL_BLEND, k))};
  }
  for (GLuint k = 0; k < kDumpedViewports; ++k) {
    for (const Named& value : kOfViewports) dump_indexed(dump, value, k);
    dump[fmt::format("GL_SCISSOR_TEST[{}]", k)] = {double(glIsEnabledi(GL_SCISSOR_TEST, k))};
  }
  for (GLuint k = 0; k < kDumpedBlocks; ++k) {
    for (const Named& value : kOfBlocks) dump_indexed(dump, value, k);
  }
  GLint unit = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
  for (GLuint k = 0; k < kDumpedUnits; ++k) {
    glActiveTexture(GL_TEXTURE0 + k);
    for (const Named& value : kOfUnits) {
      glGetDoublev(value.name, values.data());
      dump[fmt::format("{}[{}]", value.text, k)] = first(values, value.count);
    }
  }
  glActiveTexture(static_cast<GLenum>(unit));
  return dump;
}

std::string differences(const GlDump& before, const GlDump& after) {
  std::string all;
  for (const auto& [name, value] : before) {
    const auto now = after.find(name);
    if (now == after.end() || now->second != value) {
      all += fmt::format("{} was {}, is {}\n", name, value, now == after.end() ? std::vector<double>{} : now->second);
    }
  }
  return all;
}

}  // namespace terrella::test
