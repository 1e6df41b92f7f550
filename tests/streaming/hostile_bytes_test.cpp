#include <gtest/gtest.h>

#include <random>

#include "codecs/image.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sets/tms_xml.h"
#include "streaming_test_support.h"

namespace terrella {
namespace {

constexpr std::uint32_t kSeed = 20260721;
constexpr int kFlips = 400;
constexpr DecodeLimits kLimits{.max_side_px = 1024, .max_bytes = 4UL << 20};

using Bytes = std::vector<std::byte>;

/// Every prefix of a file, a step apart, and the file with a few bits flipped. Whatever comes out, it must come out.
template <class Read>
void feed_damaged(const Bytes& whole, const Read& read) {
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 200);
  for (std::size_t size = 0; size < whole.size(); size += step)
    read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
  std::mt19937 random(kSeed);
  for (int i = 0; i < kFlips; ++i) {
    Bytes damaged = whole;
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
      damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    }
    read(damaged);
  }
}

void read_as_image(const Bytes& bytes) {
  const auto image = decode_image(bytes, kLimits);
  if (!image) {
    EXPECT_FALSE(image.error().message.empty());
    return;
  }
  EXPECT_LE(image->rgba.size(), kLimits.max_bytes);
  EXPECT_EQ(image->rgba.size(),
            static_cast<std::size_t>(image->width_px) * static_cast<std::size_t>(image->height_px) * 4);
}

std::string_view text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

TEST(HostileBytes, Jpeg) { feed_damaged(*encode_jpeg(test::gradient(96, 64), 85), read_as_image); }

TEST(HostileBytes, Png) { feed_damaged(*encode_png(test::gradient(96, 64)), read_as_image); }

TEST(HostileBytes, TileSetJson) {
  TileSetInfo info;
  info.name = "planet";
  info.body = "moon";
  info.format = ImageFormat::png;
  feed_damaged(test::bytes_of(to_tileset_json(info)), [](const Bytes& bytes) {
    const auto read = parse_tileset_json(text_of(bytes), "here");
    if (!read) {
      EXPECT_EQ(read.error().message.rfind("here: ", 0), 0U) << read.error().message;
    }
  });
}

TEST(HostileBytes, TileSetJsonThatNestsDeeply) {
  const std::string brackets(kMaxTileSetJsonBytes, '[');
  EXPECT_FALSE(parse_tileset_json(brackets, "here"));
  const std::string closed = std::string(1000, '[') + std::string(1000, ']');
  EXPECT_FALSE(parse_tileset_json(closed, "here"));
  EXPECT_FALSE(parse_tileset_json(brackets + "[", "here"));
}

TEST(HostileBytes, TileMapResource) {
  const std::string xml =
      "<?xml version=\"1.0\"?><TileMap><Title>t</Title><SRS>EPSG:4326</SRS><BoundingBox minx=\"-180\" miny=\"-90\" "
      "maxx=\"180\" maxy=\"90\"/><TileFormat width=\"256\" height=\"256\" extension=\"jpg\"/><TileSets "
      "profile=\"geodetic\">"
      "<TileSet href=\"0\" units-per-pixel=\"0.703125\" order=\"0\"/></TileSets></TileMap>";
  ASSERT_TRUE(parse_tms_xml(xml, "here"));
  feed_damaged(test::bytes_of(xml), [](const Bytes& bytes) {
    const auto read = parse_tms_xml(text_of(bytes), "here");
    if (!read) {
      EXPECT_EQ(read.error().message.rfind("here: ", 0), 0U) << read.error().message;
    }
  });
}

}  // namespace
}  // namespace terrella
