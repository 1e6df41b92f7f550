#include "apps/viewer/profile/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <span>
#include <system_error>

#include "apps/process/write_file.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/panels/readout.h"
#include "apps/viewer/tools/screenshot.h"
#include "apps/viewer/tools/value_query.h"

namespace terrella {
namespace {

constexpr int kSamples = 256;
constexpr double kFoot_m = 0.3048;
constexpr std::size_t kAskedAtOnce = 4;                     // each answer is a thread, and may be a request to a server
constexpr float kProfileWidth = 34.0F, kPlotHeight = 6.0F;  // in text heights
const ImU32 kPlotGround = IM_COL32(8, 12, 18, 200), kPlotLine = IM_COL32(120, 200, 255, 255),
            kPlotHand = IM_COL32(245, 200, 66, 255);

struct Span {
  double low, high;
};

/// The values that are known; nullopt if none is. A level line lies in the middle.
std::optional<Span> span_of(const std::vector<ProfileSample>& samples, std::optional<double> ProfileSample::*what) {
  std::optional<Span> span;
  for (const ProfileSample& sample : samples) {
    const auto& value = sample.*what;
    if (!value) continue;
    span = span ? Span{std::min(span->low, *value), std::max(span->high, *value)} : Span{*value, *value};
  }
  if (span && span->low == span->high) span = Span{span->low - 1.0, span->high + 1.0};
  return span;
}

}  // namespace

std::string Profile::job() const {
  if (panel() == nullptr || open_.empty()) return {};
  return fmt::format("Profile: {} of {} values", answered_, samples_.size());
}

bool Profile::changed() const {
  return panel() != nullptr && !open_.empty() &&
         open_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void Profile::follow() {
  std::vector<Geodetic> path = path_();
  std::optional<ProfileNumbers> numbers = numbers_();
  const LayerId layer = numbers ? numbers->layer : LayerId::none;
  const LayerId shown = shown_numbers_ ? shown_numbers_->layer : LayerId::none;
  if (path == shown_path_ && layer == shown) return;
  shown_path_ = std::move(path);
  shown_numbers_ = std::move(numbers);
  samples_ = profile_samples(context_.globe.options().body.ellipsoid, shown_path_, kSamples);
  open_.clear();
  answered_ = 0;
}

void Profile::ask() {
  while (shown_numbers_ && open_.size() < kAskedAtOnce && answered_ + open_.size() < samples_.size()) {
    open_.push_back(context_.globe.stored_value(shown_numbers_->layer, samples_[answered_ + open_.size()].place));
  }
}

void Profile::take_answers() {
  while (!open_.empty() && open_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    const Result<double, TileFailure> answer = open_.front().get();
    open_.pop_front();
    if (answer) samples_[answered_].value = *answer;
    ++answered_;
  }
}

void Profile::draw_open(float foot) {
  follow();
  take_answers();
  ask();
  for (ProfileSample& sample : samples_) {
    sample.height_m = context_.globe.elevation_m(sample.place.lat, sample.place.lon);
  }
  begin_left_panel(panel(), kProfileWidth, foot, take_just_opened());
  draw_contents();
  ImGui::End();
}

void Profile::draw_contents() {
  if (samples_.empty()) return write_wrapped("Press M and click two places: the profile shows the way between them.");
  const bool heights = span_of(samples_, &ProfileSample::height_m).has_value();
  if (!heights && !shown_numbers_) {
    return write_wrapped("There are no heights and no numbers here. Ctrl + O opens a raster of them.");
  }
  const bool feet = context_.ui.units() == LengthUnits::imperial;
  if (heights) draw_plot("Height", feet ? "ft" : "m", &ProfileSample::height_m, feet ? kFoot_m : 1.0);
  if (shown_numbers_) draw_plot(shown_numbers_->name.c_str(), shown_numbers_->unit, &ProfileSample::value);
  if (ImGui::Button("Save as CSV") || entered()) save();
  tip("Writes distance, place, height and value of each sample into the folder where the program was started.");
}

void Profile::draw_plot(const char* name, const std::string& unit, std::optional<double> ProfileSample::*what,
                        double per_unit) {
  const float text = ImGui::GetFontSize();
  const std::optional<Span> span = span_of(samples_, what);
  const auto written = [&](double value) { return value_text(std::round(value / per_unit * 1e3) / 1e3, unit); };
  write_wrapped(span ? fmt::format("{}: {} to {}", name, written(span->low), written(span->high)) : std::string(name));
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, kPlotHeight * text};
  ImGui::PushID(name);
  ImGui::InvisibleButton("##plot", size);
  ImGui::PopID();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, kPlotGround);
  if (!span) return;
  const double whole_m = samples_.back().along_m;
  const auto point = [&](const ProfileSample& sample) {
    return ImVec2{at.x + size.x * static_cast<float>(sample.along_m / whole_m),
                  at.y + size.y * static_cast<float>((span->high - *(sample.*what)) / (span->high - span->low))};
  };
  for (std::size_t k = 1; k < samples_.size(); ++k) {
    const ProfileSample &from = samples_[k - 1], &to = samples_[k];
    if (from.*what && to.*what) list->AddLine(point(from), point(to), kPlotLine, line_width(1.5F));
  }
  if (!ImGui::IsItemHovered()) return;
  const double mouse_m = double((ImGui::GetIO().MousePos.x - at.x) / size.x) * whole_m;
  const auto nearest = std::ranges::min_element(
      samples_, {}, [mouse_m](const ProfileSample& sample) { return std::abs(sample.along_m - mouse_m); });
  const float x = at.x + size.x * static_cast<float>(nearest->along_m / whole_m);
  list->AddLine({x, at.y}, {x, at.y + size.y}, kPlotHand, line_width(1.0F));
  const auto& value = (*nearest).*what;
  tip(fmt::format("{}: {}", length_text(nearest->along_m, context_.ui.units()), value ? written(*value) : "no data"));
}

void Profile::save() const {
  std::error_code unknown;
  const auto file = new_file_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now(), ".csv");
  const std::string text = profile_csv(samples_);
  const Status saved = write_file(file, std::as_bytes(std::span(text)));
  saved ? say("Saved " + file.string()) : say(saved.error());
}

}  // namespace terrella
