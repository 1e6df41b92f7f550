#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

namespace terrella {

/// A thread for the OpenGL context of one globe, so that Python may call the globe from any of its threads. thread: any
class GlThread {
 public:
  GlThread() : thread_([this](const std::stop_token& end) { serve(end); }) {}

  /// Runs `work` on the thread and returns what it returned, or throws what it threw. Calls wait for each other.
  template <class Work>
  auto run(Work&& work) {
    const std::lock_guard one_at_a_time(callers_);
    std::packaged_task<decltype(work())()> task(std::forward<Work>(work));
    auto done = task.get_future();
    {
      const std::lock_guard lock(mutex_);
      job_ = [&task] { task(); };
    }
    wake_.notify_one();
    return done.get();
  }

 private:
  void serve(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    while (wake_.wait(lock, end, [this] { return job_ != nullptr; })) {
      const std::function<void()> job = std::exchange(job_, nullptr);
      lock.unlock();
      job();
      lock.lock();
    }
  }

  std::mutex callers_, mutex_;
  std::condition_variable_any wake_;
  std::function<void()> job_;
  std::jthread thread_;  // the last member: the others outlive it
};

}  // namespace terrella
