#include "apps/viewer/tools/kept_settings.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace terrella {
namespace {

class KeptSettingsFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "terrella-settings-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
    file = folder / "terrella" / "settings.json";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void write(const std::string& text) const {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  static std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path folder, file;
};

TEST_F(KeptSettingsFile, WhatWasSavedIsLoaded) {
  EXPECT_TRUE(load_settings(file).first_run);
  const KeptSettings settings{.width_px = 900,
                              .height_px = 700,
                              .panel = true,
                              .layers = true,
                              .graticule = true,
                              .map = false,
                              .units = LengthUnits::nautical};
  ASSERT_TRUE(save_settings(file, settings));
  const LoadedSettings loaded = load_settings(file);
  EXPECT_EQ(loaded.settings, settings);
  EXPECT_FALSE(loaded.first_run);
  EXPECT_EQ(loaded.complaint, "");
}

TEST_F(KeptSettingsFile, WhatOthersHaveWrittenThereStays) {
  write(R"({"graticule": true, "of_a_later_version": [1, 2]})");
  ASSERT_TRUE(save_settings(file, load_settings(file).settings));
  EXPECT_NE(text_of(file).find("of_a_later_version"), std::string::npos);
  EXPECT_TRUE(load_settings(file).settings.graticule);
}

TEST_F(KeptSettingsFile, ADamagedFileIsToldOfAndKeptBesideIt) {
  for (const std::string text :
       {"{\"panel\": fal", "[1]", R"({"width": -3, "panel": true})", R"({"graticule": 7})", R"({"units": 3})"}) {
    SCOPED_TRACE(text);
    write(text);
    const LoadedSettings loaded = load_settings(file);
    EXPECT_NE(loaded.complaint.find(file.string()), std::string::npos) << loaded.complaint;
    EXPECT_EQ(loaded.settings.width_px, 0);
    EXPECT_FALSE(loaded.settings.graticule);
    EXPECT_EQ(text_of(file.string() + ".damaged"), text);
  }
}

TEST_F(KeptSettingsFile, ValuesOfTheCommandLineAreForOneRun) {
  const KeptSettings kept{.width_px = 900, .height_px = 700};
  KeptSettings start = kept;
  start.width_px = 640;  // as the command line says
  KeptSettings now = start;
  now.height_px = 500;  // as the user has set it
  const KeptSettings after = changed_since(kept, start, now);
  EXPECT_EQ(after.width_px, 900);
  EXPECT_EQ(after.height_px, 500);
}

TEST_F(KeptSettingsFile, ModesOfEarlierVersionsAreNotLoaded) {
  write(R"({"graticule": true, "opacity": 0.4, "stereo": "anaglyph", "sky": false, "exaggeration": 9})");
  const LoadedSettings loaded = load_settings(file);
  EXPECT_EQ(loaded.complaint, "");
  EXPECT_EQ(loaded.settings, KeptSettings{.graticule = true});
}

}  // namespace
}  // namespace terrella
