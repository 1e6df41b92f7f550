// The globe in a context that is somebody else's: it leaves what it finds, and draws the same whatever it finds.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/gl/draw_state.h"
#include "render/gl/gl_state.h"
#include "render/gl/shader_library.h"
#include "tests/gl/gl_dump.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kForeign{32, 32};

/// Sets what there is to set to values that OpenGL does not begin with, by a seed.
class ForeignState {
 public:
  explicit ForeignState(unsigned seed) : random_(seed) {
    glGetIntegerv(GL_MAX_DRAW_BUFFERS, &draw_buffers_);
    bind_objects();
    set_fragments();
    set_windows();
    set_pixel_stores();
    for (const GLenum name : {GL_CULL_FACE,
                              GL_DEPTH_TEST,
                              GL_STENCIL_TEST,
                              GL_PROGRAM_POINT_SIZE,
                              GL_TEXTURE_CUBE_MAP_SEAMLESS,
                              GL_FRAMEBUFFER_SRGB,
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
                              GL_CLIP_DISTANCE7}) {
      any({0, 1}) != 0 ? glEnable(name) : glDisable(name);
    }
  }
  ~ForeignState() {
    glUseProgram(0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (const GLuint name : buffers_) glDeleteBuffers(1, &name);
    for (const GLuint name : textures_) glDeleteTextures(1, &name);
    for (const GLuint name : samplers_) glDeleteSamplers(1, &name);
  }
  ForeignState(const ForeignState&) = delete;
  ForeignState& operator=(const ForeignState&) = delete;

 private:
  GLint any(std::initializer_list<GLenum> values) {
    return static_cast<GLint>(values.begin()[random_() % values.size()]);
  }
  GLenum one_of(std::initializer_list<GLenum> values) { return static_cast<GLenum>(any(values)); }
  float part() { return static_cast<float>(random_() % 1000) / 1000.0F; }
  GLuint new_buffer() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, 4096, nullptr, GL_DYNAMIC_STORAGE_BIT);
    return buffers_.emplace_back(name);
  }

  void bind_objects() {
    for (const GLenum target :
         {GL_ARRAY_BUFFER, GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, GL_DISPATCH_INDIRECT_BUFFER,
          GL_DRAW_INDIRECT_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER, GL_SHADER_STORAGE_BUFFER,
          GL_TEXTURE_BUFFER, GL_TRANSFORM_FEEDBACK_BUFFER, GL_ATOMIC_COUNTER_BUFFER}) {
      glBindBuffer(target, new_buffer());
    }
    for (GLuint k = 0; k < 3; ++k) glBindBufferRange(GL_UNIFORM_BUFFER, k, new_buffer(), 256, 512);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, new_buffer());
    glBindBuffer(GL_UNIFORM_BUFFER, new_buffer());
    for (GLuint unit = 0; unit < 16; ++unit) bind_textures(unit);
    glActiveTexture(GL_TEXTURE0 + random_() % 16);
    program_ = std::move(*build_program(
        {{GL_VERTEX_SHADER, {"interlace.vert"}}, {GL_FRAGMENT_SHADER, {"patch_depth.frag"}}}, {"WRITE_DEPTH(pull)"}));
    glUseProgram(program_.name());
    array_ = gl::make_vertex_array();
    glVertexArrayElementBuffer(array_.name(), new_buffer());
    glBindVertexArray(array_.name());
    draw_ = gl::make_framebuffer();
    read_ = gl::make_framebuffer();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, draw_.name());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, read_.name());
  }

  void bind_textures(GLuint unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D, GL_TEXTURE_BUFFER,
                                GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE, GL_TEXTURE_2D_MULTISAMPLE}) {
      if (random_() % 4 == 0) continue;
      glCreateTextures(target, 1, &textures_.emplace_back(0U));
      glBindTexture(target, textures_.back());
    }
    glCreateSamplers(1, &samplers_.emplace_back(0U));
    glBindSampler(unit, samplers_.back());
  }

  void set_fragments() {
    for (GLuint k = 0; k < static_cast<GLuint>(draw_buffers_); ++k) {
      any({0, 1}) != 0 ? glEnablei(GL_BLEND, k) : glDisablei(GL_BLEND, k);
      glBlendFuncSeparatei(k, one_of({GL_ONE, GL_DST_COLOR}), one_of({GL_ZERO, GL_SRC_ALPHA}),
                           one_of({GL_DST_ALPHA, GL_CONSTANT_ALPHA}), one_of({GL_ONE, GL_SRC_ALPHA}));
      glBlendEquationSeparatei(k, one_of({GL_FUNC_SUBTRACT, GL_MIN}), one_of({GL_MAX, GL_FUNC_ADD}));
      const auto mask = [this] { return static_cast<GLboolean>(any({0, 1})); };
      glColorMaski(k, mask(), mask(), mask(), mask());
    }
    glBlendColor(part(), part(), part(), part());
    for (const GLenum face : {GL_FRONT, GL_BACK}) {
      glStencilFuncSeparate(face, one_of({GL_NEVER, GL_LESS, GL_GEQUAL}), any({1, 7, 30}),
                            static_cast<GLuint>(random_() % 255));
      glStencilMaskSeparate(face, static_cast<GLuint>(random_() % 255));
      glStencilOpSeparate(face, one_of({GL_INVERT, GL_ZERO}), one_of({GL_INCR, GL_KEEP}), one_of({GL_DECR, GL_ZERO}));
    }
    glClearColor(part(), part(), part(), part());
    glClearStencil(any({3, 5}));
    glClearDepth(double(part()));
    glDepthFunc(one_of({GL_NEVER, GL_NOTEQUAL, GL_ALWAYS}));
    glDepthMask(GL_FALSE);
    glCullFace(one_of({GL_FRONT, GL_FRONT_AND_BACK}));
    glFrontFace(GL_CW);
    glPolygonMode(GL_FRONT_AND_BACK, one_of({GL_LINE, GL_POINT}));
    glClipControl(GL_UPPER_LEFT, one_of({GL_ZERO_TO_ONE, GL_NEGATIVE_ONE_TO_ONE}));
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glLogicOp(GL_XOR);
    glPolygonOffset(3.0F, 5.0F);
    glPointSize(4.0F);
    glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT);
    glPrimitiveRestartIndex(2);
    glSampleCoverage(0.25F, GL_TRUE);
    glSampleMaski(0, 0x5);
  }

  void set_windows() {
    for (GLuint k = 0; k < 4; ++k) {
      glViewportIndexedf(k, part() * 10, part() * 10, 5 + part() * 20, 5 + part() * 20);
      glDepthRangeIndexed(k, 0.5 * double(part()), 0.6);
      glScissorIndexed(k, any({1, 2}), any({1, 2}), any({3, 9}), any({3, 9}));
      any({0, 1}) != 0 ? glEnablei(GL_SCISSOR_TEST, k) : glDisablei(GL_SCISSOR_TEST, k);
    }
  }

  void set_pixel_stores() {
    for (const GLenum name : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(name, any({1, 2, 8}));
    for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS,
                              GL_PACK_SKIP_IMAGES, GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS,
                              GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES}) {
      glPixelStorei(name, any({3, 17}));
    }
    for (const GLenum name : {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST}) {
      glPixelStorei(name, 1);
    }
  }

  const GlState kept_;  ///< state that later tests go on with
  std::mt19937 random_;
  GLint draw_buffers_ = 0;
  std::vector<GLuint> buffers_, textures_, samplers_;
  gl::Program program_;
  gl::VertexArray array_;
  gl::Framebuffer draw_, read_;
};

