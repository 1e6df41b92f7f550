#include "apps/viewer/panels/legend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/viewer/panels/number_panel.h"
#include "apps/viewer/tools/value_query.h"

namespace terrella {
namespace {

TEST(LegendTicks, AreRoundAndInside) {
  EXPECT_EQ(legend_ticks(-1.8, 28.9, 6), (std::vector<double>{0, 5, 10, 15, 20, 25}));
  EXPECT_EQ(legend_ticks(0.0, 1.0, 6), (std::vector<double>{0.0, 0.2, 0.4, 0.2 * 3, 0.8, 1.0}));
  EXPECT_EQ(legend_ticks(1000.0, 3520.0, 6), (std::vector<double>{1000, 1500, 2000, 2500, 3000, 3500}));
  for (const double size : {1e-9, 0.03, 7.0, 123456.0, 4e12}) {
    const auto ticks = legend_ticks(-size, 1.7 * size, 6);
    EXPECT_GE(ticks.size(), 2U) << size;
    EXPECT_LE(ticks.size(), 6U) << size;
    EXPECT_GE(ticks.front(), -size);
    EXPECT_LE(ticks.back(), 1.7 * size);
  }
  EXPECT_TRUE(legend_ticks(1.0, 1.0, 6).empty());
  EXPECT_TRUE(legend_ticks(0.0, INFINITY, 6).empty());
}

TEST(TickText, HasTheDecimalsOfTheStep) {
  EXPECT_EQ(tick_text(0.2 * 3, 0.2), "0.6");
  EXPECT_EQ(tick_text(-10.0, 10.0), "-10");
  EXPECT_EQ(tick_text(-0.0, 0.5), "0");
  EXPECT_EQ(tick_text(0.0025, 0.0005), "0.0025");
  EXPECT_EQ(tick_text(2e7, 1e7), "2e+07");
}

TEST(ValueText, HasAllDigitsAndTheUnit) {
  EXPECT_EQ(value_text(static_cast<double>(28.123F), "°C"), "28.123 °C");
  EXPECT_EQ(value_text(28123 * 0.001, "K"), "28.123 K");
  EXPECT_EQ(value_text(65535.0, ""), "65535");
  EXPECT_EQ(value_text(-1234.56789012, ""), "-1234.56789012");
}

TEST(Stretch, KeepsItsEndsApartWhenOneIsDragged) {
  NumberLook look;
  look.low = 0.0;
  look.high = 10.0;
  EXPECT_EQ(dragged(look, true, 20.0).high, 20.0);
  EXPECT_EQ(dragged(look, false, -5.0).low, -5.0);
  EXPECT_GT(dragged(look, true, -3.0).high, 0.0);
  EXPECT_LT(dragged(look, false, 30.0).low, 10.0);
}

}  // namespace
}  // namespace terrella
