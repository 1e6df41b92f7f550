#pragma once

#include <random>

#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella::test {

/// After a leg of a flight.
struct MemorySample {
  std::int64_t frames = 0;     ///< since the start
  double resident_mb = 0.0;    ///< memory of the whole process, a software driver's textures with it
  double heap_mb = 0.0;        ///< memory that the process has allocated and not freed
  int uncovered = 0;           ///< frames of the leg in which a patch had no imagery at all
  std::size_t finished = 0;    ///< tiles of imagery that wait to be uploaded
  FrameStats last;             ///< statistics of the leg's last frame
  std::size_t most_held = 0;   ///< FrameStats::patches_held, the leg's greatest
  std::size_t most_known = 0;  ///< FrameStats::tiles_known, the leg's greatest
};

/// A flight without an end over a planet that has tiles everywhere, made when they are asked for: up to orbit, down to
/// a street, along the horizon, over a pole, over ±180°, each time elsewhere. Two image layers, heights and objects,
/// the objects others on each leg, and the upper layer removed and added now and then. thread: main, a context current
class MemoryFlight {
 public:
  static constexpr std::size_t kGpuBytes = 24UL << 20;
  static constexpr std::size_t kHeightBytes = 2UL << 20;

  MemoryFlight(Viewport size, int frames_of_leg, unsigned seed);
  /// The next leg.
  [[nodiscard]] MemorySample fly();

 private:
  [[nodiscard]] Camera next_end();
  void change_layers();

  Viewport size_;
  int frames_of_leg_;
  std::mt19937 random_;
  OffscreenTarget target_;
  std::unique_ptr<Globe> globe_;
  LayerId above_ = LayerId::none;
  LayerId objects_ = LayerId::none;
  std::int64_t frames_ = 0;
  int legs_ = 0;
};

}  // namespace terrella::test
