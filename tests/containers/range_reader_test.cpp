// A file on a real server, read by ranges.

#include "streaming/http/range_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "http_test_support.h"
#include "streaming/http/http_headers.h"

namespace terrella::test {
namespace {

class RangeReaderTest : public testing::Test {
 protected:
  RangeReaderTest() {
    for (int i = 0; i < 100'000; ++i) text_ += static_cast<char>('a' + i % 26 + i / 16384 % 2);
    write_file(folder_ / "file.bin", text_);
    nginx_ = std::make_unique<ServerProcess>("nginx.py", std::vector<std::string>{folder_.path().string()});
  }
  [[nodiscard]] Url url(const std::string& name) const {
    return "http://127.0.0.1:" + std::to_string(nginx_->ready().at("port").get<int>()) + "/" + name;
  }
  /// Number of requests in nginx's log, once there are `least`: a line follows its answer.
  [[nodiscard]] std::size_t requests(std::size_t least) const {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
      const std::string log = read_text(std::string(nginx_->ready().at("access_log")));
      const auto lines = static_cast<std::size_t>(std::ranges::count(log, '\n'));
      if (lines >= least || std::chrono::steady_clock::now() > end) return lines;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  void expect_text(RangeReader& reader, std::uint64_t offset, std::uint64_t length) {
    const auto bytes = reader.read({offset, length});
    ASSERT_TRUE(bytes) << bytes.error().message;
    const std::string got(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    EXPECT_EQ(got, text_.substr(offset, length)) << offset;
  }

  ScratchFolder folder_;
  std::string text_;
  std::unique_ptr<ServerProcess> nginx_;
};

TEST_F(RangeReaderTest, ReadsAnyPartAndItsEnd) {
  RangeReader reader(url("file.bin"), {}, quick_options());
  for (const auto& [offset, length] : {std::pair(0, 1), std::pair(16383, 2), std::pair(20'000, 60'000),
                                       std::pair(99'990, 100), std::pair(99'999, 1), std::pair(0, 100'000)}) {
    expect_text(reader, static_cast<std::uint64_t>(offset), static_cast<std::uint64_t>(length));
  }
  EXPECT_TRUE(reader.read({200'000, 10})->empty());
  EXPECT_EQ(reader.version().file_bytes, text_.size());
  EXPECT_FALSE(reader.version().etag.empty());
}

TEST_F(RangeReaderTest, KnownBlocksAreNotRequestedAgainAndNeighboursAreOneRequest) {
  RangeReader reader(url("file.bin"), {}, quick_options());
  expect_text(reader, 40'000, 10);  // block 2
  expect_text(reader, 41'000, 10);
  EXPECT_EQ(requests(1), 1U);
  expect_text(reader, 0, 100'000);  // blocks 0 and 1, then 3 to 6
  EXPECT_EQ(requests(3), 3U);
}

TEST_F(RangeReaderTest, AFileThatChangesIsAnError) {
  RangeReader reader(url("file.bin"), {}, quick_options());
  expect_text(reader, 0, 10);
  write_file(folder_ / "file.bin", text_ + "more");
  const auto bytes = reader.read({50'000, 10});
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().message.find("has changed on the server"), std::string::npos) << bytes.error().message;
}

TEST_F(RangeReaderTest, AMissingFileIsNamed) {
  RangeReader reader(url("other.bin"), {}, quick_options());
  const auto bytes = reader.read({0, 10});
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().message.find("other.bin"), std::string::npos);
}

TEST_F(RangeReaderTest, TheUserMayStop) {
  RangeReader reader(url("file.bin"), {}, quick_options(), [] { return false; });
  const auto bytes = reader.read({0, 10});
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().message.find("stopped"), std::string::npos);
}

TEST(ContentRangeTest, OnlyWhatRfc9110Allows) {
  const auto range = http::parse_content_range("bytes 100-199/1234");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->bytes, (ByteRange{100, 100}));
  EXPECT_EQ(range->file_bytes, 1234U);
  EXPECT_FALSE(http::parse_content_range("Bytes 0-0/*")->file_bytes);
  for (const char* wrong : {"", "bytes", "bytes */100", "bytes 5-4/10", "bytes 0-9/9", "bytes 0-9/9x", "pages 0-9/10",
                            "bytes 0-18446744073709551615/*", "bytes 0-99999999999999999999/*", "bytes -1-5/10"}) {
    EXPECT_FALSE(http::parse_content_range(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace terrella::test
