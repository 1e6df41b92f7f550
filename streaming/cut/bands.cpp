#include "streaming/cut/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "streaming/cut/output/encode_pool.h"
#include "streaming/cut/output/record_log.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Most memory for all strips together, bytes, if the picture's width permits. The strips in progress always get their
/// memory.
constexpr std::size_t kStripBytes = 160UL << 20;
/// Number of strips that wait for an encoder while the next ones are filled.
constexpr std::size_t kStripsAhead = 2;
/// Small pictures may run further ahead, bytes.
constexpr std::size_t kAlwaysAllowedBytes = 48UL << 20;
constexpr std::int64_t kRowsPerProgress = 16;

std::size_t pool_bytes(const BandWork& work, const PyramidPart& part) {
  std::size_t building = 0;
  std::size_t finest = 0;
  for (const CutPiece& piece : work.pieces) {
    building += Pyramid::strip_bytes(piece.plan, part);
    finest += Pyramid::finest_strip_bytes(piece.plan);
  }
  const std::size_t wished = building + std::max(kAlwaysAllowedBytes, kStripsAhead * finest);
  return std::max(building, std::min(wished, kStripBytes));
}

/// The pyramids of a band, one for each piece, and the outputs for their tiles and rows.
class BandMaker {
 public:
  BandMaker(const BandWork& work, const PyramidPart& part, StripPool& strips, RecordLogWriter& tiles,
            RecordLogWriter& rows)
      : work_(work), rows_(rows), pool_(work.jobs, work.coding, tiles, tiles.found()) {
    for (std::size_t i = 0; i < work.pieces.size(); ++i) {
      pyramids_.push_back(std::make_unique<Pyramid>(
          work.pieces[i].plan, part, strips, [this](const auto& strip) { pool_.submit(strip); },
          [this, i](double area, std::span<const float> row) { keep_row(static_cast<std::int64_t>(i), area, row); }));
    }
    if (pyramids_.size() > 1) row_.resize(static_cast<std::size_t>(work.plan.finest.x1 - work.plan.finest.x0) * 4);
  }

  [[nodiscard]] Status read_row(RowReader& reader) {
    if (pyramids_.size() == 1) {
      if (Status read = reader.read_row(pyramids_.front()->next_row()); !read) return read;
      pyramids_.front()->row_written();
      return rows_kept_;
    }
    if (Status read = reader.read_row(row_); !read) return read;
    for (std::size_t i = 0; i < pyramids_.size(); ++i) {
      const std::span<std::uint8_t> to = pyramids_[i]->next_row();
      std::memcpy(to.data(), row_.data() + work_.pieces[i].first_column * 4, to.size());
      pyramids_[i]->row_written();
    }
    return rows_kept_;
  }

  [[nodiscard]] bool failed() const { return pool_.failed(); }
  [[nodiscard]] Status finish() {
    const auto counts = pool_.finish();
    if (!counts) return counts.error();
    return Done{};
  }

 private:
  void keep_row(std::int64_t piece, double area, std::span<const float> row) {
    record_.resize(sizeof(area) + row.size_bytes());
    std::memcpy(record_.data(), &area, sizeof(area));
    std::memcpy(record_.data() + sizeof(area), row.data(), row.size_bytes());
    if (Status kept = rows_.put({.level = 0, .x = piece, .y = 0}, record_); !kept) rows_kept_ = kept;
  }

  const BandWork& work_;
  RecordLogWriter& rows_;
  EncodePool pool_;
  std::vector<std::unique_ptr<Pyramid>> pyramids_;
  std::vector<std::uint8_t> row_;
  std::vector<std::byte> record_;
  Status rows_kept_ = Done{};
};

std::int64_t rows_in(const BandWork& work) { return work.plan.finest.y1 - work.plan.finest.y0; }

Status stopped(const BandWork& work) { return Error{fmt::format("{}: cutting was stopped", work.output.string())}; }

