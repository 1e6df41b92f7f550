#include "objects/cut_objects.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/split_position.h"

namespace terrella {
namespace {

/// Pieces of lines that take about a frame's time.
constexpr double kMostPiecesAtOnce = 30'000.0;
/// An area with a fill costs as much as this many pieces of a line.
constexpr double kPiecesOfAFill = 1500.0;

/// Parts of lines that grow count less: a frame later they are wanted again, and a worker is no faster.
constexpr double kShareOfGrownPieces = 0.1;

/// Appends a way with one vertex before and one after it. For a closed way, these are its neighbours round the corner.
void append_way(const std::vector<glm::dvec3>& way, bool closed, std::vector<LineVertex>& out) {
  if (way.size() < 2) return;
  const auto vertex = [](const glm::dvec3& p_m, float width) {
    const SplitPosition p = split_position(p_m);
    return LineVertex{p.high, p.low, width, {}, 0.0F, 0.0F, 0, 0};
  };
  out.push_back(vertex(closed ? way[way.size() - 2] : way.front(), 0.0F));
  for (std::size_t k = 0; k + 1 < way.size(); ++k) out.push_back(vertex(way[k], 1.0F));
  out.push_back(vertex(way.back(), 0.0F));
  out.push_back(vertex(closed ? way[1] : way.back(), 0.0F));
}

/// Sets the dashes of a way that append_way() has made. Lengths are angles between normals, as those of ground_shape().
void set_dashes(const std::vector<glm::dvec3>& way, const LineDashes& dashes, double along_m,
                const Ellipsoid& ellipsoid, std::vector<LineVertex>& out) {
  if (!(dashes.off_px > 0.0F) || out.empty()) return;
  const double flat = (1.0 - ellipsoid.f()) * (1.0 - ellipsoid.f());
  const auto normal = [flat](const glm::dvec3& p_m) { return glm::normalize(glm::dvec3(p_m.x, p_m.y, p_m.z / flat)); };
  const double wrap_m = kDashesWrap * (double(dashes.on_px) + double(dashes.off_px));
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    LineVertex& vertex = out[k + 1];
    const double length_m = ellipsoid.a_m() * glm::distance(normal(way[k]), normal(way[k + 1]));
    vertex.along_m = static_cast<float>(std::fmod(along_m, wrap_m));
    vertex.length_m = static_cast<float>(length_m);
    vertex.on = static_cast<std::uint16_t>(std::lround(8.0F * dashes.on_px));
    vertex.off = static_cast<std::uint16_t>(std::lround(8.0F * dashes.off_px));
    along_m += length_m;
  }
}

LineCut cut_line(const CutJob::Line& line, const CutJob& job) {
  LineCut cut{.index = line.index, .number = line.number};
  if (line.on_ground) {
    cut.ground = std::make_shared<GroundShape>(ground_shape(*line.shape, job.ellipsoid, line.from_rad));
    return cut;
  }
  const std::vector<glm::dvec3> way = line_along_geodesics(line.shape->places, job.ellipsoid, job.step);
  append_way(way, false, cut.vertices);
  set_dashes(way, line.shape->dashes, line.from_rad * job.ellipsoid.a_m(), job.ellipsoid, cut.vertices);
  return cut;
}

/// Fills an area, and takes its cost off the job.
FillMesh fill(const PolygonObject& area, CutJob& job) {
  FillMesh mesh = fill_area(area, job.ellipsoid, job.most_triangles, job.spare_steps);
  job.spare_steps -= std::min(job.spare_steps, mesh.spare_steps);
  return mesh;
}

/// Cuts an extruded area. Its outlines go round the roof.
AreaCut cut_solid(const CutJob::Area& area, CutJob& job) {
  AreaCut cut{.index = area.index, .number = area.number};
  const PolygonObject roof = roof_of(*area.shape);
  double lift_m = sag_m(job.ellipsoid, job.step);
  if (area.fill) {
    const FillMesh mesh = fill(roof, job);
    cut.fault = mesh.fault;
    if (!mesh.indices.empty()) cut.solid = solid_of(*area.shape, mesh, job.ellipsoid, job.step);
    if (cut.solid.size() / 3 > job.most_triangles) {
      cut.fault = FillFault::too_many_triangles;
      cut.solid.clear();
    }
    lift_m = std::max(lift_m, mesh.lift_m);
  }
  if (!area.outline) return cut;
  for (const auto& ring : roof.rings) append_way(outline(ring, job.ellipsoid, job.step, lift_m), true, cut.outline);
  return cut;
}

/// Outlines lie at the height of the fill.
AreaCut cut_area(const CutJob::Area& area, CutJob& job) {
  AreaCut cut{.index = area.index, .number = area.number};
  const PolygonObject& shape = *area.shape;
  if (area.on_ground) {
    cut.ground = std::make_shared<GroundShape>(ground_shape(shape, area.fill));
    cut.fault = cut.ground->fault;
    return cut;
  }
  if (is_extruded(shape)) return cut_solid(area, job);
  double lift_m = sag_m(job.ellipsoid, job.step);
  if (area.fill) {
    FillMesh mesh = fill(shape, job);
    cut.fault = mesh.fault;
    cut.triangles = std::move(mesh.indices);
    cut.fill.reserve(mesh.positions_m.size());
    for (const glm::dvec3& p_m : mesh.positions_m) {
      const SplitPosition p = split_position(p_m);
      cut.fill.push_back({p.high, p.low, {}});
    }
    lift_m = std::max(lift_m, mesh.lift_m);
  }
  if (!area.outline) return cut;
  if (is_underground(shape)) lift_m = 0.0;
  for (const auto& ring : shape.rings) append_way(outline(ring, job.ellipsoid, job.step, lift_m), true, cut.outline);
  return cut;
}

}  // namespace

