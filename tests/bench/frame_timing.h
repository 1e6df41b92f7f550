#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/globe.h"

namespace terrella::bench {

/// Something whose frames are timed, and what they took.
struct Subject {
  std::string name;
  std::function<void()> draw;
  std::vector<double> ms = {};
  std::vector<double> cpu_ms = {};  ///< processor time of the whole process: what other programs do does not change it
};

/// Draws the subjects in turn, so that what else the machine does meets them alike; two rounds before the first counts.
void time_frames(std::vector<Subject>& subjects, int rounds);

[[nodiscard]] double median(std::vector<double> values);

/// A globe on a tile set that uploads all it has at once, so that it settles soon. Throws std::runtime_error with the
/// tile set's or the context's complaint. thread: that of the current OpenGL context
[[nodiscard]] std::unique_ptr<Globe> open_globe(const std::string& tile_set, Texturing texturing, bool unlit);

}  // namespace terrella::bench
