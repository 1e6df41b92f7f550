#pragma once

#include <string>
#include <vector>

#include "apps/viewer/panels/ui.h"
#include "view/number_look.h"

namespace terrella {

/// A colour in a legend, and the values that have it.
struct LegendClass {
  Rgba8 color;
  std::string text;
};

/// The entry of one layer in a legend: a bar of numbers, or classes.
struct LegendItem {
  std::string title;  ///< quantity or name of the layer
  std::string unit;   ///< empty: unknown
  NumberLook look;
  std::vector<LegendClass> classes = {};  ///< drawn in place of the bar if there are any
};

/// Round values within [low, high], 1, 2 or 5 times a power of ten apart, at most `most` of them; none if low is not
/// less than high. thread: any
[[nodiscard]] std::vector<double> legend_ticks(double low, double high, int most);

/// Writes a value with the decimals that `step` needs: "-0.5", "1000", "2e+07". thread: any
[[nodiscard]] std::string tick_text(double value, double step);

/// Height of the window in its units, within a frame. thread: main
[[nodiscard]] double window_height();

/// The rectangle of draw_legend(). thread: main
[[nodiscard]] UiBox legend_box(const std::vector<LegendItem>& items, double left, double bottom);

/// Leaves out the last items, which have no room between the upper edge and `bottom`. thread: main
[[nodiscard]] std::vector<LegendItem> legend_with_room(std::vector<LegendItem> items, double left, double bottom);

/// Draws a colour bar with ticks or the classes of each item, the first one highest, with the lower left corner at a
/// place in units of the window. Between the begin and the end of a frame of Dear ImGui. thread: main
void draw_legend(const std::vector<LegendItem>& items, double left, double bottom);

}  // namespace terrella
