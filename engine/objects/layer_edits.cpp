#include <algorithm>

#include "objects/label_layout.h"
#include "objects/layer_objects.h"

// Edits of a layer's features.
namespace terrella {

bool LayerObjects::move(const ObjectMove& move) {
  return each_part(move.id, [&](PartRef part) {
    if (part.kind == ObjectKind::label) {
      KeptLabel& label = labels_[part.index];
      --label_counts_[is_underground(label.object) ? 1 : 0];
      label.object.place = move.place;
      ++label_counts_[is_underground(label.object) ? 1 : 0];
      label.place_m = place_of(move.place, label.object.heights);
      return;
    }
    if (part.kind == ObjectKind::point) {
      if (points_[part.index].arrow != LineEnd::none) return;
      points_[part.index].object.place = move.place;
      points_[part.index].object.icon.heading = move.heading.value_or(points_[part.index].object.icon.heading);
      points_[part.index].place_m = place_of(move.place, points_[part.index].object.heights);
    } else if (part.kind == ObjectKind::mesh) {
      meshes_[part.index].object.place = move.place;
      meshes_[part.index].object.heading = move.heading.value_or(meshes_[part.index].object.heading);
      meshes_[part.index].place_m = place_of(move.place, meshes_[part.index].object.heights);
    } else {
      return;
    }
    draw_again(part);
    if (index_) index_part(part);
  });
}

bool LayerObjects::change(const ObjectChange& change) {
  return each_part(change.id, [&](PartRef part) {
    Kept& object = kept(part);
    object.visible = change.visible.value_or(object.visible);
    object.filtered = change.filtered.value_or(object.filtered);
    object.selected = change.selected.value_or(object.selected);
    change_part(part, change);
    draw_again(part);
  });
}

bool LayerObjects::set_text(const ObjectText& text) {
  return each_part(text.id, [&](PartRef part) {
    if (part.kind != ObjectKind::label) return;
    labels_[part.index].object.text = text.text;
    labels_[part.index].text = label_text(text.text);
  });
}

const ObjectFeature* LayerObjects::feature(ObjectId id) const {
  const auto found = parts_.find(static_cast<std::uint64_t>(id));
  if (found == parts_.end()) return nullptr;
  const auto data_of = [this](PartRef part) -> const ObjectFeature* {
    if (part.kind == ObjectKind::point) return points_[part.index].object.of.feature.get();
    if (part.kind == ObjectKind::line) return lines_[part.index].object->of.feature.get();
    if (part.kind == ObjectKind::polygon) return areas_[part.index].object->of.feature.get();
    if (part.kind == ObjectKind::mesh) return meshes_[part.index].object.of.feature.get();
    return labels_[part.index].object.of.feature.get();
  };
  for (PartRef part = found->second; part; part = kept(part).next) {
    if (const ObjectFeature* data = data_of(part)) return data;
  }
  return nullptr;
}

void LayerObjects::change_part(PartRef part, const ObjectChange& change) {
  if (change.size_px) most_reach_px_ = std::max(most_reach_px_, 0.5 * double(*change.size_px));
  if (part.kind == ObjectKind::point && points_[part.index].arrow != LineEnd::none) {
    change_arrow(points_[part.index], change);
  } else if (part.kind == ObjectKind::point) {
    PointObject& point = points_[part.index].object;
    ObjectColor& color = is_icon(point) ? point.icon.tint : point.color;
    color = change.color.value_or(color);
    point.size_px = change.size_px.value_or(point.size_px);
    point.icon.heading = change.heading.value_or(point.icon.heading);
    most_reach_px_ = std::max(most_reach_px_, reach_px(point));
  } else if (part.kind == ObjectKind::line) {
    KeptLine& line = lines_[part.index];
    line.object->color = change.color.value_or(line.object->color);
    line.object->width_px = change.size_px.value_or(line.object->width_px);
    ask_for(part.index, line);
  } else if (part.kind == ObjectKind::polygon) {
    KeptArea& area = areas_[part.index];
    area.object->stroke = change.color.value_or(area.object->stroke);
    area.object->fill = change.fill.value_or(area.object->fill);
    area.object->stroke_width_px = change.size_px.value_or(area.object->stroke_width_px);
    ask_for(part.index, area);
  } else if (part.kind == ObjectKind::mesh) {
    meshes_[part.index].object.heading = change.heading.value_or(meshes_[part.index].object.heading);
  } else {
    KeptLabel& label = labels_[part.index];
    label.object.color = change.label.value_or(change.color.value_or(label.object.color));
    label.object.size_px = change.size_px.value_or(label.object.size_px);
    label.object.look = change.look.value_or(label.object.look);
  }
}

void LayerObjects::draw_again(PartRef part) {
  switch (part.kind) {
    case ObjectKind::point:
      return draw(points_[part.index]);
    case ObjectKind::line:
      return draw(lines_[part.index]);
    case ObjectKind::polygon:
      return draw(areas_[part.index]);
    case ObjectKind::mesh:
      return draw(meshes_[part.index]);
    case ObjectKind::label:
      return;  // labels are placed anew in each frame
  }
}

}  // namespace terrella