/// Everything that a globe can draw.
std::unique_ptr<Globe> full_globe(GlContract contract = GlContract::restore) {
  GlobeOptions options;
  options.gl_contract = contract;
  options.sky = true;
  options.time = *parse_utc("2026-06-21T12:00Z");
  options.stars = {{.direction_j2000 = {1.0F, 0.0F, 0.0F}, .magnitude = 1.0F, .color_linear = {1.0F, 1.0F, 1.0F}}};
  options.night_lights = {.width_px = 8, .height_px = 4, .values = std::vector<std::uint8_t>(32, 200)};
  options.upload_time_per_frame = std::chrono::seconds(1);
  auto globe = Globe::create(options);
  return globe ? std::move(*globe) : nullptr;
}

void fill(Globe& globe) {
  const TileGrid grid{.tile_px = 64, .max_level = 2, .reduced = true};
  ASSERT_TRUE(globe.add_imagery(one_colour(grid, {90, 140, 60})));
  ASSERT_TRUE(globe.add_imagery(
      std::make_shared<LayerSource>(grid,
                                    [](double lon, double) {
                                      return Rgba{200, 90, 30, lon < 20 ? std::uint8_t{0} : std::uint8_t{255}};
                                    }),
      {.opacity = 0.5}));
  ImageLook stretched{.opacity = 0.5};
  stretched.numbers = NumberLook{.low = 0.0, .high = 90.0};
  ASSERT_TRUE(globe.add_imagery(std::make_shared<PaintedNumbers>(
                                    grid, [](double, double row) { return static_cast<float>(std::floor(row)); },
                                    NumberInfo{.floats = true, .whole = WholeRange{-90, 90}}),
                                stretched));
  const Geodetic here{.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 1000.0};
  const Geodetic there{.lat = Angle::degrees(30.0), .lon = Angle::degrees(-10.0), .height_m = 1000.0};
  const Geodetic third{.lat = Angle::degrees(-20.0), .lon = Angle::degrees(0.0), .height_m = -1000.0};
  ASSERT_TRUE(globe.add_objects({.points = {{.place = here}, {.place = there, .radius_m = 3e5}, {.place = third}},
                                 .lines = {{.places = {here, there, third}}},
                                 .polygons = {{.rings = {{here, there, third}}}}}));
}

