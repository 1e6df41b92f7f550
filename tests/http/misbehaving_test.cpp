// The fetcher against a server that misbehaves: how each request ends, how often it was asked for.
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "http_test_support.h"

namespace terrella::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

class Misbehaving : public testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<MisbehavingServer>(); }
  static void TearDownTestSuite() { server_.reset(); }

  static HttpReply fetch(const std::string& path, const HttpOptions& options = quick_options()) {
    return Replies(options).fetch(server_->url(path));
  }
  static std::size_t asked(const std::string& path) {
    std::size_t count = 0;
    for (const Seen& seen : server_->log()) count += seen.path == path ? 1 : 0;
    return count;
  }
  static std::unique_ptr<MisbehavingServer> server_;
};
std::unique_ptr<MisbehavingServer> Misbehaving::server_;

std::string text(const HttpReply& reply) {
  return {reinterpret_cast<const char*>(reply.body.data()), reply.body.size()};
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Case {
  const char* path;
  HttpOutcome outcome;
  int status;
  int attempts;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.path; }

class Ending : public Misbehaving, public testing::WithParamInterface<Case> {};

TEST_P(Ending, IsAsItShouldBe) {
  const HttpReply reply = fetch(GetParam().path);
  EXPECT_EQ(reply.outcome, GetParam().outcome) << reply.why;
  EXPECT_EQ(reply.status, GetParam().status);
  EXPECT_EQ(reply.attempts, GetParam().attempts);
  EXPECT_EQ(asked(GetParam().path), static_cast<std::size_t>(GetParam().attempts));
  EXPECT_EQ(reply.why.empty(), reply.outcome == HttpOutcome::content);
  EXPECT_FALSE(contains(reply.why, "case=")) << "a query may hold a key: " << reply.why;
  EXPECT_EQ(reply.body.empty(), reply.outcome != HttpOutcome::content);
}

// The query makes the paths differ from other tests'.
INSTANTIATE_TEST_SUITE_P(
    OfEachFault, Ending,
    testing::Values(
        Case{"/ok/1/2/3.jpg?case=1", HttpOutcome::content, 200, 1},
        Case{"/html200?case=1", HttpOutcome::content, 200, 1}, Case{"/wrongtype?case=1", HttpOutcome::content, 200, 1},
        Case{"/truncated_jpeg?case=1", HttpOutcome::content, 200, 1}, Case{"/204?case=1", HttpOutcome::nothing, 204, 1},
        Case{"/404?case=1", HttpOutcome::nothing, 404, 1}, Case{"/410?case=1", HttpOutcome::nothing, 410, 1},
        Case{"/huge404?case=1", HttpOutcome::nothing, 404, 1}, Case{"/401?case=1", HttpOutcome::refused, 401, 1},
        Case{"/403?case=1", HttpOutcome::refused, 403, 1}, Case{"/304?case=1", HttpOutcome::refused, 304, 1},
        Case{"/huge?case=1", HttpOutcome::refused, 200, 1},
        Case{"/huge?chunked=1&case=1", HttpOutcome::refused, 200, 1},
        Case{"/bomb?case=1", HttpOutcome::refused, 200, 1}, Case{"/headers?case=1", HttpOutcome::refused, 200, 1},
        Case{"/redirect?case=1", HttpOutcome::refused, 302, 1},
        Case{"/redirect?to=file:///etc/hostname&case=1", HttpOutcome::refused, 302, 1},
        Case{"/redirect?to=ftp://127.0.0.1/case=1", HttpOutcome::refused, 302, 1},
        Case{"/500?case=1", HttpOutcome::failed, 500, 3}, Case{"/503?case=1", HttpOutcome::failed, 503, 3},
        Case{"/429?case=1", HttpOutcome::failed, 429, 3}, Case{"/reset?case=1", HttpOutcome::failed, 200, 3},
        Case{"/truncated?case=1", HttpOutcome::failed, 200, 3},
        Case{"/500?times=1&case=1", HttpOutcome::content, 200, 2},
        Case{"/503?retry_after=1&times=1&case=1", HttpOutcome::content, 200, 2},
        Case{"/truncated?times=2&case=1", HttpOutcome::content, 200, 3}));

TEST_F(Misbehaving, WhatAnAnswerSaysIsToldToTheCaller) {
  const HttpReply reply = fetch("/ok/0/0/0.jpg");
  EXPECT_EQ(reply.content_type, "image/jpeg");
  EXPECT_EQ(reply.etag, "\"v1\"");
  EXPECT_FALSE(reply.no_store);
  ASSERT_TRUE(reply.expires_unix_s.has_value());
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(static_cast<double>(*reply.expires_unix_s), std::chrono::duration<double>(now).count() + 60.0, 30.0);
}

TEST_F(Misbehaving, AConditionalRequestIsAnsweredNotModified) {
  Replies replies(quick_options());
  HttpRequest request;
  request.id = 7;
  request.url = server_->url("/ok/5/5/5.jpg");
  request.etag = "\"v1\"";
  replies.get(request);
  EXPECT_EQ(replies.wait(7).outcome, HttpOutcome::not_modified);
}

TEST_F(Misbehaving, ASilentServerIsGivenUpAfterTheStallTime) {
  HttpOptions options = quick_options();
  options.attempts = 1;
  options.stall_timeout = seconds(1);
  const auto begin = steady_clock::now();
  const HttpReply reply = fetch("/timeout", options);
  EXPECT_EQ(reply.outcome, HttpOutcome::failed);
  EXPECT_GT(steady_clock::now() - begin, milliseconds(900));
  EXPECT_LT(steady_clock::now() - begin, seconds(20));
}

TEST_F(Misbehaving, ASlowDripEndsWithTheTotalTime) {
  HttpOptions options = quick_options();
  options.attempts = 2;
  options.total_timeout = milliseconds(600);
  const HttpReply reply = fetch("/drip?n=1", options);
  EXPECT_EQ(reply.outcome, HttpOutcome::failed);
  EXPECT_EQ(reply.attempts, 2);
}

TEST_F(Misbehaving, AServerThatIsNotThereFails) {
  int port = 0;
  { port = MisbehavingServer().port(); }
  const HttpReply reply = Replies(quick_options()).fetch("http://127.0.0.1:" + std::to_string(port) + "/a?key=secret");
  EXPECT_EQ(reply.outcome, HttpOutcome::failed);
  EXPECT_EQ(reply.attempts, 3);
  EXPECT_TRUE(contains(reply.why, "127.0.0.1")) << reply.why;
  EXPECT_FALSE(contains(reply.why, "secret")) << reply.why;
}

TEST_F(Misbehaving, ARedirectLoopIsBounded) {
  HttpOptions options = quick_options();
  options.max_redirects = 4;
  const HttpReply reply = fetch("/loop/a", options);
  EXPECT_EQ(reply.outcome, HttpOutcome::refused);
  EXPECT_EQ(reply.attempts, 1);
  EXPECT_EQ(asked("/loop/a"), 5U);
}

TEST_F(Misbehaving, HeadersGoToTheirHostAndNotToWhereItRedirects) {
  const MisbehavingServer other;
  Replies replies(quick_options());
  HttpRequest request;
  request.headers = {"X-Key: secret"};
  request.id = 1;
  request.url = server_->url("/redirect?to=/echo");
  replies.get(request);
  request.id = 2;
  request.url = server_->url("/redirect?to=" + other.url("/echo"));
  replies.get(request);
  const HttpReply here = replies.wait(1);
  const HttpReply there = replies.wait(2);
  ASSERT_EQ(here.outcome, HttpOutcome::content);
  ASSERT_EQ(there.outcome, HttpOutcome::content);
  EXPECT_EQ(nlohmann::json::parse(text(here)).at("X-Key"), "secret");
  EXPECT_FALSE(contains(text(there), "secret"));
  EXPECT_FALSE(contains(text(there), "X-Key"));
}

TEST_F(Misbehaving, TheUserAgentIsTruthful) {
  const auto headers = nlohmann::json::parse(text(fetch("/echo?agent=1")));
  EXPECT_EQ(headers.at("User-Agent"), "Terrella/" TERRELLA_VERSION);
  EXPECT_TRUE(contains(headers.at("Accept-Encoding"), "gzip"));
}

TEST_F(Misbehaving, LineEndsInHeadersOrAddressesAreRefusedUnsent) {
  Replies replies(quick_options());
  HttpRequest request;
  request.id = 1;
  request.url = server_->url("/ok/injected");
  request.headers = {"X-Key: secret\r\nX-Other: b"};
  replies.get(request);
  request.id = 2;
  request.headers.clear();
  request.etag = "\"a\"\r\nX-Other: secret";
  replies.get(request);
  request.id = 3;
  request.etag.clear();
  request.url = request.url.with_secrets() + " HTTP/1.1\r\nX-Other: secret";
  replies.get(request);
  for (const std::uint64_t id : {1, 2, 3}) {
    const HttpReply reply = replies.wait(id);
    EXPECT_EQ(reply.outcome, HttpOutcome::refused) << id;
    EXPECT_FALSE(contains(reply.why, "secret")) << reply.why;
  }
  EXPECT_TRUE(contains(replies.wait(1).why, "X-Key"));
  EXPECT_EQ(asked("/ok/injected"), 0U);
}

TEST_F(Misbehaving, OtherSchemesAreRefused) {
  for (const std::string url : {"ftp://127.0.0.1/a", "gopher://127.0.0.1/a", "dict://127.0.0.1/a", "nonsense"}) {
    EXPECT_EQ(Replies(quick_options()).fetch(url).outcome, HttpOutcome::refused) << url;
  }
}

TEST_F(Misbehaving, FilesAreReadFromTheDisk) {
  const ScratchFolder folder;
  write_file(folder.path() / "a b.jpg", "picture");
  const std::string base = "file://" + folder.path().string();
  Replies replies(quick_options());
  EXPECT_EQ(text(replies.fetch(base + "/a%20b.jpg")), "picture");
  EXPECT_EQ(replies.fetch(base + "/none.jpg").outcome, HttpOutcome::nothing);
  EXPECT_EQ(replies.fetch("file:///dev/zero").outcome, HttpOutcome::refused);
  EXPECT_TRUE(replies.wait_until_idle());
}

// Limits of the whole host -----------------------------------------------------------------------------------------

double first_time_s(const std::vector<Seen>& log, const std::string& path) {
  for (const Seen& seen : log) {
    if (seen.path == path) return seen.time_s;
  }
  return -1.0;
}

TEST(OneHost, IsLeftAloneAsLongAsItAsksFor) {
  for (const std::string fault : {"/429?retry_after=2&times=1", "/503?retry_after=2&times=1&as=date"}) {
    const MisbehavingServer server;
    Replies replies(quick_options());
    const auto busy = replies.get(server.url(fault), 1.0);
    while (replies.fetcher().counts().requests == 0 || replies.fetcher().counts().in_flight > 0) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    const auto other = replies.get(server.url("/ok/other"));
    EXPECT_EQ(replies.wait(busy).outcome, HttpOutcome::content);
    EXPECT_EQ(replies.wait(other).outcome, HttpOutcome::content);
    const std::vector<Seen> log = server.log();
    // A date has whole seconds, so that up to one of the two may be gone when it is sent.
    const double least_s = fault.find("date") == std::string::npos ? 2.0 : 1.0;
    EXPECT_GE(first_time_s(log, "/ok/other") - first_time_s(log, fault), least_s - 0.01) << fault;
  }
}

TEST(OneHost, IsNotHeldUpByARequestThatIsTriedAgain) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.first_backoff = seconds(1);
  Replies replies(options);
  replies.get(server.url("/500?times=1"), 1.0);
  for (int i = 0; i < 20; ++i) replies.get(server.url("/ok/" + std::to_string(i)));
  ASSERT_TRUE(replies.wait_for(21));
  EXPECT_EQ(replies.all().back().attempts, 2) << "the one that waited comes last";
}