/// Streams the rows [from, to) of the picture.
Status stream_rows(const BandWork& work, RowReader& reader, std::int64_t from, std::int64_t to, BandMaker& maker) {
  const std::int64_t total = rows_in(work);
  for (std::int64_t y = from; y < to; ++y) {
    if (Status read = maker.read_row(reader); !read) return read;
    if ((y + 1) % kRowsPerProgress != 0 && y + 1 != total) continue;
    if (maker.failed()) return Done{};
    if (work.progress && !work.progress(y + 1, total)) return stopped(work);
  }
  return Done{};
}

struct RowRange {
  std::int64_t from, to;  ///< rows of the picture
};

RowRange rows_of_band(const BandWork& work, std::int64_t band) {
  const PixelRect& px = work.plan.finest;
  const std::int64_t top = (work.layout.first + band) * work.layout.band_rows;
  return {std::max(px.y0, top) - px.y0, std::min(px.y1, top + work.layout.band_rows) - px.y0};
}

/// Calls `visit` for each record of a file, until one fails.
template <class Visit>
Status for_each_record(const fs::path& path, const Visit& visit) {
  auto log = RecordLogReader::open(path);
  if (!log) return log.error();
  while (true) {
    const auto record = log->next();
    if (!record) return record.error();
    if (!*record) return Done{};
    if (Status visited = visit(**record); !visited) return visited;
  }
}

/// Tells of the tiles of a finished band.
Status tell_tiles(const BandWork& work, const fs::path& path) {
  if (!work.tile_made) return Done{};
  return for_each_record(path, [&](const auto& record) -> Status {
    work.tile_made({record.id, path, record.offset, record.bytes.size()});
    return Done{};
  });
}

Status make_band(const BandWork& work, RowReader& reader, std::int64_t band, StripPool& strips, const fs::path& files) {
  const fs::path path = files.string() + ".tiles";
  RecordLogWriter::Told told;
  if (work.tile_made) {
    told = [&](const TileId& id, std::uint64_t offset, std::size_t size) { work.tile_made({id, path, offset, size}); };
  }
  auto tiles = RecordLogWriter::open(path, true, work.output, std::move(told));
  if (!tiles) return tiles.error();
  auto kept = RecordLogWriter::open(files.string() + ".rows", false, work.output);
  if (!kept) return kept.error();
  const RowRange rows = rows_of_band(work, band);
  const PyramidPart part{.coarsest = work.layout.coarsest,
                         .finest = work.plan.grid.max_level,
                         .first_row = (work.layout.first + band) * work.layout.band_rows,
                         .pixels = work.pixels,
                         .nodata = work.nodata};
  {
    BandMaker maker(work, part, strips, **tiles, **kept);
    if (Status streamed = stream_rows(work, reader, rows.from, rows.to, maker); !streamed) return streamed;
    if (Status finished = maker.finish(); !finished) return finished;
  }
  // If the rows of a band have their final name, its tiles have theirs too.
  if (Status whole = (*tiles)->finish(); !whole) return whole;
  return (*kept)->finish();
}

bool is_made(const fs::path& files) {
  std::error_code failed;
  return fs::exists(files.string() + ".rows", failed);
}

Status copy_tiles(const fs::path& path, TileWriter& writer, TileCounts& counts) {
  return for_each_record(path, [&](const auto& record) -> Status {
    if (Status put = writer.put(record.id, record.bytes); !put) return put;
    counts.add(record.id, record.bytes.size());
    return Done{};
  });
}

