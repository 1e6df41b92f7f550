#include "apps/viewer/draw/draw.h"

#include <algorithm>
#include <utility>

#include "apps/viewer/draw/drawing_file.h"
#include "apps/viewer/draw/drawing_scene.h"

namespace terrella {
namespace {

constexpr double kReach_px = 9.0;  // at 96 dots per inch, from the pointer to a handle

}  // namespace

Draw::Draw(const ViewerContext& context)
    : Panel(context, "Draw"), kept_(drawings_file(context.globe.options().body.name)) {}

void Draw::restore(const SceneOptions& scene) {
  auto [drawing, complaint] = kept_.load();
  history_ = UndoHistory(std::move(drawing));
  show();
  if (!complaint.empty()) say(complaint);
  if (scene.drawings.empty()) return;
  const auto of_project = parse_drawing(scene.drawings, scene.project + ": \"drawings\"");
  if (!of_project) return say(of_project.error());
  Drawing both = history_.now();
  for (const DrawnMark& mark : of_project->drawing.marks) {
    const auto same = [mark](DrawnMark kept) {
      kept.id = mark.id;
      return kept == mark;
    };
    if (std::ranges::none_of(history_.now().marks, same)) both.add(mark);
  }
  commit(std::move(both));
}

std::string Draw::text() const { return drawing().marks.empty() ? std::string() : drawing_geojson(drawing()); }

void Draw::begin(MarkKind kind) {
  commit();
  select(ObjectId::none);
  sketch_ = kind;
  path_.restart(kind == MarkKind::area);
  if (Ui::panel_has_keyboard()) Ui::pass_keyboard(title());  // arrows move the globe, Enter adds a place
}

void Draw::cancel_sketch() {
  sketch_.reset();
  path_.restart(false);
}

// A mark with all its places is not lost.
void Draw::finish_or_cancel() {
  if (!sketch_) return;
  check_mark({.kind = *sketch_, .places = path_.places()}) ? finish() : cancel_sketch();
}

void Draw::toggled() {
  if (!is_open()) finish_or_cancel();
}

void Draw::finish() {
  if (!sketch_) return;
  DrawnMark mark{.kind = *sketch_, .places = path_.places(), .look = look_};
  if (const Status good = check_mark(mark); !good) return say(good.error());
  cancel_sketch();
  Drawing next = history_.now();
  const ObjectId id = next.add(std::move(mark));
  commit(std::move(next));
  select(id);
}

void Draw::add(glm::dvec2 at_px) {
  if (!sketch_) return;
  if (path_.ends_at(at_px)) return finish();
  if (path_.add(at_px) && sketch_ == MarkKind::place) finish();
}

void Draw::take_back() {
  if (sketch_) path_.take_back();
}

bool Draw::click(glm::dvec2 at_px) {
  if (sketch_) return add(at_px), true;
  if (panel() == nullptr) return false;
  const GlobePick found = context_.globe.pick(at_px, context_.window.framebuffer());
  if (!found.object || !owns(found.objects)) return false;
  select(found.object->of.id);
  return true;
}

bool Draw::right_click() {
  if (!sketch_) return false;
  finish();
  return true;
}

bool Draw::drag(DragStep step, glm::dvec2 at_px) {
  const View view = context_.globe.view(context_.window.framebuffer());
  const auto at = pick(view, context_.globe.ground(), at_px);
  if (step == DragStep::begin) {
    const DrawnMark* mark = selected();
    if (panel() == nullptr || sketch_ || mark == nullptr || !at) return false;
    const std::vector<MarkHandle> handles = mark_handles(context_.globe, view, *mark);
    const MarkHandle* handle = handle_at(handles, at_px, kReach_px * double(context_.window.text_scale()));
    if (handle == nullptr) return false;
    held_ = Held{.place = handle->place, .mark = *mark, .from = *at};
    if (handle->place) place_ = *handle->place;
    return true;
  }
  if (!held_) return false;
  if (step == DragStep::move && at) {
    DrawnMark mark = held_->place ? held_->mark : moved_mark(held_->mark, held_->from, *at);
    if (held_->place) mark.places[*held_->place] = {.lat = at->lat, .lon = at->lon};
    if (check_mark(mark)) change(std::move(mark));
  }
  if (step == DragStep::end) {
    held_.reset();
    commit();
  }
  return true;
}

void Draw::keep_measured(std::vector<Geodetic> places) {
  const MarkKind kind = places.size() == 1 ? MarkKind::place : MarkKind::line;
  Drawing next = history_.now();
  for (Geodetic& place : places) place.height_m = 0.0;
  const ObjectId id = next.add({.kind = kind, .places = std::move(places), .look = look_});
  commit(std::move(next));
  if (!is_open()) toggle();
  select(id);
}

void Draw::undo() {
  commit();
  if (!history_.can_undo()) return say("There is no change to undo");
  history_.undo();
  show();
  keep();
}

void Draw::redo() {
  commit();
  if (!history_.can_redo()) return say("There is no change to redo");
  history_.redo();
  show();
  keep();
}

void Draw::select(ObjectId id) {
  selected_ = id;
  place_ = 0;
}

void Draw::change(DrawnMark mark) {
  Drawing next = drawing();
  DrawnMark* found = next.find(mark.id);
  if (found == nullptr) return;
  look_ = mark.look;
  *found = std::move(mark);
  live_ = std::move(next);
  show();
}

void Draw::commit() {
  if (live_) commit(*std::exchange(live_, {}));
}

void Draw::commit(Drawing next) {
  live_.reset();
  if (next == history_.now()) return show();
  history_.commit(std::move(next));
  show();
  keep();
}

void Draw::show() {
  Globe& globe = context_.globe;
  const Drawing& now = drawing();
  const float scale = context_.window.text_scale();
  Status shown = Done{};
  if (layer_) {
    shown = globe.edit_objects(*layer_, drawing_edits(shown_, now, scale));
  } else if (!now.marks.empty()) {
    const Result<LayerId> layer = globe.add_objects(drawing_scene(now, scale));
    if (layer) layer_ = *layer;
    if (!layer) shown = layer.error();
  }
  shown_ = now;
  const DrawnMark* mark = selected();
  place_ = mark == nullptr ? 0 : std::min(place_, mark->places.size() - 1);
  if (!shown) say(shown.error());
}

void Draw::keep() {
  const Result<std::string> kept = kept_.save(history_.now());
  if (kept && !kept->empty()) say(*kept);
  if (!kept && kept_well_) say(kept.error());
  kept_well_ = kept ? Status(Done{}) : kept.error();
  if (kept) warned_ = false;
}

bool Draw::may_quit() {
  held_.reset();
  commit();
  finish_or_cancel();
  if (!kept_well_) keep();
  if (kept_well_ || std::exchange(warned_, true)) return true;
  say(Error{kept_well_.error().message + ". Save the drawings (Ctrl + S), or quit again to lose them."});
  return false;
}

bool Draw::close() {
  if (!sketch_) return Panel::close();
  cancel_sketch();
  return true;
}

void Draw::draw_over(const View& view, std::optional<glm::dvec2> cursor_px) {
  if (sketch_) return void(path_.draw_to(view, cursor_px));
  const DrawnMark* mark = selected();
  if (panel() == nullptr || mark == nullptr || context_.globe.options().stereo.mode != Stereo::off) return;
  draw_handles(mark_handles(context_.globe, view, *mark), place_, context_.window.pixels_per_unit().x);
}

}  // namespace terrella
