#include "apps/program/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "apps/film/film_plan.h"
#include "apps/film/light_sum.h"
#include "apps/film/movie_pipe.h"
#include "apps/flight/flight_file.h"
#include "apps/open_scene/open_rasters.h"
#include "apps/process/console.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "base/hash_mix.h"

namespace terrella {
namespace {

constexpr std::size_t kMostNamedTiles = 16;

/// Counts and messages of a film's frames.
struct FilmTally {
  std::int64_t written = 0;
  std::int64_t kept = 0;  ///< frames of an earlier run
  std::int64_t tiles_missing = 0, heights_missing = 0;
  std::optional<std::int64_t> first_incomplete;  ///< frame
  std::set<std::string> attributions, notes;
  bool whole_scene = true;  ///< false if objects, rasters or ground are left out
};

void tell_incomplete(std::int64_t frame, const Rendered& rendered) {
  print_message("terrella render: frame {} lacks tiles, the first one that does:\n", frame);
  std::vector<MissingTile> missing = rendered.missing;
  missing.insert(missing.end(), rendered.missing_heights.begin(), rendered.missing_heights.end());
  for (std::size_t k = 0; k < std::min(missing.size(), kMostNamedTiles); ++k) {
    print_message("terrella render: missing: {}\n", name_of(missing[k]));
  }
}

/// Frames that go into a folder or into ffmpeg.
class Film {
 public:
  Film(const FilmCommand& command, FilmPlan plan) : command_(command), plan_(std::move(plan)) {}

  /// Opens what the frames go into, but not the scene.
  Status open(const std::string& flight_text);
  /// Renders the frames of the shard. A signal ends it early.
  Status render();
  [[nodiscard]] const FilmTally& tally() const { return tally_; }
  [[nodiscard]] std::int64_t frames() const { return std::ssize(wanted_) + tally_.kept; }

 private:
  Status render_frame(std::int64_t frame);
  void count(std::int64_t frame, const Rendered& rendered);
  Status write(std::int64_t frame, const Image& image, bool complete);