TEST(OneHost, ThatAsksForTooLongIsGivenUpWithAllThatWaits) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.connections_per_host = 1;
  options.longest_wait = seconds(10);
  Replies replies(options);
  const auto first = replies.get(server.url("/429?retry_after=3600"), 1.0);
  for (int i = 0; i < 20; ++i) replies.get(server.url("/ok/" + std::to_string(i)));
  ASSERT_TRUE(replies.wait_for(21));
  for (const HttpReply& reply : replies.all()) {
    EXPECT_EQ(reply.outcome, HttpOutcome::failed);
    EXPECT_TRUE(contains(reply.why, "until 2")) << reply.why;
    EXPECT_TRUE(contains(reply.why, "127.0.0.1")) << reply.why;
  }
  EXPECT_EQ(replies.wait(first).attempts, 1);
  EXPECT_EQ(replies.fetch(server.url("/ok/later")).outcome, HttpOutcome::failed);
  EXPECT_EQ(server.log().size(), 1U);
}

TEST(OneHost, GetsNoMoreThanTheRateRetriesIncluded) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.rate_per_host = 50.0;
  options.burst = 5.0;
  options.first_backoff = milliseconds(1);
  options.attempts = 4;
  Replies replies(options);
  for (int i = 0; i < 20; ++i) replies.get(server.url("/500?case=" + std::to_string(i)));
  ASSERT_TRUE(replies.wait_for(20));
  const std::vector<Seen> log = server.log();
  ASSERT_EQ(log.size(), 80U);
  // Requests that were sent at their time may be seen late by up to this, which makes the span between two look short.
  constexpr double kDelay_s = 0.1;
  for (std::size_t i = 0; i < log.size(); ++i) {
    for (std::size_t k = i + 1; k < log.size(); ++k) {
      const double span_s = log[k].time_s - log[i].time_s + kDelay_s;
      ASSERT_LE(static_cast<double>(k - i), options.burst + options.rate_per_host * span_s) << i << " " << k;
    }
  }
  EXPECT_GE(log.back().time_s - log.front().time_s, 75 / 50.0 - kDelay_s);
  EXPECT_EQ(replies.fetcher().counts().retries, 60U);
}

