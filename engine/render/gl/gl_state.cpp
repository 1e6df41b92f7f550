#include "render/gl/gl_state.h"

#include <algorithm>

namespace terrella {
namespace {

constexpr std::array<GLenum, 4> kTextureTargets = {GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BUFFER,
                                                   GL_TEXTURE_CUBE_MAP};
constexpr std::array<GLenum, 4> kTextureBindings = {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY,
                                                    GL_TEXTURE_BINDING_BUFFER, GL_TEXTURE_BINDING_CUBE_MAP};

/// Switches that a pass sets, or expects to have OpenGL's initial value.
constexpr std::array<GLenum, 31> kSwitches = {
    GL_CULL_FACE,
    GL_DEPTH_TEST,
    GL_STENCIL_TEST,
    GL_PROGRAM_POINT_SIZE,
    GL_TEXTURE_CUBE_MAP_SEAMLESS,
    GL_FRAMEBUFFER_SRGB,  // off: colours are sRGB already
    GL_RASTERIZER_DISCARD,
    GL_PRIMITIVE_RESTART,
    GL_PRIMITIVE_RESTART_FIXED_INDEX,
    GL_DEPTH_CLAMP,
    GL_POLYGON_OFFSET_FILL,
    GL_POLYGON_OFFSET_LINE,
    GL_POLYGON_OFFSET_POINT,
    GL_POLYGON_SMOOTH,
    GL_LINE_SMOOTH,
    GL_MULTISAMPLE,
    GL_SAMPLE_ALPHA_TO_COVERAGE,
    GL_SAMPLE_ALPHA_TO_ONE,
    GL_SAMPLE_COVERAGE,
    GL_SAMPLE_MASK,
    GL_SAMPLE_SHADING,
    GL_COLOR_LOGIC_OP,
    GL_DITHER,
    GL_CLIP_DISTANCE0,
    GL_CLIP_DISTANCE1,
    GL_CLIP_DISTANCE2,
    GL_CLIP_DISTANCE3,
    GL_CLIP_DISTANCE4,
    GL_CLIP_DISTANCE5,
    GL_CLIP_DISTANCE6,
    GL_CLIP_DISTANCE7,
};
/// Switches of the compatibility profile.
constexpr std::array<GLenum, 2> kOldSwitches = {GL_ALPHA_TEST, GL_POINT_SPRITE};

constexpr std::array<GLenum, 16> kPixelStores = {
    GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH,  GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS,
    GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES,   GL_UNPACK_LSB_FIRST,
    GL_PACK_ALIGNMENT,   GL_PACK_ROW_LENGTH,    GL_PACK_IMAGE_HEIGHT,   GL_PACK_SKIP_PIXELS,
    GL_PACK_SKIP_ROWS,   GL_PACK_SKIP_IMAGES,   GL_PACK_SWAP_BYTES,     GL_PACK_LSB_FIRST};

bool begins_on(GLenum name) { return name == GL_MULTISAMPLE || name == GL_DITHER || name == GL_POINT_SPRITE; }

void turn(GLenum name, bool on) { on ? glEnable(name) : glDisable(name); }
void turn(GLenum name, GLuint index, bool on) { on ? glEnablei(name, index) : glDisablei(name, index); }

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}
GLint integer(GLenum name, GLuint index) {
  GLint value = 0;
  glGetIntegeri_v(name, index, &value);
  return value;
}

bool has_old_switches() { return (integer(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) != 0; }

}  // namespace

void set_first_gl_state() {
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  for (const GLenum name : kSwitches) turn(name, begins_on(name));
  if (has_old_switches()) {
    for (const GLenum name : kOldSwitches) turn(name, begins_on(name));
  }
  glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_UPPER_LEFT);
  glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
  glDepthRange(0.0, 1.0);
  for (const GLenum name : kPixelStores) {
    glPixelStorei(name, name == GL_UNPACK_ALIGNMENT || name == GL_PACK_ALIGNMENT ? 4 : 0);
  }
}

GlState::GlState() {
  take_bindings();
  take_switches();
  take_fragments();
  take_windows();
  take_pixel_stores();
  set_first_gl_state();
}

