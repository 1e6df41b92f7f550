#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/truth/judge.h"
#include "apps/bench/truth/judge_report.h"
#include "apps/bench/truth/truth_cache.h"

namespace {

using namespace terrella::truth;

struct Arguments {
  std::string picture, shot, cache, write_truth;
  std::vector<double> camera, body{Spheroid{}.a_m, Spheroid{}.f}, tiles;
  std::string projection = "equirectangular", latitude = "graphic";
  double meridian_deg = 180.0;
  int rays_per_side = 8;
  bool json = false;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--picture", arguments.picture, "the source: a picture of the whole body, PNG or JPEG")->required();
  app.add_option("--shot", arguments.shot, "the rendered PNG to judge")->required();
  app.add_option("--camera", arguments.camera, "LAT,LON,ALT,HEADING,PITCH,FOV: degrees, metres")
      ->delimiter(',')
      ->expected(3, 6)
      ->required();
  app.add_option("--body", arguments.body, "semi-major axis in metres, flattening")->delimiter(',')->expected(2);
  app.add_option("--projection", arguments.projection)->check(CLI::IsMember({"equirectangular", "equal-area"}));
  app.add_option("--latitude", arguments.latitude)->check(CLI::IsMember({"graphic", "centric"}));
  app.add_option("--tiles", arguments.tiles, "root span in degrees, level: judge this grid's tile borders too")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--meridian", arguments.meridian_deg,
                 "judge the zones of the antimeridian around this meridian, for comparison")
      ->capture_default_str();
  app.add_option("--rays", arguments.rays_per_side, "rays a side of a pixel")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--cache", arguments.cache, "folder that remembers truths");
  app.add_option("--write-truth", arguments.write_truth, "write the truth, rounded, as this PNG");
  app.add_flag("--json", arguments.json, "one JSON object instead of a table");
}

TruthCamera camera_of(std::vector<double> values) {
  const TruthCamera usual;
  if (values.size() < 4) values.push_back(usual.heading_deg);
  if (values.size() < 5) values.push_back(usual.pitch_deg);
  if (values.size() < 6) values.push_back(usual.fov_deg);
  return {{values[0], values[1], values[2]}, values[3], values[4], values[5]};
}

/// Renames the meridians, so that the zones of the antimeridian lie around the given one.
void turn(TruthImage& truth, double meridian_deg) {
  for (float& lon_deg : truth.lon_deg) {
    lon_deg = static_cast<float>(std::remainder(static_cast<double>(lon_deg) - meridian_deg + 180.0, 360.0));
  }
}

Picture rounded(const TruthImage& truth) {
  Picture picture{truth.width, truth.height, {}};
  for (const float level : truth.rgb) picture.rgb.push_back(static_cast<std::uint8_t>(level + 0.5F));
  return picture;
}

void run(const Arguments& arguments) {
  const Source source = make_source(read_picture(arguments.picture));
  const RowRule rows{arguments.projection == "equal-area", arguments.latitude == "centric"};
  const Picture shot = read_picture(arguments.shot);
  const Spheroid body{arguments.body[0], arguments.body[1]};
  const TruthOptions options{.width = shot.width, .height = shot.height, .rays_per_side = arguments.rays_per_side};
  TruthImage truth = cast_cached(source, rows, body, camera_of(arguments.camera), options, arguments.cache);
  if (!arguments.write_truth.empty()) write_png(rounded(truth), arguments.write_truth);
  std::optional<TileBorders> borders;
  if (!arguments.tiles.empty()) borders = TileBorders{arguments.tiles[0], static_cast<int>(arguments.tiles[1])};
  turn(truth, arguments.meridian_deg);
  const Judgement judgement = judge(shot, truth, body, rows, borders);
  fmt::print("{}", arguments.json ? as_json(judgement).dump() + "\n" : as_table(judgement));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Judges a rendered picture by the ground truth, zone by zone. Example:\n"
      "terrella_judge --picture noise.png --shot shot.png --camera 30,20,6000000"};
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
