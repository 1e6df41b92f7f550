#include "apps/viewer/offline/keep_offline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/open_scene/open_remote.h"
#include "apps/open_scene/project/write_project.h"
#include "apps/preload/preload_progress.h"
#include "apps/process/exit_code.h"
#include "apps/viewer/offline/view_box.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr float kKeepWidth = 23.0F;                   // in text heights
constexpr std::int64_t kFewTiles = 256;               // chosen at first
constexpr std::int64_t kMostEstimated = 100'000'000;  // the estimate looks for each in the cache
constexpr std::size_t kMostAnswer = 1UL << 20;        // bytes
constexpr const char *kKeepTask = "/dev/stdin", *kKeepLog = "preload.log", *kKeepAnswer = "answer.json";

/// The grid of the tiles on the server.
const TileGrid& stored_grid(const TileSetInfo& info) { return info.made_of ? *info.made_of : info.grid; }

/// The part that a line of the preload's progress says: "12.5 % of 340 tiles: …"; nothing in another line.
std::optional<double> part_in(const std::string& line) {
  constexpr std::string_view kUnit = " % of ";
  const std::size_t unit = line.find(kUnit);
  const auto percent = unit == std::string::npos ? std::nullopt : read_number(std::string_view(line).substr(0, unit));
  return percent ? std::optional(*percent / 100.0) : std::nullopt;
}

nlohmann::json answer_in(const fs::path& file) {
  const auto bytes = read_file(file, kMostAnswer);
  return bytes ? nlohmann::json::parse(as_text(*bytes), nullptr, false) : nlohmann::json();
}

/// The last message of a process, without the name of the program.
std::string last_message(const ProgramJob& job) {
  std::vector<std::string> said = job.messages();
  std::erase_if(said, [](const std::string& line) { return line.empty() || part_in(line); });
  if (said.size() < 2) return "it ended without a message";
  constexpr std::string_view kWho = "terrella preload: ";
  return said.back().starts_with(kWho) ? said.back().substr(kWho.size()) : said.back();
}

}  // namespace

KeepOffline::~KeepOffline() {
  if (estimating_) estimating_->abort();
  estimating_.reset();
  work_.reset();
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void KeepOffline::open(const LayerToKeep& layer) {
  const bool busy = work_ || paused_;
  if (busy) say(layer_.name + " is being kept; wait for its end, or cancel it");
  if (!busy && !take(layer)) return;
  if (!is_open()) toggle();
}

bool KeepOffline::take(const LayerToKeep& layer) {
  if (!has_cache_) {
    say(Error{"This session keeps no tiles: start it without --offline and --cache off"});
    return false;
  }
  const auto cache = cache_file_of_set(layer.source, layer.info, layer.time);
  if (!cache) {
    say(cache.error());
    return false;
  }
  const auto box = shown_box();
  if (!box) {
    say("The view shows no part of the globe");
    return false;
  }
  if (folder_.empty()) {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "terrella-XXXXXX").string();
    if (failed || mkdtemp(name.data()) == nullptr) {
      say(Error{"No folder for temporary files can be made: set TMPDIR to a folder that can be written"});
      return false;
    }
    folder_ = name;
  }
  SourceOptions source = layer.source;
  source.remote.time = layer.time;
  const std::string address = source.address.with_secrets();
  const bool is_template = address.find("{z}") != std::string::npos;
  if (is_template && !source.remote.max_level) source.remote.max_level = stored_grid(layer.info).max_level;
  task_ = preload_task_text(source);
  layer_ = layer;
  cache_ = *cache;
  take_box(*box);
  return true;
}

std::optional<GeoRect> KeepOffline::shown_box() const {
  return view_box(context_.navigator.camera(), context_.globe.options().body.ellipsoid, context_.window.framebuffer());
}

