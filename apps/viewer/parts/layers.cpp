#include "apps/viewer/parts/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/open_scene/swipe_sides.h"
#include "apps/process/console.h"
#include "apps/process/option_names.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/styles/class_legend.h"
#include "apps/viewer/tools/recent_files.h"
#include "geo/longitudes.h"

namespace terrella {
namespace {

constexpr double kLegendGap = 0.8;    // in text heights, to the window's edge and the status line
constexpr double kHighWindow = 18.0;  // in text heights, over the legend

/// True if a layer's dates, if it has some, follow the globe's time.
bool follows_time(const Globe& globe, const LayerRow& row) {
  return row.look.clock != LayerClock::own && globe.options().time;
}

/// The source of a layer with the colours that it has now, and with its instant if that is not the one of the start: a
/// layer that shows the newest date shows a newer one at the next start.
SourceOptions described(const Globe& globe, const LayerRow& row) {
  SourceOptions source = row.source;
  const auto time = follows_time(globe, row) ? Result<LayerTime>(LayerTime{}) : globe.layer_time(row.id);
  const auto instant = time ? (time->coming ? time->coming : time->shown) : std::nullopt;
  if (instant && row.tiles && row.tiles->info().steps && instant != row.tiles->info().instant)
    source.remote.time = row.tiles->info().steps->text(*instant);
  if (!row.numbers || !row.look.numbers) return source;
  source.numbers.colormap = row.numbers->colormap;
  source.numbers.lit = row.look.numbers->lit;
  source.numbers.contours = row.look.numbers->contour_step;
  source.numbers.stretch = {
      {.kind = StretchRule::Kind::range, .low = row.look.numbers->low, .high = row.look.numbers->high}};
  return source;
}

/// A layer of a server as it is shown now.
LayerToKeep layer_to_keep(const Globe& globe, const LayerRow& row) {
  const TileSetInfo& info = row.tiles->info();
  LayerToKeep keep{.name = row.name, .source = row.source, .info = info, .time = info.time};
  const auto time = globe.layer_time(row.id);
  if (time && time->shown && info.steps && time->shown != info.instant) keep.time = info.steps->text(*time->shown);
  return keep;
}

/// The smallest part of the planet that has both; nullopt if that is most of it.
std::optional<GeoRect> around(const std::optional<GeoRect>& a, const std::optional<GeoRect>& b) {
  if (!a || !b) return a ? a : b;
  ObjectScene corners;
  for (const GeoRect& part : {*a, *b}) {
    corners.points.push_back({.place = {.lat = part.south, .lon = part.west}});
    corners.points.push_back({.place = {.lat = part.north, .lon = part.east}});
  }
  return bounds_of(corners);
}

}  // namespace

Layers::Layers(const ViewerContext& context, std::vector<LayerRow> rows, std::optional<ElevationSource> heights,
               const SourceOptions& files, std::vector<LayerSwitch> switches)
    : Panel(context, "Layers"),
      rows_(std::move(rows)),
      heights_(std::move(heights)),
      files_(files),
      switches_(std::move(switches)) {
  for (LayerRow& row : rows_) row.key = ++steps_.last_key;
  forget_looks();
}

bool Layers::changed() const {
  const auto has_news = [](const LayerRow& row) {
    return (!row.facts_drawn && row.has_facts()) || (row.style && row.style->has_news());
  };
  return files_.ready() || value_.ready() || open_wish_ || list_wish_ || keep_wish_ ||
         (panel() != nullptr && std::ranges::any_of(rows_, has_news));
}

void Layers::draw_open(float foot) {
  std::vector<LayerRow> rows = rows_;
  for (const LayerRow& row : rows) {
    if (row.style) row.style->set_waiting(false);
  }
  const LayerWish wish = draw_layers(panel(), rows, switches_, foot, take_just_opened());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    take_look(rows_[i], rows[i].look);
    take_style(rows_[i]);
    rows_[i].objects.cluster_px = rows[i].objects.cluster_px;
    rows_[i].numbers = std::move(rows[i].numbers);
    rows_[i].facts = std::move(rows[i].facts);
    rows_[i].facts_drawn = rows_[i].has_facts();
  }
  switch (wish.ask) {
    case LayerAsk::none:
      return;
    case LayerAsk::raise:
    case LayerAsk::lower:
      return move(wish.row, wish.ask == LayerAsk::raise);
    case LayerAsk::look_at:
      return fly_over(context_, *rows_[wish.row].bounds);
    case LayerAsk::remove:
      return remove(wish.row);
    case LayerAsk::list:
      list_wish_ = {.id = rows_[wish.row].id, .name = rows_[wish.row].name, .features = rows_[wish.row].features};
      return;
    case LayerAsk::keep:
      keep_wish_ = layer_to_keep(context_.globe, rows_[wish.row]);
      return;
    case LayerAsk::open:
      open_wish_ = true;
      return;
    case LayerAsk::undo:
      return undo();
    case LayerAsk::redo:
      return redo();
  }
}

