#include "globe/object_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "base/range_check.h"
#include "geo/ranges.h"

namespace terrella {
namespace {

constexpr double kMostSize_px = 1e6, kMostDash_px = 1000.0;

Status all_good() { return Done{}; }

bool has_all_bytes(int width_px, int height_px, const std::vector<std::uint8_t>& rgba) {
  return width_px > 0 && height_px > 0 &&
         rgba.size() == 4 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
}

Status check_icon(const IconImage& icon) {
  return RangeCheck()
      .in("the width of its picture", icon.width_px, 1, kMostIconSide_px, " px")
      .in("the height of its picture", icon.height_px, 1, kMostIconSide_px, " px")
      .that(has_all_bytes(icon.width_px, icon.height_px, icon.rgba),
            fmt::format("its picture of {}x{} pixels has {} bytes; give 4 for each pixel", icon.width_px,
                        icon.height_px, icon.rgba.size()))
      .result();
}

bool is_finite(const MeshVertex& v) {
  return std::isfinite(v.position_m.x + v.position_m.y + v.position_m.z + v.normal.x + v.normal.y + v.normal.z +
                       v.uv.x + v.uv.y + v.color_linear.x + v.color_linear.y + v.color_linear.z + v.color_linear.w);
}

Status check_part(const MeshPart& part) {
  const auto inside = [count = part.vertices.size()](std::uint32_t index) { return index < count; };
  const MeshTexture* texture = part.texture.get();
  const glm::vec4& color = part.color_linear;
  return RangeCheck()
      .that(part.indices.size() % 3 == 0, "its indices are no triangles; give three for each")
      .that(std::ranges::all_of(part.indices, inside), "an index is not less than the number of vertices")
      .that(std::ranges::all_of(part.vertices, is_finite), "a vertex has a value that is not finite")
      .finite("its colour", color.x + color.y + color.z + color.w)
      .finite("its cutoff", part.cutoff)
      .that(texture == nullptr || has_all_bytes(texture->width_px, texture->height_px, texture->rgba),
            "its texture has not 4 bytes for each pixel")
      .result();
}

Status check_model(const MeshModel* model) {
  if (model == nullptr) return Error{"it has no model; give one"};
  for (std::size_t k = 0; k < model->parts.size(); ++k) {
    const Status good = check_part(model->parts[k]);
    if (!good) return RangeCheck().part(fmt::format("part {} of its model", k), good).result();
  }
  return Done{};
}

Status check_places(const std::vector<Geodetic>& places) {
  for (const Geodetic& place : places) {
    if (Status good = check_place(place); !good) return good;
  }
  return Done{};
}

Status check_look(const LabelLook& look) {
  return RangeCheck()
      .in("the size of its text", look.text_px, kLeastText_px, kMostText_px, " px")
      .in("the width of its halo", look.halo_px, 0.0, kMostHalo_px, " px")
      .known("its anchor", look.anchor, TextAnchor::bottom_right)
      .in("its letter spacing", look.letter_spacing_em, 0.0, 1.0, " em")
      .in("the blur of its halo", look.halo_blur_px, 0.0, kMostHalo_px, " px")
      .known("its weight", look.weight, TextWeight::bold)
      .result();
}

/// Checks one object after the other. Remembers the models and icons that it has checked.
class Checker {
 public:
  Status operator()(const PointObject& point) {
    const bool has_icon = point.icon.image != nullptr;
    return RangeCheck()
        .part("its place", check_place(point.place))
        .known("its heights", point.heights, HeightMode::relative_to_ground)
        .in("its radius", point.radius_m, 0.0, kMostHeight_m, " m")
        .in("its size", point.size_px, 0.0, kMostSize_px, " px")
        .that(!has_icon || point.size_px > 0.0F, "its icon has the size 0; give more")
        .finite("its heading", point.icon.heading.rad())
        .finite("its anchor", point.icon.anchor.x + point.icon.anchor.y)
        .part("its icon", has_icon && is_new(point.icon.image.get()) ? check_icon(*point.icon.image) : all_good())
        .result();
  }
  Status operator()(const LineObject& line) {
    return RangeCheck()
        .part("a place", check_places(line.places))
        .known("its heights", line.heights, HeightMode::relative_to_ground)
        .in("its width", line.width_px, 0.0, kMostSize_px, " px")
        .in("the width of its casing", line.casing_px, 0.0, kMostSize_px, " px")
        .in("the length of its dashes", line.dashes.on_px, 0.0, kMostDash_px, " px")
        .in("the length of its gaps", line.dashes.off_px, 0.0, kMostDash_px, " px")
        .that((line.dashes.on_px > 0.0F) == (line.dashes.off_px > 0.0F),
              "its dashes or its gaps have the length 0; give both, or none")
        .result();
  }
  Status operator()(const PolygonObject& polygon) {
    RangeCheck check;
    for (const auto& ring : polygon.rings) check.part("a place", check_places(ring));
    return check.known("its heights", polygon.heights, HeightMode::relative_to_ground)
        .in("the width of its stroke", polygon.stroke_width_px, 0.0, kMostSize_px, " px")
        .in("its extrude_m", polygon.extrude_m, -kMostHeight_m, kMostHeight_m, " m")
        .result();
  }
  Status operator()(const LabelObject& label) {
    return RangeCheck()
        .part("its place", check_place(label.place))
        .known("its heights", label.heights, HeightMode::relative_to_ground)
        .in("its size", label.size_px, 0.0, kMostSize_px, " px")
        .in("its radius", label.radius_m, 0.0, kMostHeight_m, " m")
        .that(!std::isnan(label.priority), "its priority is nan; give a number")
        .part("its look", check_look(label.look))
        .result();
  }
  Status operator()(const MeshObject& mesh) {
    return RangeCheck()
        .part("its place", check_place(mesh.place))
        .known("its heights", mesh.heights, HeightMode::relative_to_ground)
        .finite("its heading", mesh.heading.rad())
        .above("its scale", mesh.scale, 0.0, kMostHeight_m)
        .part("it", !mesh.model || is_new(mesh.model.get()) ? check_model(mesh.model.get()) : all_good())
        .result();
  }

