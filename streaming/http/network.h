#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <random>
#include <unordered_map>
#include <vector>

#include "streaming/http/reply_queue.h"
#include "streaming/http/request_queue.h"

namespace terrella::http {

/// HttpCounts that any thread may read.
struct HttpTally {
  std::atomic<std::size_t> waiting = 0;
  std::atomic<std::size_t> in_flight = 0;
  std::atomic<std::size_t> requests = 0;
  std::atomic<std::size_t> retries = 0;
  std::atomic<std::uint64_t> body_bytes = 0;
};

/// State of the network thread: waiting requests, hosts, curl. thread: network, but for wake()
class Network {
 public:
  using Time = HostGate::Time;

  /// Throws std::bad_alloc if curl cannot begin. Who submits raises `tally->waiting`.
  Network(const HttpOptions& options, ReplyQueue& replies, std::shared_ptr<HttpTally> tally);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  void submit(HttpRequest&& request);
  void set_priority(std::uint64_t id, double priority);
  void cancel(std::uint64_t id);
  /// Sends requests that may be sent, moves bytes, and replies. Returns false if no request ended; the caller may then
  /// wait().
  bool turn();
  /// Blocks until there are bytes to move, a request may be sent, or wake() is called.
  void wait();
  void wake();  ///< thread: any

 private:
  struct MultiFree {
    void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
  };

  [[nodiscard]] Host& host_of(const std::string& origin);
  void forget_idle_hosts();
  void enqueue(Job& job);
  void dequeue(Job& job);
  void release_due();
  void end_abandoned();
  void send_ready(Host& host);
  void send(Job& job);
  void reply_file(Job& job);
  [[nodiscard]] bool collect();
  void finish(Job& job, CURLcode code);
  void redirect(Job& job, const Verdict& verdict, int status, Url url);
  void try_again(Job& job, const Verdict& verdict, int status, const Transfer& transfer);
  [[nodiscard]] bool pause(Host& host, int status, const ReplyFields& fields, std::chrono::milliseconds own_wait);
  void fail_waiting(Host& host);
  void put_back(Job& job);
  void abandon(std::unique_ptr<Job> job);
  void end_early(Job& job);
  [[nodiscard]] std::unique_ptr<Transfer> detach(Job& job);
  void recycle(std::unique_ptr<Transfer> transfer);
  void leave_host(Job& job);
  [[nodiscard]] std::unique_ptr<Job> remove(Job& job);
  [[nodiscard]] static HttpReply begin_reply(const Job& job, HttpOutcome outcome, int status);
  void reply(Job& job, HttpOutcome outcome, int status, std::string why);
  void reply_given_up(Job& job);
  void reply_answer(Job& job, const Verdict& verdict, int status, Transfer& transfer);
  void hand_over(Job& job, HttpReply&& reply, ReplyQueue::Finish finish = {});
  [[nodiscard]] Time next_event() const;

  const HttpOptions options_;
  ReplyQueue& replies_;
  const std::shared_ptr<HttpTally> tally_;  ///< shared with files that are read after the fetcher is gone
  std::unique_ptr<CURLM, MultiFree> multi_;
  std::vector<std::unique_ptr<Transfer>> idle_;
  std::map<std::string, Host> hosts_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Job>> jobs_;
  std::set<Job*, ByDue> delayed_;
  std::vector<std::unique_ptr<Job>> abandoned_;
  std::uint64_t submitted_ = 0;
  std::minstd_rand random_{std::random_device()()};
  Time now_;  ///< time of this turn
};

}  // namespace terrella::http
