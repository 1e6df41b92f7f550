#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "globe/globe.h"

namespace terrella::bench {

/// A subject whose frames are timed, with its times by round.
struct Subject {
  std::string name;
  std::function<void()> draw;
  std::vector<double> ms = {};        ///< GPU time by a timer query; wall time to the end of glFinish on software GL
  std::vector<double> cpu_ms = {};    ///< processor time of the whole process, unaffected by other programs
  std::vector<double> whole_ms = {};  ///< a whole frame: wall time to the end of glFinish; on software GL, cpu_ms
};

/// Processor time of the whole process so far.
[[nodiscard]] double processor_ms();

struct FrameTime {
  double ms = 0.0;        ///< as Subject::ms
  double cpu_ms = 0.0;    ///< as Subject::cpu_ms
  double whole_ms = 0.0;  ///< as Subject::whole_ms
};
[[nodiscard]] FrameTime time_frame(const std::function<void()>& draw);

/// Draws the subjects in turn, so that other load affects them alike; two warm-up rounds do not count.
void time_frames(std::vector<Subject>& subjects, int rounds);

[[nodiscard]] double median(std::vector<double> values);
/// Median over the rounds of one subject's time divided by the other's in the same round. Temporary slowdowns affect
/// both alike. The lists have equal lengths of at least one.
[[nodiscard]] double median_ratio(const std::vector<double>& times, const std::vector<double>& base);

/// renderer_name() names the current context's renderer. timing_method() describes the timing; timer queries of a
/// software rasteriser are meaningless.
[[nodiscard]] std::string renderer_name();
[[nodiscard]] std::string timing_method();

/// Opens a globe on a tile set with unlimited uploads per frame, so that views settle quickly. Throws
/// std::runtime_error with the message of the tile set or the context. thread: that of the current OpenGL context
[[nodiscard]] std::unique_ptr<Globe> open_globe(const std::string& tile_set, Texturing texturing, bool unlit);
[[nodiscard]] std::unique_ptr<Globe> open_globe(const std::string& tile_set, GlobeOptions options);

}  // namespace terrella::bench
