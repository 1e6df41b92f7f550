#include "streaming/cut/input/mosaic_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

namespace terrella {
namespace {

/// Largest distance of a part from the pixels of the first part, pixels: the error of coordinates with six decimals.
constexpr double kGridAlignment_px = 0.01;

/// Position of a part, in columns and rows of parts or of pixels.
struct Cell {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

std::string named(const MosaicPart& part, std::size_t index) {
  return fmt::format("{} (picture {})", part.path.string(), index + 1);
}

/// Computes sizes. Heights within a row must agree, and so must the widths of rows.
Result<MosaicLayout> measured(MosaicLayout layout, const std::vector<MosaicPart>& parts) {
  for (MosaicRow& row : layout.rows) {
    row.height_px = parts[row.parts.front()].height_px;
    std::int64_t width = 0;
    for (const std::size_t index : row.parts) {
      const MosaicPart& part = parts[index];
      if (part.height_px != row.height_px) {
        return Error{fmt::format(
            "{}: is {} pixels high, and {} beside it {}; parts of a mosaic that lie side by side "
            "have one height",
            named(part, index), part.height_px, named(parts[row.parts.front()], row.parts.front()), row.height_px)};
      }
      width += part.width_px;
    }
    if (layout.width_px == 0) layout.width_px = width;
    if (width != layout.width_px) {
      return Error{fmt::format("{}: its row of the mosaic is {} pixels wide, the first row {}; resample it",
                               named(parts[row.parts.front()], row.parts.front()), width, layout.width_px)};
    }
    layout.height_px += row.height_px;
  }
  return layout;
}

Result<MosaicLayout> by_order(const std::vector<MosaicPart>& parts, const MosaicGrid& grid) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto rows = static_cast<std::size_t>(grid.rows);
  if (grid.columns < 1 || grid.rows < 1 || parts.size() != columns * rows) {
    return Error{fmt::format("a mosaic of {}x{} takes {} pictures, not {}", grid.columns, grid.rows, columns * rows,
                             parts.size())};
  }
  MosaicLayout layout;
  layout.rows.resize(rows);
  for (std::size_t i = 0; i < parts.size(); ++i) layout.rows[i / columns].parts.push_back(i);
  return measured(std::move(layout), parts);
}

// ---- NASA's names

std::optional<Cell> cell_by_name(const std::filesystem::path& path) {
  static const std::regex kCell("(^|[^A-Za-z0-9])([A-D])([12])([^A-Za-z0-9]|$)");
  const std::string stem = path.stem().string();
  std::smatch found;
  if (!std::regex_search(stem, found, kCell)) return {};
  return Cell{.x = found[2].str()[0] - 'A', .y = found[3].str()[0] - '1'};
}

std::string cell_name(std::int64_t x, std::int64_t y) { return fmt::format("{}{}", "ABCD"[x], y + 1); }

Result<MosaicLayout> by_names(const std::vector<MosaicPart>& parts, const std::vector<Cell>& cells) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> at;  // keyed by row, then column
  Cell first = cells.front();
  Cell last = cells.front();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [other, is_new] = at.emplace(std::pair(cells[i].y, cells[i].x), i);
    if (!is_new) {
      return Error{fmt::format("{}: is called {} as {} is", named(parts[i], i), cell_name(cells[i].x, cells[i].y),
                               named(parts[other->second], other->second))};
    }
    first = {std::min(first.x, cells[i].x), std::min(first.y, cells[i].y)};
    last = {std::max(last.x, cells[i].x), std::max(last.y, cells[i].y)};
  }
  MosaicLayout layout;
  for (std::int64_t y = first.y; y <= last.y; ++y) {
    layout.rows.emplace_back();
    for (std::int64_t x = first.x; x <= last.x; ++x) {
      const auto found = at.find({y, x});
      if (found == at.end()) {
        return Error{fmt::format("the mosaic lacks its part {}; name it too, or cut rows or columns that are whole",
                                 cell_name(x, y))};
      }
      layout.rows.back().parts.push_back(found->second);
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].width_px == parts[0].width_px && parts[i].height_px == parts[0].width_px) continue;
    return Error{fmt::format("{}: is {}x{} pixels; parts of 90 by 90 degrees are square and of one size, here {}",
                             named(parts[i], i), parts[i].width_px, parts[i].height_px, parts[0].width_px)};
  }
  constexpr double kSide_deg = 90.0;
  const double pixel_deg = kSide_deg / static_cast<double>(parts[0].width_px);
  if (parts.size() < 8) {
    layout.place = Placement{.west_deg = -180.0 + kSide_deg * static_cast<double>(first.x),
                             .north_deg = 90.0 - kSide_deg * static_cast<double>(first.y),
                             .pixel_width_deg = pixel_deg,
                             .pixel_height_deg = pixel_deg};
  }
  return measured(std::move(layout), parts);
}

// ---- places

/// Corner of a part in pixels, relative to the first part's corner.
Result<Cell> pixel_of(const std::vector<MosaicPart>& parts, std::size_t index) {
  const Placement& origin = *parts[0].place;
  const Placement& place = *parts[index].place;
  const auto off = [](double a, double b, std::int64_t pixels) {
    return std::abs(a / b - 1.0) * static_cast<double>(pixels);
  };
  if (off(place.pixel_width_deg, origin.pixel_width_deg, parts[index].width_px) > kGridAlignment_px ||
      off(place.pixel_height_deg, origin.pixel_height_deg, parts[index].height_px) > kGridAlignment_px) {
    return Error{fmt::format("{}: its pixels are {:.9g}x{:.9g} degrees, those of {} {:.9g}x{:.9g}; resample it",
                             named(parts[index], index), place.pixel_width_deg, place.pixel_height_deg,
                             named(parts[0], 0), origin.pixel_width_deg, origin.pixel_height_deg)};
  }
  const double x = (place.west_deg - origin.west_deg) / origin.pixel_width_deg;
  const double y = (origin.north_deg - place.north_deg) / origin.pixel_height_deg;
  if (std::abs(x - std::round(x)) > kGridAlignment_px || std::abs(y - std::round(y)) > kGridAlignment_px) {
    return Error{fmt::format("{}: lies {:.3f} and {:.3f} pixels off the pixels of {}; resample it",
                             named(parts[index], index), x - std::round(x), y - std::round(y), named(parts[0], 0))};
  }
  return Cell{.x = std::llround(x), .y = std::llround(y)};
}

