#include "streaming/objects/gltf_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "streaming/objects/geojson_objects.h"
#include "support/model_file.h"
#include "support/scratch_folder.h"

namespace terrella::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::array<double, 4> kRedFactor{1.0, 0.0, 0.0, 1.0};

Result<ModelFile> read_bytes(const std::string& bytes) {
  return parse_gltf_model(std::as_bytes(std::span(bytes)), "m.glb", {});
}
Result<ModelFile> read_model(const ModelFixture& model) { return read_bytes(model.bytes()); }

template <class Index = std::uint16_t>
ModelFixture unit_box() {
  return box_model<Index>({0.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 3.0F}, kRedFactor);
}

/// Two boxes, so that one can be broken and the other is to stay.
ModelFixture two_boxes() {
  ModelFixture model = unit_box();
  const std::vector<float> positions(24, 5.0F);
  const int position = model.add_accessor(positions, 5126, "VEC3", 8);
  const int index = model.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}, 5123, "SCALAR", 6);
  nlohmann::json primitive = {{"attributes", {{"POSITION", position}}}, {"indices", index}};
  nlohmann::json mesh = {{"name", "other"}};
  mesh["primitives"].push_back(primitive);
  model.json["meshes"].push_back(mesh);
  model.json["nodes"].push_back({{"mesh", 1}});
  model.json["scenes"][0]["nodes"] = {0, 1};
  return model;
}

/// Reads a model in which the second mesh is wrong: the first stays.
std::string complaint_of(const ModelFixture& model) {
  const auto file = read_model(model);
  EXPECT_TRUE(file) << file.error().message;
  if (!file) return {};
  EXPECT_EQ(file->model->parts.size(), 1U);
  EXPECT_EQ(file->model->parts.at(0).indices.size(), 36U);
  EXPECT_EQ(file->complaints.size(), 1U);
  return file->complaints.empty() ? std::string() : file->complaints[0];
}

template <class Index>
void expect_box() {
  const auto file = read_model(unit_box<Index>());
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->complaints, ElementsAre());
  const MeshPart& part = file->model->parts.at(0);
  EXPECT_EQ(part.vertices.size(), 8U);
  ASSERT_EQ(part.indices.size(), 36U);
  EXPECT_EQ(part.indices[35], 5U);
  EXPECT_EQ(part.vertices[7].position_m, glm::vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(part.color_linear, glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
}

TEST(GltfModel, ReadsIndicesOf8And16And32Bits) {
  expect_box<std::uint8_t>();
  expect_box<std::uint16_t>();
  expect_box<std::uint32_t>();
}

TEST(GltfModel, NodesTurnScaleAndMoveWhatIsUnderThem) {
  ModelFixture model = unit_box();
  const double half = std::sqrt(0.5);  // a quarter turn around y: z goes to x, x to -z
  model.json["nodes"] = {{{"children", {1}}, {"translation", {10, 20, 30}}, {"rotation", {0, half, 0, half}}},
                         {{"mesh", 0}, {"scale", {2, 2, 2}}}};
  const auto file = read_model(model);
  ASSERT_TRUE(file) << file.error().message;
  const glm::vec3 corner = file->model->parts.at(0).vertices[7].position_m;
  constexpr float kRounding_m = 1.0e-5F;
  EXPECT_NEAR(corner.x, 10.0F + 6.0F, kRounding_m);
  EXPECT_NEAR(corner.y, 20.0F + 4.0F, kRounding_m);
  EXPECT_NEAR(corner.z, 30.0F - 2.0F, kRounding_m);
}

TEST(GltfModel, ABrokenMeshIsNamedAndTheOtherStays) {
  ModelFixture out_of_range = two_boxes();
  const std::uint16_t index = 60'000;
  const std::size_t indices_at = out_of_range.json["bufferViews"][3]["byteOffset"];
  for (const std::size_t k : {0U, 5U}) std::memcpy(&out_of_range.buffer[indices_at + 2 * k], &index, 2);
  EXPECT_THAT(
      [&] {
        const auto file = read_model(out_of_range);
        return file ? file->complaints : std::vector<std::string>{};
      }(),
      Contains(AllOf(HasSubstr("m.glb"), HasSubstr("mesh 1 (\"other\")"), HasSubstr("indices out of range"))));

  ModelFixture over = two_boxes();
  over.json["accessors"][2]["count"] = 100;
  EXPECT_THAT(complaint_of(over), AllOf(HasSubstr("m.glb"), HasSubstr("mesh 1 (\"other\")"), HasSubstr("accessor 2"),
                                        HasSubstr("runs over buffer view 2")));
  ModelFixture view_over = two_boxes();
  view_over.json["bufferViews"][2]["byteLength"] = 1'000'000;
  EXPECT_THAT(complaint_of(view_over), AllOf(HasSubstr("accessor 2"), HasSubstr("runs over its buffer's")));
  ModelFixture absurd = two_boxes();
  absurd.json["accessors"][2]["count"] = 4'000'000'000'000;
  EXPECT_THAT(complaint_of(absurd), AllOf(HasSubstr("accessor 2"), HasSubstr("more than the")));
  ModelFixture sparse = two_boxes();
  sparse.json["accessors"][2].erase("bufferView");
  EXPECT_THAT(complaint_of(sparse), HasSubstr("accessor 2"));
  ModelFixture lines = two_boxes();
  lines.json["meshes"][1]["primitives"][0]["mode"] = 1;
  EXPECT_THAT(complaint_of(lines), HasSubstr("points or lines"));
}

TEST(GltfModel, PositionsThatAreNoNumbersAreLeftOut) {
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1.0e30F}) {
    ModelFixture model = unit_box();
    std::memcpy(model.buffer.data(), &wrong, sizeof wrong);  // corner 0
    const auto file = read_model(model);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model->parts.at(0).indices.size(), 36U - 3U * 6U) << "those at corner 0 are gone";
    EXPECT_THAT(file->complaints, ElementsAre(AllOf(HasSubstr("m.glb: mesh 0"), HasSubstr("no numbers"))));
  }
}

