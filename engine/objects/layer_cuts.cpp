#include <algorithm>
#include <utility>

#include "objects/layer_objects.h"

// The lines and areas of a layer: jobs to cut, and finished cuts.
namespace terrella {
namespace {

/// Vertices of a part of a line that grows come in multiples of this.
constexpr std::size_t kGrownVertices = 20;

void add_run(std::vector<FillRun>& runs, const FillRun& run) {
  if (run.count == 0) return;
  if (!runs.empty() && runs.back().height_m == run.height_m && runs.back().first + runs.back().count == run.first) {
    runs.back().count += run.count;
  } else {
    runs.push_back(run);
  }
}

}  // namespace

std::vector<std::uint32_t> LayerObjects::own_triangles(const LayerBatches& batches, const KeptArea& area) {
  const auto indices = batches.fill_indices.at(area.triangles);
  std::vector<std::uint32_t> triangles(indices.begin(), indices.end());
  for (std::uint32_t& index : triangles) index -= area.fill.first;
  return triangles;
}

// The triangles name the fill's own vertices.
void LayerObjects::put_fill(KeptArea& area, std::span<const FillVertex> fill, std::vector<std::uint32_t> triangles) {
  const std::size_t bucket = fill_bucket(area);
  area.fill = batches_.fill_vertices.add(bucket, fill);
  for (std::uint32_t& index : triangles) index += area.fill.first;
  area.triangles = batches_.fill_indices.add(bucket, triangles);
  add_run(batches_.fill_runs[bucket], {area.height_m, area.triangles.first, area.triangles.count});
  ++batches_.fill_version;
}

void LayerObjects::ask_for(std::uint32_t index, KeptLine& line) {
  if (line.asked || line.object->color.alpha == 0 || !(line.object->width_px > 0.0F)) return;
  line.asked = true;
  job_.lines.push_back({index, ++line.asked_number, as_cut(line.object), lies_on_ground(*line.object, ground_),
                        line.part.from_rad, line.part.is_part});
}

// An outline lies at the height of the fill, so both are cut together.
void LayerObjects::ask_for(std::uint32_t index, KeptArea& area) {
  const PolygonObject& object = *area.object;
  const bool fill = object.fill.alpha > 0, outline = object.stroke.alpha > 0 && object.stroke_width_px > 0.0F;
  if ((!fill || area.asked_fill) && (!outline || area.asked_outline)) return;
  area.asked_fill = area.asked_fill || fill;
  area.asked_outline = area.asked_outline || outline;
  const std::shared_ptr<const PolygonObject> shape = as_cut(area.object);
  area.height_m = mean_height_m(*shape);
  job_.areas.push_back({index, ++area.asked_number, shape, area.asked_fill, area.asked_outline, area.height_m,
                        lies_on_ground(*area.object, ground_)});
}

void LayerObjects::ask_for_grown() {
  for (const std::uint32_t index : std::exchange(grown_, {})) {
    KeptLine& line = lines_[index];
    line.grown = line.asked = false;
    if (!line.removed) ask_for(index, line);
  }
}

CutJob LayerObjects::take_job() {
  job_.step = line_step(length_);
  job_.most_triangles = kMostFillTriangles - std::min(triangles_, kMostFillTriangles);
  jobs_out_ += job_.empty() ? 0U : 1U;
  return std::exchange(job_, CutJob{.ellipsoid = ellipsoid_});
}

void LayerObjects::place(CutObjects cut) {
  --jobs_out_;
  for (LineCut& line : cut.lines) place(line);
  for (AreaCut& area : cut.areas) place(area);
}

void LayerObjects::place(LineCut& cut) {
  KeptLine& line = lines_[cut.index];
  if (line.removed || cut.number < line.placed_number) return;
  line.placed_number = cut.number;
  if (line.ground.lies != (cut.ground != nullptr)) drop({ObjectKind::line, cut.index});
  line.ground.lies = cut.ground != nullptr;
  line.ground.shape = std::move(cut.ground);
  if (!line.ground.lies) {
    line.part.vertices = cut.vertices.size();
    // Parts that grow keep their room.
    if (line.part.is_part)
      cut.vertices.resize((cut.vertices.size() / kGrownVertices + 1) * kGrownVertices, LineVertex{});
    put(batches_.lines, line.slot, bucket_of(line), cut.vertices);
    for (LineVertex& vertex : cut.vertices) vertex.on = vertex.off = 0;  // a casing has no gaps
    if (has_casing(*line.object)) put(batches_.casings, line.casing, casing_bucket(line), cut.vertices);
    join(line);
  }
  draw(line);
}

void LayerObjects::place(AreaCut& cut) {
  KeptArea& area = areas_[cut.index];
  if (area.removed || cut.number < area.placed_number) return;
  area.placed_number = cut.number;
  replaced_ += area.fill.count + area.outline.count > 0 ? 1U : 0U;
  if (!area.ground.lies || !cut.ground) drop({ObjectKind::polygon, cut.index});
  triangles_ += triangles_of(cut);
  area.fault = cut.fault;
  area.ground.lies = cut.ground != nullptr;
  area.ground.shape = std::move(cut.ground);
  if (area.ground.lies) return draw(area);
  area.outline = batches_.lines.add(outline_bucket(area), cut.outline);
  if (is_extruded(*area.object)) {
    area.fill = batches_.solids.add(fill_bucket(area), cut.solid);
  } else {
    put_fill(area, cut.fill, std::move(cut.triangles));
  }
  draw(area);
}

std::vector<MissingFill> LayerObjects::missing_fills() const {
  std::vector<MissingFill> missing;
  for (const KeptArea& area : areas_) {
    if (!area.removed && area.fault != FillFault::none) missing.push_back({area.object->of.id, area.fault});
  }
  return missing;
}

// Makes the batches anew from their own items: nothing is cut again.
void LayerObjects::place_all_again() {
  LayerBatches old = std::exchange(batches_, LayerBatches{});
  batches_.fill_version = old.fill_version + 1;
  batches_.ground.note(old.ground.take_changes());
  replaced_ = 0;
  for (KeptPoint& point : points_) {
    point.slot = {};
    if (!point.removed) draw(point);
  }
  for (KeptMesh& mesh : meshes_) {
    mesh.slot = {};
    if (!mesh.removed) draw(mesh);
  }
  for (KeptLine& line : lines_) {
    if (line.removed) continue;
    line.ground.place = GroundBatch::kNone;
    line.casing = batches_.casings.add(casing_bucket(line), old.casings.at(line.casing));
    line.slot = batches_.lines.add(bucket_of(line), old.lines.at(line.slot));
    draw(line);
  }
  for (KeptArea& area : areas_) {
    if (area.removed) continue;
    area.ground.place = GroundBatch::kNone;
    area.outline = batches_.lines.add(outline_bucket(area), old.lines.at(area.outline));
    if (is_extruded(*area.object)) {
      area.fill = batches_.solids.add(fill_bucket(area), old.solids.at(area.fill));
    } else {
      put_fill(area, old.fill_vertices.at(area.fill), own_triangles(old, area));
    }
    draw(area);
  }
}

}  // namespace terrella