std::vector<LegendItem> Layers::legend() const {
  std::vector<LegendItem> items;
  for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) {
    if (row->style && row->style->classes() && row->look.shown)
      items.push_back(class_legend(row->name, *row->style->classes()));
    if (!row->numbers || !row->look.numbers || !row->look.shown) continue;
    items.push_back(
        {.title = legend_title(row->name, *row->numbers), .unit = row->numbers->unit, .look = *row->look.numbers});
  }
  return items;
}

void Layers::draw_legend(float foot, bool before_panels) const {
  const double gap = kLegendGap * Ui::text_height(), bottom = window_height() - double(foot) - gap;
  const std::vector<LegendItem> items = legend_with_room(legend(), gap, bottom);
  const UiBox box = legend_box(items, gap, bottom);
  const auto covers = [&box](const UiBox& other) { return other.overlaps(box); };
  const bool high = box.top > kHighWindow * Ui::text_height();
  if (high == before_panels && std::ranges::none_of(Ui::panel_boxes(), covers))
    terrella::draw_legend(items, gap, bottom);
}

bool Layers::has_objects(LayerId layer) const {
  return std::ranges::any_of(
      rows_, [layer](const LayerRow& row) { return row.kind == LayerKind::objects && row.id == layer; });
}

std::optional<std::string> Layers::shown_objects(LayerId layer) const {
  const auto row = std::ranges::find_if(rows_, [layer](const LayerRow& one) {
    return one.kind == LayerKind::objects && one.id == layer && one.look.shown;
  });
  return row == rows_.end() ? std::nullopt : std::optional(row->name);
}

void Layers::describe(SceneOptions& scene) const {
  std::vector<LayerOption> images;
  scene.elevation = {};
  scene.object_layers.clear();
  for (const LayerRow& row : rows_) {
    if (row.kind == LayerKind::heights) {
      scene.elevation = row.source.address;
      scene.elevation_shown = row.look.shown;
    } else if (row.kind == LayerKind::imagery) {
      images.push_back({.source = described(context_.globe, row), .look = row.look});
    } else {
      scene.object_layers.push_back(described_objects(row));
    }
  }
  if (images.size() < 2) scene.surface.swipe.reset();  // there is nothing to compare
  set_images(scene, std::move(images));
}

std::vector<TimedLayer> Layers::timed() const {
  std::vector<TimedLayer> layers;
  for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) {
    if (row->kind != LayerKind::imagery || !row->look.shown || !row->tiles) continue;
    if (auto steps = row->tiles->info().steps)
      layers.push_back({row->id, row->name, std::move(steps), follows_time(context_.globe, *row)});
  }
  return layers;
}

bool Layers::choose_swipe_sides() {
  std::vector<ImageLook> looks;
  for (const LayerRow& row : rows_) {
    if (row.kind == LayerKind::imagery) looks.push_back(row.look);
  }
  if (!terrella::choose_swipe_sides(looks)) return false;
  auto look = looks.begin();
  for (LayerRow& row : rows_) {
    if (row.kind == LayerKind::imagery) take_look(row, *look++);
  }
  return true;
}

