#pragma once

#include <string>
#include <utility>

#include "apps/viewer/panels/ui.h"
#include "apps/viewer/parts/messages.h"
#include "apps/viewer/window.h"
#include "geo/coordinates.h"
#include "globe/globe.h"
#include "view/navigation.h"

namespace terrella {

/// The objects that every part of the viewer works on. They outlive the parts.
struct ViewerContext {
  Window& window;
  Globe& globe;
  Navigator& navigator;
  Ui& ui;
  Messages& messages;

  /// Centre of the picture, framebuffer pixels. thread: main
  [[nodiscard]] glm::dvec2 middle_px() const {
    const Viewport size = window.framebuffer();
    return 0.5 * glm::dvec2(size.width_px, size.height_px);
  }
};

/// Flies to a view of the whole rectangle. thread: main
void fly_over(const ViewerContext& context, const GeoRect& bounds);

/// A tool of the viewer with its own state. Parts do not know each other; the viewer draws them, wakes up for them and
/// passes Esc to them. thread: main for every call
class Part {
 public:
  explicit Part(const ViewerContext& context) : context_(context) {}
  virtual ~Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  /// Draws the part's panel, if open, between Ui::begin_frame() and Ui::end_frame(). The status line uses `foot` units
  /// of the window at the lower edge.
  virtual void draw(float foot) { (void)foot; }
  /// Title of the open panel; null if no panel is open that takes mouse and keyboard.
  [[nodiscard]] virtual const char* panel() const { return nullptr; }
  /// Gives the keyboard to the open panel in the next frame.
  virtual void take_keyboard() {}
  /// Text of the running job and its progress; empty if no job runs.
  [[nodiscard]] virtual std::string job() const { return {}; }
  /// True if another frame would show something new.
  [[nodiscard]] virtual bool changed() const { return false; }
  /// Cancels the running job; false if no job runs.
  virtual bool cancel() { return false; }
  /// Closes the panel or ends the tool; false if neither is in use.
  virtual bool close() { return false; }

 protected:
  void say(const std::string& text) const { context_.messages.say(text); }
  void say(const Error& fault) const { context_.messages.say(fault); }

  const ViewerContext context_;
};

/// A part with a panel that opens and closes. thread: main for every call
class Panel : public Part {
 public:
  /// `title` of the panel's window; null: the panel takes neither mouse nor keyboard.
  Panel(const ViewerContext& context, const char* title) : Part(context), title_(title) {}

  /// Opens or closes the panel. A covered panel comes to the front.
  void toggle() {
    open_ = covered_ || (!open_ && can_open());
    just_opened_ = open_;
    covered_ = false;
    if (open_) opened_ = context_.ui.next_panel();
    toggled();
  }
  [[nodiscard]] bool is_open() const { return open_; }
  [[nodiscard]] const char* panel() const override { return open_ && !covered_ ? title_ : nullptr; }
  [[nodiscard]] const char* title() const { return title_; }
  /// Greater than that of a panel that was opened earlier.
  [[nodiscard]] unsigned opened() const { return opened_; }
  /// A covered panel is neither drawn nor closed, until newer panels leave room.
  void cover(bool covered) { covered_ = covered; }
  [[nodiscard]] bool is_covered() const { return covered_; }
  void take_keyboard() override { just_opened_ = true; }
  bool close() override {
    if (!open_ || covered_) return false;
    toggle();
    return true;
  }
  void draw(float foot) override;

 protected:
  virtual void draw_open(float foot) = 0;
  virtual bool can_open() { return true; }
  virtual void toggled() {}
  /// True once after the panel was opened or got the keyboard.
  [[nodiscard]] bool take_just_opened() { return std::exchange(just_opened_, false); }

 private:
  const char* title_;
  bool open_ = false;
  bool covered_ = false;
  unsigned opened_ = 0;
  bool just_opened_ = false;
};

}  // namespace terrella
