#pragma once

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
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
  /// Paints a picture, perhaps on several threads at once. Ends early once the flag is set.
  using Paint = std::function<GroundPicture(const GroundJob&, const std::atomic<bool>& stop, GroundCanvas&)>;

  explicit GroundPainter(std::shared_ptr<ArrivalBell> bell, Paint paint = paint_job);
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
  static GroundPicture paint_job(const GroundJob& job, const std::atomic<bool>& stop, GroundCanvas& canvas) {
    return paint_ground(square_of(job.id), job.layers, job.stretch, stop, canvas);
  }
  void start();
  static void paint(Shared& shared, std::unique_lock<std::mutex>& lock, GroundCanvas& canvas);
  static void work(const std::shared_ptr<Shared>& shared);
  std::shared_ptr<Shared> shared_;
  std::vector<std::future<void>> workers_;
};

}  // namespace terrella