/// Checks that the parts of each row touch, and that each row touches the previous one.
Status check_touching(const std::vector<MosaicPart>& parts, const std::vector<Cell>& corners,
                      const MosaicLayout& layout) {
  const Cell first = corners[layout.rows.front().parts.front()];
  std::int64_t y = first.y;
  for (const MosaicRow& row : layout.rows) {
    std::int64_t x = first.x;
    for (const std::size_t index : row.parts) {
      const std::int64_t gap_x = corners[index].x - x;
      const std::int64_t gap_y = corners[index].y - y;
      if (gap_x != 0 || gap_y != 0) {
        return Error{
            fmt::format("{}: lies {} pixels east and {} south of where the mosaic goes on; parts must touch and "
                        "not overlap",
                        named(parts[index], index), gap_x, gap_y)};
      }
      x += parts[index].width_px;
    }
    y += parts[row.parts.front()].height_px;
  }
  return Done{};
}

Result<MosaicLayout> by_places(const std::vector<MosaicPart>& parts) {
  std::vector<Cell> corners;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].place) {
      return Error{
          fmt::format("{}: where in the mosaic it lies is neither said by its name (A1 to D2) nor by GeoTIFF "
                      "tags or a world file; give ‹mosaic› COLSxROWS, the pictures in rows from the north-west",
                      named(parts[i], i))};
    }
    const auto corner = pixel_of(parts, i);
    if (!corner) return corner.error();
    corners.push_back(*corner);
  }
  std::map<std::int64_t, std::vector<std::size_t>> by_row;
  for (std::size_t i = 0; i < parts.size(); ++i) by_row[corners[i].y].push_back(i);
  MosaicLayout layout;
  for (auto& [y, row] : by_row) {
    std::ranges::sort(row, {}, [&](std::size_t i) { return corners[i].x; });
    layout.rows.push_back({.height_px = 0, .parts = row});
  }
  if (Status touching = check_touching(parts, corners, layout); !touching) return touching.error();
  auto done = measured(std::move(layout), parts);
  if (!done) return done;
  return done;
}

// ---- places stated by parts

/// Corner of the mosaic by the places stated by its parts; none if no part states a place. All statements must agree.
Result<std::optional<Placement>> said_origin(const std::vector<MosaicPart>& parts, const MosaicLayout& layout) {
  std::optional<Placement> origin;
  std::int64_t y = 0;
  for (const MosaicRow& row : layout.rows) {
    std::int64_t x = 0;
    for (const std::size_t index : row.parts) {
      if (const auto& place = parts[index].place) {
        Placement said = *place;
        said.west_deg -= static_cast<double>(x) * said.pixel_width_deg;
        said.north_deg += static_cast<double>(y) * said.pixel_height_deg;
        if (!origin) origin = said;
        const double slack = kGridAlignment_px * origin->pixel_width_deg;
        const double west_off = std::remainder(said.west_deg - origin->west_deg, 360.0);
        if (std::abs(west_off) > slack || std::abs(said.north_deg - origin->north_deg) > slack) {
          return Error{
              fmt::format("{}: says that it lies {:.6g} degrees east and {:.6g} north of its place in the "
                          "mosaic; leave out ‹mosaic›, or say where the whole lies with ‹bounds›",
                          named(parts[index], index), west_off, said.north_deg - origin->north_deg)};
        }
      }
      x += parts[index].width_px;
    }
    y += row.height_px;
  }
  return origin;
}

/// Sets the place stated by the parts. It must agree with the place from names.
Result<MosaicLayout> with_said_place(MosaicLayout layout, const std::vector<MosaicPart>& parts) {
  const auto origin = said_origin(parts, layout);
  if (!origin) return origin.error();
  if (!*origin) return layout;
  const Placement by_name = layout.place.value_or(**origin);
  const double slack = kGridAlignment_px * (*origin)->pixel_width_deg;
  if (std::abs(std::remainder(by_name.west_deg - (*origin)->west_deg, 360.0)) > slack ||
      std::abs(by_name.north_deg - (*origin)->north_deg) > slack) {
    return Error{fmt::format(
        "{}: its name puts the mosaic's corner at {:.9g}, {:.9g} degrees, and its georeference at "
        "{:.9g}, {:.9g}; rename the parts, or say where they lie with ‹mosaic› and ‹bounds›",
        named(parts.front(), 0), by_name.west_deg, by_name.north_deg, (*origin)->west_deg, (*origin)->north_deg)};
  }
  layout.place = **origin;
  return layout;
}

}  // namespace

Result<MosaicLayout> lay_out(const std::vector<MosaicPart>& parts, const std::optional<MosaicGrid>& grid) {
  std::vector<Cell> cells;
  for (const MosaicPart& part : parts) {
    if (const auto cell = cell_by_name(part.path)) cells.push_back(*cell);
  }
  auto layout = grid                           ? by_order(parts, *grid)
                : cells.size() == parts.size() ? by_names(parts, cells)
                                               : by_places(parts);
  return layout ? with_said_place(*std::move(layout), parts) : layout;
}

}  // namespace terrella
