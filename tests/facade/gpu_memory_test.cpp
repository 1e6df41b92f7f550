// The GPU has too little memory: the globe goes on with less, says what it got, and leaves no error of OpenGL.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kFull{256, 256};
const TileGrid kManyTiles{.tile_px = 16, .max_level = 9}, kSqueezed{.tile_px = 16, .max_level = 9, .reduced = true};
// Slots of kManyTiles have 32 px a side and 5 kB. 8 MiB of them are fewer than a driver's layers, which are at least
// 2048; 64 GiB fill all layers with the most slots.
constexpr std::size_t kOneSlotALayer_bytes = 8UL << 20, kSlotsALayer = 16, kSlot_bytes = 5120;
// Places in a layer sixteen times as large are rounded otherwise, and which slot a tile gets depends on the order in
// which tiles come. A filter without a GPU rounds the place along a row, the place along a column and the level to
// 1/256: one colour level each between neighbours that differ by all of them, as those of coarse stripes do. Its three
// blends are rounded by half a level each. Texels of another tile would differ by dozens.
constexpr int kRounding_levels = 4;

/// A driver that says that its array textures have at most so many layers.
class FewLayers {
 public:
  explicit FewLayers(int layers) {
    GLint value = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &value);  // libepoxy looks a function up at its first call
    said_ = layers;
    get_ = epoxy_glGetIntegerv;
    epoxy_glGetIntegerv = [](GLenum limit, GLint* into) {
      get_(limit, into);
      if (limit == GL_MAX_ARRAY_TEXTURE_LAYERS) *into = said_;
    };
  }
  ~FewLayers() { epoxy_glGetIntegerv = get_; }
  FewLayers(const FewLayers&) = delete;
  FewLayers& operator=(const FewLayers&) = delete;

 private:
  static inline int said_ = 0;
  static inline PFNGLGETINTEGERVPROC get_ = nullptr;
};

/// A driver whose array textures have at most so many layers, whose pictures at most so many pixels a side, and whose
/// buffers at most so many bytes. Asked for more, OpenGL itself runs out of memory: it is asked for terabytes.
class SmallGpu {
 public:
  SmallGpu(int most_layers, int most_px, GLsizeiptr most_bytes = kAnyBytes) {
    look_up_functions();
    storage_2d_ = epoxy_glTextureStorage2D;
    storage_3d_ = epoxy_glTextureStorage3D;
    buffer_data_ = epoxy_glNamedBufferData;
    buffer_storage_ = epoxy_glNamedBufferStorage;
    here_ = this;
    layers_ = most_layers;
    side_px_ = most_px;
    bytes_ = most_bytes;
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
    epoxy_glNamedBufferData = [](GLuint name, GLsizeiptr bytes, const void* data, GLenum usage) {
      const bool fits = bytes <= bytes_;
      here_->buffer_data_(name, fits ? bytes : kAnyBytes, fits ? data : nullptr, usage);
    };
    epoxy_glNamedBufferStorage = [](GLuint name, GLsizeiptr bytes, const void* data, GLbitfield flags) {
      const bool fits = bytes <= bytes_;
      here_->buffer_storage_(name, fits ? bytes : kAnyBytes, fits ? data : nullptr, flags);
    };
  }
  static constexpr GLsizeiptr kAnyBytes = GLsizeiptr{1} << 46;
  ~SmallGpu() {
    epoxy_glTextureStorage2D = storage_2d_;
    epoxy_glTextureStorage3D = storage_3d_;
    epoxy_glNamedBufferData = buffer_data_;
    epoxy_glNamedBufferStorage = buffer_storage_;
    glEnable(GL_DEBUG_OUTPUT);
  }
  SmallGpu(const SmallGpu&) = delete;
  SmallGpu& operator=(const SmallGpu&) = delete;

