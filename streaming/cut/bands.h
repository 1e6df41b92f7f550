#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/output/encode_pool.h"
#include "streaming/cut/output/tile_encoder.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/cut/output/work_folder.h"
#include "streaming/cut/pyramid.h"

/// A cut works band by band. A band is the area of one row of tiles, kBandLevels levels above the finest. The tiles of
/// a band down to that level, and its rows of the next coarser level, depend on no other band. A killed run therefore
/// keeps its finished bands, and machines can share bands out. The coarser levels are made from the rows when all bands
/// are done.
namespace terrella {

inline constexpr int kBandLevels = 3;

struct BandLayout {
  int coarsest = 0;            ///< coarsest level made inside a band
  std::int64_t band_rows = 0;  ///< rows of the finest level in a band; bands begin at multiples of this number
  std::int64_t first = 0;
  std::int64_t count = 0;
};
[[nodiscard]] BandLayout bands_of(const CutPlan& plan);

/// Name of a band, such as "band-0007". Its files are BAND.tiles and BAND.rows (record_log).
[[nodiscard]] std::string band_name(std::int64_t band);

/// Values that are the same for all bands.
struct BandWork {
  const CutPlan& plan;
  std::vector<CutPiece> pieces;
  BandLayout layout;
  PixelKind pixels = PixelKind::opaque;
  std::optional<std::uint16_t> nodata = {};
  TileCoding coding;
  int jobs = 1;                  ///< ≥ 1
  std::filesystem::path output;  ///< included in errors
  /// Called with the rows done and the total rows. Returns false to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;
  std::function<void(const CutTile& tile)> tile_made = {};  ///< see CutWatch; may be empty
};

/// Makes the missing bands among [begin, end), counted from layout.first. The reader must be at the first row of the
/// picture. thread: one at a time
[[nodiscard]] Status make_bands(const BandWork& work, RowReader& reader, std::int64_t begin, std::int64_t end,
                                const WorkFolder& folder);

/// Writes the tiles of all bands and of the coarser levels, always in the same order. `bands` are the paths that the
/// files of each band begin with. thread: one at a time
[[nodiscard]] Result<TileCounts> join_bands(const BandWork& work, const std::vector<std::filesystem::path>& bands,
                                            TileWriter& writer);

}  // namespace terrella