 private:
  [[nodiscard]] bool is_new(const void* shared) { return checked_.insert(shared).second; }

  std::unordered_set<const void*> checked_;
};

template <class Objects>
Status check_list(const char* name, const Objects& objects, Checker& check) {
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const Status good = check(objects[k]);
    if (!good) return RangeCheck().part(fmt::format("{}[{}]", name, k), good).result();
  }
  return Done{};
}

}  // namespace

Status check_values(const ObjectScene& scene) {
  Checker check;
  if (Status good = check_list("points", scene.points, check); !good) return good;
  if (Status good = check_list("lines", scene.lines, check); !good) return good;
  if (Status good = check_list("polygons", scene.polygons, check); !good) return good;
  if (Status good = check_list("labels", scene.labels, check); !good) return good;
  return check_list("meshes", scene.meshes, check);
}

Status check_values(const ObjectMove& move) {
  return RangeCheck()
      .part("the place of a move", check_place(move.place))
      .finite("the heading of a move", move.heading.value_or(Angle{}).rad())
      .result();
}

Status check_values(const ObjectChange& change) {
  return RangeCheck()
      .above("a size", change.size_px.value_or(1.0F), 0.0, kMostSize_px, " px")
      .finite("the heading of a change", change.heading.value_or(Angle{}).rad())
      .part("the look of a change", check_look(change.look.value_or(LabelLook{})))
      .result();
}

Status check_values(const LineGrowth& growth) {
  return RangeCheck().part("a place of a growth", check_places(growth.append)).result();
}

Status check_values(const ObjectShape& shape) {
  RangeCheck check;
  for (const auto& way : shape.ways) check.part("a place of a shape", check_places(way));
  return check.result();
}

}  // namespace terrella
