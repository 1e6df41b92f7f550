#include "apps/bench/frame_timing.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <string_view>

#include <epoxy/gl.h>

#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRoundsToWarmUp = 2;

std::string gl_text(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? std::string() : text;
}

// True if the current context renders on the processor, where timer queries measure nothing.
bool is_software_gl() {
  constexpr std::array<std::string_view, 5> kSoftware{"llvmpipe", "softpipe", "swrast", "SWR", "SwiftShader"};
  return std::ranges::any_of(kSoftware, [renderer = gl_text(GL_RENDERER)](std::string_view name) {
    return renderer.find(name) != std::string::npos;
  });
}

}  // namespace

double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

FrameTime time_frame(const std::function<void()>& draw) {
  GLuint query = 0;
  if (!is_software_gl()) glGenQueries(1, &query);
  glFinish();
  const double cpu_start = processor_ms();
  const auto start = Clock::now();
  if (query != 0) glBeginQuery(GL_TIME_ELAPSED, query);
  draw();
  if (query != 0) glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  const double wall_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count(),
               cpu_ms = processor_ms() - cpu_start;
  if (query == 0) return {wall_ms, cpu_ms, cpu_ms};
  GLuint64 elapsed_ns = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &elapsed_ns);
  glDeleteQueries(1, &query);
  return {1e-6 * static_cast<double>(elapsed_ns), cpu_ms, wall_ms};
}

void time_frames(std::vector<Subject>& subjects, int rounds) {
  for (int round = -kRoundsToWarmUp; round < rounds; ++round) {
    for (Subject& subject : subjects) {
      const FrameTime time = time_frame(subject.draw);
      if (round < 0) continue;
      subject.ms.push_back(time.ms);
      subject.cpu_ms.push_back(time.cpu_ms);
      subject.whole_ms.push_back(time.whole_ms);
    }
  }
}

std::string renderer_name() { return gl_text(GL_RENDERER); }

std::string timing_method() {
  return is_software_gl() ? "wall time of a frame with a finish; software GL"
                          : "GPU time by timer queries; limits are of wall time with a finish";
}

double median_ratio(const std::vector<double>& times, const std::vector<double>& base) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < times.size(); ++k) ratios.push_back(times[k] / base[k]);
  return median(std::move(ratios));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::unique_ptr<Globe> open_globe(const std::string& tile_set, Texturing texturing, bool unlit) {
  GlobeOptions options;
  options.texturing = texturing;
  options.unlit = unlit;
  return open_globe(tile_set, options);
}

std::unique_ptr<Globe> open_globe(const std::string& tile_set, GlobeOptions options) {
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  Result<std::unique_ptr<TileSource>> source = open_tile_set(tile_set);
  if (!source) throw std::runtime_error(source.error().message);
  Result<std::unique_ptr<Globe>> made = Globe::create(options, std::shared_ptr<TileSource>(std::move(*source)));
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

}  // namespace terrella::bench
