// Stores tiles in a cache, and beside that the same tiles in plain files: tiles a second and processor time a tile.
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "streaming/cache/tile_cache.h"

namespace {

namespace fs = std::filesystem;
using namespace terrella;

constexpr int kLevel = 8;

struct Options {
  int tiles = 20'000;
  int tile_bytes = 11'000;
  std::uint64_t limit_mb = 0;
  int rounds = 3;
  std::string folder = fs::temp_directory_path().string();
};

struct Cost {
  double wall_s = 0.0;
  double cpu_s = 0.0;
};

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

template <class Work>
Cost cost_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), cpu_seconds() - cpu};
}

TileId tile(int n) { return {kLevel, n % 512, n / 512}; }

/// Sizes as of real tiles: from a third to five thirds of the mean, the same in each round.
std::vector<std::vector<std::byte>> make_tiles(const Options& options) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> size(options.tile_bytes / 3, options.tile_bytes * 5 / 3);
  std::vector<std::vector<std::byte>> tiles(static_cast<std::size_t>(options.tiles));
  for (auto& bytes : tiles) {
    bytes.resize(static_cast<std::size_t>(size(random)));
    for (std::size_t i = 0; i < bytes.size(); i += 64) bytes[i] = static_cast<std::byte>(random());
  }
  return tiles;
}

Cost store_in_cache(const Options& options, const fs::path& path, std::vector<std::vector<std::byte>> tiles) {
  TileSetInfo info;
  info.grid.max_level = kLevel;
  return cost_of([&] {
    auto cache = TileCache::open(path, info, "bench", {.max_bytes = options.limit_mb << 20});
    if (!cache) throw std::runtime_error(cache.error().message);
    for (int n = 0; n < options.tiles; ++n) {
      CacheRecord record;
      record.bytes = std::move(tiles[static_cast<std::size_t>(n)]);
      record.etag = "\"5f3c-62a1b4c8d9e00\"";
      record.last_modified = "Sun, 06 Nov 1994 08:49:37 GMT";
      (*cache)->store(tile(n), std::move(record));
    }
    if (const Status flushed = (*cache)->flush(); !flushed) throw std::runtime_error(flushed.error().message);
  });
}

Cost store_in_files(const fs::path& folder, const std::vector<std::vector<std::byte>>& tiles) {
  return cost_of([&] {
    for (int n = 0; n < static_cast<int>(tiles.size()); ++n) {
      const TileId id = tile(n);
      const fs::path column = folder / std::to_string(id.level) / std::to_string(id.x);
      if (id.y == 0) fs::create_directories(column);
      const auto& bytes = tiles[static_cast<std::size_t>(n)];
      std::ofstream file(column / (std::to_string(id.y) + ".jpg"), std::ios::binary);
      file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
  });
}

void report(const char* what, const Options& options, const Cost& cost, std::uintmax_t bytes) {
  fmt::print("{:<8} {:>8.0f} tiles/s  {:>6.1f} us CPU a tile  {:>7.1f} MB\n", what, options.tiles / cost.wall_s,
             cost.cpu_s * 1e6 / options.tiles, static_cast<double>(bytes) * 1e-6);
}

void run(const Options& options) {
  const fs::path folder = fs::path(options.folder) / fmt::format("cache_store-{}", getpid());
  const auto tiles = make_tiles(options);
  std::uintmax_t bytes = 0;
  for (const auto& data : tiles) bytes += data.size();
  for (int round = 0; round < options.rounds; ++round) {
    fs::create_directories(folder);
    const Cost cache = store_in_cache(options, folder / "cache.gpkg", tiles);
    report("cache", options, cache, fs::file_size(folder / "cache.gpkg"));
    report("files", options, store_in_files(folder / "files", tiles), bytes);
    fs::remove_all(folder);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Storing tiles in a cache, beside plain files", "cache_store");
  app.add_option("--tiles", options.tiles)->check(CLI::Range(1, 131'072))->capture_default_str();
  app.add_option("--bytes", options.tile_bytes, "mean size of a tile")
      ->check(CLI::Range(100, 1'000'000))
      ->capture_default_str();
  app.add_option("--limit-mb", options.limit_mb, "of the cache; 0: none")->capture_default_str();
  app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--folder", options.folder, "where to write")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "cache_store: {}\n", error.what());
    return 1;
  }
  return 0;
}
