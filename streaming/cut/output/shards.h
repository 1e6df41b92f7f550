#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/output/encode_pool.h"
#include "streaming/cut/output/work_folder.h"

/// Several machines at one picture: each makes the bands of its share in a folder of its own beside the output, and
/// one joins them.
namespace terrella {

struct BandRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

[[nodiscard]] Status check_shard(const CutOptions& options);

/// Shares that differ by one band at most; empty where there are fewer bands than shards.
[[nodiscard]] BandRange bands_of_shard(const CutShard& shard, std::int64_t bands);

/// "OUTPUT.shard-2-of-8"
[[nodiscard]] std::filesystem::path shard_folder(const std::filesystem::path& output, const CutShard& shard);

/// The tiles of bands that are there.
[[nodiscard]] Result<TileCounts> count_bands(const WorkFolder& folder, const BandRange& range);

struct FoundShards {
  std::vector<std::filesystem::path> bands;    ///< of all, in order: what their files' names begin with
  std::vector<std::filesystem::path> folders;  ///< that they lie in
};
/// The folders of all shards beside the output; an error that says which are missing, not finished or of another
/// picture.
[[nodiscard]] Result<FoundShards> find_shards(const std::filesystem::path& output, const std::string& key,
                                              std::int64_t bands);

}  // namespace terrella
