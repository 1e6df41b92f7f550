// The GPU has too little memory: the globe goes on with less, says what it got, and leaves no error of OpenGL.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kFull{256, 256};
const TileGrid kManyTiles{.tile_px = 16, .max_level = 9};

/// A driver whose array textures have at most so many layers, and whose pictures at most so many pixels a side. Asked
/// for more, OpenGL itself runs out of memory: it is asked for a texture of terabytes.
class SmallGpu {
 public:
  SmallGpu(int most_layers, int most_px) {
    look_up_functions();
    storage_2d_ = epoxy_glTextureStorage2D;
    storage_3d_ = epoxy_glTextureStorage3D;
    here_ = this;
    layers_ = most_layers;
    side_px_ = most_px;
    glDisable(GL_DEBUG_OUTPUT);  // a message of the debug output would fail the test
    epoxy_glTextureStorage2D = [](GLuint name, GLsizei levels, GLenum format, GLsizei width, GLsizei height) {
      const bool fits = width <= side_px_ || height <= side_px_;  // tables have one long side
      here_->storage_2d_(name, fits ? levels : 1, fits ? format : GLenum{GL_RGBA32F}, fits ? width : 16384,
                         fits ? height : 16384);
    };
    epoxy_glTextureStorage3D = [](GLuint name, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                                  GLsizei layers) {
      const bool fits = layers <= layers_;
      here_->storage_3d_(name, levels, fits ? format : GLenum{GL_RGBA32F}, fits ? width : 16384, fits ? height : 16384,
                         fits ? layers : 2048);
    };
  }
  ~SmallGpu() {
    epoxy_glTextureStorage2D = storage_2d_;
    epoxy_glTextureStorage3D = storage_3d_;
    glEnable(GL_DEBUG_OUTPUT);
  }
  SmallGpu(const SmallGpu&) = delete;
  SmallGpu& operator=(const SmallGpu&) = delete;

 private:
  /// libepoxy looks a function up at its first call, and then replaces the pointer.
  static void look_up_functions() {
    GLuint flat = 0, array = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &flat);
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &array);
    glTextureStorage2D(flat, 1, GL_R8, 1, 1);
    glTextureStorage3D(array, 1, GL_R8, 1, 1, 1);
    glDeleteTextures(1, &flat);
    glDeleteTextures(1, &array);
  }

  static inline SmallGpu* here_ = nullptr;
  static inline int layers_ = 0, side_px_ = 0;
  PFNGLTEXTURESTORAGE2DPROC storage_2d_ = nullptr;
  PFNGLTEXTURESTORAGE3DPROC storage_3d_ = nullptr;
};

class GpuMemory : public GlTest {
 protected:
  [[nodiscard]] static GlobeOptions with_bytes(std::size_t bytes) {
    GlobeOptions options = unlit_options();
    options.gpu_bytes = bytes;
    return options;
  }
  [[nodiscard]] FrameStats settled(Globe& globe) {
    globe.set_camera(camera_at(10, 20, 3.0e6));
    const FrameStats stats = settle(globe, kFull);
    EXPECT_TRUE(globe.status());
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(picture().at(128, 128), (Color{0, 200, 0}));
    return stats;
  }
  [[nodiscard]] static std::shared_ptr<TileSource> many_tiles() { return one_colour(kManyTiles, {0, 200, 0}); }
};

TEST_F(GpuMemory, WhatTheDriverGrantsIsInTheStatistics) {
  GLint layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  const std::size_t asked = std::size_t{64} << 30;
  const auto globe = make_globe(with_bytes(asked), many_tiles());
  const FrameStats stats = settled(*globe);
  const std::size_t slot = stats.gpu_bytes_granted / static_cast<std::size_t>(layers);
  EXPECT_LT(stats.gpu_bytes_granted, asked);
  EXPECT_EQ(stats.gpu_bytes_granted, slot * static_cast<std::size_t>(layers));
  globe->set_budget({.gpu_bytes = 100 * slot,
                     .upload_bytes_per_frame = 1 << 20,
                     .upload_time_per_frame = {},
                     .relief_meshes_per_frame = 1});
  EXPECT_EQ(settled(*globe).gpu_bytes_granted, 100 * slot);
}

TEST_F(GpuMemory, AGlobeGoesOnWithFewerTiles) {
  const auto rich = make_globe(with_bytes(1UL << 30), many_tiles());
  const FrameStats whole = settled(*rich);
  const SmallGpu small(150, 1024);
  const auto globe = make_globe(with_bytes(1UL << 30), many_tiles());
  const FrameStats stats = settled(*globe);
  EXPECT_GT(whole.tiles_wanted, 150);
  EXPECT_LT(stats.tiles_wanted, 150) << "the view is drawn coarser";
  EXPECT_GT(stats.tiles_wanted, 64) << "tiles beyond the first growth are used";
  EXPECT_LT(stats.gpu_bytes_granted, whole.gpu_bytes_granted);
  EXPECT_EQ(stats.gpu_bytes_granted, stats.gpu_bytes);
  EXPECT_TRUE(stats.gpu_memory_refused);
  EXPECT_FALSE(whole.gpu_memory_refused);
  EXPECT_EQ(stats.patches_uncovered, 0);
}

TEST_F(GpuMemory, ASmallerBudgetStaysIfBothSizesDoNotFit) {
  const auto globe = make_globe(with_bytes(1UL << 30), many_tiles());
  const FrameStats before = settled(*globe);
  const SmallGpu small(8, 1024);
  globe->set_budget({.gpu_bytes = before.gpu_bytes / 4,
                     .upload_bytes_per_frame = 1 << 20,
                     .upload_time_per_frame = {},
                     .relief_meshes_per_frame = 1});
  EXPECT_EQ(settled(*globe).gpu_bytes, before.gpu_bytes);
}

TEST_F(GpuMemory, ALayerWithoutMemoryIsAnError) {
  const SmallGpu small(4, 1024);
  const auto globe = std::move(*Globe::create(unlit_options()));
  const auto added = globe->add_imagery(many_tiles());
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("Globe::add_imagery: the driver has no memory for tiles"), std::string::npos)
      << added.error().message;
  EXPECT_TRUE(globe->imagery().empty());
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(GpuMemory, APictureWithoutMemoryIsAnError) {
  const auto globe = make_globe(unlit_options(), many_tiles());
  const OffscreenTarget target(kFull);
  const SmallGpu small(2048, 200);
  globe->render(target.framebuffer(), kFull);
  ASSERT_FALSE(globe->status());
  EXPECT_NE(globe->status().error().message.find("Globe::render: the driver has no memory for a picture of 256x256"),
            std::string::npos)
      << globe->status().error().message;
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  EXPECT_GT(globe->render(target.framebuffer(), {200, 200}).patches, 0);
  EXPECT_TRUE(globe->status());
}

}  // namespace
}  // namespace terrella::test
