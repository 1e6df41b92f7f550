#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "streaming/http/host_gate.h"
#include "streaming/http/http_address.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/http/transfer.h"

namespace terrella::http {

struct Host;

/// A request from submit() to its reply. thread: network
struct Job {
  enum class State {
    ready,      ///< in its host's list, by rank
    delayed,    ///< waits for a retry until `due`
    in_flight,  ///< handed to curl
    abandoned,  ///< still handed to curl, so that the connection can be reused; no reply follows
  };

  HttpRequest request;
  Address address;     ///< current address; differs from the request's after a redirect
  Url redirected_url;  ///< empty: request.url
  Host* host = nullptr;
  std::uint64_t sequence = 0;  ///< settles ties of rank: first come, first served
  State state = State::ready;
  HostGate::Time due{};  ///< delayed: time of the retry; abandoned: time to close the connection
  int attempts = 0;
  int redirects = 0;
  bool is_hop = false;           ///< the next request follows a redirect and is no new attempt
  bool may_send_headers = true;  ///< false once the request was redirected away from its original host
  std::unique_ptr<Transfer> transfer;

  [[nodiscard]] const Url& url() const { return redirected_url.empty() ? request.url : redirected_url; }
};

/// Orders by rank, best first. A NaN would break the order, so it is sorted last.
struct ByRank {
  [[nodiscard]] bool operator()(const Job* a, const Job* b) const;
};
struct ByDue {
  [[nodiscard]] bool operator()(const Job* a, const Job* b) const;
};

/// State of one origin. thread: network
struct Host {
  Host(const HostLimits& limits, HostGate::Time now) : gate(limits, now) {}

  HostGate gate;
  std::set<Job*, ByRank> ready;
  std::size_t jobs = 0;      ///< jobs for this host in any state
  std::string given_up_why;  ///< reason, while the gate is given up
};

}  // namespace terrella::http
