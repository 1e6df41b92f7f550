// Areas are cut in the plane of longitude and latitude, where ±180° and the poles are ordinary edges. A grid cuts them:
// blocks of cells are halved again and again. GLU's tessellator fills the part that remains in each cell.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geo/great_circle.h"
#include "objects/area/area_rings.h"
#include "objects/area/area_tessellator.h"
#include "objects/object_shapes.h"

namespace terrella {
namespace {

constexpr double kWidestCell_deg = 1.0;
constexpr double kNarrowestCell_deg = 0.05;
constexpr double kCellsAcross = 64.0;
/// Cells with more points are divided: for rings that cross themselves GLU may need the square of this number.
constexpr std::size_t kMostCellPoints = 64;
/// Cells with more points are divided even if each cut meets most edges.
constexpr std::size_t kMostUndivided = 512;
constexpr int kMostDivisions = 40;
constexpr double kMostArcPieces = 4.0e6;
/// Steps that an area may take for each of its points and each cell that an edge passes, and steps of a crossing.
constexpr std::size_t kStepsOfAPoint = 48, kStepsOfACrossing = 64;

struct Block {
  int west, east, south, north;  ///< grid lines
};

class AreaFiller {
 public:
  AreaFiller(const Ellipsoid& ellipsoid, int cells_of_half_turn, double height_m, std::size_t most_triangles)
      : ellipsoid_(ellipsoid),
        cells_of_half_turn_(cells_of_half_turn),
        height_m_(height_m),
        most_indices_(3 * most_triangles) {}

  void fill(const MapRings& rings, std::size_t most_steps) {
    most_steps_ = most_steps;
    const MapRect box = bounds_of(rings);
    const auto line = [this](double deg, double from_deg) { return (deg - from_deg) * cells_of_half_turn_ / 180.0; };
    const Block block{static_cast<int>(std::floor(line(box.west_deg, -180.0))),
                      static_cast<int>(std::ceil(line(box.east_deg, -180.0))),
                      static_cast<int>(std::floor(line(box.south_deg, -90.0))),
                      static_cast<int>(std::ceil(line(box.north_deg, -90.0)))};
    if (block.west < block.east && block.south < block.north) fill_block(rings, block);
  }

  [[nodiscard]] FillMesh take() {
    if (mesh_.fault != FillFault::none) return {.fault = mesh_.fault, .steps = mesh_.steps};
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] double lon_at(int line) const { return line * 180.0 / cells_of_half_turn_ - 180.0; }
  [[nodiscard]] double lat_at(int line) const { return line * 180.0 / cells_of_half_turn_ - 90.0; }
  [[nodiscard]] MapRect rect_of(const Block& b) const {
    return {lon_at(b.west), lat_at(b.south), lon_at(b.east), lat_at(b.north)};
  }

  /// Counts steps. False once the area is given up.
  bool may_go_on(std::size_t steps) {
    mesh_.steps += steps;
    if (mesh_.fault == FillFault::none && mesh_.steps > most_steps_) mesh_.fault = FillFault::tangled;
    return mesh_.fault == FillFault::none;
  }

  void fill_block(MapRings rings, const Block& block) {
    if (!may_go_on(points_of(rings))) return;
    const MapRect rect = rect_of(block);
    bool full = false;
    MapRings all = without_whole_turns(std::move(rings), rect, full);
    if (all.empty()) return full ? add_block(block) : void();
    if (full) all.push_back(ring_of(rect));
    const int wide = block.east - block.west, high = block.north - block.south;
    if (wide == 1 && high == 1) return fill_cell(all, rect, 0);
    const bool along_lon = wide >= high;
    Block low = block, upper = block;
    if (along_lon) {
      low.east = upper.west = block.west + wide / 2;
    } else {
      low.north = upper.south = block.south + high / 2;
    }
    const auto axis = along_lon ? &MapPoint::lon_deg : &MapPoint::lat_deg;
    const double at = along_lon ? lon_at(low.east) : lat_at(low.north);
    auto [below, above] = divided(std::move(all), axis, at);
    fill_block(std::move(below), low);
    fill_block(std::move(above), upper);
  }

