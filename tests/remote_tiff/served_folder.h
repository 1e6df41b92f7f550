#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "http_test_support.h"
#include "streaming/url.h"
#include "tests/support/scratch_folder.h"

namespace terrella::test {

/// A folder behind a real nginx.
class ServedFolder {
 public:
  ServedFolder() : nginx_("nginx.py", {folder_.path().string()}) {}
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] Url url(const std::string& name) const {
    return "http://127.0.0.1:" + std::to_string(nginx_.ready().at("port").get<int>()) + "/" + name;
  }
  /// Number of requests in nginx's log, once there are `least`: a line follows its answer.
  [[nodiscard]] std::size_t requests(std::size_t least) const {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
      const std::string log = read_text(std::string(nginx_.ready().at("access_log")));
      const auto lines = static_cast<std::size_t>(std::ranges::count(log, '\n'));
      if (lines >= least || std::chrono::steady_clock::now() > end) return lines;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

 private:
  ScratchFolder folder_;
  ServerProcess nginx_;
};

}  // namespace terrella::test
