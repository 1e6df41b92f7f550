// A source whose tiles become better while a globe shows them: the globe shows the better ones, and no hole meanwhile.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/gl/gl_fixture.h"

namespace terrella::test {
namespace {

constexpr Viewport kPicture{128, 128};
constexpr Color kBefore = {200, 40, 40}, kAfter = {40, 200, 40};
const TileGrid kGrid{.tile_px = 64, .max_level = 3};

/// Tiles of one colour, then of another.
class Renewed : public TileSource {
 public:
  Renewed() : before_(one_colour(kGrid, kBefore)), after_(one_colour(kGrid, kAfter)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return before_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    ++reads;
    if (fails) return TileFailure{MissingKind::broken, "broken now"};
    return renewed ? after_->read(id) : before_->read(id);
  }
  [[nodiscard]] std::uint64_t edition() const override { return count; }
  [[nodiscard]] std::uint64_t edition_of(const TileId& id) const override {
    return id.level <= changing_down_to ? count.load() : 0;
  }

  std::atomic<bool> renewed = false, fails = false;
  std::atomic<std::uint64_t> count = 0;
  std::atomic<int> reads = 0;
  int changing_down_to = kMaxTileLevel;

 private:
  std::shared_ptr<TileSource> before_, after_;
};

class Editions : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    source_ = std::make_shared<Renewed>();
    globe_ = make_globe(unlit_options(), source_);
    globe_->set_camera({.eye = {.lat = Angle::degrees(20), .lon = Angle::degrees(15), .height_m = 9.0e6}});
    settle(*globe_, kPicture);
    ASSERT_EQ(middle(), kBefore);
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  [[nodiscard]] Color middle() const { return picture().at(64, 64); }
  /// Draws while there is something new, until nothing came for a while.
  void draw_news() {
    for (int quiet = 0; quiet < 20;) {
      if (!globe_->needs_frame()) {
        ++quiet;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      quiet = 0;
      draw(*globe_, kPicture);
      const Color shown = middle();
      EXPECT_TRUE(shown == kBefore || shown == kAfter) << "a hole";
    }
  }

  std::shared_ptr<Renewed> source_;
  std::unique_ptr<Globe> globe_;
};

TEST_F(Editions, DrawnTilesAreReadAgainAndTheEarlierOnesShowMeanwhile) {
  EXPECT_FALSE(globe_->needs_frame());
  source_->renewed = true;
  ++source_->count;
  EXPECT_TRUE(globe_->needs_frame());
  draw(*globe_, kPicture);
  EXPECT_TRUE(globe_->settled()) << "better tiles are no missing ones";
  draw_news();
  const auto rgba = picture().rgba;
  for (std::size_t i = 0; i < rgba.size(); i += 4) ASSERT_NE(rgba[i], kBefore[0]) << "an earlier tile stays";
  EXPECT_EQ(middle(), kAfter);
  const int reads = source_->reads;
  globe_->set_camera({.eye = {.lat = Angle::degrees(20), .lon = Angle::degrees(15), .height_m = 9.1e6}});
  settle(*globe_, kPicture);
  EXPECT_LT(source_->reads, reads + 3) << "tiles that are up to date are not read again";
}

TEST_F(Editions, TilesThatHaveNotChangedAreNotReadAgain) {
  source_->changing_down_to = -1;
  const int reads = source_->reads;
  ++source_->count;
  draw_news();
  EXPECT_EQ(source_->reads, reads);
}

TEST_F(Editions, AnEarlierTileStaysIfTheBetterOneCannotBeRead) {
  source_->fails = true;
  ++source_->count;
  draw_news();
  EXPECT_EQ(middle(), kBefore);
  EXPECT_TRUE(globe_->missing_tiles().empty());
}

}  // namespace
}  // namespace terrella::test