 private:
  /// libepoxy looks a function up at its first call, and then replaces the pointer.
  static void look_up_functions() {
    GLuint flat = 0, array = 0;
    std::array<GLuint, 2> buffers{};
    glCreateBuffers(2, buffers.data());
    glNamedBufferData(buffers[0], 1, nullptr, GL_STATIC_DRAW);
    glNamedBufferStorage(buffers[1], 1, nullptr, 0);
    glDeleteBuffers(2, buffers.data());
    glCreateTextures(GL_TEXTURE_2D, 1, &flat);
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &array);
    glTextureStorage2D(flat, 1, GL_R8, 1, 1);
    glTextureStorage3D(array, 1, GL_R8, 1, 1, 1);
    glDeleteTextures(1, &flat);
    glDeleteTextures(1, &array);
  }

  static inline SmallGpu* here_ = nullptr;
  static inline int layers_ = 0, side_px_ = 0;
  static inline GLsizeiptr bytes_ = 0;
  PFNGLTEXTURESTORAGE2DPROC storage_2d_ = nullptr;
  PFNGLTEXTURESTORAGE3DPROC storage_3d_ = nullptr;
  PFNGLNAMEDBUFFERDATAPROC buffer_data_ = nullptr;
  PFNGLNAMEDBUFFERSTORAGEPROC buffer_storage_ = nullptr;
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
  static void set_bytes(Globe& globe, std::size_t bytes) {
    globe.set_budget({.gpu_bytes = bytes,
                      .upload_bytes_per_frame = 1 << 20,
                      .upload_time_per_frame = {},
                      .relief_meshes_per_frame = 1});
  }
  [[nodiscard]] static std::size_t layers_of_driver() {
    GLint layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    return static_cast<std::size_t>(layers);
  }
  [[nodiscard]] Picture picture_of(Globe& globe, const Camera& camera) {
    globe.set_camera(camera);
    settle(globe, kFull);
    EXPECT_TRUE(globe.status());
    return picture();
  }
  static void expect_same(const Picture& a, const Picture& b) {
    int most = 0;
    for (std::size_t k = 0; k < a.rgba.size(); ++k) most = std::max(most, std::abs(int{a.rgba[k]} - int{b.rgba[k]}));
    EXPECT_LE(most, kRounding_levels);
  }
  [[nodiscard]] static std::shared_ptr<PaintedSource> striped_tiles() {
    return std::make_shared<PaintedSource>(kSqueezed, [](double lon_deg, double row_deg) {
      const auto wave = [](double deg) { return static_cast<std::uint8_t>(127.5 + 127.0 * std::sin(0.5 * deg)); };
      return Color{wave(lon_deg), wave(row_deg), wave(lon_deg + row_deg)};
    });
  }
  [[nodiscard]] static std::shared_ptr<TileSource> number_tiles() {
    return std::make_shared<PaintedNumbers>(kSqueezed, [](double lon_deg, double row_deg) {
      return static_cast<float>(std::sin(0.3 * lon_deg) + std::cos(0.7 * row_deg));
    });
  }
  [[nodiscard]] static ImageLook number_look() {
    ImageLook look;
    look.numbers = NumberLook{.low = -2.0, .high = 2.0};
    return look;
  }
  [[nodiscard]] static std::shared_ptr<TileSource> many_tiles() { return one_colour(kManyTiles, {0, 200, 0}); }
};

TEST_F(GpuMemory, WhatTheDriverGrantsIsInTheStatistics) {
  const std::size_t asked = std::size_t{64} << 30;
  const auto globe = make_globe(with_bytes(asked), many_tiles());
  const FrameStats stats = settled(*globe);
  const std::size_t slot = stats.gpu_bytes_granted / (kSlotsALayer * layers_of_driver());
  EXPECT_LT(stats.gpu_bytes_granted, asked);
  EXPECT_EQ(stats.gpu_bytes_granted, slot * kSlotsALayer * layers_of_driver());
  set_bytes(*globe, 160 * slot);
  EXPECT_EQ(settled(*globe).gpu_bytes_granted, 160 * slot);
}

// More tiles than the driver has layers are put side by side. The picture is the same, also at a pole, where rows of
// tiles of different width share gutters, and with numbers. No tile is loaded again when its slot is moved.
TEST_F(GpuMemory, SlotsSideBySideShowTheSamePicture) {
  constexpr int kLayers = 64;
  const auto source = striped_tiles(), beside = striped_tiles();
  const auto one = make_globe(with_bytes(kOneSlotALayer_bytes), source);
  const auto several = make_globe(with_bytes(kOneSlotALayer_bytes), beside);
  for (const bool numbers : {false, true}) {
    for (Globe* globe : {one.get(), several.get()}) {
      ASSERT_TRUE(!numbers || globe->add_imagery(number_tiles(), number_look()));
    }
    for (const Camera& camera : {camera_at(10, 20, 3.0e6), camera_at(88, 20, 1.0e6), camera_at(-30, 180, 2.0e5)}) {
      const Picture expected = picture_of(*one, camera);
      const FewLayers few(kLayers);
      expect_same(expected, picture_of(*several, camera));
      EXPECT_EQ(source->reads(), beside->reads());
    }
  }
  EXPECT_GT(settle(*several, kFull).gpu_bytes, 2 * kLayers * kSlot_bytes);
  set_bytes(*several, kLayers * kSlot_bytes);
  const FewLayers few(kLayers);
  EXPECT_LE(settle(*several, kFull).gpu_bytes, kLayers * kSlot_bytes);
}