// The levels at first are those of a few tiles.
void KeepOffline::take_box(const GeoRect& box) {
  box_ = box;
  end_.clear();
  const TileGrid& grid = stored_grid(layer_.info);
  first_ = last_ = grid.min_level;
  while (last_ < grid.max_level && tiles_to(last_ + 1) <= kFewTiles) ++last_;
  estimate();
}

std::int64_t KeepOffline::tiles_to(int last) const {
  const TileGrid& grid = stored_grid(layer_.info);
  const bool projected = grid.projection == Projection::projected;
  Region region;
  region.add_box(box_);
  return plan_region(projected ? layer_.info.grid : grid, context_.globe.options().body.ellipsoid, std::move(region),
                     first_, last)
      ->total();
}

std::vector<std::string> KeepOffline::arguments() const {
  std::vector<std::string> words = {"preload",
                                    "--task",
                                    kKeepTask,
                                    fmt::format("--bbox={:.7f},{:.7f},{:.7f},{:.7f}", box_.west.deg(), box_.south.deg(),
                                                box_.east.deg(), box_.north.deg()),
                                    "--levels",
                                    fmt::format("{}-{}", first_, last_),
                                    "--json",
                                    "-o",
                                    cache_.string()};
  if (cache_size_mb_ > 0) words.insert(words.end(), {"--cache-size", std::to_string(cache_size_mb_)});
  return words;
}

void KeepOffline::estimate() {
  if (estimating_) estimating_->abort();
  estimating_.reset();
  estimate_.reset();
  if (const std::int64_t tiles = tiles_to(last_); tiles > kMostEstimated) {
    estimate_ = {.tiles = tiles,
                 .fault = "that is too much; choose fewer levels, or go closer and take the view again"};
    return;
  }
  std::vector<std::string> words = arguments();
  words.emplace_back("--dry-run");
  auto job = ProgramJob::start(std::move(words), folder_ / kKeepLog, folder_ / kKeepAnswer, task_);
  if (!job) {
    estimate_ = {.fault = job.error().message};
    return;
  }
  estimating_ = *std::move(job);
}

void KeepOffline::take_estimate() {
  if (!estimating_ || !estimating_->has_ended()) return;
  Estimate estimate;
  const nlohmann::json answer = answer_in(folder_ / kKeepAnswer);
  if (estimating_->exit_code() == kDone && answer.is_object()) {
    estimate.tiles = answer.value("tiles", std::int64_t{0});
    estimate.there = answer.value("there", std::int64_t{0});
    if (answer.contains("bytes") && answer["bytes"].is_number()) estimate.bytes = answer["bytes"].get<double>();
    if (!answer.value("fits", true)) estimate.fault = "the cache has no room for them; choose fewer levels";
  } else {
    estimate.fault = last_message(*estimating_);
  }
  estimating_.reset();
  estimate_ = std::move(estimate);
}

void KeepOffline::begin() {
  auto job = ProgramJob::start(arguments(), folder_ / kKeepLog, folder_ / kKeepAnswer, task_);
  if (!job) return say(Error{"Nothing can be kept: " + job.error().message});
  if (!paused_) part_ = 0.0;
  paused_ = cancelled_ = false;
  end_.clear();
  work_ = *std::move(job);
}

// A paused preload has ended too: the same command goes on where it ended. A young one ends by the signal itself.
void KeepOffline::take_work() {
  if (!work_ || !work_->has_ended()) return;
  const int code = work_->exit_code();
  const std::unique_ptr<ProgramJob> ended = std::move(work_);
  if (paused_ && (code == kDoneInPart || code == -SIGTERM)) return;
  paused_ = false;
  part_ = 0.0;
  const nlohmann::json answer = answer_in(folder_ / kKeepAnswer);
  if (cancelled_) {
    end_ = "Cancelled; what came is kept.";
  } else if (code == kDone && answer.is_object()) {
    end_ = fmt::format("All {} tiles are kept.", answer.value("planned", std::int64_t{0}));
    say(layer_.name + ": the view is kept for offline use");
  } else {
    end_ = "Not everything is kept: " + last_message(*ended);
    context_.messages.report(layer_.name + ": " + end_);
  }
  estimate();
}