const LayerRow* Layers::highest_numbers(const std::function<bool(const LayerRow&)>& is_there) const {
  const auto row = std::find_if(rows_.rbegin(), rows_.rend(), [&is_there](const LayerRow& layer) {
    return layer.numbers && layer.look.shown && is_there(layer);
  });
  return row == rows_.rend() ? nullptr : &*row;
}

std::optional<ProfileNumbers> Layers::shown_numbers() const {
  const LayerRow* row = highest_numbers([](const LayerRow&) { return true; });
  if (row == nullptr) return {};
  return ProfileNumbers{
      .layer = row->id, .name = legend_title(row->name, *row->numbers), .unit = one_line(row->numbers->unit)};
}

std::optional<double> Layers::finest_texel_m(const Geodetic& place) const {
  std::optional<double> finest;
  const double degree_m = context_.globe.options().body.ellipsoid.a_m() * Angle::degrees(1.0).rad();
  for (const LayerRow& row : rows_) {
    if (row.kind != LayerKind::imagery || !row.look.shown || !row.tiles) continue;
    const TileGrid& grid = row.tiles->info().grid;
    const GeoRect bounds = row.bounds.value_or(grid.bounds);
    const bool covers =
        bounds.south <= place.lat && place.lat <= bounds.north && meets_longitudes(bounds, place.lon.deg(), 0.0);
    if (!covers) continue;
    const double texel_m = tile_span_deg(grid, grid.max_level) / grid.tile_px * degree_m;
    finest = std::min(finest.value_or(texel_m), texel_m);
  }
  return finest;
}

std::string Layers::value_at(const Geodetic& place, double x_px) {
  const auto& line = context_.globe.options().surface.swipe;
  const int width_px = context_.window.framebuffer().width_px;
  const LayerRow* row =
      highest_numbers([&](const LayerRow& layer) { return shows_at(layer.look.swipe, line, x_px, width_px); });
  if (row == nullptr) return {};
  value_.ask(context_.globe, row->id, place);
  return value_.text(place, row->numbers->unit);
}

void Layers::take_look(LayerRow& row, const ImageLook& look) {
  if (look == row.look) return;
  Globe& globe = context_.globe;
  Status set = Done{};
  if (row.kind == LayerKind::imagery) set = globe.set_look(row.id, look);
  if (row.kind == LayerKind::objects) set = globe.show_objects(row.id, look.shown);
  if (row.kind == LayerKind::objects && set) set = globe.fade_objects(row.id, look.opacity);
  if (row.kind == LayerKind::heights) set = use_heights(look.shown ? heights_ : std::nullopt);
  if (!set) return say(set.error());
  row.look = look;
}

void Layers::take_style(LayerRow& row) {
  if (!row.style) return;
  if (const auto wish = row.style->take_wish()) {
    const Status done = row.style->apply(context_.globe, row.id, *wish);
    if (!done) say(done.error());
  }
  if (!row.style->take_save_wish()) return;
  const Result<std::filesystem::path> saved = save_style(*row.style);
  saved ? say("Saved " + saved->filename().string()) : say(saved.error());
}

Status Layers::use_heights(const std::optional<ElevationSource>& heights) {
  if (Status set = context_.globe.set_elevation(heights); !set) return set;
  context_.navigator.set_ground(context_.globe.ground());
  return Done{};
}

void Layers::move(std::size_t row, bool up) {
  note_looks_now();
  const unsigned key = rows_[row].key;
  const std::string name = rows_[row].name;
  if (move_row(row, up)) steps_.steps.add(MoveStep{.key = key, .name = name, .up = up});
}

