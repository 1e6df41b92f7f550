#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/profile/profile_samples.h"

namespace terrella {

/// The heights of the ground and the numbers of a layer along a measured path, as a plot and as a table. Owns the
/// panel. thread: main for every call
class Profile : public Panel {
 public:
  /// `path` returns the places of the path; fewer than two: none. `numbers` returns the layer whose numbers are shown.
  Profile(const ViewerContext& context, std::function<std::vector<Geodetic>()> path,
          std::function<std::optional<ProfileNumbers>()> numbers)
      : Panel(context, "Profile"), path_(std::move(path)), numbers_(std::move(numbers)) {}

  [[nodiscard]] std::string job() const override;
  [[nodiscard]] bool changed() const override;

 private:
  using Answer = std::future<Result<double, TileFailure>>;

  void draw_open(float foot) override;
  void draw_contents();
  void draw_plot(const char* name, const std::string& unit, std::optional<double> ProfileSample::*what,
                 double per_unit = 1.0);
  void follow();        ///< makes the samples anew if the path or the layer has changed
  void ask();           ///< asks for the values of the next samples
  void take_answers();  ///< those that have come
  void save() const;

  std::function<std::vector<Geodetic>()> path_;
  std::function<std::optional<ProfileNumbers>()> numbers_;
  std::vector<Geodetic> shown_path_;
  std::optional<ProfileNumbers> shown_numbers_;
  std::vector<ProfileSample> samples_;
  std::deque<Answer> open_;   ///< answers for the samples from `answered_` on
  std::size_t answered_ = 0;  ///< samples whose values have come
};

}  // namespace terrella