TEST(GltfModel, NodesInARingOrWithoutEndAreWalkedOnce) {
  ModelFixture model = unit_box();
  model.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0, 7}}}};
  const auto file = read_model(model);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->model->parts.size(), 1U);
  EXPECT_THAT(file->complaints, ElementsAre(HasSubstr("node 7 does not exist"), HasSubstr("node 0 comes again")));
}

// Reading a chain took the square of its length: two minutes for this one.
TEST(GltfModel, ALongChainOfNodesIsReadInTimeThatGrowsWithItsLength) {
  constexpr std::size_t kNodes = 600'000;
  constexpr double kHang_s = 60.0;  // processor time, which a busy machine does not change; a second or two are taken
  ModelFixture model = unit_box();
  nlohmann::json nodes;
  for (std::size_t k = 1; k < kNodes; ++k) nodes.push_back({{"children", {k}}});
  nodes[0]["translation"] = {1000, 0, 0};
  nodes.push_back({{"mesh", 0}});
  model.json["nodes"] = std::move(nodes);
  const std::string bytes = model.bytes();
  const std::clock_t begin = std::clock();
  const auto file = read_bytes(bytes);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kHang_s);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->complaints, ElementsAre());
  EXPECT_EQ(file->model->parts.at(0).vertices[7].position_m, glm::vec3(1001.0F, 2.0F, 3.0F)) << "under all of them";
}

TEST(GltfModel, MoreNodesThanAreReadAreAnError) {
  ModelFixture model = unit_box();
  model.json["nodes"] = nlohmann::json::array_t(kMaxModelNodes + 1, nlohmann::json::object());
  const auto file = read_model(model);
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, AllOf(HasSubstr("m.glb: "), HasSubstr("1000001 nodes"), HasSubstr("1000000")));
}

TEST(GltfModel, PrimitivesThatCannotBeDrawnCostNothing) {
  constexpr std::chrono::seconds kHang(60);
  for (const char* wrong : {"mode", "indices"}) {
    ModelFixture model = unit_box();
    const int many =
        model.add_accessor(std::vector<std::uint8_t>(kMaxModelIndices / 3), 5121, "SCALAR", kMaxModelIndices / 3);
    nlohmann::json primitive = model.json["meshes"][0]["primitives"][0];
    primitive["indices"] = many;
    if (wrong == std::string("mode")) primitive["mode"] = 1;  // lines
    if (wrong == std::string("indices")) model.json["accessors"][std::size_t(many)]["componentType"] = 5120;
    for (std::size_t k = 2; k < kMaxModelParts; ++k) model.json["meshes"][0]["primitives"].push_back(primitive);
    const auto begin = std::chrono::steady_clock::now();
    const auto file = read_model(model);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, kHang) << wrong;
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model->parts.size(), 1U);
  }
}