// Rows of a kind have the globe's order in the list.
bool Layers::move_row(std::size_t row, bool up) {
  Globe& globe = context_.globe;
  const auto ids = rows_[row].kind == LayerKind::objects ? globe.objects() : globe.imagery();
  const auto place = std::size_t(std::ranges::find(ids, rows_[row].id) - ids.begin());
  if (up ? place + 1 >= ids.size() : place == 0) return false;
  const LayerId neighbour = ids[up ? place + 1 : place - 1];
  const auto other = std::ranges::find(rows_, neighbour, &LayerRow::id);
  if (other == rows_.end()) return false;  // the measurement has no row and stays on top
  const Status moved = globe.move(rows_[row].id, up ? place + 1 : place - 1);
  if (!moved) say(moved.error());
  if (moved) std::swap(rows_[row], *other);
  return bool(moved);
}

void Layers::remove(std::size_t row) {
  note_looks_now();
  RemoveStep step = removal_of(rows_[row]);
  if (!remove_row(row)) return;
  say("Removed " + step.row.name + "; Ctrl + Z brings it back");
  steps_.steps.add(std::move(step));
}

bool Layers::remove_row(std::size_t row) {
  const LayerRow& layer = rows_[row];
  const bool heights = layer.kind == LayerKind::heights;
  const Status removed = heights ? use_heights(std::nullopt) : context_.globe.remove(layer.id);
  if (!removed) {
    say(removed.error());
    return false;
  }
  if (heights) heights_.reset();
  rows_.erase(rows_.begin() + std::ptrdiff_t(row));
  return true;
}

void Layers::watch_tiles(const FrameStats& stats) {
  const int missing = stats.tiles_missing + stats.heights_missing,
            pending = stats.tiles_pending + stats.heights_pending;
  for (LayerRow& row : rows_) {
    if (missing + pending == 0) row.problem.clear();
    if (missing == 0) continue;
    const bool is_new = row.problem.empty();
    const Globe& globe = context_.globe;
    const auto& tiles = row.kind == LayerKind::heights ? globe.missing_heights() : globe.missing_tiles();
    const auto last = std::find_if(tiles.rbegin(), tiles.rend(), [&row](const MissingTile& tile) {
      const MissingKind kind = tile.failure.kind;
      return tile.layer == row.id && kind != MissingKind::absent && kind != MissingKind::blank;
    });
    if (last == tiles.rend()) continue;
    row.problem = one_line(shown_message(last->failure.why));
    if (is_new) context_.messages.report(fmt::format("{}; L shows the layer, which tries again", row.problem));
  }
}

void Layers::open(SourceOptions said) {
  const Globe& globe = context_.globe;
  const auto place = pick(globe.view(context_.window.framebuffer()), globe.ground(), context_.middle_px());
  files_.add(std::move(said), place.value_or(Geodetic{}));
}

std::vector<std::shared_ptr<GrowingCut>> Layers::take_opened() {
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  while (auto opened = files_.poll()) {
    if (!*opened) {
      context_.messages.report(opened->error().message);
      continue;
    }
    if ((*opened)->other_body) {
      other_bodies_.push_back(*std::move((*opened)->other_body));
      continue;
    }
    std::ranges::move((*opened)->cuts, std::back_inserter(cuts));
    add(**std::move(opened));
  }
  check_fills();
  return cuts;
}

/// Reports areas that are drawn without their fill, once their layer is cut.
void Layers::check_fills() {
  if (!context_.globe.settled()) return;
  for (LayerRow& row : rows_) {
    if (row.kind != LayerKind::objects || std::exchange(row.fills_checked, true)) continue;
    for (const std::string& complaint : fill_complaints(context_.globe, row.id, row.name)) {
      context_.messages.report(complaint);
    }
  }
}

void Layers::follow_view(Viewport picture) {
  for (LayerRow& row : rows_) {
    Status followed = row.style ? row.style->follow(context_.globe, row.id, picture) : Status(Done{});
    if (followed && row.clusters) {
      followed = row.clusters->follow(context_.globe, row.id, row.objects.cluster_px, picture);
    }
    const std::string fault = followed ? std::string() : followed.error().message;
    if (fault != std::exchange(row.follow_fault, fault) && !fault.empty()) say(Error{fault});
  }
}

