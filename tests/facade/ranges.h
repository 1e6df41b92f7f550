#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"
#include "tiles/tile_grid.h"

namespace terrella::test {

inline constexpr double kNoNumberAtAll = std::numeric_limits<double>::quiet_NaN(),
                        kInfinite = std::numeric_limits<double>::infinity();
inline const TileGrid kRangeGrid{.tile_px = 16, .max_level = 1};
inline const Geodetic kRangePlace{.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 0.0};

inline std::string message_in(const Status& status) { return status ? "no error" : status.error().message; }

/// A value that a header names, with values at the ends of its range and beyond them.
template <class Target>
struct Row {
  const char* name;
  std::vector<double> good, bad;
  std::function<void(Target&, double)> set;
};

/// Tries each value of each row in a copy of `whole`.
template <class Target>
void expect_ranges(const Target& whole, const std::vector<Row<Target>>& rows, const char* call,
                   const std::function<Status(const Target&)>& attempt) {
  for (const Row<Target>& row : rows) {
    for (const double value : row.good) {
      Target target = whole;
      row.set(target, value);
      EXPECT_EQ(message_in(attempt(target)), "no error") << row.name << " = " << value;
    }
    for (const double value : row.bad) {
      Target target = whole;
      row.set(target, value);
      EXPECT_EQ(message_in(attempt(target)).rfind(call, 0), 0U)
          << row.name << " = " << value << ": " << message_in(attempt(target));
    }
  }
}

/// Rows for the parts of a place.
template <class Target>
std::vector<Row<Target>> place_rows(std::function<Geodetic&(Target&)> place) {
  return {{"lat",
           {-90.0, 90.0},
           {-90.1, 200.0, kNoNumberAtAll, kInfinite},
           [=](Target& t, double v) { place(t).lat = Angle::degrees(v); }},
          {"lon",
           {-180.0, 900.0},
           {kNoNumberAtAll, -kInfinite},
           [=](Target& t, double v) { place(t).lon = Angle::degrees(v); }},
          {"height_m", {-1e12, 1e12}, {-1.1e12, 1.1e12, kNoNumberAtAll, kInfinite}, [=](Target& t, double v) {
             place(t).height_m = v;
           }}};
}

}  // namespace terrella::test
