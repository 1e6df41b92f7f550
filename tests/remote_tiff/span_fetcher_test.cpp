// Spans of a file on a real server.

#include "streaming/remote_tiff/span_fetcher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <span>

#include "served_folder.h"

namespace terrella::test {
namespace {

Status any_bytes(const ByteRange&, std::span<const std::byte>) { return Done{}; }

class SpanFetcherTest : public testing::Test {
 protected:
  SpanFetcherTest() {
    for (int i = 0; i < 3'000'000; ++i) text_ += static_cast<char>('a' + i % 23);
    write_file(served_ / "file.bin", text_);
  }
  FileAddress address() { return {.url = served_.url("file.bin"), .headers = {}, .version = {}}; }
  /// Answers by number, once there are as many.
  static std::map<std::uint64_t, HttpReply> take(ReplyQueue& answers, std::size_t count) {
    std::map<std::uint64_t, HttpReply> taken;
    while (taken.size() < count) {
      auto answer = answers.take();
      if (!answer) break;
      const std::uint64_t number = answer->id;
      taken.emplace(number, *std::move(answer));
    }
    return taken;
  }
  void expect_text(const HttpReply& answer, std::uint64_t offset, std::uint64_t length) {
    ASSERT_EQ(answer.outcome, HttpOutcome::content) << answer.why;
    const std::string got(reinterpret_cast<const char*>(answer.body.data()), answer.body.size());
    EXPECT_TRUE(got == text_.substr(offset, length)) << offset;
  }

  ServedFolder served_;
  std::string text_;
  ReplyQueue answers_;
};

TEST_F(SpanFetcherTest, NeighboursAreOneRequest) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  // Nine spans with 8 bytes between them, and one far away.
  for (std::uint64_t i = 0; i < 9; ++i) fetcher.fetch(i, {1000 + i * 508, 500}, static_cast<double>(i), any_bytes);
  fetcher.fetch(9, {2'000'000, 700}, 5.0, any_bytes);
  const auto taken = take(answers_, 10);
  for (std::uint64_t i = 0; i < 9; ++i) expect_text(taken.at(i), 1000 + i * 508, 500);
  expect_text(taken.at(9), 2'000'000, 700);
  EXPECT_EQ(served_.requests(2), 2U);
}

TEST_F(SpanFetcherTest, OverlappingAndEqualSpansGetTheirOwnBytes) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  const std::vector<ByteRange> spans = {{100, 1000}, {600, 100}, {600, 100}, {50, 3000}, {0, 10}};
  for (std::size_t i = 0; i < spans.size(); ++i) fetcher.fetch(i, spans[i], 0.0, any_bytes);
  const auto taken = take(answers_, spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) expect_text(taken.at(i), spans[i].offset, spans[i].length);
}

TEST_F(SpanFetcherTest, AGroupHasAtMostOneMebibyte) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  for (std::uint64_t i = 0; i < 6; ++i) fetcher.fetch(i, {i * 400'000, 400'000}, 0.0, any_bytes);
  const auto taken = take(answers_, 6);
  for (std::uint64_t i = 0; i < 6; ++i) expect_text(taken.at(i), i * 400'000, 400'000);
  EXPECT_EQ(served_.requests(3), 3U);
}

TEST_F(SpanFetcherTest, TheFileMayEndTooEarly) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  fetcher.fetch(1, {text_.size() - 100, 200}, 0.0, any_bytes);
  fetcher.fetch(2, {text_.size() - 300, 100}, 0.0, any_bytes);
  const auto taken = take(answers_, 2);
  expect_text(taken.at(2), text_.size() - 300, 100);
  EXPECT_EQ(taken.at(1).outcome, HttpOutcome::refused);
  EXPECT_NE(taken.at(1).why.find("truncated"), std::string::npos) << taken.at(1).why;
}

TEST_F(SpanFetcherTest, ASpanThatDoesNotDecodeIsRequestedOnceMore) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  std::atomic<int> looks = 0;
  const auto bad = [&looks](int times) {
    return [&looks, times](const ByteRange&, std::span<const std::byte>) {
      return ++looks <= times ? Status(Error{"not so"}) : Status(Done{});
    };
  };
  fetcher.fetch(1, {1000, 500}, 0.0, bad(1));
  expect_text(take(answers_, 1).at(1), 1000, 500);
  EXPECT_EQ(looks, 2);
  fetcher.fetch(2, {1000, 500}, 0.0, bad(100));
  const HttpReply broken = take(answers_, 1).at(2);
  EXPECT_EQ(broken.outcome, HttpOutcome::broken);
  EXPECT_NE(broken.why.find("file.bin: bytes of a tile do not decode: not so"), std::string::npos) << broken.why;
  EXPECT_TRUE(broken.body.empty());
  EXPECT_EQ(looks, 4);
  EXPECT_EQ(served_.requests(4), 4U);
}

TEST_F(SpanFetcherTest, AnotherVersionIsRefused) {
  FileAddress other = address();
  other.version.etag = "\"another\"";
  SpanFetcher fetcher(other, quick_options(), answers_);
  fetcher.fetch(1, {0, 10}, 0.0, any_bytes);
  const auto taken = take(answers_, 1);
  EXPECT_EQ(taken.at(1).outcome, HttpOutcome::refused);
  EXPECT_EQ(taken.at(1).status, 412);
  EXPECT_NE(taken.at(1).why.find("file.bin: the file has changed"), std::string::npos) << taken.at(1).why;
}

TEST_F(SpanFetcherTest, ACancelledSpanIsNotAnswered) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  fetcher.fetch(1, {0, 10}, 0.0, any_bytes);
  fetcher.fetch(2, {20, 10}, 0.0, any_bytes);
  fetcher.cancel(1);
  fetcher.fetch(3, {500'000, 10}, -1.0, any_bytes);
  const auto taken = take(answers_, 2);
  EXPECT_TRUE(taken.contains(2) && taken.contains(3));
}

TEST_F(SpanFetcherTest, ASpanThatIsCancelledWhileItIsCheckedIsNotRequestedAgain) {
  SpanFetcher fetcher(address(), quick_options(), answers_);
  fetcher.fetch(1, {0, 10}, 0.0, [&fetcher](const ByteRange&, std::span<const std::byte>) {
    fetcher.cancel(1);
    return Status(Error{"not so"});
  });
  fetcher.fetch(2, {20, 10}, 0.0, any_bytes);
  expect_text(take(answers_, 1).at(2), 20, 10);
  fetcher.fetch(3, {500'000, 10}, 0.0, any_bytes);
  EXPECT_EQ(take(answers_, 1).begin()->first, 3U);
  EXPECT_EQ(served_.requests(2), 2U);
}

}  // namespace
}  // namespace terrella::test
