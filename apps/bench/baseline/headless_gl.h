#pragma once

namespace terrella::bench {

/// An OpenGL 4.5 core context without a surface. The context is current on its creating thread until destruction. This
/// class is independent of the engine, because the baseline must not change with the code under comparison. Throws
/// std::runtime_error if OpenGL 4.5 is unavailable.
class HeadlessGl {
 public:
  HeadlessGl();
  ~HeadlessGl();
  HeadlessGl(const HeadlessGl&) = delete;
  HeadlessGl& operator=(const HeadlessGl&) = delete;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace terrella::bench
