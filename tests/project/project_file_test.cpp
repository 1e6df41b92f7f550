// Project files: what is written is read again, paths follow the file, and faults are named.
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/open_scene/project/read_project.h"
#include "apps/open_scene/project/write_project.h"
#include "support/scratch_folder.h"

namespace terrella {
namespace {

using test::ScratchFolder;
namespace fs = std::filesystem;

/// A scene with a value other than the default in every entry that a project has.
SceneOptions full_scene(const ScratchFolder& folder) {
  std::ofstream(folder / "names.geojson") << "{}";
  SceneOptions scene;
  scene.base.body = *parse_body("mars");
  scene.base.address = (folder / "sub dir/mars é.tif").string();
  scene.base.projection = Projection::equal_area;
  scene.base.latitude = LatitudeKind::centric;
  scene.base.place = {.crs = "EPSG:4326", .bounds = CrsBounds{-10.1, -20.2, 30.3, 40.4}, .west_deg = {}};
  scene.base.numbers = {.colormap = "diverging:0.5",
                        .stretch = {{.kind = StretchRule::Kind::range, .low = -0.1, .high = 1.0 / 3.0}},
                        .nodata = -32768.0,
                        .band = 2,
                        .lit = true,
                        .contours = 12.5};
  scene.base_look = {.shown = false, .opacity = 0.25};
  scene.base.other_body = true;
  scene.base.numbers.angle = GroundAngle::aspect;
  scene.base.remote.name = "Mars in grey";
  scene.base.remote.attribution = "Somebody";
  scene.layers = {
      {.source = {.address = "https://example.org/{z}/{x}/{y}.png",
                  .remote = {.layer = "a",
                             .matrix_set = "b",
                             .style = "c",
                             .time = "2024-07-01",
                             .root_span_deg = 288.0,
                             .tile_px = 512,
                             .max_level = 7}},
       .look = {.opacity = 0.1, .daylight = Daylight::night, .swipe = SwipeSide::before, .blend = LayerBlend::screen}},
      {.source = {},
       .look = {.alpha = AlphaFrom::brightness,
                .height_m = 8000.0,
                .tone = {.brightness = 0.1, .contrast = 1.5, .gamma = 0.8}}}};
  scene.layers.front().source.place.west_deg = {};
  scene.elevation = (folder / "heights.tif").string();
  scene.elevation_shown = false;
  scene.exaggeration = 2.5;
  scene.object_layers = {
      {.file = (folder / "a.geojson").string(),
       .style = (folder / "s.json").string(),
       .shown = false,
       .opacity = 0.75,
       .cluster_px = 40.0},
      {.file = (folder / "b.glb").string(),
       .model_place = Geodetic{.lat = Angle::degrees(46.1), .lon = Angle::degrees(7.7), .height_m = 12.5}}};
  scene.object_layers.front().style_over = R"({"fill":["step",["get","value"],"#440154",10,"#fde725"]})";
  scene.drawings = R"({"features":[],"type":"FeatureCollection"})";
  scene.camera = *parse_camera("46.1,7.7,12345.678,10.5,-45.25,35");
  scene.size = {640, 360};
  scene.time = *parse_utc("2026-06-21T12:00:00.25Z");
  scene.night_lights = false;
  scene.sky = false;
  scene.map = false;
  scene.graticule = true;
  scene.places = (folder / "names.geojson").string();
  scene.surface = {.alpha = 0.3,
                   .blend = Blend::additive,
                   .inner_sphere_below_m = {},
                   .from_below = SurfaceFromBelow::selective,
                   .horizon_culling = HorizonCulling::on,
                   .inner_sphere_srgb = glm::vec3(56.0F, 71.0F, 97.0F) / 255.0F,
                   .hillshade = true,
                   .sharpness = Sharpness::bilinear,
                   .glint = false,
                   .swipe = 0.25};
  scene.stereo = {.mode = Stereo::anaglyph, .eye_separation_m = 123.5};
  scene.unlit = true;
  scene.texturing = Texturing::exact;
  scene.paper_a = 3.5;
  scene.squeezed_rows = false;
  scene.polar_columns = 16;
  scene.texels_per_pixel = 1.4;
  scene.depth = DepthMode::logarithmic;
  return scene;
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

SceneOptions read_or_fail(const fs::path& file) {
  SceneOptions scene;
  const Status read = read_project(file, scene);
  EXPECT_TRUE(read) << (read ? "" : read.error().message);
  return scene;
}

TEST(ProjectFile, WhatIsWrittenIsReadAgain) {
  const ScratchFolder folder;
  const SceneOptions scene = full_scene(folder);
  const ProjectText first = project_text(scene, folder.path());
  EXPECT_TRUE(first.left_out.empty());
  write(folder / "p.terrella", first.text);
  const SceneOptions read = read_or_fail(folder / "p.terrella");
  // The text holds every value, so that the same text from what was read means that all values are the same.
  EXPECT_EQ(project_text(read, folder.path()).text, first.text);
  EXPECT_EQ(read.camera, scene.camera);
  EXPECT_EQ(read.time, scene.time);
  EXPECT_EQ(read.surface, scene.surface);
  EXPECT_EQ(read.stereo, scene.stereo);
  EXPECT_EQ(read.base.numbers, scene.base.numbers);
  EXPECT_EQ(read.base.place, scene.base.place);
  EXPECT_TRUE(read.base.other_body);
  EXPECT_EQ(read.base.remote.name, scene.base.remote.name);
  EXPECT_EQ(read.base.remote.attribution, scene.base.remote.attribution);
  EXPECT_EQ(read.base_look, scene.base_look);
  EXPECT_EQ(read.layers[0].look, scene.layers[0].look);
  EXPECT_EQ(read.layers[1].look, scene.layers[1].look);
  EXPECT_EQ(read.object_layers[1].model_place->height_m, 12.5);
  EXPECT_EQ(read.object_layers[0].style_over, scene.object_layers[0].style_over);
  EXPECT_EQ(read.drawings, scene.drawings);
  EXPECT_TRUE(read.leave_out_faulty);
}

TEST(ProjectFile, PathsFollowTheFile) {
  const ScratchFolder folder;
  const SceneOptions scene = full_scene(folder);
  fs::create_directories(folder / "maps");
  write(folder / "maps/p.terrella", project_text(scene, folder / "maps").text);
  EXPECT_EQ(read_or_fail(folder / "maps/p.terrella").base.address, scene.base.address);
  const auto json = nlohmann::json::parse(project_text(scene, folder / "maps").text);
  EXPECT_EQ(json["layers"][1]["source"], "../sub dir/mars é.tif");
  EXPECT_EQ(json["layers"][2]["source"], "https://example.org/{z}/{x}/{y}.png");
  EXPECT_FALSE(json["layers"][3].contains("source")) << "the included Earth";
}

TEST(ProjectFile, SecretsAreLeftOutAndNamed) {
  SceneOptions scene;
  scene.layers = {{.source = {.address = "https://host.example/{z}/{x}/{y}.png?token=hush"}, .look = {}},
                  {.source = {.address = "https://host.example/wms"}, .look = {}}};
  scene.layers[1].source.remote.headers = {"Authorization: hush"};
  const ProjectText project = project_text(scene, {});
  EXPECT_EQ(project.text.find("hush"), std::string::npos);
  ASSERT_EQ(project.left_out.size(), 2U);
  for (const std::string& message : project.left_out) {
    EXPECT_NE(message.find("host.example"), std::string::npos) << message;
    EXPECT_EQ(message.find("hush"), std::string::npos) << message;
  }
}

TEST(ProjectFile, OptionsOfTheCommandLineWin) {
  const ScratchFolder folder;
  write(folder / "p.terrella", project_text(full_scene(folder), folder.path()).text);
  CLI::App app;
  SceneOptions scene;
  CLI::App* command = app.add_subcommand("view");
  add_scene_options(*command, scene);
  app.parse(
      std::vector<std::string>{(folder / "p.terrella").string(), "--exaggeration=7", "--time=2000-01-01", "view"});
  ASSERT_FALSE(scene.project_fault) << scene.project_fault->message;
  EXPECT_EQ(scene.exaggeration, 7.0);
  EXPECT_EQ(scene.time, *parse_utc("2000-01-01"));
  EXPECT_EQ(scene.surface.alpha, 0.3);
}

TEST(ProjectFile, WithoutImagesTheIncludedEarthStaysHidden) {
  const ScratchFolder folder;
  write(folder / "p.terrella", R"({"terrella": 1})");
  const SceneOptions scene = read_or_fail(folder / "p.terrella");
  EXPECT_TRUE(scene.base.address.empty());
  EXPECT_FALSE(scene.base_look.shown);
}

TEST(ProjectFile, FaultsAreNamed) {
  struct Case {
    const char* text;
    const char* named;
  };
  constexpr Case kCases[] = {
      {"[1]", "p.terrella"},
      {"{", "not JSON"},
      {R"({"layers": []})", "no project"},
      {R"({"terrella": 2})", "version 2"},
      {R"({"terrella": 1, "more": 1})", "\"more\""},
      {R"({"terrella": 1, "settings": {"cache": "/etc/x"}})", "\"cache\""},
      {R"({"terrella": 1, "settings": {"camera": "91,0,1"}})", "LAT"},
      {R"({"terrella": 1, "settings": {"stereo": {}}})", "\"stereo\""},
      {R"({"terrella": 1, "settings": {"exaggeration": 1e9}})", "exaggeration"},
      {R"({"terrella": 1, "layers": [{"kind": "imagery", "header": "A: b"}]})", "\"header\""},
      {R"({"terrella": 1, "layers": [{"kind": "imagery", "opacity": 2}]})", "\"opacity\""},
      {R"({"terrella": 1, "layers": [{"kind": "imagery", "daylight": "noon"}]})", "\"noon\""},
      {R"({"terrella": 1, "layers": [{"kind": "imagery", "height": -1}]})", "height"},
      {R"({"terrella": 1, "layers": [{"kind": "imagery", "stretch": "x"}]})", "--stretch"},
      {R"({"terrella": 1, "layers": [{"kind": "objects"}]})", "\"source\""},
      {R"({"terrella": 1, "layers": [{"kind": "model", "source": "a.glb"}]})", "\"place\""},
      {R"({"terrella": 1, "layers": [{"kind": "model", "source": "a.glb", "place": [1, "x", 2]}]})", "\"place\""},
      {R"({"terrella": 1, "layers": [{"kind": "heights", "source": "a", "elevation-encoding": "y"}]})", "terrarium"},
      {R"({"terrella": 1, "layers": [{"kind": "objects", "source": "a", "classes": {"fill": ["x"]}}]})", "fill"},
      {R"({"terrella": 1, "layers": [{"kind": "none"}]})", "\"none\""},
      {R"({"terrella": 1, "layers": [7]})", "layer 1"},
      {R"({"terrella": 1, "layers": {}})", "\"layers\""}};
  const ScratchFolder folder;
  for (const Case& one : kCases) {
    write(folder / "p.terrella", one.text);
    SceneOptions scene;
    scene.exaggeration = 3.0;
    const Status read = read_project(folder / "p.terrella", scene);
    ASSERT_FALSE(read) << one.text;
    EXPECT_NE(read.error().message.find("p.terrella"), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find(one.named), std::string::npos) << read.error().message;
    EXPECT_EQ(scene.exaggeration, 3.0) << "the options are as before";
  }
}

TEST(ProjectFile, MutantsAreRefusedOrRead) {
  const ScratchFolder folder;
  const std::string whole = project_text(full_scene(folder), folder.path()).text;
  unsigned seed = 1;
  for (int k = 0; k < 400; ++k) {
    std::string text = whole;
    for (int change = 0; change < 3; ++change) {
      seed = seed * 1664525U + 1013904223U;
      text[(seed >> 8) % text.size()] = static_cast<char>(32 + (seed >> 3) % 95);
    }
    write(folder / "p.terrella", text);
    SceneOptions scene;
    const Status read = read_project(folder / "p.terrella", scene);
    const std::string message = read ? "p.terrella" : read.error().message;
    EXPECT_NE(message.find("p.terrella"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace terrella
