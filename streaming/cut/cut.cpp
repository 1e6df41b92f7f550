#include "streaming/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <thread>

#include "streaming/cut/cut_plan.h"
#include "streaming/cut/encode_pool.h"
#include "streaming/cut/pyramid.h"
#include "streaming/cut/row_reader.h"
#include "streaming/cut/tile_writer.h"

namespace terrella {
namespace {

/// Strips that wait for an encoder while the next ones are filled.
constexpr std::size_t kStripsAhead = 2;
/// Small pictures may run further ahead, bytes.
constexpr std::size_t kAlwaysAllowedBytes = 48UL << 20;
constexpr std::int64_t kRowsPerProgress = 16;

int encoder_count(int jobs) {
  if (jobs > 0) return jobs;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

TileSetInfo describe(const CutOptions& options, const CutPlan& plan, const PictureInfo& picture) {
  return {.name = options.name.empty() ? options.images.front().stem().string() : options.name,
          .attribution = options.attribution,
          .body = options.body,
          .grid = plan.grid,
          .format = options.format.value_or(picture.has_alpha ? ImageFormat::png : ImageFormat::jpeg)};
}

/// Reads the picture's rows into the pyramid, until the end, a failure, or a wish to stop.
Status stream_rows(RowReader& reader, const CutPlan& plan, Pyramid& pyramid, const EncodePool& pool,
                   const CutOptions& options) {
  const std::int64_t total = plan.finest.y1 - plan.finest.y0;
  std::vector<std::uint8_t> last_row;
  for (std::int64_t y = 0; y < total; ++y) {
    const std::span<std::uint8_t> row = pyramid.next_row();
    if (y < plan.picture_rows) {
      if (Status read = reader.read_row(row); !read) return read;
      if (y + 1 == plan.picture_rows && y + 1 < total) last_row.assign(row.begin(), row.end());
    } else {
      std::memcpy(row.data(), last_row.data(), row.size());
    }
    pyramid.row_written();
    if ((y + 1) % kRowsPerProgress != 0 && y + 1 != total) continue;
    if (pool.failed()) return Done{};
    if (options.progress && !options.progress(y + 1, total)) {
      return Error{fmt::format("{}: cutting was stopped", options.images.front().string())};
    }
  }
  return Done{};
}

Result<CutSummary> cut_rows(RowReader& reader, const CutPlan& plan, const CutOptions& options) {
  const TileSetInfo info = describe(options, plan, reader.info());
  auto writer = make_tile_writer(options.output, info);
  if (!writer) return writer.error();
  StripPool strips(Pyramid::strip_bytes(plan) +
                   std::max(kAlwaysAllowedBytes, kStripsAhead * Pyramid::finest_strip_bytes(plan)));
  TileCounts counts;
  {
    EncodePool pool(encoder_count(options.jobs), info.format, options.quality, **writer);
    Pyramid pyramid(plan, reader.info().has_alpha, strips,
                    [&](const std::shared_ptr<const Strip>& strip) { pool.submit(strip); });
    if (Status streamed = stream_rows(reader, plan, pyramid, pool, options); !streamed) return streamed.error();
    const auto finished = pool.finish();
    if (!finished) return finished.error();
    counts = *finished;
  }
  if (Status named = (*writer)->finish(); !named) return named.error();
  return CutSummary{.grid = plan.grid, .tiles = counts.tiles, .bytes = counts.bytes};
}

}  // namespace

Result<CutSummary> cut(const CutOptions& options) {
  if (options.images.empty()) return Error{"no picture is named; give a JPEG, PNG or TIFF file"};
  if (options.images.size() > 1) {
    return Error{fmt::format("{}: only one picture can be cut at a time; cut each into its own output",
                             options.images[1].string())};
  }
  auto reader = open_rows(options.images.front());
  if (!reader) return reader.error();
  const auto plan = plan_cut((*reader)->info(), options);
  if (!plan) return plan.error();
  try {
    return cut_rows(**reader, *plan, options);
  } catch (const std::bad_alloc&) {
    return Error{fmt::format("{}: not enough memory to cut a picture {} pixels wide; give a smaller --tile-size",
                             options.images.front().string(), (*reader)->info().width_px)};
  }
}

}  // namespace terrella
