#pragma once

#include <array>
#include <string>

#include "apps/viewer/panels/readout.h"
#include "apps/viewer/tools/bookmarks.h"

namespace terrella {

enum class BookmarkAsk { none, save, fly_to, rename, raise, lower, remove, restore };
/// User's request in the panel of bookmarks.
struct BookmarkWish {
  BookmarkAsk ask = BookmarkAsk::none;
  int number = 0;
  std::string name = {};  ///< for `rename`
};

/// The row that the user edits.
struct BookmarkEdit {
  int number = 0;  ///< 0: none
  std::array<char, 100> name{};
  bool just_opened = false;
};

/// Name of a bookmark; without one that of its place, or else its coordinates and height.
[[nodiscard]] std::string shown_name(const Bookmark& bookmark, LengthUnits units);

/// Draws the panel at the left edge, between Ui::begin_frame() and Ui::end_frame(). `foot` units at the lower edge stay
/// free. `just_opened` gives the panel the keyboard; `removed` offers to take back a removal. thread: main
[[nodiscard]] BookmarkWish draw_bookmarks(const char* title, const Bookmarks& bookmarks, BookmarkEdit& edit,
                                          LengthUnits units, bool removed, float foot, bool just_opened);

}  // namespace terrella
