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

/// A cut goes band by band: a band is what one row of tiles covers kBandLevels levels above the finest. Its tiles down
/// to that level, and its rows of the level above, need nothing of other bands. So a band is what a killed run need not
/// do again and what machines share out; the coarser levels are made of the rows when all bands are there.
namespace terrella {

inline constexpr int kBandLevels = 3;

struct BandLayout {
  int coarsest = 0;            ///< of a band's own levels
  std::int64_t band_rows = 0;  ///< of the finest level; bands lie at multiples of it
  std::int64_t first = 0;
  std::int64_t count = 0;
};
[[nodiscard]] BandLayout bands_of(const CutPlan& plan);

/// "band-0007": its files are BAND.tiles and BAND.rows (record_log).
[[nodiscard]] std::string band_name(std::int64_t band);

/// All that stays the same from band to band.
struct BandWork {
  const CutPlan& plan;
  std::vector<CutPiece> pieces;
  BandLayout layout;
  PixelKind pixels = PixelKind::opaque;
  std::optional<std::uint16_t> nodata = {};
  TileCoding coding;
  int jobs = 1;                  ///< ≥ 1
  std::filesystem::path output;  ///< named in errors
  /// With rows done and rows in all; false asks to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;
};

/// Makes the bands [begin, end), counted from layout.first, that are not in the folder yet. The reader stands at the
/// picture's first row. thread: one at a time
[[nodiscard]] Status make_bands(const BandWork& work, RowReader& reader, std::int64_t begin, std::int64_t end,
                                const WorkFolder& folder);

/// Writes the tiles of all bands, whose files begin with these paths, and of the coarser levels. Always in the same
/// order. thread: one at a time
[[nodiscard]] Result<TileCounts> join_bands(const BandWork& work, const std::vector<std::filesystem::path>& bands,
                                            TileWriter& writer);

}  // namespace terrella