TEST(OneHost, HasNoMoreInFlightThanConnections) {
  const MisbehavingServer server({"--latency-ms", "20"});
  HttpOptions options = quick_options();
  options.connections_per_host = 2;
  Replies replies(options);
  for (int i = 0; i < 20; ++i) replies.get(server.url("/ok/" + std::to_string(i)));
  std::size_t most = 0;
  for (HttpCounts counts = replies.fetcher().counts(); counts.waiting > 0; counts = replies.fetcher().counts()) {
    most = std::max(most, counts.in_flight);
    std::this_thread::sleep_for(milliseconds(1));
  }
  ASSERT_TRUE(replies.wait_for(20));
  EXPECT_EQ(most, 2U);
}

// Order, and giving up -----------------------------------------------------------------------------------------------

TEST(Ranking, IsReadWhenARequestIsSent) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.connections_per_host = 1;
  Replies replies(options);
  replies.get(server.url("/slow"), 100.0);
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 10; ++i) ids.push_back(replies.get(server.url("/ok/" + std::to_string(i)), i));
  replies.fetcher().set_priority(ids[0], 50.0);
  replies.fetcher().set_priority(ids[9], -1.0);
  replies.fetcher().set_priority(ids[5], std::numeric_limits<double>::quiet_NaN());
  replies.fetcher().set_priority(12345, 1.0);
  ASSERT_TRUE(replies.wait_for(11));
  std::vector<std::string> paths;
  for (const Seen& seen : server.log()) paths.push_back(seen.path);
  const std::vector<std::string> wanted = {"/slow", "/ok/0", "/ok/8", "/ok/7", "/ok/6", "/ok/4",
                                           "/ok/3", "/ok/2", "/ok/1", "/ok/9", "/ok/5"};
  EXPECT_EQ(paths, wanted);
}

