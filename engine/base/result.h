#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace terrella {

/// A failure caused by the outside world: a file, a server, foreign bytes. The message is for a person. It names the
/// input, says what is wrong with it and, if possible, what to do.
struct Error {
  std::string message;
};

/// A value, or the reason why there is no value. Misuse, as value() of a failure, is an assertion. thread: any
template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(E error) : state_(std::in_place_index<1>, std::move(error)) {}

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] T& value() & {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& value() && {
    assert(ok());
    return std::move(*std::get_if<0>(&state_));
  }
  [[nodiscard]] const E& error() const {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }

  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] T* operator->() { return &value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }

 private:
  std::variant<T, E> state_;
};

/// The success value of an operation that returns nothing else.
struct Done {};
using Status = Result<Done>;

}  // namespace terrella
