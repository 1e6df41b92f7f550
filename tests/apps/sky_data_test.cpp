// The files of the sky as they are shipped, and what is said where one is missing or damaged.
#include "apps/open_scene/sky_data.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "globe/data_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

const fs::path kShipped = TERRELLA_DATA_SOURCE;

/// A folder that TERRELLA_DATA names while it lives.
class DataFolder {
 public:
  DataFolder() : path_(fs::path(testing::TempDir()) / ("sky_data_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
    ::setenv("TERRELLA_DATA", path_.c_str(), 1);
  }
  ~DataFolder() {
    ::unsetenv("TERRELLA_DATA");
    fs::remove_all(path_);
  }
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

  void write(const char* name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
  }
  void copy(const char* from, const char* name) const {
    fs::copy_file(kShipped / from, path_ / name, fs::copy_options::overwrite_existing);
  }

 private:
  fs::path path_;
};

// A library knows no program, so an application names the folder.
TEST(DataFiles, FillOptionsFromAFolderNamedAtRunTime) {
  const DataFolder folder;
  const fs::path path = std::getenv("TERRELLA_DATA");
  GlobeOptions options;
  const Status missing = add_data(options, path);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find((path / "DejaVuSans.ttf").string()), std::string::npos);
  folder.copy("fonts/DejaVuSans.ttf", "DejaVuSans.ttf");
  ASSERT_TRUE(add_data(options, path)) << "a globe without a sky needs a font only";
  EXPECT_FALSE(options.label_font.empty());
  EXPECT_TRUE(options.stars.empty());
  options.sky = true;
  folder.copy("sky/stars.csv", "stars.csv");
  EXPECT_FALSE(add_data(options, path)) << "no city lights";
  EXPECT_TRUE(options.stars.empty()) << "half filled";
  folder.copy("earth/night_lights.png", "night_lights.png");
  ASSERT_TRUE(add_data(options, path));
  EXPECT_EQ(options.stars.size(), 8874u);
  EXPECT_EQ(options.night_lights.width_px, 2048);
}

TEST(SkyData, IsWhatTheProgramShips) {
  const auto stars = load_stars(kShipped / "sky" / "stars.csv");
  ASSERT_TRUE(stars) << stars.error().message;
  EXPECT_EQ(stars->size(), 8874u);
  EXPECT_FLOAT_EQ(stars->front().magnitude, -1.44F) << "Sirius is the brightest";
  const auto lights = load_night_lights(kShipped / "earth" / "night_lights.png");
  ASSERT_TRUE(lights) << lights.error().message;
  EXPECT_EQ(lights->width_px, 2048);
  EXPECT_EQ(lights->height_px, 1024);
  const auto at = [&lights](double lat, double lon) {
    const auto x = static_cast<std::size_t>((lon + 180.0) / 360.0 * 2048.0);
    const auto y = static_cast<std::size_t>((90.0 - lat) / 180.0 * 1024.0);
    return int(lights->values[y * 2048 + x]);
  };
  EXPECT_GT(at(48.86, 2.35), 150) << "Paris";
  EXPECT_GT(at(30.05, 31.25), 150) << "Cairo";
  EXPECT_EQ(at(0.0, -150.0), 0) << "the Pacific";
  EXPECT_EQ(at(-80.0, 0.0), 0) << "Antarctica's ice";
}

TEST(SkyData, DoesWithoutWhatIsMissingOrDamagedAndSaysSo) {
  const DataFolder folder;
  SkyData data = load_sky_data();
  EXPECT_TRUE(data.stars.empty());
  EXPECT_TRUE(data.night_lights.values.empty());
  ASSERT_EQ(data.problems.size(), 2u);
  EXPECT_NE(data.problems[0].find("stars.csv"), std::string::npos) << data.problems[0];
  EXPECT_NE(data.problems[0].find("without stars"), std::string::npos) << data.problems[0];
  folder.write("stars.csv", "ra_deg,dec_deg,vmag,bv\n1,2,3,0\n1,2,x,0\n");
  folder.write("night_lights.png", "\x89PNG\r\n\x1a\nno more");
  data = load_sky_data();
  ASSERT_EQ(data.problems.size(), 2u);
  EXPECT_NE(data.problems[0].find("stars.csv: line 3"), std::string::npos) << data.problems[0];
  EXPECT_NE(data.problems[1].find("night_lights.png"), std::string::npos) << data.problems[1];
  folder.copy("sky/stars.csv", "stars.csv");
  folder.copy("earth/night_lights.png", "night_lights.png");
  data = load_sky_data();
  EXPECT_TRUE(data.problems.empty());
  EXPECT_EQ(data.stars.size(), 8874u);
}

}  // namespace
}  // namespace terrella::test