GlState::~GlState() {
  put_bindings();
  for (const Switch& s : switches_) turn(s.name, s.on);
  put_fragments();
  put_windows();
  for (std::size_t k = 0; k < kStores; ++k) glPixelStorei(kPixelStores[k], pixel_stores_[k]);
}

void GlState::take_bindings() {
  program_ = integer(GL_CURRENT_PROGRAM);
  vertex_array_ = integer(GL_VERTEX_ARRAY_BINDING);
  draw_framebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  read_framebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
  uniform_buffer_ = integer(GL_UNIFORM_BUFFER_BINDING);
  block_buffer_ = integer(GL_UNIFORM_BUFFER_BINDING, 0);
  glGetInteger64i_v(GL_UNIFORM_BUFFER_START, 0, &block_first_);
  glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, 0, &block_bytes_);
  indirect_buffer_ = integer(GL_DRAW_INDIRECT_BUFFER_BINDING);
  unpack_buffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
  pack_buffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
  active_unit_ = integer(GL_ACTIVE_TEXTURE);
  for (GLuint unit = 0; unit < kUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    for (std::size_t k = 0; k < kTargets; ++k) textures_[unit][k] = integer(kTextureBindings[k]);
    samplers_[unit] = integer(GL_SAMPLER_BINDING);
  }
  glActiveTexture(static_cast<GLenum>(active_unit_));
}

void GlState::put_bindings() const {
  const auto name = [](GLint value) { return static_cast<GLuint>(value); };
  glUseProgram(name(program_));
  glBindVertexArray(name(vertex_array_));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(draw_framebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, name(read_framebuffer_));
  if (block_bytes_ > 0) {
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, name(block_buffer_), static_cast<GLintptr>(block_first_),
                      static_cast<GLsizeiptr>(block_bytes_));
  } else {
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, name(block_buffer_));
  }
  glBindBuffer(GL_UNIFORM_BUFFER, name(uniform_buffer_));
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, name(indirect_buffer_));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, name(unpack_buffer_));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, name(pack_buffer_));
  for (GLuint unit = 0; unit < kUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    for (std::size_t k = 0; k < kTargets; ++k) glBindTexture(kTextureTargets[k], name(textures_[unit][k]));
    glBindSampler(unit, name(samplers_[unit]));
  }
  glActiveTexture(static_cast<GLenum>(active_unit_));
}

void GlState::take_switches() {
  switches_.reserve(kSwitches.size() + kOldSwitches.size());
  const auto take = [this](GLenum name) { switches_.push_back({name, glIsEnabled(name) == GL_TRUE}); };
  std::ranges::for_each(kSwitches, take);
  if (has_old_switches()) std::ranges::for_each(kOldSwitches, take);
}

void GlState::take_fragments() {
  blending_.resize(static_cast<std::size_t>(integer(GL_MAX_DRAW_BUFFERS)));
  for (GLuint k = 0; k < blending_.size(); ++k) {
    Blending& b = blending_[k];
    b.on = glIsEnabledi(GL_BLEND, k) == GL_TRUE;
    b.from_rgb = integer(GL_BLEND_SRC_RGB, k);
    b.to_rgb = integer(GL_BLEND_DST_RGB, k);
    b.from_alpha = integer(GL_BLEND_SRC_ALPHA, k);
    b.to_alpha = integer(GL_BLEND_DST_ALPHA, k);
    b.equation_rgb = integer(GL_BLEND_EQUATION_RGB, k);
    b.equation_alpha = integer(GL_BLEND_EQUATION_ALPHA, k);
    glGetBooleani_v(GL_COLOR_WRITEMASK, k, b.mask.data());
  }
  glGetFloatv(GL_BLEND_COLOR, blend_color_.data());
  stencil_ = {
      StencilFace{integer(GL_STENCIL_FUNC), integer(GL_STENCIL_REF), integer(GL_STENCIL_VALUE_MASK),
                  integer(GL_STENCIL_WRITEMASK), integer(GL_STENCIL_FAIL), integer(GL_STENCIL_PASS_DEPTH_FAIL),
                  integer(GL_STENCIL_PASS_DEPTH_PASS)},
      StencilFace{integer(GL_STENCIL_BACK_FUNC), integer(GL_STENCIL_BACK_REF), integer(GL_STENCIL_BACK_VALUE_MASK),
                  integer(GL_STENCIL_BACK_WRITEMASK), integer(GL_STENCIL_BACK_FAIL),
                  integer(GL_STENCIL_BACK_PASS_DEPTH_FAIL), integer(GL_STENCIL_BACK_PASS_DEPTH_PASS)}};
  glGetFloatv(GL_COLOR_CLEAR_VALUE, clear_color_.data());
  clear_stencil_ = integer(GL_STENCIL_CLEAR_VALUE);
  glGetDoublev(GL_DEPTH_CLEAR_VALUE, &clear_depth_);
  depth_test_ = integer(GL_DEPTH_FUNC);
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
  cull_face_ = integer(GL_CULL_FACE_MODE);
  front_face_ = integer(GL_FRONT_FACE);
  std::array<GLint, 2> modes{};  // the number of modes depends on the driver
  glGetIntegerv(GL_POLYGON_MODE, modes.data());
  polygon_mode_ = modes.front();
  clip_origin_ = integer(GL_CLIP_ORIGIN);
  clip_depth_ = integer(GL_CLIP_DEPTH_MODE);
  point_origin_ = integer(GL_POINT_SPRITE_COORD_ORIGIN);
  provoking_vertex_ = integer(GL_PROVOKING_VERTEX);
}