class ForeignContext : public GlTest {};

TEST_F(ForeignContext, RenderingLeavesTheStateAsItWas) {
  const auto globe = full_globe();
  ASSERT_TRUE(globe);
  fill(*globe);
  globe->set_camera(camera_at(0, 10, 1.0e7));
  const std::vector<SurfaceLook> looks = {
      {}, {.alpha = 0.5}, {.alpha = 0.5, .from_below = SurfaceFromBelow::selective}};
  unsigned seed = 1;
  for (const SurfaceLook& surface : looks) {
    for (const Stereo stereo : {Stereo::off, Stereo::interlaced}) {
      globe->set_surface(surface);
      globe->set_stereo({.mode = stereo, .eye_separation_m = {}});
      for (const double height_m : {1.0e7, -1.0e5}) {
        globe->set_camera(camera_at(0, 10, height_m));
        OffscreenTarget target(kForeign);
        const ForeignState foreign(seed++);
        const GlDump before = dump_gl_state();
        globe->render(target.framebuffer(), kForeign);
        EXPECT_EQ(differences(before, dump_gl_state()), "");
      }
    }
  }
}

TEST_F(ForeignContext, RenderingIntoSamplesLeavesTheStateAsItWas) {
  const auto globe = full_globe();
  ASSERT_TRUE(globe);
  fill(*globe);
  globe->set_camera(camera_at(0, 10, 1.0e7));
  gl::Texture color = gl::make_texture(GL_TEXTURE_2D_MULTISAMPLE), depth = gl::make_texture(GL_TEXTURE_2D_MULTISAMPLE);
  glTextureStorage2DMultisample(color.name(), 4, GL_RGBA8, kForeign.width_px, kForeign.height_px, GL_TRUE);
  glTextureStorage2DMultisample(depth.name(), 4, GL_DEPTH_COMPONENT32F, kForeign.width_px, kForeign.height_px, GL_TRUE);
  const gl::Framebuffer target = gl::make_framebuffer();
  glNamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
  glNamedFramebufferTexture(target.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  for (const unsigned seed : {91U, 92U}) {
    const ForeignState foreign(seed);
    const GlDump before = dump_gl_state();
    globe->render(target.name(), kForeign);
    EXPECT_TRUE(globe->status());
    EXPECT_EQ(differences(before, dump_gl_state()), "");
    EXPECT_TRUE(globe->copy_depth(target.name()));
    EXPECT_EQ(differences(before, dump_gl_state()), "");
  }
}

// The caller's own drawing finds no sampler, which would override the filter of its textures, and no vertex array of a
// pass. What it leaves does not change the picture.
TEST_F(ForeignContext, ACallersDrawingFindsNothingOfTheGlobesAndMayLeaveAnything) {
  const auto globe = full_globe();
  ASSERT_TRUE(globe);
  fill(*globe);
  globe->set_camera(camera_at(0, 10, 1.0e7));
  settle(*globe, kForeign);
  draw(*globe, kForeign);
  const Picture alone = picture();
  const GlState kept;
  std::vector<std::unique_ptr<ForeignState>> left;
  int found = 0;
  globe->on_draw([&](DrawStage, const FrameMatrices&) {
    GLint value = 0;
    for (GLuint unit = 0; unit < GlState::kUnits; ++unit) {
      glActiveTexture(GL_TEXTURE0 + unit);
      glGetIntegerv(GL_SAMPLER_BINDING, &value);
      EXPECT_EQ(value, 0) << "unit " << unit;
    }
    for (const GLenum name : {GL_VERTEX_ARRAY_BINDING, GL_CURRENT_PROGRAM, GL_PIXEL_UNPACK_BUFFER_BINDING, GL_BLEND}) {
      glGetIntegerv(name, &value);
      EXPECT_EQ(value, 0) << name;
    }
    left.push_back(std::make_unique<ForeignState>(1000U + static_cast<unsigned>(left.size())));
    ++found;
  });
  draw(*globe, kForeign);
  EXPECT_GE(found, 2);
  EXPECT_EQ(picture().rgba, alone.rgba);
  left.clear();
}

TEST_F(ForeignContext, EveryOtherCallDoesToo) {
  OffscreenTarget target(kForeign);
  const ForeignState foreign(77);
  const GlDump before = dump_gl_state();
  {
    const auto globe = full_globe();
    EXPECT_EQ(differences(before, dump_gl_state()), "");
    fill(*globe);
    EXPECT_EQ(differences(before, dump_gl_state()), "");
    globe->render_until_settled(target.framebuffer(), kForeign,
                                std::chrono::steady_clock::now() + std::chrono::seconds(60));
    EXPECT_TRUE(globe->value_at(globe->imagery().back(), {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0)}));
    EXPECT_EQ(differences(before, dump_gl_state()), "");
    globe->set_budget(
        {.gpu_bytes = 1, .upload_bytes_per_frame = 1, .upload_time_per_frame = {}, .relief_meshes_per_frame = 1});
    EXPECT_TRUE(globe->show_objects(globe->objects().front(), false));
    EXPECT_TRUE(globe->remove(globe->objects().front()));
    EXPECT_TRUE(globe->remove(globe->imagery().front()));
    EXPECT_EQ(differences(before, dump_gl_state()), "");
  }
  EXPECT_EQ(differences(before, dump_gl_state()), "");
}