TEST(GltfModel, MoreThanAModelMayHoldIsLeftOut) {
  ModelFixture model = unit_box();
  const nlohmann::json primitive = model.json["meshes"][0]["primitives"][0];
  for (std::size_t k = 1; k < kMaxModelParts + 50; ++k) model.json["meshes"][0]["primitives"].push_back(primitive);
  const auto file = read_model(model);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->model->parts.size(), kMaxModelParts);
  EXPECT_THAT(file->complaints, ElementsAre(HasSubstr("at most 10000")));
}

TEST(GltfModel, ABufferThatIsMissingTakesOnlyWhatNeedsIt) {
  const ScratchFolder folder;
  ModelFixture model = two_boxes();
  std::ofstream(folder.path() / "here.bin", std::ios::binary) << model.buffer;
  nlohmann::json document = model.document("here.bin");
  document["buffers"].push_back({{"uri", "gone.bin"}, {"byteLength", 96}});
  document["bufferViews"][2] = {{"buffer", 1}, {"byteLength", 96}};
  std::ofstream(folder.path() / "m.gltf") << document;
  const auto file = read_gltf_model(folder.path() / "m.gltf");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->model->parts.size(), 1U);
  EXPECT_THAT(file->complaints, ElementsAre(AllOf(HasSubstr("m.gltf"), HasSubstr("gone.bin")),
                                            AllOf(HasSubstr("mesh 1"), HasSubstr("accessor 2"),
                                                  HasSubstr("buffer 1, which is missing"))));
  document["buffers"][1]["uri"] = "../gone.bin";
  std::ofstream(folder.path() / "m.gltf") << document;
  EXPECT_THAT(read_gltf_model(folder.path() / "m.gltf")->complaints,
              Contains(HasSubstr("only files in the same folder")));
}

/// A model whose buffer is `uri`, beside a folder with a secret: what is complained of, and none if it was read.
class ModelLinks : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(models() / "inside");
    std::filesystem::create_directories(folder_.path() / "outside");
    for (const char* name : {"outside/secret.bin", "models/inside/own.bin"}) {
      std::ofstream(folder_.path() / name, std::ios::binary) << unit_box().buffer;
    }
  }
  [[nodiscard]] std::filesystem::path models() const { return folder_.path() / "models"; }
  void link(const char* name, const std::filesystem::path& to) const {
    std::filesystem::create_symlink(to, models() / name);
  }
  [[nodiscard]] std::string read(const std::string& uri) const {
    std::ofstream(models() / "m.gltf") << unit_box().document(uri);
    const auto file = read_gltf_model(models() / "m.gltf");
    return file ? std::string() : file.error().message;
  }

  ScratchFolder folder_;
};

TEST_F(ModelLinks, NamesThatLeadOutOfTheFolderAreRefused) {
  const std::string absolute = (folder_.path() / "outside/secret.bin").string();
  for (const std::string& uri : {std::string("../outside/secret.bin"), std::string("inside/../../outside/secret.bin"),
                                 std::string("%2e%2e/outside/secret.bin"), std::string("..%2Foutside%2fsecret.bin"),
                                 absolute, std::string("%2e%2e%00/outside/secret.bin")}) {
    EXPECT_THAT(read(uri), AllOf(HasSubstr("m.gltf: "), HasSubstr("only files in the same folder"))) << uri;
  }
  EXPECT_NE(read("file://" + absolute), "") << "not a name of a file";
}

