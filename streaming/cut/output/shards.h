#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/output/encode_pool.h"
#include "streaming/cut/output/work_folder.h"

/// Lets several machines cut one picture. Each makes the bands of its share in its own folder beside the output. One
/// machine joins them.
namespace terrella {

struct BandRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

[[nodiscard]] Status check_shard(const CutOptions& options);

/// Bands of one shard. Shares differ by at most one band. A share is empty if there are fewer bands than shards.
[[nodiscard]] BandRange bands_of_shard(const CutShard& shard, std::int64_t bands);

/// "OUTPUT.shard-2-of-8"
[[nodiscard]] std::filesystem::path shard_folder(const std::filesystem::path& output, const CutShard& shard);

/// Counts the tiles of existing bands.
[[nodiscard]] Result<TileCounts> count_bands(const WorkFolder& folder, const BandRange& range);

struct FoundShards {
  std::vector<std::filesystem::path> bands;    ///< path prefix of the files of each band, in order
  std::vector<std::filesystem::path> folders;  ///< folders that contain them
};
/// Finds the folders of all shards beside the output. The error lists shards that are missing, unfinished or of another
/// picture.
[[nodiscard]] Result<FoundShards> find_shards(const std::filesystem::path& output, const std::string& key,
                                              std::int64_t bands);

}  // namespace terrella
