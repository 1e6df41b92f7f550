#include "globe/ground_painter.h"

#include <algorithm>
#include <atomic>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "tiles/late_workers.h"

namespace terrella {
namespace {

constexpr unsigned kMostPainters = 8;

}  // namespace

struct GroundPainter::Shared {
  std::shared_ptr<ArrivalBell> bell;
  Paint work;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::condition_variable asked;
  // Guarded by the mutex.
  std::deque<GroundJob> waiting;
  std::unordered_set<PatchId, PatchIdHash> painting;
  std::vector<PaintedGround> done;
};

GroundPainter::GroundPainter(std::shared_ptr<ArrivalBell> bell, Paint paint) : shared_(std::make_shared<Shared>()) {
  shared_->bell = std::move(bell);
  shared_->work = std::move(paint);
}

GroundPainter::~GroundPainter() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = true;
  }
  shared_->asked.notify_all();
  for (std::future<void>& worker : workers_) end_late(std::move(worker));
}

// Paints the first picture that waits. The lock is held before and after.
void GroundPainter::paint(Shared& shared, std::unique_lock<std::mutex>& lock, GroundCanvas& canvas) {
  const GroundJob job = std::move(shared.waiting.front());
  shared.waiting.pop_front();
  shared.painting.insert(job.id);
  lock.unlock();
  PaintedGround done{job.id, job.stretch, job.revision, {}};
  try {
    done.picture = shared.work(job, shared.stop, canvas);
  } catch (const std::bad_alloc&) {
    done.is_painted = false;
    canvas.forget();
  }
  lock.lock();
  if (shared.stop) return;
  shared.done.push_back(std::move(done));
  lock.unlock();
  shared.bell->ring();
  lock.lock();
}

void GroundPainter::work(const std::shared_ptr<Shared>& shared) {
  GroundCanvas canvas;
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->asked.wait(lock, [&] { return shared->stop || !shared->waiting.empty(); });
    if (shared->stop) return;
    paint(*shared, lock, canvas);
  }
}

void GroundPainter::start() {
  const unsigned count = std::clamp(std::thread::hardware_concurrency(), 1U, kMostPainters);
  try {
    while (workers_.size() < count) {
      workers_.push_back(std::async(std::launch::async, [shared = shared_] { work(shared); }));
    }
  } catch (const std::system_error&) {  // the system has no more threads
  }
}

void GroundPainter::ask(std::deque<GroundJob> jobs) {
  if (workers_.empty() && !jobs.empty()) start();
  std::unique_lock lock(shared_->mutex);
  std::erase_if(jobs, [this](const GroundJob& job) { return shared_->painting.contains(job.id); });
  shared_->waiting = std::move(jobs);
  if (workers_.empty() && !shared_->waiting.empty()) {
    GroundCanvas canvas;
    paint(*shared_, lock, canvas);
  }
  lock.unlock();
  shared_->asked.notify_all();
}

bool GroundPainter::is_painting(const PatchId& id) const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->painting.contains(id);
}

bool GroundPainter::has_news() const {
  const std::lock_guard lock(shared_->mutex);
  return !shared_->done.empty();
}

std::vector<PaintedGround> GroundPainter::take() {
  const std::lock_guard lock(shared_->mutex);
  std::vector<PaintedGround> done = std::exchange(shared_->done, {});
  for (const PaintedGround& one : done) shared_->painting.erase(one.id);
  return done;
}

}  // namespace terrella
