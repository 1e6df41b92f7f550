#include "apps/viewer/action.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "apps/viewer/viewer.h"

namespace terrella {
namespace {

TEST(Actions, EachKeyHasOneAction) {
  std::set<std::pair<char32_t, unsigned>> characters;
  std::set<std::pair<int, unsigned>> keys;
  for (const Action& action : Viewer::actions()) {
    for (const char32_t character : action.characters)
      EXPECT_TRUE(characters.insert({character, action.flags & (Action::ctrl | Action::shifted)}).second)
          << action.what;
    for (const int key : {action.key, action.other_key}) {
      EXPECT_TRUE(key == 0 || keys.insert({key, action.flags & Action::kModifiers}).second) << key;
    }
  }
  EXPECT_GT(characters.size() + keys.size(), 30U);
}

TEST(Actions, LettersAreInLowerCase) {
  for (const Action& action : Viewer::actions()) {
    for (const char32_t character : action.characters) EXPECT_FALSE(character >= 'A' && character <= 'Z');
  }
}

TEST(Actions, EachRowOfTheListHasATextAndEachButtonATip) {
  for (const Action& action : Viewer::actions()) {
    EXPECT_EQ(action.keys == nullptr, action.what == nullptr);
    EXPECT_TRUE(action.keys != nullptr || action.run != nullptr);
    EXPECT_TRUE(action.button == nullptr || (action.keys != nullptr && action.run != nullptr));
  }
}

TEST(Actions, EachHasAWayByMouseAndATextInTheMenu) {
  for (const Action& action : Viewer::actions()) {
    if (action.keys == nullptr) continue;
    EXPECT_STRNE(mouse_way(action), "") << action.what;
    EXPECT_FALSE(menu_text(action).empty());
  }
}

/// A row of the user's page.
std::string row_of(const Action& action) {
  return "| " + std::string(action.what) + " | " + action.keys + " | " + mouse_way(action) + " |\n";
}

// The user's page lists the actions as the program does. The failure prints the table for the page.
TEST(Actions, TheUsersPageListsThemAll) {
  std::string table;
  for (const Action& action : Viewer::actions()) {
    if (action.keys != nullptr) table += row_of(action);
  }
  std::ifstream file(TERRELLA_USER_PAGE);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(page.find("| action | keyboard | mouse |\n|---|---|---|\n" + table + "\n"), page.npos) << table;
}

}  // namespace
}  // namespace terrella
