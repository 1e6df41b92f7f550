// Tiles made of Web Mercator's: where they show things, how sharp, what they do where something is missing.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <condition_variable>
#include <future>
#include <mutex>
#include <numbers>
#include <thread>

#include "mercator_planet.h"
#include "streaming/warp/web_mercator.h"
#include "tests/streaming/streaming_test_support.h"
#include "tiles/height_decoder.h"
#include "tiles/tile_loader.h"

namespace terrella {
namespace {

using test::MercatorPlanet;
using test::PlaceColor;

constexpr int kMercatorPx = 64;
constexpr int kMercatorLevels = 7;
/// Content may lie a quarter of a pixel off; eight bits and the filter leave a fiftieth.
constexpr double kPlacementPx = 0.05;
/// Error of waves 12 pixels long and 100 levels high: a cubic keeps 98 % of them.
constexpr double kWaveRms = 3.0;

/// Waves whose crests lie so many degrees apart, so that what is misplaced shows in proportion.
test::Planet waves(double lat_period_deg, double lon_period_deg) {
  return [=](double lat, double lon) {
    const auto wave = [](double at, double period) {
      return 127.5 + 100.0 * std::sin(2.0 * std::numbers::pi * at / period);
    };
    return PlaceColor{.red = wave(lat, lat_period_deg), .green = wave(lon, lon_period_deg), .blue = 40.0};
  };
}

std::unique_ptr<TileSource> geodetic(std::unique_ptr<MercatorPlanet> planet) {
  auto tiles = as_geodetic(std::move(planet), "the test's set");
  EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
  return *std::move(tiles);
}

Result<Image, TileFailure> picture(TileSource& tiles, const TileId& id) {
  auto tile = tiles.read(id);
  if (!tile) return tile.error();
  return tile->make_picture();
}

/// Misfit between a tile and the planet: the shift that explains most of it, and the error in all.
struct Misfit {
  double shift_px = 0.0;
  double rms = 0.0;
};

/// Misfit of one channel, along rows or columns, by least squares against the planet's own slope. Pixels beyond ±84°
/// are left out: there the set ends.
Misfit misfit(const Image& tile, const TileGrid& grid, const TileId& id, const test::Planet& planet, bool north_south) {
  const TileBounds bounds = tile_bounds(grid, id);
  const double step = tile_span_deg(grid, id.level) / grid.tile_px;
  double product = 0.0, square = 0.0, error = 0.0;
  int pixels = 0;
  for (int j = 0; j < tile.height_px; ++j) {
    const double lat = bounds.north_deg - (j + 0.5) * step;
    if (std::abs(lat) > 84.0) continue;
    for (int i = 0; i < tile.width_px; ++i) {
      const double lon = bounds.west_deg + (i + 0.5) * step;
      const auto value = [&](double move) {
        const PlaceColor color =
            planet(lat + (north_south ? move * step : 0.0), lon + (north_south ? 0.0 : move * step));
        return north_south ? color.red : color.green;
      };
      const double slope = value(0.5) - value(-0.5);
      const std::size_t at = static_cast<std::size_t>(j * tile.width_px + i) * 4;
      const double difference = tile.rgba[at + (north_south ? 0 : 1)] - value(0.0);
      product += difference * slope;
      square += slope * slope;
      error += difference * difference;
      ++pixels;
    }
  }
  if (pixels == 0) return {};
  return {.shift_px = std::abs(product / square), .rms = std::sqrt(error / pixels)};
}

struct Place {
  int level;
  double lat_deg, lon_deg;
  friend void PrintTo(const Place& one, std::ostream* out) {
    *out << one.level << " at " << one.lat_deg << ", " << one.lon_deg;
  }
};

class MercatorPlaces : public testing::TestWithParam<Place> {};

TEST_P(MercatorPlaces, ShowThingsWhereTheyAre) {
  const Place place = GetParam();
  TileGrid grid = geodetic_grid_of(MercatorPlanet({}, kMercatorPx, kMercatorLevels).info().grid);
  const double step = tile_span_deg(grid, place.level) / grid.tile_px;
  const TileXY at = tile_xy(grid, place.level, place.lat_deg, place.lon_deg);
  const TileId id{place.level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)};
  const TileBounds bounds = tile_bounds(grid, id);
  // As long on the ground both ways, and whole periods around the planet.
  const double nearest =
      std::abs(place.lat_deg) < 1.0 ? 0.0 : std::min(std::abs(bounds.south_deg), std::abs(bounds.north_deg));
  const double cosine = std::cos(nearest * std::numbers::pi / 180.0);
  const double around = std::round(360.0 / (12.0 * step / cosine));
  const auto planet = waves(12.0 * step, 360.0 / around);
  const auto tiles = geodetic(std::make_unique<MercatorPlanet>(planet, kMercatorPx, kMercatorLevels));
  const auto made = picture(*tiles, id);
  ASSERT_TRUE(made) << made.error().why;
  const Misfit rows = misfit(*made, grid, id, planet, true);
  const Misfit columns = misfit(*made, grid, id, planet, false);
  EXPECT_LE(rows.shift_px, kPlacementPx);
  EXPECT_LE(columns.shift_px, kPlacementPx);
  EXPECT_LE(rows.rms, kWaveRms);
  EXPECT_LE(columns.rms, kWaveRms);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, MercatorPlaces,
                         testing::Values(Place{3, 20.0, 10.0}, Place{5, 1.0, -179.0}, Place{5, -1.0, 179.0},
                                         Place{6, 47.0, 8.0}, Place{6, -63.0, 179.9}, Place{7, 70.0, -179.9},
                                         Place{7, 78.0, 15.0}, Place{8, -80.0, 30.0}, Place{8, 65.0, 30.0},
                                         Place{9, 83.0, 100.0}));

TEST(Mercator, BeyondItsEndTilesAreTransparent) {
  const auto tiles = geodetic(std::make_unique<MercatorPlanet>(waves(30.0, 30.0), kMercatorPx, 4));
  const TileGrid& grid = tiles->info().grid;
  EXPECT_EQ(grid.max_level, 7) << "an eighth of a texel along the meridian at 82.8°";
  const TileId id{4, 3, 0};
  const auto made = picture(*tiles, id);
  ASSERT_TRUE(made);
  const double step = tile_span_deg(grid, 4) / kMercatorPx;
  for (int j = 0; j < kMercatorPx; ++j) {
    const double north = 90.0 - j * step;
    const int alpha = made->rgba[static_cast<std::size_t>(j * kMercatorPx + 5) * 4 + 3];
    if (north - step >= kMercatorEndDeg) {
      EXPECT_EQ(alpha, 0) << j;
    } else if (north <= kMercatorEndDeg) {
      EXPECT_EQ(alpha, 255) << j;
    } else {
      EXPECT_NEAR(alpha, 255.0 * (kMercatorEndDeg - north + step) / step, 1.0);
    }
  }
  EXPECT_FALSE(exists(grid, {7, 0, 0})) << "wholly beyond the end";
}

TEST(Mercator, PlainColoursStayThoseAndNothingIsReadThatIsNotNeeded) {
  const auto plain = [](double, double) { return PlaceColor{.red = 200.0, .green = 3.0, .blue = 255.0}; };
  auto planet = std::make_unique<MercatorPlanet>(plain, kMercatorPx, kMercatorLevels);
  MercatorPlanet& stored = *planet;
  const auto tiles = geodetic(std::move(planet));
  const auto made = picture(*tiles, {6, 20, 9});
  ASSERT_TRUE(made);
  for (std::size_t i = 0; i < made->rgba.size(); i += 4) {
    ASSERT_EQ(made->rgba[i], 200);
    ASSERT_EQ(made->rgba[i + 1], 3);
    ASSERT_EQ(made->rgba[i + 2], 255);
    ASSERT_EQ(made->rgba[i + 3], 255);
  }
  // 34° to 39°: the tiles' own level, one column, and the row that the filter looks into.
  EXPECT_LE(stored.reads().size(), 3U);
  for (const auto& [id, reads] : stored.reads()) {
    EXPECT_EQ(id.level, 6);
    EXPECT_EQ(id.x, 20);
    EXPECT_EQ(reads, 1);
  }
  // Blocks decoded for one tile serve its neighbours.
  const std::size_t before = stored.reads().size();
  ASSERT_TRUE(picture(*tiles, {6, 20, 9}));
  for (const auto& [id, reads] : stored.reads()) EXPECT_EQ(reads, 1);
  EXPECT_EQ(stored.reads().size(), before);
}

TEST(Mercator, FarFromTheEquatorALevelLessIsEnough) {
  const TileGrid mercator = MercatorPlanet({}, kMercatorPx, 10).info().grid;
  const TileGrid grid = geodetic_grid_of(mercator);
  const auto level_at = [&](double lat) {
    const TileId id{10, 500, static_cast<std::int64_t>(tile_xy(grid, 10, lat, 0.0).y)};
    return stored_tiles_of(mercator, std::array{id})->begin()->level;
  };
  EXPECT_EQ(level_at(0.0), 10);
  EXPECT_EQ(level_at(59.0), 10);
  EXPECT_EQ(level_at(61.0), 9);
  EXPECT_EQ(level_at(-76.0), 8);
  EXPECT_EQ(level_at(84.0), 7);
}

// ---- what is missing

struct MissingTest : testing::Test {
  MissingTest() : planet(std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5)), stored(*planet) {}
  Result<Image, TileFailure> make(const TileId& id) {
    if (planet) tiles = geodetic(std::move(planet));
    return picture(*tiles, id);
  }
  std::unique_ptr<MercatorPlanet> planet;
  MercatorPlanet& stored;
  std::unique_ptr<TileSource> tiles;
  /// Its own rows are those of 5/10/13 and 5/10/14 in Mercator, 11.25° to 22.5° north.
  static constexpr TileId kTile{5, 10, 6};
};

