#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/panels/bookmark_panel.h"
#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/bookmarks.h"

namespace terrella {

/// Saves views under numbers and names, and flies to them. Owns the bookmarks and their panel. thread: main
class BookmarkViews : public Panel {
 public:
  /// `place_shown`: name of the place in the middle of the view; empty if none is known. `changed` is called after each
  /// change.
  BookmarkViews(const ViewerContext& context, std::function<std::string()> place_shown, std::function<void()> changed)
      : Panel(context, "Bookmarks"), place_shown_(std::move(place_shown)), changed_(std::move(changed)) {}

  // `number` in [1, Bookmarks::kMost].
  void fly_to(int number);
  void save(int number);
  [[nodiscard]] std::vector<Camera> views();  ///< all views, in the order of their numbers
  void save_as_next();                        ///< saves the view under the lowest free number

 private:
  bool can_open() override { return load(); }
  void toggled() override { edit_ = {}; }
  void draw_open(float foot) override;
  [[nodiscard]] bool load();
  void change(const BookmarkWish& wish);
  void move(int number, int by);
  /// Writes the file and tells how it went.
  void keep(const std::string& done) const;

  std::function<std::string()> place_shown_;
  std::function<void()> changed_;
  Bookmarks bookmarks_;
  BookmarkEdit edit_;
  std::optional<std::pair<int, Bookmark>> removed_;  ///< by the last removal
};

}  // namespace terrella
