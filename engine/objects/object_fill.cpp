// Areas are cut in the plane of longitude and latitude, where ±180° and the poles are ordinary edges. A grid cuts them:
// blocks of cells are halved again and again. GLU's tessellator fills the part that remains in each cell.
#include <GL/glu.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>

#include "geo/great_circle.h"
#include "objects/object_shapes.h"

namespace terrella {
namespace {

constexpr double kWidestCell_deg = 1.0;
constexpr double kNarrowestCell_deg = 0.05;
constexpr double kCellsAcross = 64.0;
/// Cells with more points are divided: for rings that cross themselves GLU may need the square of this number.
constexpr std::size_t kMostCellPoints = 512;
constexpr int kMostDivisions = 12;
constexpr double kMostArcPieces = 4.0e6;

using Rings = std::vector<MapRing>;

/// One run of GLU's tessellator, even-odd.
class Tessellator {
 public:
  Tessellator() : tess_(gluNewTess()) {
    gluTessProperty(tess_, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_ODD);
    gluTessNormal(tess_, 0.0, 0.0, 1.0);
    gluTessCallback(tess_, GLU_TESS_VERTEX_DATA, reinterpret_cast<_GLUfuncptr>(&Tessellator::on_vertex));
    gluTessCallback(tess_, GLU_TESS_COMBINE_DATA, reinterpret_cast<_GLUfuncptr>(&Tessellator::on_combine));
    // A callback for edges makes the tessellator emit triangles instead of strips and fans.
    gluTessCallback(tess_, GLU_TESS_EDGE_FLAG, reinterpret_cast<_GLUfuncptr>(&Tessellator::on_edge));
  }
  ~Tessellator() { gluDeleteTess(tess_); }
  Tessellator(const Tessellator&) = delete;
  Tessellator& operator=(const Tessellator&) = delete;

  /// Vertices of triangles, three per triangle.
  const std::vector<MapPoint>& triangles(const Rings& rings) {
    corners_.clear();
    points_.clear();
    gluTessBeginPolygon(tess_, this);
    for (const MapRing& ring : rings) {
      gluTessBeginContour(tess_);
      for (const MapPoint& p : ring) {
        points_.push_back({p.lon_deg, p.lat_deg, 0.0});
        gluTessVertex(tess_, points_.back().data(), &points_.back());
      }
      gluTessEndContour(tess_);
    }
    gluTessEndPolygon(tess_);
    corners_.resize(corners_.size() - corners_.size() % 3);
    return corners_;
  }

 private:
  using Point = std::array<double, 3>;
  static void on_vertex(void* vertex, void* self) {
    const Point& p = *static_cast<const Point*>(vertex);
    static_cast<Tessellator*>(self)->corners_.push_back({p[0], p[1]});
  }
  static void on_combine(const GLdouble at[3], void* const[4], const GLfloat[4], void** made, void* self) {
    auto& points = static_cast<Tessellator*>(self)->points_;
    points.push_back({at[0], at[1], 0.0});
    *made = &points.back();
  }
  static void on_edge(GLboolean) {}

  GLUtesselator* tess_;
  std::deque<Point> points_;  // a deque, because addresses must stay valid
  std::vector<MapPoint> corners_;
};

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

  void fill(const Rings& rings) {
    const MapRect box = bounds_of(rings);
    const auto line = [this](double deg, double from_deg) { return (deg - from_deg) * cells_of_half_turn_ / 180.0; };
    const Block block{static_cast<int>(std::floor(line(box.west_deg, -180.0))),
                      static_cast<int>(std::ceil(line(box.east_deg, -180.0))),
                      static_cast<int>(std::floor(line(box.south_deg, -90.0))),
                      static_cast<int>(std::ceil(line(box.north_deg, -90.0)))};
    if (block.west < block.east && block.south < block.north) fill_block(rings, block);
  }

  [[nodiscard]] FillMesh take() { return too_many_ ? FillMesh{} : std::move(mesh_); }

 private:
  [[nodiscard]] double lon_at(int line) const { return line * 180.0 / cells_of_half_turn_ - 180.0; }
  [[nodiscard]] double lat_at(int line) const { return line * 180.0 / cells_of_half_turn_ - 90.0; }
  [[nodiscard]] MapRect rect_of(const Block& b) const {
    return {lon_at(b.west), lat_at(b.south), lon_at(b.east), lat_at(b.north)};
  }

  void fill_block(const Rings& rings, const Block& block) {
    const MapRect rect = rect_of(block);
    bool full = false;
    const Rings open = without_whole_turns(rings, rect, full);
    if (too_many_ || (open.empty() && !full)) return;
    if (open.empty()) return add_block(block);
    const int wide = block.east - block.west, high = block.north - block.south;
    Rings all = open;
    if (full) all.push_back(ring_of(rect));
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
    fill_block(clipped(all, axis, at, -1.0), low);
    fill_block(clipped(all, axis, at, 1.0), upper);
  }

  /// Removes rings that only follow the block's border. `full` tells if together they cover the block.
  static Rings without_whole_turns(const Rings& rings, const MapRect& rect, bool& full) {
    const double whole = (rect.east_deg - rect.west_deg) * (rect.north_deg - rect.south_deg);
    Rings open;
    for (const MapRing& ring : rings) {
      const double turns = area(ring) / whole;
      constexpr double kRounding = 1e-9;
      const bool on_border = std::ranges::all_of(ring, [&rect](const MapPoint& p) {
        return p.lon_deg == rect.west_deg || p.lon_deg == rect.east_deg || p.lat_deg == rect.south_deg ||
               p.lat_deg == rect.north_deg;
      });
      if (!on_border || std::abs(turns - std::round(turns)) > kRounding) {
        open.push_back(ring);
      } else if (std::fmod(std::round(std::abs(turns)), 2.0) == 1.0) {
        full = !full;
      }
    }
    return open;
  }

