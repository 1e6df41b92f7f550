#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "apps/viewer/tools/dropped_files.h"
#include "apps/viewer/tools/folder_list.h"
#include "apps/viewer/tools/recent_files.h"
#include "support/scratch_folder.h"

namespace terrella {
namespace {

TEST(RecentFiles, AreThereInTheNextRunTheNewestFirst) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "new" / "recent.json";
  auto recent = RecentFiles::load(file);
  ASSERT_TRUE(recent) << "a file that is not there has none";
  for (const char* opened : {"/a.tif", "/b.tif", "/c.tif", "/a.tif"}) recent->add(opened);
  ASSERT_TRUE(recent->save(file));
  const auto again = RecentFiles::load(file);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->all(), (std::vector<std::string>{"/a.tif", "/c.tif", "/b.tif"}));
}

TEST(RecentFiles, AreNotMoreThanTheListShows) {
  RecentFiles recent;
  for (int k = 0; k < 50; ++k) recent.add("/" + std::to_string(k));
  EXPECT_EQ(recent.all().size(), RecentFiles::kMost);
  EXPECT_EQ(recent.all().front(), "/49");
}

TEST(RecentFiles, AddressesWithSecretsAreNotStored) {
  RecentFiles recent;
  recent.add("https://tiles.example/{z}/{x}/{y}.png?key=abc");
  recent.add("https://user:word@tiles.example/a.tif");
  EXPECT_TRUE(recent.all().empty());
  recent.add("https://tiles.example/wms?service=WMS&layers=hills");
  EXPECT_EQ(recent.all().size(), 1U);
}

TEST(RecentFiles, ADamagedFileIsNamed) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "recent.json";
  for (const char* text : {"[", "{}", "{\"recent\": 7}"}) {
    std::ofstream(file) << text;
    const auto recent = RecentFiles::load(file);
    ASSERT_FALSE(recent) << text;
    EXPECT_NE(recent.error().message.find("recent.json"), std::string::npos);
  }
}

TEST(FolderList, HasFoldersFirstAndOnlyWhatCanBeShown) {
  const test::ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "zoo");
  std::filesystem::create_directory(folder.path() / "Art");
  for (const char* name : {"b.tif", "A.TIF", "notes.doc", ".hidden.png"}) std::ofstream(folder.path() / name) << "x";
  const auto shown = list_folder(folder.path(), false);
  ASSERT_TRUE(shown);
  EXPECT_EQ(*shown, (std::vector<FolderEntry>{{"Art", true}, {"zoo", true}, {"A.TIF", false}, {"b.tif", false}}));
  const auto all = list_folder(folder.path(), true);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->size(), 5U);
}

TEST(FolderList, AMissingFolderIsNamedWithACure) {
  const auto none = list_folder("/nowhere/at/all", false);
  ASSERT_FALSE(none);
  for (const char* part : {"/nowhere/at/all", "choose another folder"}) {
    EXPECT_NE(none.error().message.find(part), std::string::npos);
  }
}

TEST(OpenedFiles, HaveNamesWithoutSecrets) {
  EXPECT_EQ(shown_name("/data/moon.tif"), "moon.tif");
  EXPECT_EQ(shown_name("/data/dem/"), "dem");
  EXPECT_EQ(shown_name("https://tiles.example/{z}/{x}/{y}.png?key=abc"), "https://tiles.example/{z}/{x}/{y}.png");
}

TEST(OpenedFiles, APictureIsOfTheBodyThatItsNameHasAsAWord) {
  for (const char* name : {"/a/moon.jpg", "Moon_4k.PNG", "the-moon-2.webp"}) {
    const auto body = named_body(name);
    ASSERT_TRUE(body) << name;
    EXPECT_EQ(body->name, "moon");
  }
  for (const char* name : {"honeymoon.jpg", "moon.tif", "/moon/land.jpg", "europa.png", "a.jpg"}) {
    EXPECT_FALSE(named_body(name)) << name;
  }
}

TEST(OpenedFiles, ObjectsOnServersAreRefusedWithACure) {
  for (const char* address : {"https://maps.example/a.geojson", "https://maps.example/a.glb"}) {
    const auto opened = open_dropped({.address = address}, {}, {});
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("download this one"), std::string::npos) << opened.error().message;
  }
}

}  // namespace
}  // namespace terrella
