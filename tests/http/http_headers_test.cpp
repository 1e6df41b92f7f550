#include "streaming/http/http_headers.h"

#include <gtest/gtest.h>

#include "streaming/http/http_address.h"

namespace terrella::http {
namespace {

constexpr std::int64_t kNow = 784111777;  // Sun, 06 Nov 1994 08:49:37 GMT, the date of RFC 9110's examples

ReplyFields read(std::initializer_list<std::string_view> lines) {
  ReplyFields fields;
  for (const std::string_view line : lines) read_field_line(line, fields);
  return fields;
}

std::optional<std::int64_t> life_s(std::initializer_list<std::string_view> lines) {
  const auto expiry = expiry_unix_s(read(lines), kNow);
  if (!expiry) return std::nullopt;
  return *expiry - kNow;
}

TEST(ReplyFields, AreReadWhateverTheirCaseAndBlanks) {
  const ReplyFields fields = read({"HTTP/1.1 200 OK\r\n", "CONTENT-type:  image/jpeg \r\n", "etag:\"a\"\r\n",
                                   "Last-Modified: Sun, 06 Nov 1994 08:49:37 GMT\r\n", "\r\n"});
  EXPECT_EQ(fields.content_type, "image/jpeg");
  EXPECT_EQ(fields.etag, "\"a\"");
  EXPECT_EQ(fields.last_modified, "Sun, 06 Nov 1994 08:49:37 GMT");
}

TEST(ReplyFields, OfAnInterimAnswerDoNotCount) {
  const ReplyFields fields = read({"HTTP/1.1 103 Early Hints", "ETag: \"early\"", "Cache-Control: no-store", "",
                                   "HTTP/1.1 200 OK", "Content-Type: image/png"});
  EXPECT_EQ(fields.etag, "");
  EXPECT_FALSE(fields.no_store);
  EXPECT_EQ(fields.content_type, "image/png");
  EXPECT_EQ(fields.bytes, 98U) << "of both";
}

TEST(ReplyFields, WithControlCharactersOrTooLongAreLeftOut) {
  EXPECT_EQ(read({std::string_view("ETag: \"a\rX: y\"")}).etag, "");
  const std::string longest(ReplyFields::kMaxValueBytes, 'x');
  EXPECT_EQ(read({"ETag: " + longest}).etag, longest);
  EXPECT_EQ(read({"ETag: " + longest + "x"}).etag, "");
}

TEST(Expiry, ComesFromMaxAgeLessAge) {
  EXPECT_EQ(life_s({"Cache-Control: max-age=60"}), 60);
  EXPECT_EQ(life_s({"Cache-Control: public, MAX-AGE=60", "Age: 20"}), 40);
  EXPECT_EQ(life_s({"Cache-Control: max-age=60", "Age: 100"}), -40);
  EXPECT_EQ(life_s({"Cache-Control: max-age=\"60\""}), 60);
  EXPECT_EQ(life_s({"Cache-Control: private=\"a, max-age=5\", max-age=60"}), 60) << "a comma inside quotes";
  EXPECT_EQ(life_s({"Cache-Control: max-age=60", "Cache-Control: max-age=30"}), 30);
  EXPECT_EQ(life_s({"Cache-Control: max-age=soon"}), 0);
  EXPECT_EQ(life_s({"Cache-Control: max-age=-1"}), 0);
  EXPECT_EQ(life_s({"Cache-Control: max-age=99999999999999999999"}), ReplyFields::kForever_s);
}

TEST(Expiry, ComesFromExpiresByTheServersClock) {
  EXPECT_EQ(life_s({"Expires: Sun, 06 Nov 1994 09:49:37 GMT"}), 3600);
  EXPECT_EQ(life_s({"Date: Sun, 06 Nov 1994 09:00:00 GMT", "Expires: Sun, 06 Nov 1994 09:00:10 GMT"}), 10);
  EXPECT_EQ(life_s({"Expires: 0"}), 0);
  EXPECT_EQ(life_s({"Expires: Sun, 06 Nov 1994 09:49:37 GMT", "Cache-Control: max-age=5"}), 5);
}

TEST(Expiry, IsNowOrUnsaid) {
  EXPECT_EQ(life_s({"Cache-Control: no-cache, max-age=60"}), 0);
  EXPECT_EQ(life_s({"Cache-Control: no-store"}), 0);
  EXPECT_TRUE(read({"Cache-Control: no-store"}).no_store);
  EXPECT_EQ(life_s({"Cache-Control: public"}), std::nullopt);
  EXPECT_EQ(life_s({}), std::nullopt);
}

TEST(RetryAfter, IsSecondsOrADate) {
  using std::chrono::seconds;
  EXPECT_EQ(retry_after(read({"Retry-After: 120"}), kNow), seconds(120));
  EXPECT_EQ(retry_after(read({"Retry-After: Sun, 06 Nov 1994 08:50:37 GMT"}), kNow), seconds(60));
  EXPECT_EQ(
      retry_after(read({"Date: Sun, 06 Nov 1994 08:50:07 GMT", "Retry-After: Sun, 06 Nov 1994 08:50:37 GMT"}), kNow),
      seconds(30));
  EXPECT_EQ(retry_after(read({"Retry-After: Sunday, 06-Nov-94 08:50:37 GMT"}), kNow), seconds(60)) << "obsolete form";
  EXPECT_EQ(retry_after(read({"Retry-After: 0"}), kNow), std::nullopt);
  EXPECT_EQ(retry_after(read({"Retry-After: Sun, 06 Nov 1994 08:40:37 GMT"}), kNow), std::nullopt);
  EXPECT_EQ(retry_after(read({"Retry-After: later"}), kNow), std::nullopt);
  EXPECT_EQ(retry_after(read({"Retry-After: 99999999999999999999"}), kNow), seconds(ReplyFields::kForever_s));
}

TEST(RequestHeader, IsRefusedByNameAndWithoutItsValue) {
  EXPECT_TRUE(check_request_header("X-Key: secret").ok());
  EXPECT_TRUE(check_request_header("Authorization: Bearer secret").ok());
  for (const std::string_view header : {"X-Key: secret\r\nHost: b", "X-Key: secret\nA: b", "User-Agent: secret",
                                        "host: secret", "X Key: secret", ": secret", "secret", ""}) {
    const Status status = check_request_header(header);
    ASSERT_FALSE(status.ok()) << header;
    EXPECT_EQ(status.error().message.find("secret"), std::string::npos) << header;
  }
  EXPECT_NE(check_request_header("X-Key: a\r\nHost: b").error().message.find("X-Key"), std::string::npos);
}

TEST(HttpAddress, HasAnOriginAndNoQuery) {
  const auto address = parse_http_address("HTTPS://user:word@Tiles.Example/a/b.jpg?key=secret#c");
  ASSERT_TRUE(address.ok());
  EXPECT_EQ(address->scheme, Address::Scheme::https);
  EXPECT_EQ(shown(*address), "https://tiles.example:443/a/b.jpg");
  EXPECT_EQ(parse_http_address("http://[::1]:8080/")->origin, "http://[::1]:8080");
  EXPECT_EQ(parse_http_address("file:///a%20b/c.jpg")->path, "/a b/c.jpg");
}

TEST(HttpAddress, IsRefusedWithoutItsQuery) {
  for (const std::string url : {"ftp://h/a?secret", "gopher://h/?secret", "http://h/a\r\nX: y?secret",
                                "http://h/a b?secret", "http://", "a/b?secret", "", "file://other/etc/x?secret",
                                "file:///a%00?secret", "http://h:99999/?secret", "javascript:secret"}) {
    const auto address = parse_http_address(url);
    ASSERT_FALSE(address.ok()) << url;
    EXPECT_EQ(address.error().message.find("secret"), std::string::npos) << address.error().message;
  }
}

}  // namespace
}  // namespace terrella::http
