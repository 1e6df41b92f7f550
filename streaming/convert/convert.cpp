#include "streaming/convert/convert.h"

#include <fmt/format.h>

#include <new>
#include <optional>
#include <utility>

#include "streaming/convert/part_file.h"
#include "streaming/convert/tile_order.h"
#include "streaming/convert/web_tiles.h"
#include "streaming/cut/cut_key.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/cut/output/work_folder.h"
#include "streaming/cut/output_claim.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStopped = "interrupted; nothing was written, it can be run again";

Status may_be_replaced(const OutputClaim& claim, const fs::path& there) {
  std::error_code failed;
  const bool in_use = fs::exists(there, failed) && !fs::is_empty(there, failed);
  if (in_use && claim.mark != kConvertMark) {
    return Error{claim.output.string() + ": is there already; name another output, or move this one away"};
  }
  if (in_use && !claim.force) {
    return Error{
        fmt::format("{}: is there already; give ‹force› to replace it, or name another output", claim.output.string())};
  }
  return may_replace(claim, there);
}

class Conversion {
 public:
  Conversion(const ConvertOptions& options, OutputClaim claim, std::shared_ptr<TileSource> source)
      : options_(options), claim_(std::move(claim)), source_(std::move(source)) {
    summary_.info = source_->info();
  }

  [[nodiscard]] Result<ConvertSummary> run() {
    if (Status fits = check_output(claim_.output, summary_.info); !fits) return fits.error();
    const auto folder = WorkFolder::beside(claim_.output, kConvertMark);
    if (!folder) return folder.error();
    auto order = TileOrder::make(*folder / "order", summary_.info.grid);
    if (!order) return cannot_write(claim_.output, order.error());
    if (Status listed = list(*order); !listed) return listed.error();
    if (Status copied = copy(*order, *folder / "output"); !copied) return copied.error();
    const OutputKind kind = output_kind(claim_.output);
    const bool web = kind == OutputKind::mbtiles || kind == OutputKind::pmtiles;
    const int first_level = web ? zoom_of_roots(summary_.info.grid) : 0;
    summary_.min_level = levels_.least + first_level;
    summary_.max_level = levels_.most + first_level;
    return summary_;
  }

 private:
  [[nodiscard]] bool goes_on(std::int64_t done, std::int64_t total) const {
    return !options_.progress || options_.progress(done, total);
  }

  [[nodiscard]] Status list(TileOrder& order) {
    auto* const lister = dynamic_cast<TileLister*>(source_.get());
    if (lister == nullptr) return Error{options_.from.string() + ": its tiles cannot be listed"};
    Status added = Done{};
    Status listed = lister->for_each_tile([&](const TileId& id) {
      added = written(claim_.output, order.add(id));
      if (added && !goes_on(0, 1)) added = Error{kStopped};
      return added.ok();
    });
    if (!listed) return listed;
    if (added && order.count() == 0) return Error{options_.from.string() + ": the set holds no tiles"};
    return added;
  }

  [[nodiscard]] Status copy(TileOrder& order, const fs::path& part) {
    Status done = Done{};
    std::int64_t count = 0;
    const WriteStatus walked = order.for_each([&](const TileId& id) {
      done = goes_on(count++, order.count()) ? copy_tile(id, part) : Status(Error{kStopped});
      return done.ok();
    });
    if (!walked) return cannot_write(claim_.output, walked.error());
    if (!done) return done;
    if (!writer_) return Error{options_.from.string() + ": all tiles of the set are empty"};
    if (!goes_on(count, order.count())) return Error{kStopped};
    return writer_->finish();
  }

  [[nodiscard]] Status copy_tile(const TileId& id, const fs::path& part) {
    const auto tile = source_->read(id);
    if (!tile && tile.error().kind == MissingKind::blank) {
      ++summary_.blank;
      return Done{};
    }
    const auto refuse = [&](const std::string& why) {
      return Error{
          fmt::format("{}: level {}, column {}, row {}: {}", options_.from.string(), id.level, id.x, id.y, why)};
    };
    if (!tile && tile.error().kind == MissingKind::absent) {
      return refuse("this tile is listed but is not there (" + tile.error().why +
                    "); put it back, or remove the link or entry that names it");
    }
    if (!tile) return refuse(tile.error().why + "; ‹verify› says more");
    if (tile->number_scale != 1.0 || tile->number_offset != 0.0) {
      return refuse(
          "the numbers of this tile have a scale of their own, which only this file can state; convert what it was "
          "made from, or copy the file");
    }
    const ImageFormat format = sniff_format(tile->bytes);
    formats_.add(format);
    const OutputKind kind = output_kind(claim_.output);
    if (formats_.mixed && (kind == OutputKind::mbtiles || kind == OutputKind::folder)) {
      const bool folder = kind == OutputKind::folder;
      return refuse(
          fmt::format("this tile is {}, others are {}, and {} has one format for all tiles; name an output "
                      "that ends in {}",
                      extension_of(format), extension_of(formats_.first), folder ? "a folder" : "an MBTiles file",
                      folder ? ".gpkg" : ".gpkg or .pmtiles"));
    }
    if (Status made = make_writer(part); !made) return made;
    levels_.add(id.level);
    ++summary_.tiles;
    summary_.bytes += std::ssize(tile->bytes);
    return writer_->put(id, tile->bytes);
  }

  /// Makes the writer at the first tile, whose format is that of the set, whatever the set states.
  [[nodiscard]] Status make_writer(const fs::path& part) {
    if (writer_) return Done{};
    summary_.info.format = formats_.common(summary_.info.format);
    auto writer =
        make_tile_writer({.output = claim_.output,
                          .part = part,
                          .info = summary_.info,
                          .last_change = last_change_of({options_.from}),
                          .mark = claim_.mark,
                          .may_replace = [this](const fs::path& there) { return may_be_replaced(claim_, there); }});
    if (!writer) return writer.error();
    writer_ = *std::move(writer);
    return Done{};
  }

  const ConvertOptions& options_;
  const OutputClaim claim_;
  const std::shared_ptr<TileSource> source_;
  std::unique_ptr<TileWriter> writer_;
  TileFormats formats_;
  ZoomRange levels_;
  ConvertSummary summary_;
};

Result<ConvertSummary> run(const ConvertOptions& options) {
  if (options.to.empty()) return Error{"no output is named"};
  OutputClaim claim{.output = options.to.filename().empty() ? options.to.parent_path() : options.to,
                    .images = {options.from},
                    .mark = options.mark,
                    .force = options.force};
  std::shared_ptr<TileSource> source = options.source;
  if (!source) {
    auto opened = open_stored_tile_set(options.from, options.geodetic_mbtiles);
    if (!opened) return opened.error();
    source = *std::move(opened);
  }
  if (Status may = may_be_replaced(claim, claim.output); !may) return may.error();
  return Conversion(options, std::move(claim), std::move(source)).run();
}

}  // namespace

Result<ConvertSummary> convert(const ConvertOptions& options) {
  try {
    return run(options);
  } catch (const std::bad_alloc&) {
    return Error{options.from.string() + ": not enough memory to convert it"};
  }
}

}  // namespace terrella
