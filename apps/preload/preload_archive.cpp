#include "apps/preload/preload_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/hash_mix.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/convert/convert.h"
#include "streaming/convert/merge_into.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/cut/output_claim.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

constexpr std::int64_t kMostRowsAtOnce = 4096;

/// Mark of an archive that has all tiles of a plan.
std::string mark_of(const PreloadSource& source, const TilePlan& plan) {
  std::uint64_t hash = name_hash(source.key);
  const auto feed = plan.walk();
  while (const auto run = feed->next()) {
    for (const std::int64_t number : {std::int64_t{run->level}, run->x, run->first_y, run->last_y}) {
      hash = mix_bits(hash ^ static_cast<std::uint64_t>(number)) + 1;
    }
  }
  return fmt::format("preload {:016x}", hash);
}

/// The planned tiles of a cache. An earlier preload of another plan may have left more.
class PlannedTiles : public TileSource, public TileLister {
 public:
  PlannedTiles(const TilePlan& plan, TileCache& cache, std::shared_ptr<TileSource> stored)
      : plan_(plan), cache_(cache), stored_(std::move(stored)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return stored_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return stored_->read(id); }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    bool goes_on = true;
    const auto look = [this](const TileId&) {
      ++stored_tiles;
      return true;
    };
    if (Status all = dynamic_cast<TileLister&>(*stored_).for_each_tile(look); !all) return all;
    const auto feed = plan_.walk();
    for (auto run = feed->next(); run && goes_on; run = feed->next()) {
      const auto call_row = [&](std::int64_t y, const CacheRecord& record) {
        if (goes_on && !record.missing) goes_on = call({.level = run->level, .x = run->x, .y = y});
      };
      for (std::int64_t y = run->first_y; y <= run->last_y && goes_on; y += kMostRowsAtOnce) {
        const std::int64_t last_y = std::min(run->last_y, y + kMostRowsAtOnce - 1);
        if (Status looked = cache_.peek_column(run->level, run->x, y, last_y, call_row); !looked) return looked;
      }
    }
    return Done{};
  }

  std::int64_t stored_tiles = 0;  ///< tiles of the cache, once they were listed

 private:
  const TilePlan& plan_;
  TileCache& cache_;
  const std::shared_ptr<TileSource> stored_;
};

}  // namespace

std::string cache_file_of(const std::string& output) {
  return is_web_format(output) ? output + ".unfinished.gpkg" : output;
}

Status check_archive(const std::string& output, const PreloadSource& source) {
  Status fits = check_output(output, source.cache_info);
  if (fits || !source.remote || source.cache_info.grid.projection != Projection::equirectangular) return fits;
  return Error{fits.error().message + "; or give --projection web-mercator if the address counts tiles as web maps do"};
}

Result<bool> has_archive(const std::string& output, const PreloadSource& source, const TilePlan& plan) {
  std::error_code failed;
  if (!is_web_format(output) || !std::filesystem::exists(output, failed)) return false;
  if (may_replace({.output = output, .images = {}, .mark = mark_of(source, plan)}, output)) {
    return !std::filesystem::is_empty(output, failed);
  }
  return Error{output + ": is there already, and was not made by this preload; name another output, or move it away"};
}

Result<bool> make_archive(const std::string& output, const PreloadSource& source, const TilePlan& plan,
                          std::shared_ptr<TileCache> cache,
                          const std::function<bool(std::int64_t done, std::int64_t total)>& progress) {
  const std::string file = cache_file_of(output);
  const auto planned = std::make_shared<PlannedTiles>(plan, *cache, merged_tiles({file}, cache->info(), output));
  const auto made =
      convert({.from = file, .to = output, .source = planned, .mark = mark_of(source, plan), .progress = progress});
  if (!made) return made.error();
  cache.reset();
  const bool has_more = planned->stored_tiles > made->tiles + made->blank;
  if (!has_more) remove_database(file);
  return has_more;
}

}  // namespace terrella
