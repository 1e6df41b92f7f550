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

/// One request from submit() to its reply. thread: network
struct Job {
  enum class State {
    ready,      ///< in its host's list, by rank
    delayed,    ///< after a failure, until `due`
    in_flight,  ///< in curl's hands
    abandoned,  ///< in curl's hands still, so that the connection can be used again; no reply follows
  };

  HttpRequest request;
  Address address;     ///< where it goes now: another than the request's after a redirect
  Url redirected_url;  ///< empty: request.url
  Host* host = nullptr;
  std::uint64_t sequence = 0;  ///< settles ties of rank: first come, first served
  State state = State::ready;
  HostGate::Time due{};  ///< delayed: when it is ready; abandoned: when the connection is given up
  int attempts = 0;
  int redirects = 0;
  bool is_hop = false;           ///< the next request follows a redirect, and is no new attempt
  bool may_send_headers = true;  ///< false once it has left the host that it was meant for
  std::unique_ptr<Transfer> transfer;

  [[nodiscard]] const Url& url() const { return redirected_url.empty() ? request.url : redirected_url; }
};

/// Best first. A NaN would break the order: it comes last.
struct ByRank {
  [[nodiscard]] bool operator()(const Job* a, const Job* b) const;
};
struct ByDue {
  [[nodiscard]] bool operator()(const Job* a, const Job* b) const;
};

/// What the fetcher knows of one origin. thread: network
struct Host {
  Host(const HostLimits& limits, HostGate::Time now) : gate(limits, now) {}

  HostGate gate;
  std::set<Job*, ByRank> ready;
  std::size_t jobs = 0;      ///< that point here, whatever their state
  std::string given_up_why;  ///< while the gate is given up
};

}  // namespace terrella::http
