#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/viewer/viewer.h"

namespace terrella {
namespace {

constexpr double kLayerRoom = 1.3;         // visible extent relative to a layer's extent
constexpr double kNearestLayer_m = 2.0e3;  // minimum height, as a single point has no extent

/// Looks straight down on the middle, from a height that shows the whole rectangle.
Camera camera_over(const GeoRect& bounds, const Ellipsoid& body, Angle fov_y, double aspect) {
  const double lat_deg = 0.5 * (bounds.south.deg() + bounds.north.deg());
  const double high = bounds.north.rad() - bounds.south.rad();
  const double wide = width_of(bounds).rad() * std::cos(Angle::degrees(lat_deg).rad());
  const double span_m = kLayerRoom * body.a_m() * std::max(high, wide / aspect);
  Camera camera;
  camera.fov_y = fov_y;
  camera.eye = {.lat = Angle::degrees(lat_deg), .lon = bounds.west + 0.5 * width_of(bounds)};
  camera.eye.height_m = std::max(kNearestLayer_m, 0.5 * span_m / std::tan(0.5 * fov_y.rad()));
  return camera;
}

}  // namespace

void Viewer::toggle_layers() {
  layers_shown_ = !layers_shown_;
  layers_opened_ = layers_shown_;
  show_panels();
}

void Viewer::draw_layer_panel() {
  std::vector<LayerRow> rows = layers_;
  const LayerWish wish = draw_layers(rows, graticule_, std::exchange(layers_opened_, false));
  for (std::size_t i = 0; i < rows.size(); ++i) take_look(layers_[i], rows[i].look);
  const LayerRow* row = wish.ask == LayerAsk::none ? nullptr : &layers_[wish.row];
  switch (wish.ask) {
    case LayerAsk::none:
      return;
    case LayerAsk::raise:
    case LayerAsk::lower:
      return move_layer(wish.row, wish.ask == LayerAsk::raise);
    case LayerAsk::look_at:
      return look_at(*row->bounds);
    case LayerAsk::remove:
      return remove_layer(wish.row);
  }
}

void Viewer::take_look(LayerRow& row, const ImageLook& look) {
  if (look == row.look) return;
  Status set = Done{};
  if (row.kind == LayerKind::imagery) set = globe_.set_look(row.id, look);
  if (row.kind == LayerKind::objects) set = globe_.show_objects(row.id, look.shown);
  if (row.kind == LayerKind::objects && set) set = globe_.fade_objects(row.id, look.opacity);
  if (row.kind == LayerKind::heights) set = use_heights(look.shown ? options_.heights : std::nullopt);
  if (!set) return say(set.error().message);
  row.look = look;
}

Status Viewer::use_heights(const std::optional<ElevationSource>& heights) {
  if (Status set = globe_.set_elevation(heights); !set) return set;
  navigator_.set_ground(globe_.ground());
  settings_.has_relief = globe_.has_relief();
  return Done{};
}

// Rows of a kind have the globe's order in the list.
void Viewer::move_layer(std::size_t row, bool up) {
  const auto ids = layers_[row].kind == LayerKind::objects ? globe_.objects() : globe_.imagery();
  const auto place = std::size_t(std::ranges::find(ids, layers_[row].id) - ids.begin());
  if (up ? place + 1 >= ids.size() : place == 0) return;
  const LayerId neighbour = ids[up ? place + 1 : place - 1];
  const auto other = std::ranges::find(layers_, neighbour, &LayerRow::id);
  if (other == layers_.end()) return;  // the measurement has no row and stays on top
  const Status moved = globe_.move(layers_[row].id, up ? place + 1 : place - 1);
  if (!moved) return say(moved.error().message);
  std::swap(layers_[row], *other);
}

void Viewer::remove_layer(std::size_t row) {
  const LayerRow& layer = layers_[row];
  const Status removed = layer.kind == LayerKind::heights ? use_heights(std::nullopt) : globe_.remove(layer.id);
  if (!removed) return say(removed.error().message);
  if (layer.kind == LayerKind::heights) options_.heights.reset();
  say("Removed " + layer.name);
  layers_.erase(layers_.begin() + std::ptrdiff_t(row));
}

void Viewer::look_at(const GeoRect& bounds) {
  const Viewport window = window_.framebuffer();
  const double aspect = double(window.width_px) / std::max(1, window.height_px);
  navigator_.fly_to(camera_over(bounds, globe_.options().body.ellipsoid, navigator_.camera().fov_y, aspect),
                    Input::now());
}

void Viewer::take_dropped() {
  const glm::dvec2 middle = 0.5 * glm::dvec2(window_.framebuffer().width_px, window_.framebuffer().height_px);
  for (std::filesystem::path& path : input_.take_dropped()) {
    const auto place = pick(globe_.view(window_.framebuffer()), globe_.ground(), middle);
    dropped_.add(std::move(path), place.value_or(Geodetic{}));
  }
  while (auto opened = dropped_.poll()) {
    if (*opened) {
      add_layer(**std::move(opened));
    } else {
      say_too(opened->error().message);
    }
  }
}

// Reports each file that failed, when several were dropped.
void Viewer::say_too(const std::string& problem) {
  const bool more = !problems_.empty() && message_ == problems_;
  problems_ = more ? problems_ + "\n" + problem : problem;
  say(problems_);
}

void Viewer::add_layer(OpenedFile file) {
  LayerRow row{.name = file.path.filename().string()};
  if (row.name.empty()) row.name = file.path.string();
  std::string told = "Added " + row.name + "; L shows the layers";
  Status added = Done{};
  if (auto* tiles = std::get_if<std::shared_ptr<TileSource>>(&file.what)) {
    row.bounds = if_a_part((*tiles)->info().grid.bounds);
    row.finest_level = (*tiles)->info().grid.max_level;
    const auto id = globe_.add_imagery(std::move(*tiles));
    id ? void(row.id = *id) : void(added = id.error());
  } else if (auto* heights = std::get_if<ElevationSource>(&file.what)) {
    row.kind = LayerKind::heights;
    added = use_heights(*heights);
    if (added) options_.heights = *heights;
    if (added) std::erase_if(layers_, [](const LayerRow& layer) { return layer.kind == LayerKind::heights; });
  } else {
    auto& objects = std::get<ObjectFile>(file.what);
    row.kind = LayerKind::objects;
    row.bounds = bounds_of(objects.scene);
    if (!objects.complaints.empty()) {
      told = fmt::format("{}; {} faulty objects or properties were skipped", objects.complaints.front(),
                         objects.complaints.size() + objects.complaints_left_out);
    }
    const auto id = globe_.add_objects(std::move(objects.scene));
    id ? void(row.id = *id) : void(added = id.error());
  }
  if (!added) return say(row.name + ": " + added.error().message);
  if (row.bounds) look_at(*row.bounds);
  insert_row(std::move(row));
  say(std::move(told));
}

// Rows are sorted: heights, then imagery, then objects.
void Viewer::insert_row(LayerRow row) {
  const auto rank = [](LayerKind kind) { return kind == LayerKind::heights ? 0 : kind == LayerKind::imagery ? 1 : 2; };
  const auto over = std::ranges::find_if(layers_, [&](const LayerRow& r) { return rank(r.kind) > rank(row.kind); });
  layers_.insert(over, std::move(row));
}

}  // namespace terrella
