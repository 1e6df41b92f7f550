#include "streaming/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <system_error>
#include <thread>

#include "streaming/cut/bands.h"
#include "streaming/cut/cut_key.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/input/cut_input.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/cut/input/watched_rows.h"
#include "streaming/cut/mercator_plan.h"
#include "streaming/cut/mercator_rows.h"
#include "streaming/cut/output/shards.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/cut/output/work_folder.h"
#include "streaming/cut/output_claim.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

int encoder_count(int jobs) {
  if (jobs > 0) return jobs;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

/// True if tiles are JPEG where they are opaque, and PNG at the picture's outline. An MBTiles file has one format.
bool has_png_outline(const CutOptions& options, const CutInput& input) {
  if (options.format || input.numbers) return false;
  const PictureInfo& picture = input.rows->info();
  const bool may_mix = output_kind(options.output) != OutputKind::mbtiles;
  return !picture.has_alpha || (may_mix && picture.opaque_inside);
}

PixelKind pixel_kind(const CutOptions& options, const CutInput& input, const CutPlan& plan) {
  if (input.numbers) return input.numbers->floats ? PixelKind::number : PixelKind::height;
  if (input.rows->info().has_alpha) return PixelKind::alpha;
  return has_png_outline(options, input) && !is_planet(plan) ? PixelKind::alpha : PixelKind::opaque;
}

std::optional<std::uint16_t> nodata_of(const CutInput& input) {
  if (!input.numbers || input.numbers->floats || !input.numbers->nodata) return {};
  return static_cast<std::uint16_t>(*input.numbers->nodata);
}

std::optional<float> float_nodata_of(const CutInput& input) {
  if (!input.numbers || !input.numbers->floats || !input.numbers->nodata) return {};
  return static_cast<float>(*input.numbers->nodata);
}

TileSetInfo describe(const CutOptions& options, const CutPlan& plan, const CutInput& input) {
  const bool needs_png = !has_png_outline(options, input);
  return {.name = options.name,
          .attribution = options.attribution,
          .body = options.body,
          .grid = plan.grid,
          .format = options.format.value_or(needs_png ? ImageFormat::png : ImageFormat::jpeg),
          .numbers = input.numbers};
}

/// One call of cut() with its pictures opened and its output checked.
struct Job {
  const CutOptions& options;
  OutputClaim claim;
  CutInput input;
  CutPlan plan;
  TileSetInfo info;
  std::string key;

  [[nodiscard]] BandWork work() const {
    return {.plan = plan,
            .pieces = pieces_of(plan),
            .layout = bands_of(plan),
            .pixels = pixel_kind(options, input, plan),
            .nodata = nodata_of(input),
            .coding = {.format = info.format,
                       .quality = options.quality,
                       .finest = plan.grid.max_level,
                       .heights = input.numbers.has_value(),
                       .floats = input.numbers && input.numbers->floats,
                       .png_outline = has_png_outline(options, input),
                       .nodata = float_nodata_of(input)},
            .jobs = encoder_count(options.jobs),
            .output = claim.output,
            .progress = options.progress,
            .tile_made = options.watch ? options.watch->tile_made : std::function<void(const CutTile&)>()};
  }
};

Result<CutSummary> join(const Job& job, const BandWork& work, const std::vector<fs::path>& bands,
                        const WorkFolder& folder) {
  auto writer = make_tile_writer(
      {.output = job.claim.output,
       .part = folder / "output",
       .info = job.info,
       .last_change = last_change_of(job.options.images),
       .mark = job.claim.mark,
       .may_replace = [&claim = job.claim](const fs::path& there) { return may_replace(claim, there); }});
  if (!writer) return writer.error();
  const auto counts = join_bands(work, bands, **writer);
  if (!counts) return counts.error();
  if (Status named = (*writer)->finish(); !named) return named.error();
  return CutSummary{.grid = job.plan.grid, .tiles = counts->tiles, .bytes = counts->bytes};
}

Result<CutSummary> cut_whole(const Job& job) {
  auto folder = WorkFolder::beside(job.claim.output, job.key);
  if (!folder) return folder.error();
  BandWork work = job.work();
  // Kept until an error of another kind: a full disk must not stay full.
  if (job.options.keep_unfinished && work.progress) {
    work.progress = [&, told = std::move(work.progress)](std::int64_t done, std::int64_t total) {
      const bool goes_on = told(done, total);
      if (!goes_on) folder->keep();
      return goes_on;
    };
  }
  if (Status made = make_bands(work, *job.input.rows, 0, work.layout.count, *folder); !made) return made.error();
  std::vector<fs::path> bands;
  for (std::int64_t band = 0; band < work.layout.count; ++band) bands.push_back(*folder / band_name(band));
  return join(job, work, bands, *folder);
}

Result<CutSummary> cut_shard(const Job& job) {
  const BandWork work = job.work();
  const BandRange mine = bands_of_shard(*job.options.shard, work.layout.count);
  auto folder = WorkFolder::named(shard_folder(job.claim.output, *job.options.shard), job.key);
  if (!folder) return folder.error();
  if (Status made = make_bands(work, *job.input.rows, mine.begin, mine.end, *folder); !made) return made.error();
  const auto counts = count_bands(*folder, mine);
  if (!counts) return counts.error();
  return CutSummary{.grid = job.plan.grid, .tiles = counts->tiles, .bytes = counts->bytes};
}

Result<CutSummary> join_shards(const Job& job) {
  const auto shards = find_shards(job.claim.output, job.key, bands_of(job.plan).count);
  if (!shards) return shards.error();
  const auto folder = WorkFolder::beside(job.claim.output, job.key);
  if (!folder) return folder.error();
  auto summary = join(job, job.work(), shards->bands, *folder);
  if (!summary || job.options.keep_shards) return summary;
  for (const fs::path& done : shards->folders) {
    std::error_code ignored;
    fs::remove_all(done, ignored);
  }
  return summary;
}

fs::path without_trailing_slash(const fs::path& path) { return path.filename().empty() ? path.parent_path() : path; }

/// Replaces the rows of the picture by those in Web Mercator.
Result<CutPlan> to_mercator(const CutOptions& options, const CutPlan& picture, CutInput& input) {
  const std::string name = options.images.front().string();
  const auto body = body_of(options);
  if (!body) return body.error();
  const Ellipsoid& figure = body->ellipsoid;
  auto plan = mercator_plan(picture, figure, input.numbers.has_value(), name);
  if (!plan) return plan.error();
  if (reaches_beyond_mercator(picture, figure)) {
    input.remarks.push_back(fmt::format(
        "{}: latitudes beyond {:.4f} degrees are left out, because Web Mercator ends there", name, kMercatorEndDeg));
  }
  auto rows = with_rows(std::move(input.rows), picture.finest.y1 - picture.finest.y0);
  input.rows = mercator_rows(std::move(rows), picture, *plan, figure, input.numbers.has_value(), options.jobs);
  return plan;
}

/// Plan of the opened pictures, whose rows become those of the plan. Their place replaces the options about it.
Result<CutPlan> plan_input(const CutOptions& options, CutInput& input) {
  CutOptions placed = options;
  placed.bounds = input.bounds;
  placed.latitude = input.latitude;
  auto plan = plan_cut(input.rows->info(), placed);
  if (!plan) return plan;
  if (options.grid == CutGrid::web_mercator) return to_mercator(options, *plan, input);
  input.rows = with_rows(std::move(input.rows), plan->finest.y1 - plan->finest.y0);
  return plan;
}

/// Fails if the output's format has no geodetic tiles, which the options ask for.
Status check_grid_of_output(const CutOptions& options) {
  if (!is_web_format(options.output) || options.grid == CutGrid::web_mercator) return Done{};
  return Error{fmt::format(
      "{}: such a file holds tiles in Web Mercator alone; give ‹grid› webmercator, or name an output that ends in "
      ".gpkg, or a folder",
      options.output.string())};
}

/// Checks the output before any work, because it may be known already that the output must stay.
Result<OutputClaim> claim_output(const CutOptions& options) {
  if (options.output.empty()) return Error{"no output is named; give a file that ends in .gpkg, or a folder"};
  const auto key = cut_key(options, {});
  if (!key) return key.error();
  OutputClaim claim{.output = without_trailing_slash(options.output),
                    .images = options.images,
                    .mark = cut_mark(*key),
                    .force = options.force};
  if (Status may = may_replace(claim, claim.output); !may) return may.error();
  return claim;
}

Result<Job> prepare(const CutOptions& options) {
  if (options.images.empty()) return Error{"no picture is named; give a JPEG, PNG, WebP or TIFF file"};
  if (Status sane = check_options(options); !sane) return sane.error();
  if (Status sane = check_shard(options); !sane) return sane.error();
  if (Status fits = check_grid_of_output(options); !fits) return fits.error();
  auto claim = claim_output(options);
  if (!claim) return claim.error();
  auto input = open_input(options);
  if (!input) return input.error();
  const auto plan = plan_input(options, *input);
  if (!plan) return plan.error();
  const auto key = cut_key(options, input->place);
  if (!key) return key.error();
  if (options.remark) std::ranges::for_each(input->remarks, options.remark);
  if (options.watch) input->rows = watched_rows(std::move(input->rows), options);
  TileSetInfo info = describe(options, *plan, *input);
  if (Status fits = check_output(claim->output, info); !fits) return fits.error();
  return Job{options, *std::move(claim), *std::move(input), *plan, std::move(info), *key};
}

Result<CutSummary> run(const CutOptions& options) {
  const auto job = prepare(options);
  if (!job) return job.error();
  auto summary = options.shard ? cut_shard(*job) : options.join ? join_shards(*job) : cut_whole(*job);
  if (summary && job->input.left_out) summary->left_out = *job->input.left_out;
  return summary;
}

}  // namespace

Result<CutSummary> cut(const CutOptions& asked) {
  CutOptions options = asked;
  if (options.name.empty() && !options.images.empty()) options.name = options.images.front().stem().string();
  try {
    return run(options);
  } catch (const std::bad_alloc&) {
    return Error{fmt::format("{}: not enough memory to cut it; give fewer ‹jobs› or a smaller ‹tile_px›",
                             options.images.front().string())};
  } catch (const std::system_error& error) {
    return Error{
        fmt::format("{}: cannot be cut: {}; give fewer ‹jobs›", options.images.front().string(), error.what())};
  }
}

Result<PlannedCut> plan_pictures(const CutOptions& options) {
  auto input = open_input(options);
  if (!input) return input.error();
  const auto plan = plan_input(options, *input);
  if (!plan) return plan.error();
  return PlannedCut{.info = describe(options, *plan, *input), .plan = *plan};
}

Status check_pictures(const CutOptions& options) {
  const auto planned = plan_pictures(options);
  if (!planned) return planned.error();
  return Done{};
}

}  // namespace terrella