void GlState::put_fragments() const {
  const auto name = [](GLint value) { return static_cast<GLenum>(value); };
  for (GLuint k = 0; k < blending_.size(); ++k) {
    const Blending& b = blending_[k];
    turn(GL_BLEND, k, b.on);
    glBlendFuncSeparatei(k, name(b.from_rgb), name(b.to_rgb), name(b.from_alpha), name(b.to_alpha));
    glBlendEquationSeparatei(k, name(b.equation_rgb), name(b.equation_alpha));
    glColorMaski(k, b.mask[0], b.mask[1], b.mask[2], b.mask[3]);
  }
  glBlendColor(blend_color_[0], blend_color_[1], blend_color_[2], blend_color_[3]);
  for (const GLenum face : {GLenum{GL_FRONT}, GLenum{GL_BACK}}) {
    const StencilFace& s = stencil_[face == GL_FRONT ? 0 : 1];
    glStencilFuncSeparate(face, name(s.test), s.reference, static_cast<GLuint>(s.read_mask));
    glStencilMaskSeparate(face, static_cast<GLuint>(s.write_mask));
    glStencilOpSeparate(face, name(s.fail), name(s.depth_fail), name(s.pass));
  }
  glClearColor(clear_color_[0], clear_color_[1], clear_color_[2], clear_color_[3]);
  glClearStencil(clear_stencil_);
  glClearDepth(clear_depth_);
  glDepthFunc(name(depth_test_));
  glDepthMask(depth_mask_);
  glCullFace(name(cull_face_));
  glFrontFace(name(front_face_));
  glPolygonMode(GL_FRONT_AND_BACK, name(polygon_mode_));
  glClipControl(name(clip_origin_), name(clip_depth_));
  glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, point_origin_);
  glProvokingVertex(name(provoking_vertex_));
}

void GlState::take_windows() {
  windows_.resize(static_cast<std::size_t>(integer(GL_MAX_VIEWPORTS)));
  for (GLuint k = 0; k < windows_.size(); ++k) {
    Window& w = windows_[k];
    glGetFloati_v(GL_VIEWPORT, k, w.viewport.data());
    glGetDoublei_v(GL_DEPTH_RANGE, k, w.depth_range.data());
    glGetIntegeri_v(GL_SCISSOR_BOX, k, w.scissor.data());
    w.scissor_on = glIsEnabledi(GL_SCISSOR_TEST, k) == GL_TRUE;
  }
}

void GlState::put_windows() const {
  for (GLuint k = 0; k < windows_.size(); ++k) {
    const Window& w = windows_[k];
    glViewportIndexedfv(k, w.viewport.data());
    glDepthRangeIndexed(k, w.depth_range[0], w.depth_range[1]);
    glScissorIndexedv(k, w.scissor.data());
    turn(GL_SCISSOR_TEST, k, w.scissor_on);
  }
}

void GlState::take_pixel_stores() {
  for (std::size_t k = 0; k < kStores; ++k) pixel_stores_[k] = integer(kPixelStores[k]);
}

}  // namespace terrella