TEST_F(MissingTest, AnAncestorStandsInForWhatIsAbsent) {
  const auto whole = make(kTile);
  ASSERT_TRUE(whole);
  stored.note_missing({5, 10, 14}, MissingKind::absent);
  tiles = geodetic(std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5));
  auto part = std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5);
  part->note_missing({5, 10, 14}, MissingKind::absent);
  tiles = geodetic(std::move(part));
  const auto made = make(kTile);
  ASSERT_TRUE(made) << made.error().why;
  double worst = 0.0;
  for (std::size_t i = 0; i < made->rgba.size(); ++i)
    worst = std::max(worst, std::abs(double(made->rgba[i]) - whole->rgba[i]));
  EXPECT_GT(worst, 0.0) << "some of it is of the coarser level";
  EXPECT_LT(worst, 8.0) << "which shows the same waves";
}

TEST_F(MissingTest, WithoutAnAncestorItIsTransparentThere) {
  for (int level = 0; level <= 5; ++level)
    stored.note_missing({level, 10 >> (5 - level), 14 >> (5 - level)}, MissingKind::absent);
  const auto made = make(kTile);
  ASSERT_TRUE(made) << made.error().why;
  EXPECT_EQ(made->rgba[3], 255) << "north";
  EXPECT_EQ(made->rgba.back(), 0) << "south";
}

