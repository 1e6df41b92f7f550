#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/feature_list/feature_table.h"

namespace terrella {

/// Order of a list, as the user chose it.
struct ListSort {
  bool by_field = false;  ///< by the chosen field; else by name
  bool descending = false;
  bool operator==(const ListSort&) const = default;
};

/// Contents of the panel of a list.
struct ListContents {
  const std::string& layer;
  const FeatureTable* table = nullptr;  ///< null while the features are being read
  const std::string& field;             ///< the chosen field; empty: none
  const FieldColumn* column = nullptr;  ///< its values; null while they are being read
  const std::vector<std::uint32_t>& found;
  std::optional<std::uint32_t> selected = {};  ///< row of the table
  bool reveal = false;                         ///< scrolls to the selected row
  bool takes_keyboard = false;                 ///< gives the filter the keyboard
};

/// Requests of the user in the panel of a list.
struct ListWish {
  bool filtered = false;                      ///< the text of the filter has changed
  bool typing = false;                        ///< the filter has the keyboard
  int step = 0;                               ///< rows down that an arrow key asks for
  bool entered = false;                       ///< Enter was pressed in the filter
  std::optional<std::uint32_t> clicked = {};  ///< row of the table
  std::optional<std::string> field = {};      ///< another field; empty: none
  std::optional<ListSort> sort = {};          ///< the order that the table's head shows
};

/// Draws the panel with filter, count and table. Only rows in view cost time. `foot` units at the lower edge stay free.
/// thread: main
[[nodiscard]] ListWish draw_feature_list(const char* title, const ListContents& contents, std::string& filter,
                                         float foot);

}  // namespace terrella
