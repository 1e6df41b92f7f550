#pragma once

#include <unistd.h>

#include <utility>

namespace terrella {

/// An open file or socket, which is closed with its owner. thread: any, one at a time unless const
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;

  [[nodiscard]] int number() const { return number_; }
  void release() { number_ = -1; }  ///< somebody else closes it

 private:
  int number_;  ///< negative: none
};

}  // namespace terrella
