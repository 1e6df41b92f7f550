#include "apps/viewer/parts/bookmark_views.h"

#include <fmt/format.h>

#include <utility>

#include "apps/viewer/input.h"

namespace terrella {

// Reads the file each time, because another window may have set a bookmark. A damaged file is left unchanged.
bool BookmarkViews::load() {
  const auto file = bookmarks_file(context_.globe.options().body.name);
  if (!file) return true;
  Result<Bookmarks> kept = Bookmarks::load(*file);
  if (!kept) {
    say(kept.error());
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

std::vector<Camera> BookmarkViews::views() {
  std::vector<Camera> views;
  if (!load()) return views;
  views.reserve(bookmarks_.all().size());
  for (const auto& [number, bookmark] : bookmarks_.all()) views.push_back(bookmark.camera);
  return views;
}

void BookmarkViews::save(int number) {
  if (!load()) return;
  bookmarks_.set(number, context_.navigator.camera(), place_shown_());
  keep(fmt::format("Bookmark {} saved", number));
}

void BookmarkViews::save_as_next() {
  if (!load()) return;
  const auto number = bookmarks_.free_number();
  if (!number) return say(fmt::format("All {} bookmarks are in use. Press K and delete one.", Bookmarks::kMost));
  save(*number);
}

void BookmarkViews::keep(const std::string& done) const {
  const auto file = bookmarks_file(context_.globe.options().body.name);
  const Status saved =
      file ? bookmarks_.save(*file) : Status(Error{"Bookmarks last until the window closes, because HOME is not set"});
  saved ? say(done) : say(saved.error());
  changed_();
}

void BookmarkViews::draw_open(float foot) {
  const bool just_opened = take_just_opened();
  const BookmarkWish wish =
      draw_bookmarks(panel(), bookmarks_, edit_, context_.ui.units(), removed_.has_value(), foot, just_opened);
  if (wish.ask == BookmarkAsk::fly_to) return fly_to(wish.number);
  if (wish.ask == BookmarkAsk::save) return save_as_next();
  if (wish.ask != BookmarkAsk::none && load()) change(wish);
}

void BookmarkViews::change(const BookmarkWish& wish) {
  const auto found = bookmarks_.all().find(wish.number);
  if (wish.ask == BookmarkAsk::restore && removed_) {
    const auto [number, bookmark] = *std::exchange(removed_, {});
    const int free = bookmarks_.at(number) ? bookmarks_.free_number().value_or(number) : number;
    bookmarks_.set(free, bookmark.camera, bookmark.place);
    bookmarks_.rename(free, bookmark.name);
    return keep(fmt::format("Bookmark {} restored", free));
  }
  if (found == bookmarks_.all().end()) return;  // another window has removed it
  if (wish.ask == BookmarkAsk::raise) return move(wish.number, -1);
  if (wish.ask == BookmarkAsk::lower) return move(wish.number, 1);
  if (wish.ask == BookmarkAsk::rename) {
    bookmarks_.rename(wish.number, wish.name);
    return keep(fmt::format("Bookmark {} renamed", wish.number));
  }
  removed_ = *found;
  edit_ = {};
  bookmarks_.remove(wish.number);
  keep(fmt::format("Bookmark {} deleted", wish.number));
}

void BookmarkViews::move(int number, int by) {
  const int other = number + by;
  if (other < 1 || other > Bookmarks::kMost) return;
  bookmarks_.exchange(number, other);
  edit_.number = other;
  keep(fmt::format("Bookmark {} is now bookmark {}", number, other));
}

}  // namespace terrella