TEST(Ranking, TiesAreServedInTheOrderInWhichTheyCame) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.connections_per_host = 1;
  Replies replies(options);
  for (int i = 0; i < 50; ++i) replies.get(server.url("/ok"));
  ASSERT_TRUE(replies.wait_for(50));
  const std::vector<HttpReply> all = replies.all();
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].id, i + 1);
}

TEST(Cancelling, LeavesNoReplyAndNoRequest) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.connections_per_host = 1;
  Replies replies(options);
  const auto first = replies.get(server.url("/slow"), 1.0);
  const auto waiting = replies.get(server.url("/ok/cancelled"));
  const auto last = replies.get(server.url("/ok/last"), -1.0);
  replies.fetcher().cancel(waiting);
  replies.fetcher().cancel(waiting);
  EXPECT_EQ(replies.wait(first).outcome, HttpOutcome::content);
  EXPECT_EQ(replies.wait(last).outcome, HttpOutcome::content);
  EXPECT_EQ(replies.all().size(), 2U);
  EXPECT_LT(first_time_s(server.log(), "/ok/cancelled"), 0.0);
  EXPECT_TRUE(replies.wait_until_idle());
}

TEST(Cancelling, WhatIsInFlightFreesItsPlaceSoon) {
  const MisbehavingServer server;
  HttpOptions options = quick_options();
  options.connections_per_host = 1;
  Replies replies(options);
  const auto stuck = replies.get(server.url("/timeout"));
  while (replies.fetcher().counts().in_flight == 0) std::this_thread::sleep_for(milliseconds(1));
  replies.fetcher().cancel(stuck);
  const auto begin = steady_clock::now();
  EXPECT_EQ(replies.fetch(server.url("/ok/next")).outcome, HttpOutcome::content);
  EXPECT_LT(steady_clock::now() - begin, seconds(15)) << "not the time-out of the one that is stuck";
  EXPECT_EQ(replies.all().size(), 1U);
}

