#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/viewer/catalogue/catalogue.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// Lists public sources by body and theme, to add one as a layer. Owns the panel. Asks no server. thread: main
class CataloguePanel : public Panel {
 public:
  /// `add` is called with the chosen entry. `offline`: the panel says that only caches are read.
  CataloguePanel(const ViewerContext& context, bool offline, std::function<void(const CatalogueEntry&)> add);

  void take_keyboard() override;

 private:
  void toggled() override;
  void draw_open(float foot) override;
  void draw_filter(bool just_opened);
  void draw_entries(float height);
  /// Draws an entry in two lines. True if it was clicked.
  [[nodiscard]] bool draw_entry(const CatalogueEntry& entry, bool marked) const;
  void find();

  bool offline_;
  std::function<void(const CatalogueEntry&)> add_;
  Catalogue catalogue_;             ///< the globe's body first; read when the panel opens
  std::vector<std::size_t> found_;  ///< entries that have the text of the filter
  std::string filter_;
  std::size_t marked_ = 0;  ///< in `found_`
  bool reveal_ = false;     ///< scrolls to the marked entry
  bool entered_ = false;
  const CatalogueEntry* chosen_ = nullptr;
};

}  // namespace terrella