TEST_F(ForeignContext, ThePictureIsTheSameWhateverTheStateWas) {
  const auto picture_after = [&](unsigned seed, GlContract contract = GlContract::restore) {
    const auto globe = full_globe(contract);
    fill(*globe);
    globe->set_camera(camera_at(0, 10, 1.0e7));
    settle(*globe, kForeign);
    if (seed == 0) {
      draw(*globe, kForeign);
      return picture();
    }
    {
      const ForeignState foreign(seed);
      draw(*globe, kForeign);
    }
    return picture();
  };
  const Picture plain = picture_after(0);
  for (const unsigned seed : {3U, 4U, 5U}) {
    for (const GlContract contract : {GlContract::restore, GlContract::leave}) {
      EXPECT_EQ(picture_after(seed, contract).rgba, plain.rgba) << "with seed " << seed;
    }
  }
}

int queries = 0;
/// Counts the calls of one function of OpenGL, `place` is where libepoxy keeps it.
template <auto* place>
struct Counted;
template <class R, class... Arguments, R (**place)(Arguments...)>
struct Counted<place> {
  static inline R (*function)(Arguments...) = nullptr;
  static R count(Arguments... arguments) {
    ++queries;
    return function(arguments...);
  }
  Counted() {
    function = *place;
    *place = count;
  }
  ~Counted() { *place = function; }
};
struct CountedQueries {
  Counted<&epoxy_glGetIntegerv> integer;
  Counted<&epoxy_glGetIntegeri_v> integer_i;
  Counted<&epoxy_glGetInteger64i_v> integer64_i;
  Counted<&epoxy_glGetFloatv> number;
  Counted<&epoxy_glGetFloati_v> number_i;
  Counted<&epoxy_glGetDoublev> real;
  Counted<&epoxy_glGetDoublei_v> real_i;
  Counted<&epoxy_glGetBooleanv> boolean;
  Counted<&epoxy_glGetBooleani_v> boolean_i;
  Counted<&epoxy_glIsEnabled> enabled;
  Counted<&epoxy_glIsEnabledi> enabled_i;
};

