#include "ground_truth/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <limits>

namespace terrella::truth {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// The ratio of a zone of 17,212 pixels to its surroundings has a standard deviation of 0.5 % among 20 meridians where
// no seam is. It would be 0.7 % in zones of this size, so 2 % is three of them.
constexpr std::size_t kEnoughPixels = 8000;

double limit_of(const Bound& bound, const JudgedView& judged, const std::vector<JudgedView>& earlier) {
  if (bound.kind == Bound::Kind::figure) return bound.value;
  if (bound.kind == Bound::Kind::other_zone) return bound.value * judged.judgement[bound.reference].rms;
  const auto is_meant = [&](const JudgedView& other) { return other.view.name == bound.reference_view; };
  const auto other = std::find_if(earlier.begin(), earlier.end(), is_meant);
  assert(other != earlier.end());
  return bound.value * other->judgement[bound.reference].rms;
}

std::vector<Bound> bounds_of(const JudgedView& judged) {
  std::vector<Bound> bounds = judged.view.bounds;
  // Noise is alike everywhere; a real planet's coast or ice edge beside a border says nothing about the border.
  if (judged.view.planet != "noise") return bounds;
  const auto hold_against = [&](Zone zone, Zone beside) {
    if (judged.judgement[zone].pixels < kEnoughPixels || judged.judgement[beside].pixels < kEnoughPixels) return;
    bounds.push_back({zone, Bound::Kind::other_zone, kSurroundings, beside, {}});
  };
  hold_against(Zone::antimeridian, Zone::antimeridian_surroundings);
  hold_against(Zone::tile_borders, Zone::border_surroundings);
  return bounds;
}

AccuracyLine limb_line(const JudgedView& judged, const char* name, const LimbError& limb, double limit) {
  return {judged.view.name, name, 100.0 * limb.share(), 0.0, limb.pixels, 100.0 * limit, judged.render_s};
}

std::string limit_text(const AccuracyLine& line) {
  if (std::isnan(line.limit)) return "";
  return fmt::format("{:.3f}{}", line.limit, line.fails() ? "  EXCEEDED" : "");
}

}  // namespace

std::vector<AccuracyLine> lines_of(const JudgedView& judged, const std::vector<JudgedView>& earlier) {
  std::vector<AccuracyLine> lines;
  const std::vector<Bound> bounds = bounds_of(judged);
  for (std::size_t z = 0; z < kZones; ++z) {
    const ZoneError& error = judged.judgement.zones[z];
    if (error.pixels == 0) continue;
    double limit = kNone;
    for (const Bound& bound : bounds) {
      if (bound.zone == static_cast<Zone>(z)) limit = std::fmin(limit, limit_of(bound, judged, earlier));
    }
    lines.push_back({judged.view.name, std::string(zone_name(static_cast<Zone>(z))), error.rms, error.max, error.pixels,
                     limit, judged.render_s});
  }
  if (judged.judgement.limb.pixels > 0) {
    lines.push_back(limb_line(judged, "limb, % off", judged.judgement.limb, kNone));
    lines.push_back(limb_line(judged, "outside, % off", judged.judgement.outside, kLimbShare));
  }
  return lines;
}

std::string as_table(const std::vector<AccuracyLine>& lines) {
  std::string text =
      fmt::format("{:<28} {:<26} {:>8} {:>6} {:>8}  {}\n", "view", "zone", "RMS", "max", "pixels", "limit");
  for (const AccuracyLine& line : lines) {
    text += fmt::format("{:<28} {:<26} {:>8.3f} {:>6.1f} {:>8}  {}\n", line.view, line.zone, line.rms, line.max,
                        line.pixels, limit_text(line));
  }
  return text;
}

void write_csv(const std::vector<AccuracyLine>& lines, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "view,zone,rms,max,pixels,limit,render_s\n";
  for (const AccuracyLine& line : lines) {
    const std::string limit = std::isnan(line.limit) ? "" : fmt::format("{:.4f}", line.limit);
    out << fmt::format("\"{}\",\"{}\",{:.4f},{:.1f},{},{},{:.2f}\n", line.view, line.zone, line.rms, line.max,
                       line.pixels, limit, line.render_s);
  }
}

}  // namespace terrella::truth