  const FilmCommand& command_;
  FilmPlan plan_;
  std::vector<std::int64_t> wanted_;
  std::optional<FilmFolder> folder_;
  std::unique_ptr<MoviePipe> movie_;
  std::unique_ptr<ScenePicture> picture_;
  FilmTally tally_;
};

Status Film::open(const std::string& flight_text) {
  const RenderCommand& render = command_.render;
  if (!is_movie_name(render.output)) {
    auto names = FrameNames::parse(render.output);
    if (!names) return names.error();
    FilmFacts facts = command_.facts;
    facts["names"] = names->pattern();
    facts["frames"] = std::to_string(plan_.frames());
    facts["flight"] = fmt::format("{:016x}", name_hash(flight_text));
    auto folder = FilmFolder::open(*std::move(names), facts, command_.force);
    if (!folder) return folder.error();
    folder_ = *std::move(folder);
  }
  const Shard shard = command_.shard.value_or(Shard{});
  for (std::int64_t frame = shard.index - 1; frame < plan_.frames(); frame += shard.count) {
    const bool there = folder_ && !command_.force && folder_->has(frame);
    if (there)
      ++tally_.kept;
    else
      wanted_.push_back(frame);
  }
  return Done{};
}

Status Film::render() {
  if (wanted_.empty()) return Done{};
  RenderCommand scene = command_.render;
  if (!scene.scene.time) scene.scene.time = plan_.first_sun();
  if (Status clock = check_clock(scene.scene); !clock) return clock;
  auto opened = ScenePicture::open(scene);
  if (!opened) return opened.error();
  picture_ = *std::move(opened);
  if (!folder_) {
    auto movie = MoviePipe::start(command_.render.output, command_.render.scene.size, command_.fps);
    if (!movie) return movie.error();
    movie_ = *std::move(movie);
  }
  Progress progress("rendering " + command_.render.output);
  for (const std::int64_t frame : wanted_) {
    if (StopSignals::came()) return Done{};
    if (Status drawn = render_frame(frame); !drawn) {
      if (StopSignals::came()) return Done{};
      return Error{fmt::format("frame {}: {}", frame, drawn.error().message)};
    }
    progress.show(++tally_.written, std::ssize(wanted_));
  }
  return movie_ ? movie_->finish() : Status(Done{});
}

Status Film::render_frame(std::int64_t frame) {
  const std::vector<FlightMoment> moments = plan_.moments(frame, command_.shutter, command_.moments);
  if (moments.size() > 1) {
    const FlightMoment own = plan_.moment(frame);
    if (Status begun = picture_->begin_frame(own.surface_alpha, own.sun); !begun) return begun;
    if (Status shown = picture_->show_features(own.camera); !shown) return shown;
  }
  std::optional<LightSum> light;
  if (moments.size() > 1) light.emplace(command_.render.scene.size, 1);
  Image image;
  bool complete = true;
  std::int64_t tiles = 0, heights = 0;  // the most that a moment lacks
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const FlightMoment& moment = moments[k];
    if (k == 0 || moment != moments[k - 1]) {
      if (Status begun = picture_->begin_frame(moment.surface_alpha, moment.sun); !begun) return begun;
      auto rendered = light ? picture_->draw_scene(moment.camera) : picture_->draw(moment.camera);
      if (!rendered) return rendered.error();
      count(frame, *rendered);
      tiles = std::max<std::int64_t>(tiles, rendered->stats.tiles_missing + rendered->stats.tiles_pending);
      heights = std::max<std::int64_t>(heights, heights_without(rendered->stats));
      complete = complete && is_complete(rendered->stats) && rendered->missing_dates.empty();
      image = std::move(rendered->image);
    }
    if (light) light->add(image);
  }
  tally_.tiles_missing += tiles;
  tally_.heights_missing += heights;
  if (light) {
    image = light->mean();
    if (Status drawn = picture_->draw_over(plan_.moment(frame).camera, image); !drawn) return drawn;
  }
  return write(frame, image, complete);
}

void Film::count(std::int64_t frame, const Rendered& rendered) {
  const FrameStats& stats = rendered.stats;
  tally_.attributions.insert(rendered.attributions.begin(), rendered.attributions.end());
  for (std::string note : {memory_note(command_.render.scene.memory_mb, stats), font_note(stats)}) {
    if (!note.empty() && tally_.notes.insert(note).second) print_message("terrella render: {}\n", note);
  }
  for (const std::string& date : rendered.missing_dates) {
    if (tally_.notes.insert(date).second) print_message("terrella render: {}\n", date);
  }
  tally_.whole_scene = tally_.whole_scene && rendered.missing_dates.empty() && picture_->has_all_objects() &&
                       rasters_left_out() == 0 && stats.ground_left_out == 0;
  if (is_complete(stats) || tally_.first_incomplete) return;
  tally_.first_incomplete = frame;
  tell_incomplete(frame, rendered);
}

Status Film::write(std::int64_t frame, const Image& image, bool complete) {
  if (movie_) return movie_->write(image);
  folder_->remove_parts(frame);
  return folder_->write(frame, image, complete);
}

void report(const FilmCommand& command, const Film& film, double seconds) {
  const FilmTally& tally = film.tally();
  const std::string& output = command.render.output;
  if (command.render.json) {
    nlohmann::json result = {{"output", output},
                             {"frames", film.frames()},
                             {"written", tally.written},
                             {"kept", tally.kept},
                             {"tiles_lacked", tally.tiles_missing},
                             {"heights_lacked", tally.heights_missing},
                             {"seconds", seconds},
                             {"attributions", tally.attributions}};
    if (tally.first_incomplete) result["first_frame_lacking"] = *tally.first_incomplete;
    print_result("{}\n", result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} frames: {} written, {} kept; {} tiles missing; {:.1f} s\n", output, film.frames(), tally.written,
               tally.kept, tally.tiles_missing + tally.heights_missing, seconds);
  thank(output, fmt::format("{}", fmt::join(tally.attributions, "; ")));
}

/// Exit code of a film that ended without an error.
int conclude(const FilmCommand& command, const Film& film) {
  const std::int64_t to_go = film.frames() - film.tally().kept - film.tally().written;
  if (StopSignals::came() && to_go > 0) {
    print_message("terrella render: stopped with {} frames to go; {}\n", to_go,
                  is_movie_name(command.render.output) ? "no film was written; one of frames would go on"
                                                       : "the same command goes on");
    return kDoneInPart;
  }
  return film.tally().first_incomplete || !film.tally().whole_scene ? kDoneInPart : kDone;
}

}  // namespace

Status check_together(const FilmCommand& command) {
  const std::string& output = command.render.output;
  if (is_movie_name(output) && output.find('%') == std::string::npos) {
    if (!command.shard) return Done{};
    return Error{
        "--shard makes frames, not a film of one file; write them with -o frames/%05d.png, and join them with ffmpeg"};
  }
  if (is_movie_name(output)) return Error{output + ": frames are pictures; name them as frames/%05d.png"};
  const auto names = FrameNames::parse(output);
  return names ? Status(Done{}) : names.error();
}

int run_film(const FilmCommand& command) {
  const StopSignals signals;
  const auto begun = std::chrono::steady_clock::now();
  auto flight = read_flight(command.flight);
  if (!flight) return fail("render", flight.error().message);
  for (const std::string& complaint : flight->complaints) print_message("{}\n", one_line(complaint));
  auto plan = FilmPlan::make(std::move(flight->paths), command.fps);
  if (!plan) return fail("render", command.flight + ": " + plan.error().message);
  std::error_code unknown;
  if (is_movie_name(command.render.output) && !command.force &&
      std::filesystem::exists(command.render.output, unknown)) {
    return fail("render", command.render.output + ": is there already; --force replaces it, or name another film");
  }
  Film film(command, *std::move(plan));
  if (const Status opened = film.open(flight->text); !opened) return fail("render", opened.error().message);
  const Status rendered = film.render();
  if (!rendered) return fail("render", rendered.error().message);
  report(command, film, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  return conclude(command, film);
}

}  // namespace terrella