TEST_F(MissingTest, AllAbsentIsAbsentAndAllBlankIsBlank) {
  for (const MissingKind kind : {MissingKind::absent, MissingKind::blank}) {
    auto none = std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5);
    for (int y = 10; y < 17; ++y) none->note_missing({5, 10, y}, kind);
    tiles = geodetic(std::move(none));
    planet.reset();
    const auto made = tiles->read(kTile);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, kind);
  }
}

TEST_F(MissingTest, WhatFailedOrIsBrokenIsNamed) {
  stored.note_missing({5, 10, 14}, MissingKind::failed);
  const auto failed = make(kTile);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, MissingKind::failed);
  EXPECT_NE(failed.error().why.find("Web Mercator tile 5/10/14: the test says so"), std::string::npos);

  auto wrong = std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5);
  wrong->give({5, 10, 14}, test::gradient(32, 32));
  tiles = geodetic(std::move(wrong));
  const auto small = picture(*tiles, kTile);
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error().kind, MissingKind::broken);
  EXPECT_NE(small.error().why.find("5/10/14: it is 32×32 pixels, the tile set says 64×64"), std::string::npos);
}

TEST(Mercator, SetsBeyondItsEndAreRefused) {
  auto pole = std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5);
  pole->change().grid.bounds.south = Angle::degrees(86.0);
  EXPECT_FALSE(as_geodetic(std::move(pole), "pole.gpkg"));
}

