#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "globe/globe.h"

namespace terrella::bench {

/// Something whose frames are timed, and what they took, round by round.
struct Subject {
  std::string name;
  std::function<void()> draw;
  std::vector<double> ms = {};      ///< of the GPU by a timer query; on software GL wall time to the end of glFinish
  std::vector<double> cpu_ms = {};  ///< processor time of the whole process: what other programs do does not change it
};

struct FrameTime {
  double ms = 0.0;      ///< as Subject::ms
  double cpu_ms = 0.0;  ///< as Subject::cpu_ms
};
[[nodiscard]] FrameTime time_frame(const std::function<void()>& draw);

/// Draws the subjects in turn, so that what else the machine does meets them alike; two rounds before the first counts.
void time_frames(std::vector<Subject>& subjects, int rounds);

[[nodiscard]] double median(std::vector<double> values);
/// Median over the rounds of one subject's time over the other's in the same round: what slows the machine down for a
/// while slows both. Of equally many, at least one.
[[nodiscard]] double median_ratio(const std::vector<double>& times, const std::vector<double>& base);

/// The current context's renderer, and how its frames are timed: a software rasteriser's timer queries say nothing.
[[nodiscard]] std::string renderer_name();
[[nodiscard]] std::string timing_method();

/// A globe on a tile set that uploads all it has at once, so that it settles soon. Throws std::runtime_error with the
/// tile set's or the context's complaint. thread: that of the current OpenGL context
[[nodiscard]] std::unique_ptr<Globe> open_globe(const std::string& tile_set, Texturing texturing, bool unlit);
[[nodiscard]] std::unique_ptr<Globe> open_globe(const std::string& tile_set, GlobeOptions options);

}  // namespace terrella::bench