std::size_t triangles_of(const AreaCut& cut) { return (cut.triangles.size() + cut.solid.size()) / 3; }

bool CutJob::is_large() const {
  double pieces = 0.0;
  for (const Line& line : lines) {
    const double length = line.on_ground ? 0.0 : length_of(line.shape->places) / step;
    pieces += (line.is_part ? kShareOfGrownPieces : 1.0) * (double(line.shape->places.size()) + length);
  }
  for (const Area& area : areas) {
    if (area.fill && !area.on_ground) pieces += kPiecesOfAFill;
    for (const auto& ring : area.shape->rings) {
      pieces += double(ring.size());
      if (!area.on_ground) pieces += length_of(ring) / step;
    }
  }
  return !(pieces <= kMostPiecesAtOnce);
}

Angle line_length(const ObjectScene& scene) {
  Angle length{};
  for (const LineObject& line : scene.lines) length = length + length_of(line.places);
  for (const PolygonObject& polygon : scene.polygons) {
    for (const auto& ring : polygon.rings) length = length + length_of(ring);
  }
  return length;
}

Angle line_step(Angle length) {
  Angle step = kLineStep;
  while (length.rad() > double(kMostLineVertices) * step.rad()) step = 2.0 * step;
  return step;
}

CutObjects cut_objects(CutJob job, const std::atomic<bool>& stop) {
  CutObjects cut;
  for (const CutJob::Line& line : job.lines) {
    if (stop) return cut;
    cut.lines.push_back(cut_line(line, job));
  }
  std::ranges::stable_sort(job.areas, {}, &CutJob::Area::height_m);
  for (const CutJob::Area& area : job.areas) {
    if (stop) return cut;
    cut.areas.push_back(cut_area(area, job));
    job.most_triangles -= triangles_of(cut.areas.back());
  }
  std::ranges::sort(cut.areas, {}, &AreaCut::index);
  return cut;
}

}  // namespace terrella