TEST(Cancelling, ThousandsOfTimesASecondLosesNothing) {
  const MisbehavingServer server;
  Replies replies(quick_options());
  constexpr std::uint64_t kRequests = 600;
  std::vector<std::uint64_t> ids;
  for (std::uint64_t i = 0; i < kRequests; ++i) ids.push_back(replies.get(server.url("/ok/" + std::to_string(i % 7))));
  std::thread other([&] {
    for (int round = 0; round < 10; ++round) {
      for (const std::uint64_t id : ids)
        replies.fetcher().set_priority(id, static_cast<double>((id * 7919 + round) % 101));
    }
  });
  for (std::size_t i = 0; i < ids.size(); i += 2) replies.fetcher().cancel(ids[i]);
  other.join();
  for (std::size_t i = 1; i < ids.size(); i += 2) EXPECT_EQ(replies.wait(ids[i]).outcome, HttpOutcome::content);
  EXPECT_TRUE(replies.wait_until_idle());
}

TEST(Fetcher, EndsAtOnceWhateverIsUnderWay) {
  const MisbehavingServer server;
  const auto begin = steady_clock::now();
  {
    Replies replies(quick_options());
    for (int i = 0; i < 100; ++i) replies.get(server.url("/timeout"));
    while (replies.fetcher().counts().in_flight == 0) std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_LT(steady_clock::now() - begin, seconds(15));
}

TEST(Fetcher, MayBeAskedAgainUnderTheSameNumberAfterAReply) {
  const MisbehavingServer server;
  ReplyQueue replies;
  HttpFetcher fetcher(quick_options(), replies);
  for (int i = 0; i < 5; ++i) {
    HttpRequest request;
    request.id = 1;
    request.url = server.url("/ok/again");
    fetcher.submit(std::move(request));
    const auto reply = replies.take_all(kPatience);
    ASSERT_EQ(reply.size(), 1U);
    EXPECT_EQ(reply.front().outcome, HttpOutcome::content);
  }
}

}  // namespace
}  // namespace terrella::test
