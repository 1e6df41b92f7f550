#pragma once

#include <sys/types.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "streaming/http/reply_queue.h"
#include "tests/support/scratch_folder.h"

namespace terrella::test {

/// For what must happen: a loaded machine under a sanitizer. A test that waits so long has failed.
constexpr std::chrono::seconds kPatience{60};

/// A Python program of this folder that prints a line of JSON when it is ready, and ends when its standard input does.
class ServerProcess {
 public:
  ServerProcess(const std::string& script, const std::vector<std::string>& arguments);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  [[nodiscard]] const nlohmann::json& ready() const { return ready_; }

 private:
  pid_t process_ = -1;
  int its_input_ = -1;
  nlohmann::json ready_;
};

/// One request as misbehaving_server.py has seen it.
struct Seen {
  double time_s = 0.0;  ///< on a clock that does not jump
  std::string path;     ///< with query
  nlohmann::json headers;
};

class MisbehavingServer {
 public:
  explicit MisbehavingServer(std::vector<std::string> arguments = {});
  [[nodiscard]] std::string url(const std::string& path) const;
  [[nodiscard]] std::vector<Seen> log() const;
  [[nodiscard]] int port() const { return process_.ready().at("port"); }

 private:
  ServerProcess process_;
};

/// A fetcher whose replies are kept.
class Replies {
 public:
  explicit Replies(const HttpOptions& options);
  ~Replies() { queue_.close(); }
  Replies(const Replies&) = delete;
  Replies& operator=(const Replies&) = delete;
  [[nodiscard]] HttpFetcher& fetcher() { return fetcher_; }
  std::uint64_t get(const std::string& url, double priority = 0.0);
  void get(HttpRequest request) { fetcher_.submit(std::move(request)); }
  /// The reply of this identity; one that says "no reply in time" if there is none.
  [[nodiscard]] HttpReply wait(std::uint64_t id);
  [[nodiscard]] HttpReply fetch(const std::string& url) { return wait(get(url)); }
  [[nodiscard]] bool wait_for(std::size_t replies);
  /// Nothing waits and nothing is in flight.
  [[nodiscard]] bool wait_until_idle() const;
  [[nodiscard]] std::vector<HttpReply> all() const;  ///< in the order in which they came

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<HttpReply> replies_;
  std::uint64_t next_id_ = 1;
  ReplyQueue queue_;
  HttpFetcher fetcher_;
  std::jthread taker_;
};

/// Options with which a test is over soon.
[[nodiscard]] HttpOptions quick_options();

void write_file(const std::filesystem::path& path, const std::string& text);
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace terrella::test
