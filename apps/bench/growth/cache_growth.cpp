#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "apps/bench/growth/flat_source.h"
#include "apps/bench/growth/growth_rows.h"
#include "apps/bench/shots.h"
#include "streaming/cache/cache_report.h"
#include "streaming/cache/merge_caches.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/tile_cache.h"

namespace terrella::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kGrowthSource = "bench growth";
/// Tiles of these levels can be drawn. All others lie on kDeepLevel, and have kRowBytes each.
constexpr int kDrawnLevels = 4, kDeepLevel = 12;
constexpr int kRowBytes = 256;
constexpr std::int64_t kDeepRows = std::int64_t{1} << kDeepLevel;
constexpr int kLooks = 2000;                                   // look-ups of one measurement
constexpr std::int64_t kLeastStored = 100, kStoredPart = 100;  // a hundredth of the cache is stored anew

TileSetInfo growth_info() {
  TileSetInfo info = make_flat_source(kDeepLevel)->info();
  info.name = kGrowthSource;
  return info;
}

template <class T, class E>
T must(Result<T, E> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

std::shared_ptr<TileCache> cache_at(const fs::path& path, std::uint64_t max_bytes = 0) {
  return must(TileCache::open(path, growth_info(), kGrowthSource, {.max_bytes = max_bytes}));
}

std::int64_t drawn_tiles() {
  std::int64_t tiles = 0;
  for (int level = 0; level < kDrawnLevels; ++level) tiles += std::int64_t{2} << (2 * level);
  return tiles;
}

void store_drawn_tiles(TileCache& cache) {
  for (int level = 0; level < kDrawnLevels; ++level) {
    for (std::int64_t x = 0; x < std::int64_t{2} << level; ++x) {
      for (std::int64_t y = 0; y < std::int64_t{1} << level; ++y) {
        CacheRecord record;
        record.bytes = flat_tile();
        cache.store({level, x, y}, std::move(record));
      }
    }
  }
  must(cache.flush());
}

/// A cache of so many tiles. Those of kDeepLevel are written column by column with SQL, because a million answers of a
/// server would take minutes. Their last uses are roughly in the order of storing, as after a
/// flight.
void make_cache(const fs::path& path, std::int64_t tiles) {
  remove_database(path);
  store_drawn_tiles(*cache_at(path));
  auto database = must(SqliteWriter::open(path, SqliteWriter::Mode::existing));
  const std::string rows = fmt::format(
      "WITH RECURSIVE k(n) AS (SELECT 0 UNION ALL SELECT n + 1 FROM k WHERE n + 1 < {}) INSERT INTO tiles "
      "(zoom_level, tile_column, tile_row, tile_data) SELECT {}, n / {}, n % {}, zeroblob({}) FROM k",
      tiles - drawn_tiles(), kDeepLevel, kDeepRows, kDeepRows, kRowBytes);
  const std::string sides = fmt::format(
      "INSERT INTO terrella_cache_tiles SELECT id, '\"5f3c-62a1b4c8\"', '', 1700000000, NULL, "
      "1700000000 + id / 10 + id * 7919 % 1000 FROM tiles WHERE zoom_level = {}",
      kDeepLevel);
  for (const std::string& sql :
       {std::string("PRAGMA synchronous = OFF"), std::string("BEGIN"), rows, sides, std::string("COMMIT")}) {
    must(database.run(sql));
  }
}

class CacheGrowth {
 public:
  CacheGrowth(const BenchOptions& options, const AddRow& add) : options_(options), add_(add) {}

  void measure(std::int64_t tiles) {
    tiles_ = tiles;
    const fs::path folder = options_.work / "growth", path = folder / "cache.gpkg";
    fs::create_directories(folder);
    say("made");
    make_cache(path, tiles);
    megabytes_ = 1e-6 * static_cast<double>(fs::file_size(path));
    say("opened");
    timed("open", 3, [&] { cache_at(path); });
    look_up(path);
    timed("info", 1, [&] { must(read_cache_report(path, 1'700'000'000)); });
    draw(path);
    merge(folder, path);
    evict(path);
    remove_database(path);
  }

 private:
  void say(const char* what) { options_.progress(fmt::format("cache of {} tiles: {}", tiles_, what)); }

  /// Adds a row with the least of several runs, divided by the items of a run.
  template <class Work>
  void timed(const char* subject, int runs, const Work& work, double items = 1.0) {
    double ms = HUGE_VAL, cpu_ms = HUGE_VAL;
    for (int run = 0; run < runs; ++run) {
      const auto start = Clock::now();
      const double cpu = processor_ms();
      work();
      cpu_ms = std::min(cpu_ms, processor_ms() - cpu);
      ms = std::min(ms, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    add(subject, ms / items, cpu_ms / items, items > 1.0);
  }

  void add(const char* subject, double ms, double cpu_ms, bool of_one) {
    add_({.series = "cache",
          .subject = subject,
          .size = static_cast<double>(tiles_),
          .ms = ms,
          .cpu_ms = cpu_ms,
          .tiles = tiles_,
          .of_one = of_one,
          .megabytes = megabytes_});
  }

  void look_up(const fs::path& path) {
    say("look-ups");
    const auto cache = cache_at(path);
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::int64_t> any(0, tiles_ - drawn_tiles() - 1);
    timed(
        "look-up", 3,
        [&] {
          for (int k = 0; k < kLooks; ++k) {
            const std::int64_t n = any(random);
            if (!must(cache->find({kDeepLevel, n / kDeepRows, n % kDeepRows}))) {
              throw std::runtime_error("a tile of the cache is not found");
            }
          }
        },
        kLooks);
  }

  void draw(const fs::path& path) {
    say("a view drawn from it");
    constexpr Viewport kSize{512, 512};
    GlobeOptions options;
    options.unlit = true;
    const auto globe = open_globe(path.string(), options);
    const OffscreenTarget target(kSize);
    settle(*globe, {.eye = {20, 0, 2e7}}, target, kSize);
    std::vector<Subject> frames = {{.name = "", .draw = [&] { globe->render(target.framebuffer(), kSize); }}};
    time_frames(frames, options_.effort == Effort::quick ? 3 : 15);
    add("frame", median(frames[0].ms), median(frames[0].cpu_ms), false);
  }

  void merge(const fs::path& folder, const fs::path& path) {
    say("merged with a small one");
    const fs::path small = folder / "small.gpkg", merged = folder / "merged.gpkg";
    make_cache(small, 1000);
    timed("merge", 1, [&] { must(merge_caches({path, small}, merged)); });
    remove_database(merged);
    remove_database(small);
  }

  /// Stores tiles under a limit of the file's own size. They are as large as the others, so each evicts one. The first
  /// ones make room for SQLite's log, which counts; the others are timed.
  void evict(const fs::path& path) {
    say("tiles evicted");
    const auto cache = cache_at(path, static_cast<std::uint64_t>(1e6 * megabytes_));
    const std::int64_t stored = std::max(kLeastStored, tiles_ / kStoredPart);
    const auto store = [&](std::int64_t first) {
      for (std::int64_t k = first; k < first + stored; ++k) {
        CacheRecord record;
        record.bytes.resize(kRowBytes);
        cache->store({kDeepLevel - 1, k / 64, k % 64}, std::move(record));
      }
      must(cache->flush());
    };
    store(0);
    timed(
        "store and evict", 1, [&] { store(stored); }, static_cast<double>(stored));
  }

  const BenchOptions& options_;
  const AddRow& add_;
  std::int64_t tiles_ = 0;
  double megabytes_ = 0.0;
};

}  // namespace

void measure_cache_growth(const BenchOptions& options, const AddRow& add) {
  if (!options.wants("cache")) return;
  std::vector<std::int64_t> sizes = {1'000, 10'000};
  if (options.effort != Effort::quick) sizes.insert(sizes.end(), {100'000, 1'000'000});
  if (options.effort == Effort::full) sizes.push_back(10'000'000);
  CacheGrowth growth(options, add);
  for (const std::int64_t tiles : sizes) growth.measure(tiles);
}

}  // namespace terrella::bench