  void fill_cell(MapRings rings, const MapRect& rect, int division) {
    if (!may_go_on(points_of(rings))) return;
    if (points_of(rings) <= kMostCellPoints) return tessellate(rings);
    bool full = false;
    MapRings all = without_pairs(without_whole_turns(std::move(rings), rect, full));
    if (full) all.push_back(ring_of(rect));
    if (points_of(all) <= kMostCellPoints) return tessellate(all);
    const Cut cut = best_cut(all, rect);
    if (points_of(all) <= kMostUndivided && cut.edges > 0.25 * double(points_of(all))) return tessellate(all);
    if (division < kMostDivisions) return divide_cell(std::move(all), rect, cut.along_lon, division);
    mesh_.fault = FillFault::tangled;
  }

  void tessellate(const MapRings& rings) {
    const std::size_t before = tessellator_.crossings();
    for (const MapPoint& corner : tessellator_.triangles(rings)) mesh_.indices.push_back(add_vertex(corner));
    if (mesh_.indices.size() > most_indices_) mesh_.fault = FillFault::too_many_triangles;
    may_go_on(kStepsOfACrossing * (tessellator_.crossings() - before));
  }

  struct Cut {
    bool along_lon;
    double edges;  ///< number of edges that the cut meets, about
  };

  /// The cut through a cell that meets fewer edges: a cut along a bundle of edges separates them, a cut across makes
  /// twice as many. Edges on the cell's border do not count.
  static Cut best_cut(const MapRings& rings, const MapRect& r) {
    double along_lon = 0.0, along_lat = 0.0;
    for (const MapRing& ring : rings) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const MapPoint &a = ring[k], &b = ring[(k + 1) % ring.size()];
        if (a.lat_deg != b.lat_deg || (a.lat_deg != r.south_deg && a.lat_deg != r.north_deg))
          along_lon += std::abs(b.lon_deg - a.lon_deg);
        if (a.lon_deg != b.lon_deg || (a.lon_deg != r.west_deg && a.lon_deg != r.east_deg))
          along_lat += std::abs(b.lat_deg - a.lat_deg);
      }
    }
    const double by_meridian = along_lon / (r.east_deg - r.west_deg),
                 by_parallel = along_lat / (r.north_deg - r.south_deg);
    return {by_meridian <= by_parallel, std::min(by_meridian, by_parallel)};
  }

  void divide_cell(MapRings rings, const MapRect& rect, bool along_lon, int division) {
    MapRect low = rect, upper = rect;
    if (along_lon) {
      low.east_deg = upper.west_deg = 0.5 * (rect.west_deg + rect.east_deg);
    } else {
      low.north_deg = upper.south_deg = 0.5 * (rect.south_deg + rect.north_deg);
    }
    const auto axis = along_lon ? &MapPoint::lon_deg : &MapPoint::lat_deg;
    const double at = along_lon ? low.east_deg : low.north_deg;
    auto [below, above] = divided(std::move(rings), axis, at);
    fill_cell(std::move(below), low, division + 1);
    fill_cell(std::move(above), upper, division + 1);
  }

  void add_block(const Block& block) {
    const auto wide = static_cast<std::uint32_t>(block.east - block.west);
    const auto first = static_cast<std::uint32_t>(mesh_.positions_m.size());
    for (int j = block.south; j <= block.north; ++j) {
      for (int i = block.west; i <= block.east; ++i) add_vertex({lon_at(i), lat_at(j)});
    }
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(block.north - block.south); ++j) {
      for (std::uint32_t i = 0; i < wide; ++i) {
        const std::uint32_t a = first + j * (wide + 1) + i, d = a + wide + 1;
        mesh_.indices.insert(mesh_.indices.end(), {a, a + 1, d + 1, a, d + 1, d});
      }
    }
    if (mesh_.indices.size() > most_indices_) mesh_.fault = FillFault::too_many_triangles;
  }

  std::uint32_t add_vertex(const MapPoint& p) {
    const EcefDir normal = Ellipsoid::normal(Angle::degrees(p.lat_deg), Angle::degrees(p.lon_deg));
    mesh_.positions_m.push_back(ellipsoid_.position(normal, height_m_).xyz_m);
    return static_cast<std::uint32_t>(mesh_.positions_m.size() - 1);
  }

  const Ellipsoid& ellipsoid_;
  int cells_of_half_turn_;
  double height_m_;
  std::size_t most_indices_;
  std::size_t most_steps_ = 0;
  AreaTessellator tessellator_;
  FillMesh mesh_;
};

