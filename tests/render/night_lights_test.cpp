// A patch's programs with CITY_LIGHTS: white imagery by day and by night, with a city and without.
#include "render/surface/night_lights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "render/gl/frame_block.h"
#include "render/gl/offscreen.h"
#include "render/gl/shader_library.h"

namespace terrella::test {
namespace {

constexpr Viewport kTile{8, 8};

/// One triangle over the whole picture, all of it at one place of the planet.
class NightLightsTest : public testing::Test {
 protected:
  void SetUp() override {
    auto context = HeadlessContext::create();
    ASSERT_TRUE(context) << context.error().message;
    context_ = std::move(*context);
    target_ = std::make_unique<OffscreenTarget>(kTile);
    GreyPicture map{64, 32, std::vector<std::uint8_t>(64 * 32, 0)};
    // A city as large as a country, from 10°W to 10°E and from 20°S to 20°N.
    for (std::size_t y = 12; y < 20; ++y) {
      for (std::size_t x = 30; x < 34; ++x) map.values[y * 64 + x] = 255;
    }
    auto lights = NightLights::create(map);
    ASSERT_TRUE(lights) << lights.error().message;
    lights_ = std::make_unique<NightLights>(std::move(*lights));
    white_ = gl::make_texture(GL_TEXTURE_2D_ARRAY);
    glTextureStorage3D(white_.name(), 1, GL_RGBA8, 1, 1, 1);
    const std::array<std::uint8_t, 4> white = {255, 255, 255, 255};
    glTextureSubImage3D(white_.name(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, white.data());
    cells_buffer_ = gl::make_buffer();
    const std::uint32_t cell = 0;
    glNamedBufferStorage(cells_buffer_.name(), sizeof(cell), &cell, 0);
    cells_ = gl::make_texture(GL_TEXTURE_BUFFER);
    glTextureBuffer(cells_.name(), GL_R32UI, cells_buffer_.name());
    for (const GLuint unit : {0U, 2U, 3U}) glBindTextureUnit(unit, white_.name());
    glBindTextureUnit(1, cells_.name());
  }
  void TearDown() override {
    if (!context_) return;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }

  // The colour that `files` give a place while the Sun stands over 0°N `sun_lon`.
  std::array<int, 3> color(std::initializer_list<std::string_view> files, double lat_deg, double lon_deg,
                           double sun_lon, bool lit = true) {
    const auto program = build_program({{GL_VERTEX_SHADER, {"frame.glsl", "patch.vert"}}, {GL_FRAGMENT_SHADER, files}},
                                       {"DEPTH_REVERSED", "DAY_AND_NIGHT", "CITY_LIGHTS"});
    if (!program) {
      ADD_FAILURE() << program.error().message;
      return {};
    }
    const double lat = glm::radians(lat_deg), lon = glm::radians(lon_deg), sun = glm::radians(sun_lon);
    FrameBlock block{};
    block.view_from_ecef = glm::mat4(1.0F);
    block.clip_scale = glm::vec4(1.0F, 1.0F, 0.5F, 10.0F);
    block.sun_ecef = glm::vec4(std::cos(sun), std::sin(sun), 0.0, lit ? 1.0 : 0.0);
    block.texels = glm::vec4(1.0F, 1.0F, 1.0F, 1.0F);
    const gl::Buffer frame = gl::make_buffer();
    glNamedBufferStorage(frame.name(), sizeof(block), &block, 0);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame.name());
    const std::array<float, 9> corners = {-1, -1, -1, 3, -1, -1, -1, 3, -1};
    const gl::Buffer vertices = gl::make_buffer();
    glNamedBufferStorage(vertices.name(), sizeof(corners), corners.data(), 0);
    const gl::VertexArray array = gl::make_vertex_array();
    glVertexArrayVertexBuffer(array.name(), 0, vertices.name(), 0, 3 * sizeof(float));
    glVertexArrayAttribFormat(array.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(array.name(), 0);
    glBindVertexArray(array.name());
    for (GLuint k = 1; k < 4; ++k) glVertexAttrib4f(k, 0, 0, 0, 0);
    glVertexAttrib4f(4, 0.5F, 0.5F, 1.0F, 1.0F);
    glVertexAttrib4f(5, static_cast<float>(std::cos(lon)), static_cast<float>(std::sin(lon)),
                     static_cast<float>(std::cos(lat)), static_cast<float>(std::sin(lat)));
    glVertexAttrib4f(6, 0, 0, 0, 0);
    glVertexAttribI4ui(7, 0, 1U | (1U << 16), 0, 0);
    lights_->bind();
    glBindFramebuffer(GL_FRAMEBUFFER, target_->framebuffer());
    glViewport(0, 0, kTile.width_px, kTile.height_px);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(program->name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const std::vector<std::uint8_t> picture = target_->read();
    const std::size_t middle = 4 * (4 * 8 + 4);
    return {picture[middle], picture[middle + 1], picture[middle + 2]};
  }

 private:
  std::unique_ptr<HeadlessContext> context_;
  std::unique_ptr<OffscreenTarget> target_;
  std::unique_ptr<NightLights> lights_;
  gl::Texture white_, cells_;
  gl::Buffer cells_buffer_;
};

TEST_F(NightLightsTest, LightsCitiesByNightAlone) {
  const std::initializer_list<std::string_view> programs[] = {
      {"frame.glsl", "air.glsl", "patch_common.glsl", "patch_taps.glsl", "patch_plain.frag"},
      {"frame.glsl", "air.glsl", "patch_common.glsl", "patch_taps.glsl", "patch_magnified.frag"},
      {"frame.glsl", "functions.glsl", "air.glsl", "patch_common.glsl", "patch_taps.glsl", "patch_exact_point.glsl",
       "patch_polar_taps.glsl", "patch_polar.frag"}};
  for (const auto& files : programs) {
    SCOPED_TRACE(std::data(files)[files.size() - 1]);
    EXPECT_EQ(color(files, 0, 0, 0)[0], 255) << "a city at noon";
    EXPECT_EQ(color(files, 0, 60, 60)[2], 255) << "the country at noon";
    const auto city = color(files, 0, 0, 180), country = color(files, 0, 60, 180),
               unlit = color(files, 0, 0, 180, false);
    EXPECT_EQ(city[0], 255);
    EXPECT_LT(city[2], city[1]) << "lamps are yellow";
    EXPECT_GT(city[1], 200);
    EXPECT_LT(country[0], 30);
    EXPECT_GT(country[2], country[0]) << "night is blue";
    EXPECT_EQ(unlit[2], 255) << "imagery alone has no night";
  }
}

TEST_F(NightLightsTest, RefusesAMapThatIsNone) {
  for (const GreyPicture& map : {GreyPicture{0, 0, {}}, GreyPicture{4, 2, std::vector<std::uint8_t>(7)},
                                 GreyPicture{100000, 1, std::vector<std::uint8_t>(100000)}}) {
    EXPECT_FALSE(NightLights::create(map));
  }
}

}  // namespace
}  // namespace terrella::test
