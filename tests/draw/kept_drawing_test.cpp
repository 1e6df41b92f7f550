#include "apps/viewer/draw/kept_drawing.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "apps/viewer/draw/drawing_file.h"
#include "support/scratch_folder.h"
#include "tests/draw/draw_samples.h"

namespace terrella {
namespace {

using test::text_of_file;

Drawing with_place(double lat_deg) {
  Drawing drawing;
  drawing.add({.places = {{.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(7.0)}}});
  return drawing;
}

std::size_t files_in(const std::filesystem::path& folder) {
  return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(KeptDrawing, IsThereInTheNextRun) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "new" / "drawings.geojson";
  KeptDrawing first(file);
  EXPECT_TRUE(first.load().drawing.marks.empty());
  for (const double lat_deg : {1.0, 2.0}) {
    const auto saved = first.save(with_place(lat_deg));
    ASSERT_TRUE(saved);
    EXPECT_EQ(*saved, "");
  }
  KeptDrawing second(file);
  const auto loaded = second.load();
  EXPECT_EQ(loaded.complaint, "");
  EXPECT_EQ(drawing_geojson(loaded.drawing), drawing_geojson(with_place(2.0)));
  EXPECT_TRUE(second.save({}));
  EXPECT_EQ(files_in(file.parent_path()), 1U);
}

TEST(KeptDrawing, SetsAsideTheMarksOfAnotherWindow) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "drawings.geojson";
  KeptDrawing one(file), other(file);
  static_cast<void>(one.load());
  static_cast<void>(other.load());
  ASSERT_TRUE(one.save(with_place(1.0)));
  const std::string marks = text_of_file(file);
  const auto saved = other.save(with_place(2.0));
  ASSERT_TRUE(saved);
  EXPECT_NE(saved->find("Another window"), std::string::npos);
  const std::string aside = saved->substr(saved->find(folder.path().string()));
  EXPECT_EQ(text_of_file(aside), marks);
  EXPECT_EQ(text_of_file(file), drawing_geojson(with_place(2.0)));
}

TEST(KeptDrawing, SetsAsideAFileThatCannotBeReadWhole) {
  const std::string hole = R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]],[[4,1],[5,1],[5,2],[4,1]]]})";
  for (const std::string& text : {std::string("{broken"), hole}) {
    const test::ScratchFolder folder;
    const auto file = folder.path() / "drawings.geojson";
    std::ofstream(file) << text;
    KeptDrawing kept(file);
    const auto loaded = kept.load();
    EXPECT_NE(loaded.complaint.find(folder.path().string()), std::string::npos) << loaded.complaint;
    ASSERT_TRUE(kept.save(with_place(1.0)));
    EXPECT_EQ(files_in(folder.path()), 2U);
    EXPECT_EQ(text_of_file(loaded.complaint.substr(loaded.complaint.find(folder.path().string()))), text);
  }
}

TEST(KeptDrawing, SaysIfNothingCanBeKept) {
  KeptDrawing none({});
  EXPECT_TRUE(none.load().complaint.empty());
  EXPECT_FALSE(none.save(with_place(1.0)));
  const test::ScratchFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  KeptDrawing below_file(folder.path() / "file" / "drawings.geojson");
  static_cast<void>(below_file.load());
  EXPECT_FALSE(below_file.save(with_place(1.0)));
}

TEST(KeptDrawing, HasAFileForEachBody) {
  const test::ScratchFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  EXPECT_EQ(drawings_file("earth"), folder.path() / "terrella" / "drawings.geojson");
  EXPECT_EQ(drawings_file("mars"), folder.path() / "terrella" / "drawings-mars.geojson");
  EXPECT_EQ(drawings_file("1737400,0/a"), folder.path() / "terrella" / "drawings-1737400_0_a.geojson");
}

}  // namespace
}  // namespace terrella
