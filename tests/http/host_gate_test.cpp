#include "streaming/http/host_gate.h"

#include <gtest/gtest.h>

#include "streaming/http/retry_policy.h"

namespace terrella::http {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const HostGate::Time kStart{seconds(1000)};
// The gate opens within a rounding step of a steady clock's tick.
constexpr std::chrono::microseconds kTick{1};

HostLimits limits(int connections, int in_flight, double rate_per_s = 0.0, double burst = 1.0) {
  return {.connections = connections, .in_flight = in_flight, .rate_per_s = rate_per_s, .burst = burst};
}

int fill(HostGate& gate, HostGate::Time now) {
  int sent = 0;
  for (; gate.is_open(now); ++sent) gate.sent(now);
  return sent;
}

TEST(HostGate, SendsAsManyAsConnectionsUntilTheHostMultiplexes) {
  HostGate gate(limits(6, 32), kStart);
  EXPECT_EQ(fill(gate, kStart), 6);
  EXPECT_EQ(gate.opens_at(kStart), HostGate::Time::max());
  gate.answered(true);
  gate.learn(true);
  EXPECT_EQ(fill(gate, kStart), 27);
  gate.learn(false);
  EXPECT_FALSE(gate.is_open(kStart));
}

TEST(HostGate, KeepsToTheRateAfterABurst) {
  HostGate gate(limits(64, 64, 10.0, 5.0), kStart);
  int sent = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    const HostGate::Time now = kStart + milliseconds(ms);
    while (gate.is_open(now)) {
      gate.sent(now);
      gate.answered(true);
      ++sent;
    }
  }
  EXPECT_EQ(sent, 5 + 19);
}

TEST(HostGate, TellsWhenTheNextTokenComes) {
  HostGate gate(limits(6, 32, 4.0, 1.0), kStart);
  gate.sent(kStart);
  const HostGate::Time opens = gate.opens_at(kStart);
  EXPECT_NEAR(std::chrono::duration<double>(opens - kStart).count(), 0.25,
              std::chrono::duration<double>(kTick).count());
  EXPECT_FALSE(gate.is_open(opens - kTick));
  EXPECT_TRUE(gate.is_open(opens));
}

TEST(HostGate, SavesNoMoreThanABurst) {
  HostGate gate(limits(64, 64, 10.0, 5.0), kStart);
  EXPECT_EQ(fill(gate, kStart + seconds(3600)), 5);
}

TEST(HostGate, IsShutDuringAPauseThatNeverShortens) {
  HostGate gate(limits(6, 32), kStart);
  gate.pause(kStart + seconds(10), kStart);
  gate.pause(kStart + seconds(5), kStart);
  EXPECT_EQ(gate.opens_at(kStart), kStart + seconds(10));
  EXPECT_FALSE(gate.is_open(kStart + seconds(10) - kTick));
  EXPECT_TRUE(gate.is_open(kStart + seconds(10)));
}

TEST(HostGate, BeginsWithHalfAfterAPauseAndGrowsBack) {
  HostGate gate(limits(8, 32), kStart);
  EXPECT_EQ(fill(gate, kStart), 8);
  for (int i = 0; i < 8; ++i) {
    gate.answered(false);
    gate.pause(kStart + seconds(1), kStart);
  }
  EXPECT_EQ(fill(gate, kStart + seconds(1)), 4) << "one burst of refusals halves once";
  for (int i = 0; i < 100; ++i) {
    gate.answered(true);
    gate.sent(kStart + seconds(1));
  }
  fill(gate, kStart + seconds(1));
  EXPECT_EQ(gate.in_flight(), 8);
}

TEST(HostGate, NeverFallsBelowOne) {
  HostGate gate(limits(2, 2), kStart);
  for (int i = 0; i < 10; ++i) gate.pause(kStart + seconds(i), kStart + seconds(i));
  EXPECT_EQ(fill(gate, kStart + seconds(20)), 1);
}

TEST(HostGate, IsGivenUpForATime) {
  HostGate gate(limits(6, 32), kStart);
  gate.give_up(kStart + seconds(10));
  EXPECT_TRUE(gate.is_given_up(kStart));
  EXPECT_FALSE(gate.is_open(kStart));
  EXPECT_FALSE(gate.is_given_up(kStart + seconds(10)));
  EXPECT_TRUE(gate.is_open(kStart + seconds(10)));
}

TEST(Backoff, DoublesWithJitterUpToTheLongest) {
  HttpOptions options;
  options.first_backoff = milliseconds(100);
  options.longest_backoff = milliseconds(1000);
  EXPECT_EQ(backoff(options, 1, 0.5), milliseconds(100));
  EXPECT_EQ(backoff(options, 2, 0.5), milliseconds(200));
  EXPECT_EQ(backoff(options, 4, 0.5), milliseconds(800));
  EXPECT_EQ(backoff(options, 5, 0.5), milliseconds(1000));
  EXPECT_EQ(backoff(options, 20, 0.5), milliseconds(1000));
  EXPECT_EQ(backoff(options, 1, 0.0), milliseconds(75));
  EXPECT_LT(backoff(options, 1, 0.999), milliseconds(125));
}

Verdict of_status(int status, bool conditional = false) {
  return judge({.status = status, .conditional = conditional});
}

TEST(Verdict, OfAStatus) {
  using Next = Verdict::Next;
  EXPECT_EQ(of_status(200).outcome, HttpOutcome::content);
  EXPECT_EQ(of_status(304, true).outcome, HttpOutcome::not_modified);
  EXPECT_EQ(of_status(304).outcome, HttpOutcome::refused);
  for (const int status : {204, 404, 410}) EXPECT_EQ(of_status(status).outcome, HttpOutcome::nothing) << status;
  for (const int status : {206, 400, 401, 403, 418}) {
    EXPECT_EQ(of_status(status).next, Next::reply) << status;
    EXPECT_EQ(of_status(status).outcome, HttpOutcome::refused) << status;
  }
  for (const int status : {408, 425, 500, 502, 504, 599}) EXPECT_EQ(of_status(status).next, Next::again) << status;
  for (const int status : {429, 503}) EXPECT_EQ(of_status(status).next, Next::wait) << status;
  for (const int status : {301, 302, 303, 307, 308}) EXPECT_EQ(of_status(status).next, Next::redirect) << status;
}

TEST(Verdict, OfABrokenTransfer) {
  using Next = Verdict::Next;
  for (const CURLcode code : {CURLE_RECV_ERROR, CURLE_PARTIAL_FILE, CURLE_OPERATION_TIMEDOUT, CURLE_COULDNT_CONNECT}) {
    EXPECT_EQ(judge({.code = code}).next, Next::again) << code;
    EXPECT_EQ(judge({.code = code, .status = 200}).next, Next::again) << code;
    EXPECT_FALSE(judge({.code = code}).why.empty());
  }
  EXPECT_EQ(judge({.code = CURLE_PEER_FAILED_VERIFICATION}).outcome, HttpOutcome::refused);
  EXPECT_EQ(judge({.code = CURLE_WRITE_ERROR, .status = 200, .cut = Cut::body_too_large}).outcome,
            HttpOutcome::refused);
  EXPECT_EQ(judge({.code = CURLE_WRITE_ERROR, .status = 404, .cut = Cut::error_body}).outcome, HttpOutcome::nothing);
  EXPECT_EQ(judge({.code = CURLE_RECV_ERROR, .status = 404}).outcome, HttpOutcome::nothing) << "the status says enough";
}

}  // namespace
}  // namespace terrella::http
