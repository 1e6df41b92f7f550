#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <utility>

#include "apps/process/console.h"
#include "apps/viewer/panels/control_column.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/panels/panel_fonts.h"

namespace terrella {
namespace {

constexpr std::chrono::seconds kHintTime(30);
constexpr const char* kHint = "Drag to turn the globe, use the wheel to zoom. P opens settings, F1 lists shortcuts.";
constexpr double kLoadingPause_s = 1.0 / 60.0;  // between checks for arrived tiles
constexpr double kIdlePause_s = 1.0;            // between retries of failed tiles
constexpr double kShareOfWait = 0.1;            // a pause, as a share of the time waited so far
constexpr double kTinyWindow = 22.0;            // height, in text heights
constexpr double kRoomForBoth = 20.0;           // width, in text heights, for balloon and buttons

}  // namespace

Viewer::Viewer(Window& window, Globe& globe, const ViewerOptions& options)
    : window_(window),
      globe_(globe),
      options_(options),
      ui_(window),
      navigator_(options.camera, globe.ground(), window.framebuffer()),
      input_(window, ui_, navigator_, actions()),
      layers_(context_, options.layers, options.heights, options.scene.base, switches()),
      modes_(context_, actions(), [this](const Action& action) { action.run(*this); }),
      cutting_(context_, std::exchange(options_.cuts, {})) {
  graticule_.is_on() = options.scene.graticule.value_or(options.kept.graticule);
  map_.is_on() = options.map;
  ui_.use_units(options.units);
  if (options.hold_session) projects_.hold_session();
  if (options.kept.panel) modes_.toggle();
  if (options.kept.layers) layers_.toggle();
  saved_ = options.kept;
  started_ = now_kept();
  if (options.first_run) messages_.say(kHint, kHintTime);
  if (!options.message.empty()) messages_.say(options.message);
  input_.set_dragger(
      [this](DragStep step, glm::dvec2 at_px) { return swipe_.drag(step, at_px) || draw_.drag(step, at_px); });
  draw_.restore(options.scene);
  for (const LayerRow& row : options.layers) {
    if (row.kind == LayerKind::objects) flights_.look_into(row.objects.file, false);
    if (last_attribution_.empty()) last_attribution_ = row.attribution;
  }
  if (!options.flight.empty()) flights_.open(options.flight);
}

std::optional<NextScene> Viewer::run() {
  for (SourceOptions& file : std::exchange(options_.open, {})) {
    flights_.look_into(file.address.with_secrets(), true);
    layers_.open(std::move(file));
  }
  while (!is_closed()) {
    wait_for_work();
    handle_events();
    const Viewport framebuffer = window_.framebuffer();
    if (framebuffer.width_px <= 0 || framebuffer.height_px <= 0) continue;
    const bool dirty = input_.take_dirty();
    if (panel_frames_ > 0) --panel_frames_;
    const bool panels = front_panel() != nullptr || input_.is_over_panel();
    if ((dirty || ui_.has_waiting()) && panels) panel_frames_ = kPanelFrames;
    modes_.play().advance(Input::now());
    timeline_.advance();
    flights_.advance(Input::now());
    keep_.advance();
    navigator_.set_viewport(framebuffer);
    tell_of_finest_texels();
    navigator_.advance(Input::now());
    history_.follow(navigator_.camera(), navigator_.at_rest(), Input::now());
    draw_frame(framebuffer);
    follow_panels();
    print_at_rest();
  }
  keep_settings();
  projects_.keep_session();
  return projects_.next();
}

// Reports once that the zoom has reached the finest texels.
void Viewer::tell_of_finest_texels() {
  navigator_.set_finest_texel(globe_.finest_texel_m());
  const bool there = navigator_.is_at_texels();
  if (there && !was_at_texels_) messages_.say("The imagery has no finer detail. Zoom in again to go closer.");
  was_at_texels_ = there;
}

void Viewer::handle_events() {
  for (const InputEvent& event : input_.take_events()) {
    if (event.action != nullptr) event.action->run(*this);
    if (event.action == nullptr && help_.close()) continue;  // a click closes the list of shortcuts
    if (event.action == nullptr && event.button == PointerButton::left) click(event.at_px);
    const bool right = event.action == nullptr && event.button == PointerButton::right;
    if (right && !draw_.right_click()) menu_.open_at(event.at_px);
  }
  input_.set_double_clicks(!measure_.is_on() && !draw_.is_sketching());
  if (const auto key = input_.take_bookmark()) {
    key->set ? bookmarks_.save(key->number) : bookmarks_.fly_to(key->number);
  }
  for (const std::filesystem::path& file : input_.take_dropped()) open_file(file);
  cutting_.add(layers_.take_opened());
  for (OtherBodyFile& file : layers_.take_other_bodies()) question_.ask(std::move(file));
  if (layers_.take_open_wish()) open_.toggle();
  if (auto layer = layers_.take_list_wish()) list_.open(*std::move(layer));
  if (auto layer = layers_.take_keep_wish()) keep_.open(*layer);
  follow_panels();
}

// The open panel that takes mouse and keyboard first; null if there is none.
Part* Viewer::front_panel() const {
  const auto front = std::ranges::find_if(parts_, [](const Part* part) { return part->panel() != nullptr; });
  return front == parts_.end() ? nullptr : *front;
}

// Panels take events while one is open.
void Viewer::follow_panels() {
  Part* front = front_panel();
  if (front == front_) return;
  front_ = front;
  ui_.take_events(front != nullptr);
  if (front != nullptr) front->take_keyboard();
  panel_frames_ = kPanelFrames;
}

// True if another frame would differ.
bool Viewer::work() const {
  if (input_.dirty() || ui_.has_waiting() || panel_frames_ > 0 || button_held_ || navigator_.animating() ||
      job() != job_text_)
    return true;
  if (std::ranges::any_of(parts_, [](const Part* part) { return part->changed(); })) return true;
  if (!pictures_.is_drawing() && globe_.needs_frame()) return true;
  return messages_.is_due() || messages_.has_waiting() || glfwWindowShouldClose(window_.handle()) == GLFW_TRUE;
}

// The longer tiles have not come, the longer the pause: a slow server must not keep the processor busy.
double Viewer::pause_s(Seconds waited) const {
  if (globe_.settled() && job().empty()) return kIdlePause_s;
  return std::clamp(kShareOfWait * waited.count(), kLoadingPause_s, kIdlePause_s);
}

void Viewer::wait_for_work() {
  if (work()) return input_.listen();
  keep_settings();
  projects_.keep_session();
  const Seconds start = Input::now();
  do {
    const double pause = balloon_.seconds_left(messages_.seconds_left(pause_s(Input::now() - start)));
    input_.listen(modes_.play().seconds_left(timeline_.seconds_left(pause)));
  } while (!work());
}

std::string Viewer::job() const {
  for (const Part* part : parts_) {
    if (std::string text = part->job(); !text.empty()) return text;
  }
  return {};
}

void Viewer::draw_frame(Viewport framebuffer) {
  const auto start = Clock::now();
  globe_.set_camera(nameable(navigator_.camera()));
  layers_.follow_view(framebuffer);
  if (pictures_.is_drawing()) {
    pictures_.draw_picture(framebuffer);
    frame_.drop();                                              // the globe was drawn at another size
    if (!pictures_.is_drawing()) panel_frames_ = kPanelFrames;  // the globe returns
  } else {
    frame_.draw(globe_, framebuffer);
    const std::string fault = globe_.status() ? std::string() : globe_.status().error().message;
    if (fault != std::exchange(said_fault_, fault) && !fault.empty()) messages_.say(Error{fault});
    layers_.watch_tiles(frame_.stats());
    const std::string note = memory_note(globe_.options().gpu_bytes >> 20, globe_.last_frame());
    if (!note.empty() && !std::exchange(said_memory_, true)) messages_.say(note);
    const std::string letters = font_note(globe_.last_frame());
    if (letters != std::exchange(said_letters_, letters)) messages_.say(letters);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, framebuffer.width_px, framebuffer.height_px);
  draw_panels(framebuffer);
  layers_.note_looks();
  const bool whole = panel_frames_ == 0 && !letters_wait();  // a newly opened panel is not drawn yet
  if (whole) pictures_.after_frame(framebuffer);
  glfwSwapBuffers(window_.handle());
  messages_.end_frame();
  frame_graph_.note(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
}

void Viewer::draw_panels(Viewport framebuffer) {
  const View view = globe_.view(framebuffer);
  messages_.begin_frame();
  job_text_ = job();
  labels_.clear();
  map_.update(frame_graph_.last_ms());
  ui_.begin_frame();
  if (help_.is_open()) {
    help_.draw(0.0F);
  } else {
    // A tiny window shows an open panel alone.
    const bool tiny = window_height() < kTinyWindow * Ui::text_height();
    const bool alone = tiny && (front_panel() != nullptr || balloon_.is_in_view());
    const float foot = alone ? 0.0F : draw_texts(status(view));
    for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) (*part)->draw(foot);
    if (!alone) draw_legend(foot, false);
    if (!pictures_.is_drawing()) draw_over_panels(view, foot);
    cover_panels(framebuffer);
  }
  if (options_.print_panels) panels_text_ = Ui::boxes_text(labels_);
  ui_.end_frame();
}

// A pointer that rests on the globe gets a name, while no button is held and nothing moves.
void Viewer::draw_balloon(const View& view, float foot) {
  const bool busy =
      input_.is_over_panel() || input_.is_button_held() || measure_.is_on() || draw_.is_sketching() || menu_.is_open();
  balloon_.draw_over(view, busy || !navigator_.at_rest() ? std::nullopt : input_.cursor_px(), foot);
}

// Draws items where the panels leave room.
void Viewer::draw_over_panels(const View& view, float foot) {
  const auto cursor_px = input_.is_over_panel() ? std::nullopt : input_.cursor_px();
  swipe_.draw_over(view);
  measure_.draw_over(view, cursor_px, foot);
  draw_.draw_over(view, cursor_px);
  const bool narrow = view.viewport.width_px < kRoomForBoth * Ui::text_height() * window_.pixels_per_unit().x;
  if (narrow) draw_balloon(view, foot);  // has the room of the buttons
  const ControlColumn column = draw_control_column(actions(), navigator_.camera().heading);
  button_held_ = column.held;
  if (column.clicked != nullptr) column.clicked->run(*this);
  if (!narrow) draw_balloon(view, foot);
  // Lines first. Names keep off panels, objects' labels and the graticule's labels.
  map_.draw_lines(view);
  const std::vector<UiBox> panels = Ui::panel_boxes();
  const auto taken = [&] {
    std::vector<UiBox> boxes = panels;
    boxes.insert(boxes.end(), labels_.begin(), labels_.end());
    return boxes;
  };
  labels_ = object_labels(globe_, window_.pixels_per_unit().x);
  std::ranges::move(graticule_.draw_over(view, double(foot), taken()), std::back_inserter(labels_));
  std::ranges::move(map_.draw_names(view, taken()), std::back_inserter(labels_));
}

// Draws the texts that the panels leave room. Returns the height of those at the lower edge.
float Viewer::draw_texts(const PanelStatus& status) {
  const float foot = frame_graph_.draw_above(draw_status(status, window_.pixels_per_unit().x), frame_.stats());
  draw_legend(foot, true);
  draw_message(status, foot);
  draw_head(status);
  return foot;
}

// A picture that is being saved brings its own legend.
void Viewer::draw_legend(float foot, bool before_panels) const {
  if (!pictures_.is_drawing()) layers_.draw_legend(foot, before_panels);
}

// In a small window the panel that was opened last is in front; panels that it covers wait until it closes.
void Viewer::cover_panels(Viewport framebuffer) {
  std::array<Panel*, 16> newest{&keep_, &question_,  &pictures_, &profile_, &timeline_,  &search_, &open_,   &projects_,
                                &body_, &catalogue_, &list_,     &flights_, &bookmarks_, &draw_,   &layers_, &modes_};
  std::ranges::sort(newest, std::ranges::greater(), &Panel::opened);
  std::vector<UiBox> front;
  const bool resized = std::exchange(panels_size_, framebuffer) != framebuffer;  // covered panels have other places now
  if (resized) panel_frames_ = kPanelFrames;
  for (Panel* panel : newest) {
    if (resized) panel->cover(false);
    const auto box = panel->is_open() ? Ui::panel_box(panel->title()) : std::nullopt;
    if (!box || resized) continue;
    const bool covered = std::ranges::any_of(front, [&box](const UiBox& other) { return other.overlaps(*box); });
    if (covered != panel->is_covered()) panel_frames_ = kPanelFrames;
    panel->cover(covered);
    if (!covered) front.push_back(*box);
  }
}

void Viewer::print_at_rest() {
  const auto print = [](std::string text, std::string& printed) {
    if (text == printed) return;
    printed = std::move(text);
    print_result("{}\n", printed);
    std::fflush(stdout);
  };
  if (!navigator_.at_rest()) return;
  if (options_.print_camera) print(camera_text(navigator_.camera()), printed_camera_);
  if (options_.print_panels && panel_frames_ == 0) print(panels_text_, printed_panels_);
}

}  // namespace terrella