TEST_F(GpuMemory, AnObjectLayerWithoutMemoryIsLeftOutUntilThereIsSome) {
  const auto globe = make_globe(unlit_options(), many_tiles());
  EXPECT_FALSE(settled(*globe).gpu_memory_refused);
  ObjectScene discs;
  for (int k = 0; k < 1000; ++k) {
    discs.points.push_back({.place = {.lat = Angle::degrees(10), .lon = Angle::degrees(20)}, .size_px = 20.0F});
  }
  ASSERT_TRUE(globe->add_objects(discs));
  {
    const SmallGpu small(2048, 16384, 30'000);
    EXPECT_TRUE(settled(*globe).gpu_memory_refused) << "1,000 discs take 32,000 bytes";
  }
  const FrameStats stats = settle(*globe, kFull);
  EXPECT_FALSE(stats.gpu_memory_refused);
  EXPECT_EQ(picture().at(128, 128), (Color{230, 60, 50}));
}

TEST_F(GpuMemory, AnAreaOnTheGroundWithoutMemoryIsLeftOutUntilTheBudgetIsSetAgain) {
  const auto globe = make_globe(unlit_options(), many_tiles());
  EXPECT_FALSE(settled(*globe).gpu_memory_refused);
  PolygonObject area{.fill = {230, 0, 0}};
  for (const auto& [lat, lon] : {std::pair{0, 10}, {0, 30}, {20, 30}, {20, 10}}) {
    area.rings.resize(1);
    area.rings[0].push_back({.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)});
  }
  ASSERT_TRUE(globe->add_objects({.polygons = {area}}));
  {
    const SmallGpu small(0, 16384);
    EXPECT_TRUE(settled(*globe).gpu_memory_refused);
  }
  set_bytes(*globe, std::size_t{512} << 20);
  EXPECT_FALSE(settle(*globe, kFull).gpu_memory_refused);
  EXPECT_EQ(picture().at(128, 128), (Color{230, 0, 0}));
}

TEST_F(GpuMemory, AModelWithoutMemoryIsLeftOut) {
  const auto globe = make_globe(unlit_options(), many_tiles());
  EXPECT_FALSE(settled(*globe).gpu_memory_refused);
  const auto model = std::make_shared<MeshModel>();
  model->parts.push_back({.vertices = std::vector<MeshVertex>(2000), .indices = std::vector<std::uint32_t>(3000)});
  const auto picture_px = std::make_shared<MeshTexture>();
  *picture_px = {.width_px = 300, .height_px = 300, .rgba = std::vector<std::uint8_t>(360'000)};
  model->parts.push_back({.vertices = std::vector<MeshVertex>(3), .indices = {0, 1, 2}, .texture = picture_px});
  ObjectScene scene;
  scene.meshes.push_back({.model = model, .place = {.lat = Angle::degrees(10), .lon = Angle::degrees(20)}});
  for (const auto& [side_px, bytes] : {std::pair{16384, GLsizeiptr{60'000}}, {256, SmallGpu::kAnyBytes - 1}}) {
    const SmallGpu small(2048, side_px, bytes);
    const LayerId layer = *globe->add_objects(scene);
    EXPECT_TRUE(settled(*globe).gpu_memory_refused) << side_px << " px, " << bytes << " bytes";
    ASSERT_TRUE(globe->remove(layer));
  }
}

// 512 patches are 9 MB.
TEST_F(GpuMemory, GroundWithoutMemoryIsAnErrorUntilThereIsSome) {
  std::unique_ptr<Globe> globe;
  const OffscreenTarget target(kFull);
  {
    const SmallGpu small(2048, 16384, 1'000'000);
    globe = make_globe(unlit_options(), many_tiles());
    globe->render(target.framebuffer(), kFull);
    ASSERT_FALSE(globe->status());
    EXPECT_NE(globe->status().error().message.find("no memory for the vertices of the ground"), std::string::npos)
        << globe->status().error().message;
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
  EXPECT_FALSE(settled(*globe).gpu_memory_refused);
}

TEST_F(GpuMemory, AGlobeGoesOnWithFewerTiles) {
  const auto rich = make_globe(with_bytes(kOneSlotALayer_bytes), many_tiles());
  const FrameStats whole = settled(*rich);
  const SmallGpu small(150, 1024);
  const auto globe = make_globe(with_bytes(kOneSlotALayer_bytes), many_tiles());
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
  const auto globe = make_globe(with_bytes(kOneSlotALayer_bytes), many_tiles());
  const FrameStats before = settled(*globe);
  const SmallGpu small(8, 1024);
  set_bytes(*globe, before.gpu_bytes / 4);
  EXPECT_EQ(settled(*globe).gpu_bytes, before.gpu_bytes);
}

TEST_F(GpuMemory, ALayerWithoutMemoryIsAnError) {
  const SmallGpu small(4, 1024);
  const auto globe = std::move(*Globe::create(with_bytes(kOneSlotALayer_bytes)));
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