/// Heights of 100 m for each degree of latitude, with a tile of scale 2 and offset 7.
class HeightPlanet : public TileSource {
 public:
  HeightPlanet() {
    info_.grid = {
        .root_span_deg = 360.0, .tile_px = kMercatorPx, .max_level = 4, .projection = Projection::web_mercator};
    info_.numbers = NumberInfo{.scale = 1.0, .offset = 0.0, .floats = true};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    EncodedTile tile{.bytes = {}, .number_scale = 2.0, .number_offset = 7.0};
    tile.make_numbers = [id]() -> Result<Numbers, TileFailure> {
      Numbers numbers{kMercatorPx, kMercatorPx, {}};
      for (int j = 0; j < kMercatorPx; ++j) {
        const double down = (static_cast<double>(id.y) + (j + 0.5) / kMercatorPx) * std::ldexp(1.0, -id.level);
        const double y = std::numbers::pi * (1.0 - 2.0 * down);
        const double lat = std::atan(std::sinh(y)) * 180.0 / std::numbers::pi;
        numbers.values.insert(numbers.values.end(), kMercatorPx, static_cast<float>((100.0 * lat - 7.0) / 2.0));
      }
      return numbers;
    };
    return tile;
  }

 private:
  TileSetInfo info_;
};

TEST(Mercator, HeightsAreNumbersOfTheSameMeaning) {
  const auto tiles = as_geodetic(std::make_unique<HeightPlanet>(), "heights");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const TileId id{4, 5, 3};  // 22.5° to 0°
  const auto tile = (*tiles)->read(id);
  ASSERT_TRUE(tile);
  const auto heights = decode_heights(id, *tile, *(*tiles)->info().numbers, kMercatorPx);
  ASSERT_TRUE(heights) << heights.error().why;
  for (int j = 0; j < kMercatorPx; ++j) {
    const double lat = 22.5 - (j + 0.5) * 22.5 / kMercatorPx;
    ASSERT_NEAR(heights->heights_m[static_cast<std::size_t>(j * kMercatorPx + 9)], 100.0 * lat, 0.5) << j;
  }
  const auto end = (*tiles)->read({4, 5, 0});
  ASSERT_TRUE(end);
  EXPECT_TRUE(std::isnan(end->make_numbers()->values.front())) << "the pole";
  EXPECT_FALSE(std::isnan(end->make_numbers()->values.back()));
}

// ---- behind a network

constexpr std::chrono::seconds kFarPatience{60};  // a loaded machine under a sanitizer

