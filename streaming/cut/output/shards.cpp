#include "streaming/cut/output/shards.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "streaming/cut/bands.h"
#include "streaming/cut/output/part_name.h"
#include "streaming/cut/output/record_log.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxShards = 100000;

/// The count N of any folder OUTPUT.shard-I-of-N with this key; 0 if there is none.
int shard_count(const fs::path& output, const std::string& key) {
  const std::string begin = output.filename().string() + ".shard-";
  std::error_code failed;
  for (fs::directory_iterator entry(folder_of(output), failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    CutShard shard;
    if (!name.starts_with(begin) ||
        std::sscanf(name.c_str() + begin.size(), "%d-of-%d", &shard.index, &shard.count) != 2) {
      continue;
    }
    const bool sane = shard.count >= 1 && shard.count <= kMaxShards && entry->path() == shard_folder(output, shard);
    if (sane && key_of_folder(entry->path()) == key) return shard.count;
  }
  return 0;
}

bool has_all(const fs::path& folder, const BandRange& range) {
  std::error_code failed;
  for (std::int64_t band = range.begin; band < range.end; ++band) {
    if (!fs::exists(folder / (band_name(band) + ".rows"), failed)) return false;
  }
  return true;
}

}  // namespace

Status check_shard(const CutOptions& options) {
  if (!options.shard) return Done{};
  const auto& [index, count] = *options.shard;
  if (options.join) return Error{"a shard cannot be joined; join when all shards are done"};
  if (count >= 1 && count <= kMaxShards && index >= 1 && index <= count) return Done{};
  return Error{fmt::format("shard {}/{}: it takes I/N with 1 <= I <= N <= {}", index, count, kMaxShards)};
}

BandRange bands_of_shard(const CutShard& shard, std::int64_t bands) {
  return {bands * (shard.index - 1) / shard.count, bands * shard.index / shard.count};
}

fs::path shard_folder(const fs::path& output, const CutShard& shard) {
  return folder_of(output) / fmt::format("{}.shard-{}-of-{}", output.filename().string(), shard.index, shard.count);
}

Result<TileCounts> count_bands(const WorkFolder& folder, const BandRange& range) {
  TileCounts counts;
  for (std::int64_t band = range.begin; band < range.end; ++band) {
    auto log = RecordLogReader::open(folder / (band_name(band) + ".tiles"));
    if (!log) return log.error();
    while (true) {
      const auto record = log->next();
      if (!record) return record.error();
      if (!*record) break;
      counts.add((*record)->id, (*record)->bytes.size());
    }
  }
  return counts;
}

Result<FoundShards> find_shards(const fs::path& output, const std::string& key, std::int64_t bands) {
  const int count = shard_count(output, key);
  if (count == 0) {
    return Error{
        fmt::format("{}: no shards of these pictures with these options lie beside it; cut them first with "
                    "‹shard› 1/N to ‹shard› N/N",
                    output.string())};
  }
  FoundShards found;
  std::vector<int> missing;
  for (int index = 1; index <= count; ++index) {
    const fs::path folder = shard_folder(output, {index, count});
    const BandRange range = bands_of_shard({index, count}, bands);
    if (range.begin == range.end) {
      if (key_of_folder(folder) == key) found.folders.push_back(folder);
      continue;
    }
    if (key_of_folder(folder) != key || !has_all(folder, range)) {
      missing.push_back(index);
      continue;
    }
    found.folders.push_back(folder);
    for (std::int64_t band = range.begin; band < range.end; ++band) found.bands.push_back(folder / band_name(band));
  }
  if (missing.empty()) return found;
  return Error{fmt::format("{}: shards {} of {} are missing or not finished; run them again with the same arguments",
                           output.string(), fmt::join(missing, ", "), count)};
}

}  // namespace terrella