TEST_F(ForeignContext, AskingForNoStateIsAnOption) {
  const auto queries_of_a_frame = [&](GlContract contract) {
    const auto globe = full_globe(contract);
    fill(*globe);
    globe->set_camera(camera_at(0, 10, 1.0e7));
    settle(*globe, kForeign);
    const CountedQueries counted;
    queries = 0;
    draw(*globe, kForeign);
    return queries;
  };
  const int restoring = queries_of_a_frame(GlContract::restore);
  RecordProperty("queries_restore", restoring);
  EXPECT_GT(restoring, 100);
  EXPECT_EQ(queries_of_a_frame(GlContract::leave), 1) << "is the profile compatible?";
}

TEST_F(ForeignContext, ADrawStateIsSetWhateverWasSetBefore) {
  const DrawState all{.program = 0,
                      .depth = DepthState{GL_GEQUAL, false},
                      .stencil = StencilState{3, 5, 6},
                      .blend = BlendState{GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA, GL_MAX, 0.25F},
                      .color = {false, true, false, true},
                      .cull = GL_FRONT,
                      .scissor = true,
                      .program_point_size = true};
  apply(all);
  const GlDump full = dump_gl_state();
  apply({});
  const GlDump empty = dump_gl_state();
  EXPECT_NE(differences(full, empty), "");
  apply(all);
  EXPECT_EQ(differences(full, dump_gl_state()), "");
  apply({});
  EXPECT_EQ(differences(empty, dump_gl_state()), "");
  EXPECT_EQ(all, all.with(0));
  EXPECT_NE(all, all.with(1));
}

TEST_F(ForeignContext, AnSrgbFramebufferTakesTheSameBytes) {
  const auto globe = full_globe();
  fill(*globe);
  globe->set_camera(camera_at(0, 10, 1.0e7));
  settle(*globe, kForeign);
  const Picture plain = picture();
  const gl::Texture color = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(color.name(), 1, GL_SRGB8_ALPHA8, kForeign.width_px, kForeign.height_px);
  const gl::Framebuffer target = gl::make_framebuffer();
  glNamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
  for (const bool srgb : {false, true}) {
    srgb ? glEnable(GL_FRAMEBUFFER_SRGB) : glDisable(GL_FRAMEBUFFER_SRGB);
    globe->render(target.name(), kForeign);
    std::vector<std::uint8_t> bytes(plain.rgba.size());
    glGetTextureImage(color.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes.size()), bytes.data());
    const std::size_t row = bytes.size() / kForeign.height_px;
    for (std::size_t y = 0; y < static_cast<std::size_t>(kForeign.height_px); ++y) {
      EXPECT_TRUE(std::equal(bytes.begin() + y * row, bytes.begin() + (y + 1) * row, plain.rgba.end() - (y + 1) * row));
    }
  }
}

}  // namespace
}  // namespace terrella::test
