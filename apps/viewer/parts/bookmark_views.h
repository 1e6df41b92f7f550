#pragma once

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/bookmarks.h"

namespace terrella {

/// Saves views under numbers and flies to them. Owns the bookmarks. thread: main
class BookmarkViews : public Part {
 public:
  explicit BookmarkViews(const ViewerContext& context) : Part(context) {}

  // `number` in [1, Bookmarks::kMost].
  void fly_to(int number);
  void save(int number);

 private:
  [[nodiscard]] bool load();

  Bookmarks bookmarks_;
};

}  // namespace terrella