TEST_F(ModelLinks, LinksThatLeadOutOfTheFolderAreRefused) {
  link("file.bin", folder_.path() / "outside/secret.bin");
  link("relative.bin", "../outside/secret.bin");
  link("folder", "../outside");
  link("chain.bin", "inside/../file.bin");
  for (const char* uri : {"file.bin", "relative.bin", "folder/secret.bin", "inside/../chain.bin"}) {
    EXPECT_THAT(read(uri), AllOf(HasSubstr("m.gltf: "), HasSubstr(std::string(uri).substr(0, 4)),
                                 HasSubstr("out of the folder"), HasSubstr("secret.bin")))
        << uri;
  }
  link("ring.bin", "ring.bin");
  link("nowhere.bin", "../outside/none.bin");
  EXPECT_NE(read("ring.bin"), "");
  EXPECT_NE(read("nowhere.bin"), "");
}

TEST_F(ModelLinks, LinksThatStayInTheFolderAreFollowed) {
  link("own.bin", "inside/own.bin");
  link("again", "inside");
  for (const char* uri : {"own.bin", "again/own.bin", "inside/../own.bin", "./inside/own.bin"})
    EXPECT_EQ(read(uri), "");
  std::filesystem::create_directory_symlink(models(), folder_.path() / "door");
  EXPECT_TRUE(read_gltf_model(folder_.path() / "door/m.gltf")) << "the folder may be a link itself";
}

TEST(GltfModel, PicturesInABufferMayNotRunOverIt) {
  ModelFixture model = unit_box();
  model.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 100}, {"byteLength", 2'000'000'000}});
  model.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
  model.json["textures"] = {{{"source", 0}}};
  model.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const auto file = read_model(model);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->model->parts.size(), 1U);
  EXPECT_THAT(file->complaints, ElementsAre(AllOf(HasSubstr("image 0"), HasSubstr("runs over its buffer"))));
}

TEST(GltfModel, WhatIsNoModelIsAnErrorThatNamesTheFile) {
  const std::string whole = unit_box().bytes();
  std::string long_buffer = whole;
  const std::uint32_t json_bytes = static_cast<std::uint32_t>(whole.size()) - 28 - 168;
  const std::uint32_t too_long = 172;  // by less than a chunk's header
  std::memcpy(&long_buffer[20 + json_bytes], &too_long, sizeof too_long);
  for (const std::string& bytes :
       {std::string(), std::string("{}"), std::string("<kml/>"), whole.substr(0, 15), whole.substr(0, 200), long_buffer,
        std::string(100'000, '['), std::string(R"({"asset":{"version":"2.0"}})")}) {
    const auto file = read_bytes(bytes);
    ASSERT_FALSE(file) << bytes.substr(0, 40);
    EXPECT_THAT(file.error().message, HasSubstr("m.glb: "));
  }
  EXPECT_THAT(read_gltf_model("no/such.glb").error().message, HasSubstr("no/such.glb"));
}

TEST(GltfModel, PointsOfGeojsonNameModels) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "box.glb", std::ios::binary) << unit_box().bytes();
  const auto point = [](const std::string& properties) {
    return R"({"type":"Feature","properties":)" + properties +
           R"(,"geometry":{"type":"Point","coordinates":[8,47,9]}})";
  };
  std::istringstream text(R"({"type":"FeatureCollection","features":[)" +
                          point(R"({"model":"box.glb","scale":3,"heading_deg":90})") + "," +
                          point(R"({"model":"box.glb","scale":-1})") + "," + point(R"({"model":"gone.glb"})") + "," +
                          point(R"({"model":"../box.glb"})") + "," + point(R"({"scale":"other"})") + "]}");
  const auto file = parse_geojson_objects(text, "f.geojson", folder.path());
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->scene.meshes.size(), 2U);
  EXPECT_EQ(file->scene.meshes[0].model, file->scene.meshes[1].model) << "read once";
  EXPECT_EQ(file->scene.meshes[0].scale, 3.0);
  EXPECT_DOUBLE_EQ(file->scene.meshes[0].heading.deg(), 90.0);
  EXPECT_EQ(file->scene.meshes[0].place.height_m, 9.0);
  EXPECT_EQ(file->scene.points.size(), 3U) << "points whose model is not to be had are drawn as points";
  EXPECT_THAT(file->complaints, ElementsAre(AllOf(HasSubstr("feature 2"), HasSubstr("\"scale\"")),
                                            AllOf(HasSubstr("f.geojson: feature 3"), HasSubstr("gone.glb")),
                                            AllOf(HasSubstr("feature 4"), HasSubstr("only files in the same folder"))));
}

}  // namespace
}  // namespace terrella::test
