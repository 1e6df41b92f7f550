#pragma once

namespace terrella::bench {

/// An OpenGL 4.5 core context without a surface, current on the thread that made it until destruction. The engine's own
/// is not used: the baseline must not change with what it is compared with. Throws std::runtime_error if there is no
/// such GL.
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