  static double area(const MapRing& ring) {
    double twice = 0.0;
    const MapPoint& o = ring.front();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const MapPoint &a = ring[i], &b = ring[i + 1];
      twice += (a.lon_deg - o.lon_deg) * (b.lat_deg - o.lat_deg) - (b.lon_deg - o.lon_deg) * (a.lat_deg - o.lat_deg);
    }
    return 0.5 * twice;
  }

  static MapRing ring_of(const MapRect& r) {
    return {{r.west_deg, r.south_deg}, {r.east_deg, r.south_deg}, {r.east_deg, r.north_deg}, {r.west_deg, r.north_deg}};
  }

  static Rings clipped(const Rings& rings, double MapPoint::*axis, double at, double side) {
    Rings parts;
    for (const MapRing& ring : rings) {
      MapRing part = clip_ring(ring, axis, at, side);
      if (part.size() >= 3) parts.push_back(std::move(part));
    }
    return parts;
  }

  void fill_cell(const Rings& rings, const MapRect& rect, int division) {
    std::size_t points = 0;
    for (const MapRing& ring : rings) points += ring.size();
    if (points == 0 || too_many_) return;
    if (points > kMostCellPoints) {
      if (division == kMostDivisions) return;
      return divide_cell(rings, rect, division);
    }
    for (const MapPoint& corner : tessellator_.triangles(rings)) mesh_.indices.push_back(add_vertex(corner));
    too_many_ = mesh_.indices.size() > most_indices_;
  }

  void divide_cell(const Rings& rings, const MapRect& rect, int division) {
    MapRect low = rect, upper = rect;
    const bool along_lon = division % 2 == 0;
    if (along_lon) {
      low.east_deg = upper.west_deg = 0.5 * (rect.west_deg + rect.east_deg);
    } else {
      low.north_deg = upper.south_deg = 0.5 * (rect.south_deg + rect.north_deg);
    }
    const auto axis = along_lon ? &MapPoint::lon_deg : &MapPoint::lat_deg;
    const double at = along_lon ? low.east_deg : low.north_deg;
    fill_cell(clipped(rings, axis, at, -1.0), low, division + 1);
    fill_cell(clipped(rings, axis, at, 1.0), upper, division + 1);
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
    too_many_ = mesh_.indices.size() > most_indices_;
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
  bool too_many_ = false;
  Tessellator tessellator_;
  FillMesh mesh_;
};

std::vector<MapPoint> on_map(const std::vector<Geodetic>& ring) {
  std::vector<MapPoint> positions;
  positions.reserve(ring.size());
  for (const Geodetic& p : ring) positions.push_back({p.lon.deg(), std::clamp(p.lat.deg(), -90.0, 90.0)});
  return positions;
}

/// Returns the rings on the map; empty if one is invalid or too long.
Rings rings_on_map(const PolygonObject& polygon) {
  Rings rings;
  double arc_pieces = 0.0;
  for (const auto& ring : polygon.rings) {
    if (ring.size() < 3) continue;
    const std::vector<MapPoint> positions = on_map(ring);
    arc_pieces += pieces_of(positions);
    if (!(arc_pieces <= kMostArcPieces)) return {};  // also refuses values that are not finite
    auto parts = rings_of(positions);
    if (!parts) return {};
    for (MapRing& part : *parts) rings.push_back(std::move(part));
  }
  return rings;
}

/// Number of grid cells per half turn. Even, so that ±180° and the poles are grid lines.
int cells_of_half_turn(const Rings& rings) {
  double extent = 0.0;
  for (const MapRing& ring : rings) {
    const auto lon = std::ranges::minmax(ring, {}, &MapPoint::lon_deg);
    const auto lat = std::ranges::minmax(ring, {}, &MapPoint::lat_deg);
    extent = std::max({extent, lon.max.lon_deg - lon.min.lon_deg, lat.max.lat_deg - lat.min.lat_deg});
  }
  const double wish = std::clamp(extent / kCellsAcross, kNarrowestCell_deg, kWidestCell_deg);
  return 2 * static_cast<int>(std::ceil(90.0 / wish));
}

}  // namespace

double mean_height_m(const PolygonObject& polygon) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& ring : polygon.rings) {
    for (const Geodetic& place : ring) sum += place.height_m;
    count += ring.size();
  }
  return count == 0 ? 0.0 : sum / double(count);
}

FillMesh fill_area(const PolygonObject& polygon, const Ellipsoid& ellipsoid, std::size_t most_triangles) {
  const Rings rings = rings_on_map(polygon);
  if (rings.empty()) return {};
  const int cells = cells_of_half_turn(rings);
  const double diagonal_deg = std::numbers::sqrt2 * 180.0 / cells;
  const double lift_m = is_underground(polygon) ? 0.0 : sag_m(ellipsoid, Angle::degrees(diagonal_deg));
  AreaFiller filler(ellipsoid, cells, mean_height_m(polygon) + lift_m, most_triangles);
  filler.fill(rings);
  FillMesh mesh = filler.take();
  mesh.lift_m = lift_m;
  return mesh;
}

}  // namespace terrella
