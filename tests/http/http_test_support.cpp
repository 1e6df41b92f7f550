#include "http_test_support.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace terrella::test {
namespace {

std::string first_line(int descriptor) {
  std::string line;
  char c = 0;
  while (read(descriptor, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

}  // namespace

ServerProcess::ServerProcess(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {TERRELLA_PYTHON, "-B", std::string(TERRELLA_HTTP_TESTS) + "/" + script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  std::array<int, 2> input{};
  std::array<int, 2> output{};
  if (pipe2(input.data(), O_CLOEXEC) != 0 || pipe2(output.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
  const int problem = posix_spawn(&process_, TERRELLA_PYTHON, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(input[0]);
  close(output[1]);
  its_input_ = input[1];
  const std::string line = problem == 0 ? first_line(output[0]) : std::string();
  close(output[0]);
  if (line.empty()) throw std::runtime_error(script + " does not start");
  ready_ = nlohmann::json::parse(line);
}

ServerProcess::~ServerProcess() {
  if (process_ > 0) kill(process_, SIGTERM);
  close(its_input_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
}

namespace {

std::vector<std::string> ending_with_us(std::vector<std::string> arguments) {
  arguments.push_back("--until-stdin-ends");
  return arguments;
}

}  // namespace

MisbehavingServer::MisbehavingServer(std::vector<std::string> arguments)
    : process_("misbehaving_server.py", ending_with_us(std::move(arguments))) {}

std::string MisbehavingServer::url(const std::string& path) const {
  return "http://127.0.0.1:" + std::to_string(port()) + path;
}

std::vector<Seen> MisbehavingServer::log() const {
  const HttpReply reply = Replies(quick_options()).fetch(url("/log"));
  std::istringstream lines(std::string(reinterpret_cast<const char*>(reply.body.data()), reply.body.size()));
  std::vector<Seen> log;
  for (std::string line; std::getline(lines, line);) {
    const auto entry = nlohmann::json::parse(line);
    log.push_back({entry.at("time_s"), entry.at("path"), entry.at("headers")});
  }
  return log;
}

Replies::Replies(const HttpOptions& options)
    : fetcher_(options, queue_), taker_([this] {
        while (auto reply = queue_.take()) {
          const std::lock_guard lock(mutex_);
          replies_.push_back(*std::move(reply));
          changed_.notify_all();
        }
      }) {}

std::uint64_t Replies::get(const std::string& url, double priority) {
  HttpRequest request;
  request.id = next_id_++;
  request.url = url;
  request.priority = priority;
  fetcher_.submit(request);
  return request.id;
}

HttpReply Replies::wait(std::uint64_t id) {
  std::unique_lock lock(mutex_);
  const HttpReply* found = nullptr;
  changed_.wait_for(lock, kPatience, [&] {
    for (const HttpReply& reply : replies_) {
      if (reply.id == id) found = &reply;
    }
    return found != nullptr;
  });
  if (found != nullptr) return *found;
  HttpReply none;
  none.why = "no reply in time";
  return none;
}

bool Replies::wait_for(std::size_t replies) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [&] { return replies_.size() >= replies; });
}

bool Replies::wait_until_idle() const {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    const HttpCounts counts = fetcher_.counts();
    if (counts.waiting == 0 && counts.in_flight == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

std::vector<HttpReply> Replies::all() const {
  const std::lock_guard lock(mutex_);
  return replies_;
}

HttpOptions quick_options() {
  HttpOptions options;
  options.first_backoff = std::chrono::milliseconds(20);
  options.attempts = 3;
  return options;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace terrella::test
