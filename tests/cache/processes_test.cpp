#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "cache/cache_test_support.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::nth_tile;
using test::tile_record;

/// A cache_worker whose words go to a file.
class Worker {
 public:
  Worker(const std::vector<std::string>& arguments, const fs::path& words) {
    std::vector<std::string> all{TERRELLA_CACHE_WORKER};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, words.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    EXPECT_EQ(posix_spawn(&pid_, all[0].c_str(), &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Worker() {
    if (pid_ > 0) static_cast<void>(end(SIGKILL));
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// The exit code, or minus the signal that ended it.
  int end(int signal_to_send = 0) {
    if (signal_to_send != 0) kill(pid_, signal_to_send);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

/// Until the worker has said something, however slow the machine is; at most a minute.
void wait_for_words(const fs::path& words) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  std::error_code error;
  while ((!fs::exists(words, error) || fs::file_size(words, error) == 0) && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

class Processes : public testing::Test {
 protected:
  test::ScratchFolder folder_;
  const fs::path file_ = folder_ / "planet.gpkg";
};

TEST_F(Processes, SeveralWriteAndReadAtOnceWhileGdalLooks) {
  {
    Worker first({"share", file_.string(), "1", "4"}, folder_ / "1.txt");
    Worker second({"share", file_.string(), "2", "4"}, folder_ / "2.txt");
    Worker third({"share", file_.string(), "3", "4"}, folder_ / "3.txt");
    const std::string gdalinfo =
        std::string(TERRELLA_GDALINFO) + " '" + file_.string() + "' >'" + (folder_ / "log").string() + "' 2>&1";
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
    while (!fs::exists(file_)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    int looks = 0;
    for (; std::chrono::steady_clock::now() < end; ++looks) EXPECT_EQ(std::system(gdalinfo.c_str()), 0);
    EXPECT_GT(looks, 0);
    EXPECT_EQ(first.end(), 0);
    EXPECT_EQ(second.end(), 0);
    EXPECT_EQ(third.end(), 0);
  }
  EXPECT_EQ(test::integrity(file_), "ok");
  EXPECT_EQ(test::sql(file_,
                      "SELECT count(*) FROM tiles JOIN terrella_cache_absences USING "
                      "(zoom_level, tile_column, tile_row)"),
            "0");
}

TEST_F(Processes, AllThatWasReportedSurvivesKillAtAnyMoment) {
  constexpr int kKills = 20;
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  std::size_t reported = 0;
  for (int n = 0; n < kKills; ++n) {
    SCOPED_TRACE(n);
    const fs::path words = folder_ / "said.txt";
    Worker worker({"write", file_.string(), std::to_string(n)}, words);
    // Every other one may be killed before it has stored anything: while it makes or opens the file.
    if (n % 2 == 0) wait_for_words(words);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 150));
    ASSERT_EQ(worker.end(SIGKILL), -SIGKILL);
    const auto cache = test::open_cache(file_);
    ASSERT_TRUE(cache);
    ASSERT_TRUE(cache->set_aside().empty()) << cache->set_aside();
    std::ifstream said(words);
    for (int number = 0; said >> number; ++reported) {
      const auto record = test::found(*cache, nth_tile(10, number));
      ASSERT_TRUE(record) << number;
      ASSERT_EQ(record->bytes, tile_record(nth_tile(10, number)).bytes) << number;
    }
    ASSERT_EQ(test::integrity(file_), "ok");
  }
  // On a busy machine hardly more than the first batch of those that were waited for.
  EXPECT_GE(reported, kKills / 2U);
}

}  // namespace
}  // namespace terrella
