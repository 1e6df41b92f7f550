#pragma once

#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <unordered_set>
#include <vector>

#include "objects/ground/ground_picture.h"
#include "surface/patch_id.h"
#include "tiles/arrival_bell.h"

namespace terrella {

/// The square of a patch on its face.
[[nodiscard]] inline FaceSquare square_of(const PatchId& id) {
  const double side = std::ldexp(2.0, -id.level);
  return {id.face, -1.0 + side * id.x, -1.0 + side * id.y, side};
}

/// A picture to paint. `layers` are shared with the globe.
struct GroundJob {
  PatchId id;
  std::vector<GroundChunks> layers;
  double stretch = 1.0;
  std::uint64_t revision = 0;
};
struct PaintedGround {
  PatchId id;
  double stretch = 1.0;
  std::uint64_t revision = 0;
  GroundPicture picture;
  bool is_painted = true;  ///< false: there was no memory
};

/// Threads that paint pictures of the ground, begun by the first job. If the system has no thread left, each ask()
/// paints one picture. The destructor stops the threads and does not wait. thread: main
class GroundPainter {
 public:
  explicit GroundPainter(std::shared_ptr<ArrivalBell> bell);
  ~GroundPainter();
  GroundPainter(const GroundPainter&) = delete;
  GroundPainter& operator=(const GroundPainter&) = delete;

  /// Replaces the jobs that wait.
  void ask(std::deque<GroundJob> jobs);
  [[nodiscard]] bool is_painting(const PatchId& id) const;
  [[nodiscard]] bool has_news() const;
  [[nodiscard]] std::vector<PaintedGround> take();

 private:
  struct Shared;
  void start();
  static void paint(Shared& shared, std::unique_lock<std::mutex>& lock, GroundCanvas& canvas);
  static void work(const std::shared_ptr<Shared>& shared);
  std::shared_ptr<Shared> shared_;
  std::vector<std::future<void>> workers_;
};

}  // namespace terrella
