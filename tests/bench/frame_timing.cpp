#include "bench/frame_timing.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>

#include <epoxy/gl.h>

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRoundsToWarmUp = 2;

double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace

void time_frames(std::vector<Subject>& subjects, int rounds) {
  for (int round = -kRoundsToWarmUp; round < rounds; ++round) {
    for (Subject& subject : subjects) {
      glFinish();
      const auto start = Clock::now();
      const double cpu_start = processor_ms();
      subject.draw();
      glFinish();
      const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
      if (round < 0) continue;
      subject.ms.push_back(ms);
      subject.cpu_ms.push_back(processor_ms() - cpu_start);
    }
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::unique_ptr<Globe> open_globe(const std::string& tile_set, Texturing texturing, bool unlit) {
  GlobeOptions options;
  options.texturing = texturing;
  options.unlit = unlit;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  Result<std::unique_ptr<TileSource>> source = open_tile_set(tile_set);
  if (!source) throw std::runtime_error(source.error().message);
  Result<std::unique_ptr<Globe>> made = Globe::create(options, std::shared_ptr<TileSource>(std::move(*source)));
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

}  // namespace terrella::bench