void KeepOffline::advance() {
  shown_job_ = job();
  take_estimate();
  take_work();
}

double KeepOffline::part() const {
  if (!work_ || !work_->has_news()) return part_;
  for (const std::string& line : work_->messages()) part_ = std::max(part_, part_in(line).value_or(0.0));
  return part_;
}

std::string KeepOffline::job() const {
  if (work_) return fmt::format("Keeping {}: {:.0f} %", layer_.name, 100.0 * part());
  return estimating_ ? "Counting tiles" : "";
}

bool KeepOffline::changed() const {
  return job() != shown_job_ || (work_ && work_->has_ended()) || (estimating_ && estimating_->has_ended());
}

void KeepOffline::draw_open(float foot) {
  begin_left_panel(panel(), kKeepWidth, foot, take_just_opened());
  ImGui::PushItemWidth(0.55F * kKeepWidth * ImGui::GetFontSize());
  write_wrapped(layer_.name);
  work_ || paused_ ? draw_work() : draw_choice();
  if (!end_.empty()) write_wrapped(end_);
  ImGui::PopItemWidth();
  ImGui::End();
}

void KeepOffline::draw_estimate() const {
  if (!estimate_) return write_wrapped("Counting tiles…");
  if (estimate_->tiles > 0) {
    write_wrapped(fmt::format("{} tiles, {} of them there already", estimate_->tiles, estimate_->there));
  }
  if (!estimate_->fault.empty()) return write_wrapped("Not possible: " + estimate_->fault);
  write_wrapped(estimate_->bytes ? fmt::format("About {} to come", bytes_text(*estimate_->bytes)) : "Size unknown");
}

void KeepOffline::draw_choice() {
  write_wrapped(fmt::format("From {:.2f}, {:.2f} to {:.2f}, {:.2f}", box_.south.deg(), box_.west.deg(),
                            box_.north.deg(), box_.east.deg()),
                true);
  if (ImGui::Button("Take the view") || entered()) {
    const auto box = shown_box();
    box ? take_box(*box) : say("The view shows no part of the globe");
  }
  tip("Takes the part of the globe that the window shows now.");
  const TileGrid& grid = stored_grid(layer_.info);
  int levels[2] = {first_, last_};
  if (ImGui::SliderInt2("Levels", levels, grid.min_level, grid.max_level, "%d", ImGuiSliderFlags_AlwaysClamp)) {
    first_ = levels[0];
    last_ = std::max(levels[0], levels[1]);
    if (estimating_) estimating_->abort();
    estimating_.reset();
    estimate_.reset();
  }
  tip("First and last level of the server's tiles. Each finer level has up to four times as many.");
  if (!estimate_ && !estimating_ && !ImGui::IsAnyItemActive()) estimate();
  draw_estimate();
  if (!estimate_ || !estimate_->fault.empty()) return;
  if (ImGui::Button("Start") || entered()) begin();
  tip("Stores the tiles in the session's cache, beside the window's work. They stay there whatever else is looked at.");
}

void KeepOffline::draw_work() {
  ImGui::ProgressBar(float(part()), {-1.0F, 0.0F});
  if (work_ && work_->is_stopped()) return write_wrapped("It ends with the requests on their way.");
  if (paused_ && !work_) {
    if (ImGui::Button("Resume###pause") || entered()) begin();
    tip("Goes on where it was paused.");
  } else if (ImGui::Button("Pause###pause") || entered()) {
    paused_ = true;
    work_->stop();
  }
  beside_if_room("Cancel");
  if (ImGui::Button("Cancel") || entered()) {
    cancelled_ = true;
    if (work_) work_->stop();
    if (!work_) end_ = "Cancelled; what came is kept.";
    if (!work_) estimate_.reset();
    paused_ = false;
  }
  tip("Stops; the tiles that came stay in the cache.");
}

}  // namespace terrella