bool Layers::cancel() {
  if (!files_.busy()) return false;
  (void)files_.leave_off();
  return true;
}

void Layers::add(OpenedFile file) {
  std::optional<ObjectFile> features = std::move(file.features);
  const SourceOptions said = file.said;
  std::optional<GeoRect> part = add_row(std::move(file));
  if (features) part = around(part, add_row({.said = said, .what = *std::move(features)}));
  if (part) fly_over(context_, *part);
}

std::optional<GeoRect> Layers::add_row(OpenedFile file) {
  const std::string path = file.said.address.with_secrets();
  LayerRow row{.name = shown_name(file.said), .source = file.said};
  row.objects = {.file = path, .model_place = file.model_place};
  row.read_facts = std::move(file.read_facts);
  std::string told = "Added " + row.name + "; L shows the layers";
  Status added = Done{};
  if (auto* layer = std::get_if<ImageryLayer>(&file.what)) {
    added = add_tiles(std::move(*layer), row);
  } else if (const auto* heights = std::get_if<ElevationSource>(&file.what)) {
    added = add_heights(*heights, row);
  } else {
    auto& objects = std::get<ObjectFile>(file.what);
    if (!objects.complaints.empty()) {
      told = fmt::format("{}; {} faulty objects or properties were skipped", objects.complaints.front(),
                         objects.complaints.size() + objects.complaints_left_out);
    }
    added = add_objects(std::move(objects), row);
  }
  if (!added) {
    say(Error{row.name + ": " + added.error().message});
    return {};
  }
  const std::optional<GeoRect> part = row.bounds;
  insert(std::move(row));
  const Status kept = remember_opened(std::array{path});
  kept ? say(told) : say(kept.error());
  return part;
}

Status Layers::add_tiles(ImageryLayer layer, LayerRow& row) {
  row.bounds = if_a_part(layer.tiles->info().grid.bounds);
  row.finest_level = layer.tiles->info().grid.max_level;
  row.attribution = layer.tiles->info().attribution;
  const auto id = context_.globe.add_imagery(layer.tiles, layer.look);
  if (!id) return id.error();
  row.tiles = std::move(layer.tiles);
  row.look = layer.look;
  row.numbers = std::move(layer.numbers);
  row.id = *id;
  return Done{};
}

Status Layers::add_heights(const ElevationSource& heights, LayerRow& row) {
  row.kind = LayerKind::heights;
  row.attribution = heights.tiles()->info().attribution;
  if (Status used = use_heights(heights); !used) return used;
  heights_ = heights;
  std::erase_if(rows_, [](const LayerRow& layer) { return layer.kind == LayerKind::heights; });
  return Done{};
}

Status Layers::add_objects(ObjectFile file, LayerRow& row) {
  row.kind = LayerKind::objects;
  row.bounds = bounds_of(file.scene);
  row.attribution = file.attribution;
  row.style = style_of_layer(layer_features(file.scene));
  row.features = std::make_shared<const std::vector<ListedFeature>>(listed_features(file.scene));
  row.take_points(cluster_points(file.scene));
  const auto id = context_.globe.add_objects(std::move(file.scene));
  if (!id) return id.error();
  row.id = *id;
  return context_.globe.set_attribution(*id, std::move(file.attribution));
}

// Rows are sorted: heights, then imagery, then objects.
void Layers::insert(LayerRow row) {
  if (row.key == 0) row.key = ++steps_.last_key;
  const auto rank = [](LayerKind kind) { return kind == LayerKind::heights ? 0 : kind == LayerKind::imagery ? 1 : 2; };
  const auto over = std::ranges::find_if(rows_, [&](const LayerRow& r) { return rank(r.kind) > rank(row.kind); });
  rows_.insert(over, std::move(row));
}

}  // namespace terrella
