#include "apps/viewer/tools/bookmarks.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/scratch_folder.h"

namespace terrella {
namespace {

Camera somewhere() {
  return {.eye = {.lat = Angle::degrees(46.1), .lon = Angle::degrees(-7.2), .height_m = 12345.678},
          .heading = Angle::degrees(30.0),
          .pitch = Angle::degrees(-20.0)};
}

TEST(Bookmarks, AreThereInTheNextRunToTheLastBit) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "new" / "folder" / "bookmarks.json";
  auto bookmarks = Bookmarks::load(file);
  ASSERT_TRUE(bookmarks) << "a file that is not there has none";
  bookmarks->set(1, somewhere());
  bookmarks->set(9, {}, "Zürich, Switzerland");
  ASSERT_TRUE(bookmarks->save(file));
  const auto again = Bookmarks::load(file);
  ASSERT_TRUE(again);
  ASSERT_TRUE(again->at(1) && again->at(9));
  EXPECT_FALSE(again->at(2));
  EXPECT_EQ(again->all().at(9).place, "Zürich, Switzerland");
  EXPECT_EQ(again->all().at(1).place, "");
  EXPECT_EQ(again->at(1)->eye.height_m, somewhere().eye.height_m);
  EXPECT_NEAR(again->at(1)->eye.lat.deg(), 46.1, 1e-13);
}

TEST(Bookmarks, EachBodyHasAFileOfItsOwn) {
  const auto earth = bookmarks_file("earth"), mars = bookmarks_file("mars"), other = bookmarks_file("255000,0");
  ASSERT_TRUE(earth && mars && other) << "HOME is set";
  EXPECT_EQ(earth->filename(), "bookmarks.json");
  EXPECT_EQ(mars->filename(), "bookmarks-mars.json");
  EXPECT_EQ(other->filename(), "bookmarks-255000_0.json");
}

TEST(Bookmarks, ADamagedFileIsNamedAndOneBadBookmarkLosesNoOther) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "bookmarks.json";
  std::ofstream(file) << "{\"bookmarks\": {";
  const auto damaged = Bookmarks::load(file);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().message.find("bookmarks.json"), std::string::npos);
  std::ofstream(file) << R"({"bookmarks": {"1": "north of here", "2": 7, "3": "46,7,1000", "12": "0,0,1"}})";
  const auto some = Bookmarks::load(file);
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_FALSE(some->at(1));
  EXPECT_FALSE(some->at(2));
  EXPECT_TRUE(some->at(3));
}

TEST(Bookmarks, HaveNamesAndAnOrderThatStay) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "bookmarks.json";
  Bookmarks bookmarks;
  EXPECT_EQ(bookmarks.free_number(), 1);
  bookmarks.set(1, somewhere());
  bookmarks.set(3, {});
  EXPECT_EQ(bookmarks.free_number(), 2);
  bookmarks.rename(1, "Zürich \"home\"");
  bookmarks.exchange(1, 2);
  bookmarks.exchange(2, 3);
  bookmarks.set(12, somewhere());
  ASSERT_TRUE(bookmarks.save(file));
  auto again = Bookmarks::load(file);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->all().size(), 3U);
  EXPECT_FALSE(again->at(1));
  EXPECT_EQ(again->all().at(3).name, "Zürich \"home\"");
  EXPECT_TRUE(again->all().at(2).name.empty());
  again->set(3, {});
  EXPECT_EQ(again->all().at(3).name, "Zürich \"home\"") << "another view under the same name";
  again->remove(3);
  EXPECT_FALSE(again->at(3));
}

// Files of earlier versions have cameras under numbers.
TEST(Bookmarks, TheFileKeepsItsForm) {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "bookmarks.json";
  std::ofstream(file) << R"({"bookmarks": {"2": "46,7,1000,0,-90,40"}})";
  auto bookmarks = Bookmarks::load(file);
  ASSERT_TRUE(bookmarks);
  bookmarks->rename(2, "Alps");
  ASSERT_TRUE(bookmarks->save(file));
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json["bookmarks"]["2"], "46,7,1000,0,-90,40");
  EXPECT_EQ(json["names"]["2"], "Alps");
}

TEST(Bookmarks, WhereNothingCanBeWrittenItSaysSo) {
  const test::ScratchFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const Status saved = Bookmarks().save(folder.path() / "file" / "bookmarks.json");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("file"), std::string::npos);
}

}  // namespace
}  // namespace terrella