Status put_rows(const fs::path& path, const std::vector<std::unique_ptr<Pyramid>>& pyramids,
                const std::vector<std::size_t>& floats) {
  auto log = RecordLogReader::open(path);
  if (!log) return log.error();
  std::vector<float> row;
  while (true) {
    const auto record = log->next();
    if (!record) return record.error();
    if (!*record) return Done{};
    const auto piece = static_cast<std::size_t>((*record)->id.x);
    const std::vector<std::byte>& bytes = (*record)->bytes;
    double area = 0.0;
    if (piece >= pyramids.size() || bytes.size() != sizeof(area) + floats[piece] * sizeof(float)) {
      return Error{fmt::format("{}: does not fit this picture; remove it and cut again", path.string())};
    }
    std::memcpy(&area, bytes.data(), sizeof(area));
    row.resize(floats[piece]);
    std::memcpy(row.data(), bytes.data() + sizeof(area), row.size() * sizeof(float));
    pyramids[piece]->put_row(area, row);
  }
}

/// Makes the levels above the bands' own.
Status make_coarse_levels(const BandWork& work, const std::vector<fs::path>& bands, TileWriter& writer,
                          TileCounts& counts) {
  const PyramidPart part{
      .coarsest = 0, .finest = work.layout.coarsest - 1, .first_row = 0, .pixels = work.pixels, .nodata = work.nodata};
  StripPool strips(pool_bytes(work, part));
  EncodePool pool(work.jobs, work.coding, writer);
  std::vector<std::unique_ptr<Pyramid>> pyramids;
  std::vector<std::size_t> floats;
  for (const CutPiece& piece : work.pieces) {
    pyramids.push_back(std::make_unique<Pyramid>(
        piece.plan, part, strips, [&](const auto& strip) { pool.submit(strip); }, [](double, auto) {}));
    floats.push_back(Pyramid::row_floats(piece.plan, part.finest));
  }
  for (const fs::path& band : bands) {
    if (Status put = put_rows(band.string() + ".rows", pyramids, floats); !put) return put;
  }
  const auto finished = pool.finish();
  if (!finished) return finished.error();
  counts.tiles += finished->tiles;
  counts.bytes += finished->bytes;
  return Done{};
}

}  // namespace

BandLayout bands_of(const CutPlan& plan) {
  BandLayout layout;
  layout.coarsest = std::max(0, plan.grid.max_level - kBandLevels);
  layout.band_rows = std::int64_t{plan.grid.tile_px} << (plan.grid.max_level - layout.coarsest);
  layout.first = plan.finest.y0 / layout.band_rows;
  layout.count = (plan.finest.y1 - 1) / layout.band_rows + 1 - layout.first;
  return layout;
}

std::string band_name(std::int64_t band) { return fmt::format("band-{:04}", band); }

Status make_bands(const BandWork& work, RowReader& reader, std::int64_t begin, std::int64_t end,
                  const WorkFolder& folder) {
  const PyramidPart part{.coarsest = work.layout.coarsest, .finest = work.plan.grid.max_level};
  StripPool strips(pool_bytes(work, part));
  std::int64_t position = 0;
  for (std::int64_t band = begin; band < end; ++band) {
    const fs::path files = folder / band_name(band);
    if (is_made(files)) {
      if (Status known = tell_tiles(work, files.string() + ".tiles"); !known) return known;
      continue;
    }
    const RowRange rows = rows_of_band(work, band);
    if (Status skipped = reader.skip_rows(rows.from - position); !skipped) return skipped;
    if (Status made = make_band(work, reader, band, strips, files); !made) return made;
    position = rows.to;
  }
  return Done{};
}

Result<TileCounts> join_bands(const BandWork& work, const std::vector<fs::path>& bands, TileWriter& writer) {
  TileCounts counts;
  for (const fs::path& band : bands) {
    if (Status copied = copy_tiles(band.string() + ".tiles", writer, counts); !copied) return copied.error();
    if (const std::int64_t all = rows_in(work); work.progress && !work.progress(all, all)) return stopped(work).error();
  }
  if (work.layout.coarsest == 0) return counts;
  if (Status made = make_coarse_levels(work, bands, writer, counts); !made) return made.error();
  return counts;
}

}  // namespace terrella
