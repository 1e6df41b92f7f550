#pragma once

#include <stdexcept>
#include <utility>

#include "base/result.h"

namespace terrella::bench {

/// The value of a result. Throws std::runtime_error with the message of an error. thread: any
template <class T>
[[nodiscard]] T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

}  // namespace terrella::bench