/// A planet whose tiles have to be fetched; the test answers.
class FarPlanet : public TileSource, public RemoteTiles {
 public:
  explicit FarPlanet(std::unique_ptr<MercatorPlanet> planet) : planet_(std::move(planet)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return planet_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override {
    std::unique_lock lock(disk_);
    disk_waits_ = !disk_turns_;
    disk_changed_.notify_all();
    disk_changed_.wait(lock, [this] { return disk_turns_; });
    return TileFailure{MissingKind::remote, {}};
  }
  /// A disk that does not turn holds up read().
  void turn_disk(bool turns) {
    const std::lock_guard lock(disk_);
    disk_turns_ = turns;
    disk_changed_.notify_all();
  }
  void wait_until_disk_waits() {
    std::unique_lock lock(disk_);
    disk_changed_.wait(lock, [this] { return disk_waits_; });
  }
  [[nodiscard]] RemoteTiles* remote() override { return this; }
  void fetch(const TileId& id, double priority, Done done) override {
    const std::lock_guard lock(mutex_);
    ++fetches[id];
    priorities[id] = priority;
    asked_[id] = std::move(done);
    changed_.notify_all();
  }
  void set_priority(const TileId& id, double priority) override {
    const std::lock_guard lock(mutex_);
    priorities[id] = priority;
  }
  void cancel(const TileId& id) override {
    const std::lock_guard lock(mutex_);
    asked_.erase(id);
    changed_.notify_all();
  }
  /// True once exactly so many tiles are asked for.
  [[nodiscard]] bool wait_until_asked(std::size_t tiles) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kFarPatience, [&] { return asked_.size() == tiles; });
  }
  /// Answers one after the other until nothing is asked.
  void answer_all() {
    while (true) {
      TileId id;
      Done done;
      {
        const std::lock_guard lock(mutex_);
        if (asked_.empty()) return;
        id = asked_.begin()->first;
        done = std::move(asked_.begin()->second);
        asked_.erase(asked_.begin());
      }
      done(planet_->read(id));
    }
  }

  std::map<TileId, int> fetches;
  std::map<TileId, double> priorities;

 private:
  const std::unique_ptr<MercatorPlanet> planet_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<TileId, Done> asked_;
  std::mutex disk_;
  std::condition_variable disk_changed_;
  bool disk_turns_ = true;
  bool disk_waits_ = false;
};

struct FarMercator : testing::Test {
  FarMercator() {
    auto planet = std::make_unique<MercatorPlanet>(waves(20.0, 20.0), kMercatorPx, 5);
    stored = planet.get();
    auto far_planet = std::make_unique<FarPlanet>(std::move(planet));
    network = far_planet.get();
    tiles = *as_geodetic(std::move(far_planet), "far");
  }
  /// Wants a tile, and waits until the network is asked for all that the tiles wanted so far are made of.
  void want(const TileId& id, double priority) {
    wanted.push_back(id);
    tiles->remote()->fetch(id, priority, [this](Result<EncodedTile, TileFailure> answer) {
      const std::lock_guard lock(mutex);
      answers.push_back(std::move(answer));
    });
    EXPECT_TRUE(network->wait_until_asked(stored_tiles_of(stored->info().grid, wanted)->size()));
  }
  [[nodiscard]] std::size_t answered() {
    const std::lock_guard lock(mutex);
    return answers.size();
  }
  /// Lets the network answer until so many tiles are made.
  [[nodiscard]] bool answer_until(std::size_t tiles_made) {
    const auto deadline = std::chrono::steady_clock::now() + kFarPatience;
    while (answered() < tiles_made && std::chrono::steady_clock::now() < deadline) {
      network->answer_all();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return answered() == tiles_made;
  }
  std::mutex mutex;  ///< guards answers
  std::vector<Result<EncodedTile, TileFailure>> answers;
  std::vector<TileId> wanted;
  MercatorPlanet* stored = nullptr;
  FarPlanet* network = nullptr;
  std::unique_ptr<TileSource> tiles;
};

TEST_F(FarMercator, WhatManyTilesAreMadeOfIsFetchedOnce) {
  for (int y = 4; y < 8; ++y) {
    ASSERT_EQ(tiles->read({5, 10, y}).error().kind, MissingKind::remote);
    want({5, 10, y}, y);
  }
  for (const auto& [id, times] : network->fetches) EXPECT_EQ(times, 1) << id.y;
  for (const auto& [id, priority] : network->priorities) EXPECT_GE(priority, 4.0);
  ASSERT_TRUE(answer_until(4));
  for (const auto& answer : answers) {
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->make_picture());
  }
}

