// Judges the built program: cuts the planets, renders each view of accuracy_views.cpp with `terrella render --unlit`,
// and holds it against the ray caster. Working files (planets, tile sets, remembered truths, shots, accuracy.csv) stay
// in the folder TERRELLA_ACCURACY_DIR of the build.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "apps/bench/truth/noise_planet.h"
#include "apps/bench/truth/truth_cache.h"
#include "ground_truth/accuracy_report.h"
#include "ground_truth/terrella_process.h"

namespace terrella::truth {
namespace {

namespace fs = std::filesystem;
const fs::path kProgram = TERRELLA_PROGRAM;
const fs::path kFolder = TERRELLA_ACCURACY_DIR;
const fs::path kBlueMarble = TERRELLA_BLUE_MARBLE;
constexpr int kTile_px = 256;

ProcessResult terrella_run(const std::vector<std::string>& arguments) {
  return run_process(kProgram, arguments, kFolder / "output.txt");
}

struct Planet {
  Source source;
  fs::path tiles;
};

Planet cut(const fs::path& image, const std::string& name) {
  Planet planet{make_source(read_picture(image)), kFolder / (name + ".gpkg")};
  fs::remove(planet.tiles);
  const ProcessResult result = terrella_run({"cut", image.string(), "-o", planet.tiles.string(), "--format", "png"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  fmt::print("cut {} in {:.1f} s\n", name, result.seconds);
  return planet;
}

fs::path noise_image() {
  const fs::path image = kFolder / "noise.png";
  write_png(noise_planet({}), image);
  return image;
}

class AccuracyTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(kFolder);
    planets_["noise"] = cut(noise_image(), "noise");
    planets_["blue_marble"] = cut(kBlueMarble, "blue_marble");
  }
  static void TearDownTestSuite() { planets_.clear(); }
  static const Planet& planet(const std::string& name) { return planets_.at(name); }

 private:
  static inline std::map<std::string, Planet> planets_;
};

std::vector<std::string> render_arguments(const AccuracyView& view, const fs::path& tiles, const fs::path& shot) {
  const TruthCamera& c = view.camera;
  return {"render",
          tiles.string(),
          "--unlit",
          "-o",
          shot.string(),
          "--size",
          fmt::format("{0}x{0}", view.size_px),
          "--camera",
          fmt::format("{},{},{},{},{},{}", c.eye.lat_deg, c.eye.lon_deg, c.eye.height_m, c.heading_deg, c.pitch_deg,
                      c.fov_deg),
          "--body",
          fmt::format("{},{}", view.body.a_m, view.body.f),
          "--projection",
          view.rows.equal_area ? "equal-area" : "equirectangular",
          "--latitude",
          view.rows.centric ? "centric" : "graphic"};
}

JudgedView judged(const AccuracyView& view, const Planet& planet) {
  const fs::path shot = kFolder / (view.name + ".png");
  fs::remove(shot);
  const ProcessResult result = terrella_run(render_arguments(view, planet.tiles, shot));
  EXPECT_EQ(result.exit_code, 0) << view.name << ": " << result.output;
  const TruthImage truth = cast_cached(planet.source, view.rows, view.body, view.camera,
                                       {.width = view.size_px, .height = view.size_px}, kFolder / "truth");
  const TileBorders finest{360.0 * kTile_px / planet.source.picture.width, 0};
  return {view, judge(read_picture(shot), truth, view.body, view.rows, finest), result.seconds};
}

TEST_F(AccuracyTest, EveryViewKeepsItsLimits) {
  std::vector<JudgedView> views;
  std::vector<AccuracyLine> table;
  for (const AccuracyView& view : accuracy_views()) {
    views.push_back(judged(view, planet(view.planet)));
    for (const AccuracyLine& line : lines_of(views.back(), views)) {
      table.push_back(line);
      EXPECT_FALSE(line.fails()) << line.view << ", " << line.zone << ": " << line.rms << " exceeds " << line.limit;
    }
  }
  write_csv(table, kFolder / "accuracy.csv");
  fmt::print("{}", as_table(table));
}

}  // namespace
}  // namespace terrella::truth