std::vector<MapPoint> on_map(const std::vector<Geodetic>& ring) {
  std::vector<MapPoint> positions;
  positions.reserve(ring.size());
  for (const Geodetic& p : ring) positions.push_back({p.lon.deg(), std::clamp(p.lat.deg(), -90.0, 90.0)});
  return positions;
}

/// Returns the rings on the map; none if one is invalid or too long.
std::optional<MapRings> rings_on_map(const PolygonObject& polygon) {
  MapRings rings;
  double arc_pieces = 0.0;
  for (const auto& ring : polygon.rings) {
    if (ring.size() < 3) continue;
    const std::vector<MapPoint> positions = on_map(ring);
    arc_pieces += pieces_of(positions);
    if (!(arc_pieces <= kMostArcPieces)) return std::nullopt;  // also refuses values that are not finite
    auto parts = rings_of(positions);
    if (!parts) return std::nullopt;
    for (MapRing& part : *parts) rings.push_back(std::move(part));
  }
  return rings;
}

/// Number of grid cells per half turn. Even, so that ±180° and the poles are grid lines.
int cells_of_half_turn(const MapRings& rings) {
  double extent = 0.0;
  for (const MapRing& ring : rings) {
    const auto lon = std::ranges::minmax(ring, {}, &MapPoint::lon_deg);
    const auto lat = std::ranges::minmax(ring, {}, &MapPoint::lat_deg);
    extent = std::max({extent, lon.max.lon_deg - lon.min.lon_deg, lat.max.lat_deg - lat.min.lat_deg});
  }
  const double wish = std::clamp(extent / kCellsAcross, kNarrowestCell_deg, kWidestCell_deg);
  return 2 * static_cast<int>(std::ceil(90.0 / wish));
}

/// Number of points, and of cells that edges pass.
std::size_t size_of(const MapRings& rings, double cell_deg) {
  double turned_deg = 0.0;
  for (const MapRing& ring : rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const MapPoint &a = ring[k], &b = ring[(k + 1) % ring.size()];
      turned_deg += std::abs(b.lon_deg - a.lon_deg) + std::abs(b.lat_deg - a.lat_deg);
    }
  }
  return points_of(rings) + static_cast<std::size_t>(turned_deg / cell_deg);
}

}  // namespace

const char* to_text(FillFault fault) {
  switch (fault) {
    case FillFault::none:
      break;
    case FillFault::invalid:
      return "a ring is invalid or too long; repair or simplify it";
    case FillFault::too_many_triangles:
      return "the areas of the layer need too many triangles together; divide the file or simplify the areas";
    case FillFault::tangled:
      return "too many of its edges cross or almost lie on each other; repair it, as ST_MakeValid of PostGIS and \"Fix "
             "geometries\" of QGIS do";
  }
  return "";
}

double mean_height_m(const PolygonObject& polygon) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& ring : polygon.rings) {
    for (const Geodetic& place : ring) sum += place.height_m;
    count += ring.size();
  }
  return count == 0 ? 0.0 : sum / double(count);
}

FillMesh fill_area(const PolygonObject& polygon, const Ellipsoid& ellipsoid, std::size_t most_triangles,
                   std::size_t spare_steps) {
  const std::optional<MapRings> on_map = rings_on_map(polygon);
  if (!on_map) return {.fault = FillFault::invalid};
  if (most_triangles == 0) return {.fault = FillFault::too_many_triangles};
  const MapRings rings = without_pairs(*on_map);
  if (rings.empty()) return {};
  const int cells = cells_of_half_turn(rings);
  const double diagonal_deg = std::numbers::sqrt2 * 180.0 / cells;
  const double lift_m = is_underground(polygon) ? 0.0 : sag_m(ellipsoid, Angle::degrees(diagonal_deg));
  AreaFiller filler(ellipsoid, cells, mean_height_m(polygon) + lift_m, most_triangles);
  const std::size_t due_steps = kStepsOfAPoint * size_of(rings, 180.0 / cells);
  filler.fill(rings, due_steps + spare_steps);
  FillMesh mesh = filler.take();
  mesh.lift_m = lift_m;
  mesh.spare_steps = mesh.steps - std::min(mesh.steps, due_steps);
  return mesh;
}

}  // namespace terrella
