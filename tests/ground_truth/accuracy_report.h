#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/truth/judge.h"
#include "ground_truth/accuracy_views.h"

namespace terrella::truth {

/// A line of the table: a zone of a view.
struct AccuracyLine {
  std::string view;
  std::string zone;
  double rms = 0.0;  ///< 8-bit levels; for the limb the share of pixels that are off, in percent
  double max = 0.0;
  std::size_t pixels = 0;
  double limit = 0.0;  ///< NaN: none
  double render_s = 0.0;
  [[nodiscard]] bool fails() const { return rms > limit; }
};

/// All that is held against a view: each zone that is in the picture, its bounds, the antimeridian and the tile borders
/// against what lies beside them, the limb. `earlier` are the judgements of the views before, for bounds that refer to
/// them.
struct JudgedView {
  AccuracyView view;
  Judgement judgement;
  double render_s = 0.0;
};
[[nodiscard]] std::vector<AccuracyLine> lines_of(const JudgedView& judged, const std::vector<JudgedView>& earlier);

[[nodiscard]] std::string as_table(const std::vector<AccuracyLine>& lines);
void write_csv(const std::vector<AccuracyLine>& lines, const std::filesystem::path& file);

}  // namespace terrella::truth
