#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "raster_files.h"
#include "streaming/numbers/colour_table.h"

namespace terrella::test {
namespace {

constexpr const char* kTable =
    "# heights\n"
    "-100, 0, 0, 128\n"
    "0\twhite\n"
    "50% 10:20:30:40   # a part of the range\n"
    "  1e3 255 128 0 255 the label\r\n"
    "nv 1 2 3 0\n"
    "default Grey\n"
    "\n";

TEST(ColourTableTest, ReadsEveryForm) {
  const auto table = parse_colour_table(kTable, "t.txt");
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->entries.size(), 4U);
  EXPECT_EQ(table->entries[0].at, -100.0);
  EXPECT_EQ(table->entries[0].colour, (TableColour{0, 0, 128, 255}));
  EXPECT_EQ(table->entries[1].colour, (TableColour{255, 255, 255, 255}));
  EXPECT_TRUE(table->entries[2].percent);
  EXPECT_EQ(table->entries[2].at, 50.0);
  EXPECT_EQ(table->entries[2].colour, (TableColour{10, 20, 30, 40}));
  EXPECT_EQ(table->entries[3].at, 1000.0);
  EXPECT_EQ(table->entries[3].colour, (TableColour{255, 128, 0, 255}));
  EXPECT_EQ(table->nodata, (TableColour{1, 2, 3, 0}));
  EXPECT_EQ(table->other, (TableColour{128, 128, 128, 255}));
  EXPECT_FALSE(table->discrete);
}

TEST(ColourTableTest, StepsOfQgisExportsAreSteps) {
  const auto table = parse_colour_table(
      "# QGIS Generated Color Map Export File\nINTERPOLATION:DISCRETE\n10,1,2,3,255,<= 10\n20,4,5,6,255,20\n", "q.txt");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_TRUE(table->discrete);
  EXPECT_EQ(table->entries.size(), 2U);
}

TEST(ColourTableTest, FaultsNameTheLineAndTheForm) {
  for (const char* line :
       {"10 256 0 0", "10 1 2", "10 pink", "x 1 2 3", "10 1.5 2 3", "10", "10 1 2 3 999", "nv", "50%% red"}) {
    const auto table = parse_colour_table(fmt::format("0 black\n# note\n{}\n", line), "maps/t.txt");
    ASSERT_FALSE(table) << line;
    EXPECT_NE(table.error().message.find("maps/t.txt: line 3"), std::string::npos) << table.error().message;
    EXPECT_NE(table.error().message.find("VALUE R G B"), std::string::npos) << table.error().message;
  }
  const auto empty = parse_colour_table("# nothing\n", "t.txt");
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("no entry"), std::string::npos);
  EXPECT_FALSE(read_colour_table("/nowhere/t.txt"));
}

/// gdaldem reads the same table: each entry's value has the entry's colour.
TEST(ColourTableTest, GdaldemReadsTheSameTable) {
  const ScratchFolder folder;
  const std::string text = "0 black\n25% 10 20 30\n60 red\n100,255,255,254\n";
  std::ofstream(folder / "t.txt") << text;
  const std::array<double, 4> values{0.0, 25.0, 60.0, 100.0};
  write_raw(folder / "in.raw", "Float32", 4, 1, 1,
            [&](int x, int, int) { return values[static_cast<std::size_t>(x)]; });
  ASSERT_TRUE(translate("", folder / "in.raw", folder / "in.tif"));
  ASSERT_TRUE(run(fmt::format("{} color-relief {} {} {}", TERRELLA_GDALDEM, (folder / "in.tif").string(),
                              (folder / "t.txt").string(), (folder / "out.tif").string())));
  const GdalPixels pixels = read_by_gdal(folder / "out.tif", 3);
  const auto table = parse_colour_table(text, "t.txt");
  ASSERT_TRUE(table) << table.error().message;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(pixels.at(static_cast<int>(i), 0, c), table->entries[i].colour[static_cast<std::size_t>(c)]) << i;
    }
  }
}

}  // namespace
}  // namespace terrella::test
