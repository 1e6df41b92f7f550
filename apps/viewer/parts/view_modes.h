#pragma once

#include <functional>
#include <optional>
#include <span>

#include "apps/viewer/action.h"
#include "apps/viewer/panels/view_settings.h"
#include "apps/viewer/parts/part.h"
#include "apps/viewer/parts/time_play.h"
#include "apps/viewer/parts/underground.h"

namespace terrella {

/// Changes how the globe looks: opacity, stereo, sky, time, exaggeration, under the ground. Owns the view panel and the
/// modes of the start, to which reset() returns. thread: main for every call
class ViewModes : public Panel {
 public:
  /// Actions with a button get one in the panel; a click calls `run`.
  ViewModes(const ViewerContext& context, std::span<const Action> actions, std::function<void(const Action&)> run);

  void next_opacity();
  void next_stereo();
  void toggle_sky();
  [[nodiscard]] bool has_sky() const { return sky_; }
  void toggle_underground() { underground_.toggle(); }
  void toggle_play() { play_.play(!play_.is_playing()); }
  [[nodiscard]] TimePlay& play() { return play_; }
  [[nodiscard]] bool changed() const override { return play_.changed(); }
  /// Returns to the modes of the start, and flies to the whole globe with north up. Modes that the user has changed are
  /// reset by a second call soon after the first, which asks.
  void reset();

 private:
  void draw_open(float foot) override;
  void apply(const ViewSettings& settings);
  void set_time(std::optional<UtcTime> time);
  [[nodiscard]] ViewSettings modes() const;
  [[nodiscard]] bool is_as_started() const;

  std::span<const Action> actions_;
  std::function<void(const Action&)> run_;
  Underground underground_;
  TimePlay play_;
  bool sky_;
  ViewSettings start_;         ///< modes at the start
  Seconds reset_until_{-1.0};  ///< a second reset() does not ask until then
  ViewSettings settings_;      ///< settings in the panel, with the text as typed so far
};

}  // namespace terrella
