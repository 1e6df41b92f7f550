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
  std::set<char32_t> characters;
  std::set<std::pair<int, unsigned>> keys;
  for (const Action& action : Viewer::actions()) {
    for (const char32_t character : action.characters) EXPECT_TRUE(characters.insert(character).second) << action.what;
    for (const int key : {action.key, action.other_key}) {
      EXPECT_TRUE(key == 0 || keys.insert({key, action.flags & Action::shifted}).second) << key;
    }
  }
  EXPECT_GT(characters.size() + keys.size(), 30U);
}

TEST(Actions, LettersAreInLowerCase) {
  for (const Action& action : Viewer::actions()) {
    for (const char32_t character : action.characters) EXPECT_FALSE(character >= 'A' && character <= 'Z');
  }
}

// Input takes the first row that fits.
TEST(Actions, ARowWithShiftStandsBeforeTheRowWithout) {
  std::set<int> plain;
  for (const Action& action : Viewer::actions()) {
    if (action.key == 0) continue;
    const bool shifted = (action.flags & Action::shifted) != 0;
    EXPECT_FALSE(shifted && plain.contains(action.key)) << action.key;
    if (!shifted) plain.insert(action.key);
  }
}

TEST(Actions, EachRowOfTheListHasATextAndEachButtonATip) {
  for (const Action& action : Viewer::actions()) {
    EXPECT_EQ(action.keys == nullptr, action.what == nullptr);
    EXPECT_TRUE(action.keys != nullptr || action.run != nullptr);
    EXPECT_TRUE(action.button == nullptr || (action.keys != nullptr && action.run != nullptr));
  }
}

// The user's page names every letter key of the program.
TEST(Actions, TheUsersPageNamesEachLetter) {
  std::ifstream file(TERRELLA_USER_PAGE);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string table = page.substr(page.find("| input |"), page.find("| Esc |") - page.find("| input |"));
  std::set<char> named;
  for (std::size_t at = table.find("\n| "); at != table.npos; at = table.find("\n| ", at + 1)) {
    const std::string keys = table.substr(at + 3, table.find(" |", at + 3) - at - 3);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const bool alone = (i == 0 || keys[i - 1] == ' ') && (i + 1 == keys.size() || keys[i + 1] == ',');
      if (alone) named.insert(keys[i]);
    }
  }
  for (const Action& action : Viewer::actions()) {
    for (const char32_t character : action.characters) {
      if (character < 'a' || character > 'z') continue;
      EXPECT_TRUE(named.contains(char(character - 'a' + 'A'))) << action.what;
    }
  }
}

}  // namespace
}  // namespace terrella
