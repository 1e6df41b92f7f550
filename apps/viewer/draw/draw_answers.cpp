#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include "apps/open_scene/bounds_view.h"
#include "apps/viewer/draw/draw.h"
#include "apps/viewer/draw/drawing_file.h"
#include "apps/viewer/draw/drawing_scene.h"
#include "apps/viewer/panels/layer_panel.h"
#include "apps/viewer/tools/screenshot.h"

// The panel's requests.
namespace terrella {

// A change of colour, width or name becomes one step when no item is held any more.
void Draw::draw_open(float foot) {
  const DrawPanelState state{.drawing = drawing(),
                             .selected = selected(),
                             .place = place_,
                             .sketch = sketch_,
                             .sketched = sketch_ && path_.places().size() > 1 ? path_.text() : "",
                             .can_undo = history_.can_undo() || live_.has_value(),
                             .can_redo = history_.can_redo() && !live_.has_value()};
  const DrawWish wish = draw_drawing(title(), state, file_, foot, take_just_opened());
  const bool is_held = ImGui::IsAnyItemActive() || Ui::has_open_list() || held_.has_value();
  if (live_ && !is_held && wish.ask != DrawAsk::change) commit();
  answer(wish);
}

void Draw::answer(const DrawWish& wish) {
  switch (wish.ask) {
    case DrawAsk::none:
      return;
    case DrawAsk::sketch:
      return begin(wish.kind);
    case DrawAsk::finish:
      return finish();
    case DrawAsk::cancel:
      return cancel_sketch();
    case DrawAsk::undo:
      return undo();
    case DrawAsk::redo:
      return redo();
    case DrawAsk::select:
      return select(wish.id);
    case DrawAsk::save:
      return save();
    case DrawAsk::open:
      return open_file();
    case DrawAsk::fly:
      return fly_there();
    case DrawAsk::change: {
      const Status good = check_mark(*wish.changed);
      return good ? change(*wish.changed) : say(good.error());
    }
    default:
      return answer_place(wish);
  }
}

std::optional<Geodetic> Draw::middle_place() const {
  const View view = context_.globe.view(context_.window.framebuffer());
  auto place = pick(view, context_.globe.ground(), context_.middle_px());
  if (!place) say("There is no ground in the middle of the view");
  if (place) place->height_m = 0.0;
  return place;
}

/// Requests about a place of the selected mark.
void Draw::answer_place(const DrawWish& wish) {
  const DrawnMark* now = selected();
  if (now == nullptr) return;
  if (wish.ask == DrawAsk::choose) {
    place_ = wish.place;
    return;
  }
  Drawing next = drawing();
  if (wish.ask == DrawAsk::remove) {
    next.remove(now->id);
    return commit(std::move(next));
  }
  DrawnMark mark = *now;
  const auto at = mark.places.begin() + std::ptrdiff_t(place_);
  if (wish.ask == DrawAsk::remove_place) {
    mark.places.erase(at);
  } else if (const auto middle = middle_place()) {
    if (wish.ask == DrawAsk::move_place) *at = *middle;
    if (wish.ask == DrawAsk::move_mark) mark = moved_mark(std::move(mark), *at, *middle);
    if (wish.ask == DrawAsk::insert) mark.places.insert(at + 1, *middle);
  } else {
    return;
  }
  if (const Status good = check_mark(mark); !good) return say(good.error());
  if (wish.ask == DrawAsk::insert) ++place_;
  *next.find(mark.id) = std::move(mark);
  commit(std::move(next));
}

void Draw::fly_there() const {
  const DrawnMark* mark = selected();
  if (mark == nullptr) return;
  const auto bounds = bounds_of(drawing_scene({{*mark}}, 1.0F));
  if (mark->places.size() > 1 && bounds) return fly_over(context_, *bounds);
  Navigator& navigator = context_.navigator;
  Camera there{.eye = middle_of(*mark), .fov_y = navigator.camera().fov_y};
  there.eye.height_m = navigator.camera().eye.height_m;
  navigator.fly_to(there, Input::now());
}

// Another file of that name is replaced only by a second save.
void Draw::save() {
  commit();
  if (history_.now().marks.empty()) return say("Nothing is drawn yet. Press D to start.");
  std::error_code unknown;
  const auto folder = std::filesystem::current_path(unknown);
  if (file_.empty()) {
    file_ = new_file_name(folder, std::chrono::system_clock::now(), ".geojson").filename().string();
    overwrite_ = file_;
  }
  if (std::filesystem::exists(folder / file_, unknown) && std::exchange(overwrite_, file_) != file_)
    return say(file_ + " is there already. Save again to replace it.");
  const Status saved = save_drawing(folder / file_, history_.now());
  if (saved) overwrite_ = file_;
  saved ? say("Saved " + (folder / file_).string()) : say(saved.error());
}

void Draw::open_file() {
  commit();
  std::error_code unknown;
  if (file_.empty()) return say("Type the name of a file first");
  const auto opened = open_drawing(std::filesystem::current_path(unknown) / file_);
  if (!opened) return say(opened.error());
  Drawing next = history_.now();
  for (const DrawnMark& mark : opened->drawing.marks) next.add(mark);
  commit(std::move(next));
  const std::size_t lost = opened->left_out + opened->complaints.size();
  say(fmt::format("{} marks added{}", opened->drawing.marks.size(),
                  lost == 0 ? "" : fmt::format("; {} parts of the file cannot be marks, and are left out", lost)));
}

}  // namespace terrella
