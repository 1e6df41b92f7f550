#include "apps/viewer/parts/bookmark_views.h"

#include <fmt/format.h>

#include <utility>

#include "apps/viewer/input.h"

namespace terrella {

// Reads the file each time, because another window may have set a bookmark. A damaged file is left unchanged.
bool BookmarkViews::load() {
  const auto file = bookmarks_file();
  if (!file) return true;
  Result<Bookmarks> kept = Bookmarks::load(*file);
  if (!kept) {
    say(kept.error().message);
    return false;
  }
  bookmarks_ = *std::move(kept);
  return true;
}

void BookmarkViews::fly_to(int number) {
  if (!load()) return;
  if (const auto& there = bookmarks_.at(number)) return context_.navigator.fly_to(*there, Input::now());
  say(fmt::format("Bookmark {0} is empty; Ctrl + {0} saves the view", number));
}

void BookmarkViews::save(int number) {
  if (!load()) return;
  bookmarks_.set(number, context_.navigator.camera());
  const auto file = bookmarks_file();
  const Status saved = file ? bookmarks_.save(*file) : Status(Error{"Kept until the window closes: HOME is not set"});
  say(saved ? fmt::format("Bookmark {} saved", number) : saved.error().message);
}

}  // namespace terrella
