#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/timeline/joined_steps.h"
#include "view/navigation.h"

namespace terrella {

/// A shown layer of images that has instants.
struct TimedLayer {
  LayerId id = LayerId::none;
  std::string name;
  std::shared_ptr<const TimeSteps> steps;
  bool follows = false;  ///< its date follows the globe's time (LayerClock)
};

/// Shows layers at the instants that they have, and plays them. Owns the panel. The next instant is asked for once the
/// last one is on the screen, so a slow server slows the play down and no instant is left out. thread: main for every
/// call
class Timeline : public Panel {
 public:
  /// `layers` returns the shown layers with instants, the highest first.
  Timeline(const ViewerContext& context, std::function<std::vector<TimedLayer>()> layers)
      : Panel(context, "Dates"), layers_(std::move(layers)) {}

  /// The instants on the screen, each with its layer if there are several.
  [[nodiscard]] std::vector<std::string> shown() const;
  /// Asks for the next instant if it is time for it, else loads it. Call it once per frame.
  void advance();

  [[nodiscard]] bool changed() const override;
  /// Seconds until the next instant, at most `most_s`; `most_s` while pausing.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  void draw_open(float foot) override;
  [[nodiscard]] bool can_open() override;
  void draw_contents(const std::vector<TimedLayer>& layers);
  void draw_buttons(const JoinedSteps& steps);
  void draw_slider(const JoinedSteps& steps);
  void draw_choices();
  void draw_dates(const std::vector<TimedLayer>& layers) const;
  void play(bool on);
  void step(bool backwards);
  void go(UtcTime time);
  /// The instant that was asked for last of these layers; else the one that the highest layer shows.
  [[nodiscard]] UtcTime now(const std::vector<TimedLayer>& layers) const;
  [[nodiscard]] bool is_coming() const;

  std::function<std::vector<TimedLayer>()> layers_;
  std::optional<UtcTime> asked_;   ///< the instant that was asked for last
  std::vector<LayerId> asked_of_;  ///< the layers that there were then
  std::optional<double> dragged_;  ///< place of the slider while it is held, from 0 to 1
  StepPlay play_;
  bool playing_ = false, local_ = false;
  int speed_ = 1;         ///< index of the speeds
  Seconds stepped_{0.0};  ///< time of the last step
};

}  // namespace terrella
