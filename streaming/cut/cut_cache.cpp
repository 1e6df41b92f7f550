#include <fmt/format.h>

#include <algorithm>

#include "base/hash_mix.h"
#include "streaming/cut.h"
#include "streaming/cut/cut_key.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxStemBytes = 80;

/// Files beside the picture can change its place without changing its own size and time.
Result<std::string> cache_name(const CutOptions& options) {
  const fs::path& image = options.images.front();
  const auto picture = picture_of(options);
  if (!picture) return picture.error();
  const auto place = find_place(options, *picture);
  if (!place) return place.error();
  if (options.remark) std::ranges::for_each(place->placed.remarks, options.remark);
  const auto of_picture = cut_key(options, place_text(*place));
  if (!of_picture) return of_picture.error();
  std::error_code failed;
  const fs::path canonical = fs::canonical(file_of(image), failed);
  if (failed) return Error{fmt::format("{}: cannot be opened: {}", image.string(), failed.message())};
  const std::string key = canonical.string() + "|" + *of_picture;
  return fmt::format("{}-{:016x}.gpkg", image.stem().string().substr(0, kMaxStemBytes), name_hash(key));
}

}  // namespace

Result<fs::path> cache_path(const CutOptions& options, const fs::path& cache_dir) {
  if (options.images.size() != 1) return Error{"one picture is cut into the cache at a time"};
  const auto name = cache_name(options);
  if (!name) return name.error();
  return cache_dir / *name;
}

Result<fs::path> cut_into_cache(const CutOptions& options, const fs::path& cache_dir) {
  const auto path = cache_path(options, cache_dir);
  if (!path) return path.error();
  CutOptions into = options;
  into.output = *path;
  into.remark = {};
  std::error_code failed;
  // A file with this name is always complete.
  if (fs::is_regular_file(into.output, failed)) return into.output;
  fs::create_directories(cache_dir, failed);
  if (failed) return Error{fmt::format("{}: cannot be made: {}", cache_dir.string(), failed.message())};
  const auto done = cut(into);
  if (!done) return done.error();
  return into.output;
}

}  // namespace terrella
