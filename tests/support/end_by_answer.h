#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <utility>

namespace terrella::test {

/// Fetches a tile with an answer that holds the last owner of its source, so that the answer ends the source. Returns
/// false if the answer does not come or does not return.
template <class Source, class Id>
[[nodiscard]] bool end_by_answer(std::shared_ptr<Source> source, const Id& id) {
  constexpr std::chrono::seconds kLongest{60};  // a loaded machine under a sanitizer
  const auto ended = std::make_shared<std::promise<void>>();
  std::promise<void> let_go;
  auto* const tiles = source->remote();
  tiles->fetch(id, 1.0, [owner = std::move(source), ended, gone = let_go.get_future().share()](const auto&) mutable {
    gone.wait();  // until nobody else has the source
    EXPECT_EQ(owner.use_count(), 1);
    owner.reset();
    ended->set_value();
  });
  let_go.set_value();
  return ended->get_future().wait_for(kLongest) == std::future_status::ready;
}

}  // namespace terrella::test