TEST_F(FarMercator, AbsentOnesAreLookedForALevelHigherOverTheNetworkToo) {
  stored->note_missing({5, 10, 14}, MissingKind::absent);
  want({5, 10, 6}, 1.0);
  ASSERT_TRUE(answer_until(1));
  ASSERT_TRUE(answers[0]) << answers[0].error().why;
  EXPECT_EQ(network->fetches.count({4, 5, 7}), 1U);
  EXPECT_EQ(answers[0]->make_picture()->rgba.back(), 255);
}

TEST_F(FarMercator, WhatNobodyWaitsForIsCancelled) {
  want({5, 10, 6}, 1.0);
  const std::size_t one = stored_tiles_of(stored->info().grid, wanted)->size();
  want({5, 10, 5}, 2.0);
  ASSERT_GT(stored_tiles_of(stored->info().grid, wanted)->size(), one);
  tiles->remote()->cancel({5, 10, 5});
  EXPECT_TRUE(network->wait_until_asked(one)) << "the other tile's stay";
  tiles->remote()->cancel({5, 10, 6});
  EXPECT_TRUE(network->wait_until_asked(0));
  EXPECT_EQ(answered(), 0U);
}

TEST_F(FarMercator, MainDoesNotWaitForTheDiskThatAnAnswerWaitsFor) {
  stored->note_missing({5, 10, 14}, MissingKind::absent);
  want({5, 10, 6}, 1.0);
  network->turn_disk(false);
  network->answer_all();
  network->wait_until_disk_waits();
  auto called = std::async(std::launch::async, [this] {
    tiles->remote()->set_priority({5, 10, 6}, 3.0);
    tiles->remote()->cancel({5, 10, 6});
  });
  EXPECT_EQ(called.wait_for(std::chrono::seconds(5)), std::future_status::ready);
  network->turn_disk(true);
  called.get();
  EXPECT_TRUE(network->wait_until_asked(0));
  EXPECT_EQ(answered(), 0U);
}

TEST_F(FarMercator, OneThatFailsEndsTheWaitAtOnce) {
  const TileId first = *stored_tiles_of(stored->info().grid, std::array{TileId{5, 10, 6}})->begin();
  stored->note_missing(first, MissingKind::failed);
  want({5, 10, 6}, 1.0);
  ASSERT_TRUE(answer_until(1));
  ASSERT_FALSE(answers[0]);
  EXPECT_EQ(answers[0].error().kind, MissingKind::failed);
  EXPECT_TRUE(network->wait_until_asked(0));
}

TEST_F(FarMercator, TheLoaderTakesThemAsItTakesAnyTiles) {
  const std::shared_ptr<TileSource> shared = std::move(tiles);
  TileLoader loader(shared, {.workers = 2});
  loader.request(std::vector<TileRequest>{{{5, 10, 6}, 1.0}, {{5, 10, 7}, 2.0}});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  std::size_t come = 0;
  while (come < 2 && std::chrono::steady_clock::now() < deadline) {
    network->answer_all();
    loader.wait(std::chrono::steady_clock::now() + std::chrono::milliseconds(5));
    for (const LoadedTile& tile : loader.poll(1 << 20)) {
      EXPECT_TRUE(tile.tile) << tile.tile.error().why;
      ++come;
    }
  }
  EXPECT_EQ(come, 2U);
}

}  // namespace
}  // namespace terrella
