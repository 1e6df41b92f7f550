// Certificates, and a real server: nginx with HTTP/1.1 and HTTP/2.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "http_test_support.h"

namespace terrella::test {
namespace {

/// Writes certificate.pem and key.pem for localhost, valid as `validity` says in openssl's words.
void make_certificate(const std::filesystem::path& folder, const std::string& validity) {
  write_file(folder / "empty", "");
  write_file(
      folder / "ca.cnf",
      "[ca]\ndefault_ca=d\n[d]\ndatabase=" + (folder / "empty").string() + "\nnew_certs_dir=" + folder.string() +
          "\nrand_serial=yes\ndefault_md=sha256\npolicy=p\nx509_extensions=x\nunique_subject=no\n[p]\ncommonName="
          "supplied\n[x]\nsubjectAltName=DNS:localhost,IP:127.0.0.1\nbasicConstraints=critical,CA:true\n");
  const std::string in = "cd " + folder.string() + " && ";
  const std::string request =
      in +
      "openssl req -new -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -keyout key.pem -out request.pem "
      "-subj /CN=localhost 2>/dev/null";
  ASSERT_EQ(std::system(request.c_str()), 0);
  const std::string sign = in +
                           "openssl ca -config ca.cnf -selfsign -batch -notext -keyfile key.pem -in request.pem "
                           "-out certificate.pem " +
                           validity + " 2>/dev/null";
  ASSERT_EQ(std::system(sign.c_str()), 0);
}

HttpReply fetch_over_tls(const std::filesystem::path& folder, const std::string& ca_file, const std::string& host) {
  const MisbehavingServer server({"--tls", (folder / "certificate.pem").string(), (folder / "key.pem").string()});
  HttpOptions options = quick_options();
  options.ca_file = ca_file;
  return Replies(options).fetch("https://" + host + ":" + std::to_string(server.port()) + "/ok/1?key=secret");
}

TEST(Certificate, ThatIsTrustedIsTaken) {
  const ScratchFolder folder;
  make_certificate(folder.path(), "-days 2");
  const HttpReply reply = fetch_over_tls(folder.path(), (folder.path() / "certificate.pem").string(), "127.0.0.1");
  EXPECT_EQ(reply.outcome, HttpOutcome::content) << reply.why;
}

TEST(Certificate, ThatHasExpiredIsRefusedAtOnce) {
  const ScratchFolder folder;
  make_certificate(folder.path(), "-startdate 20200101000000Z -enddate 20200102000000Z");
  const HttpReply reply = fetch_over_tls(folder.path(), (folder.path() / "certificate.pem").string(), "127.0.0.1");
  EXPECT_EQ(reply.outcome, HttpOutcome::refused);
  EXPECT_EQ(reply.attempts, 1);
  EXPECT_NE(reply.why.find("expired"), std::string::npos) << reply.why;
  EXPECT_EQ(reply.why.find("secret"), std::string::npos) << reply.why;
}

TEST(Certificate, ThatNobodySignedIsRefused) {
  const ScratchFolder folder;
  make_certificate(folder.path(), "-days 2");
  EXPECT_EQ(fetch_over_tls(folder.path(), "", "127.0.0.1").outcome, HttpOutcome::refused);
}

TEST(Certificate, OfAnotherNameIsRefused) {
  const ScratchFolder folder;
  make_certificate(folder.path(), "-days 2");
  const std::string trusted = (folder.path() / "certificate.pem").string();
  EXPECT_EQ(fetch_over_tls(folder.path(), trusted, "127.0.0.2").outcome, HttpOutcome::failed) << "nobody listens there";
  EXPECT_EQ(fetch_over_tls(folder.path(), trusted, "0.0.0.0").outcome, HttpOutcome::refused);
}

#ifdef TERRELLA_NGINX

struct Access {
  std::string connection, protocol, status, path;
};

class Nginx : public testing::Test {
 protected:
  static constexpr int kTiles = 500;

  Nginx() {
    for (int i = 0; i < kTiles; ++i) write_file(folder_.path() / "0" / (std::to_string(i) + ".jpg"), content(i));
    nginx_ = std::make_unique<ServerProcess>("nginx.py", std::vector<std::string>{folder_.path().string()});
  }

  static std::string content(int i) { return std::string(2000, static_cast<char>('a' + i % 26)) + std::to_string(i); }

  [[nodiscard]] std::string url(int i, bool tls) const {
    const int port = nginx_->ready().at(tls ? "tls_port" : "port");
    return (tls ? "https" : "http") + ("://127.0.0.1:" + std::to_string(port)) + "/0/" + std::to_string(i) + ".jpg";
  }

  [[nodiscard]] HttpOptions options() const {
    HttpOptions options = quick_options();
    options.ca_file = nginx_->ready().at("ca_file");
    return options;
  }

  [[nodiscard]] std::vector<Access> accesses() const {
    std::istringstream lines(read_text(std::string(nginx_->ready().at("access_log"))));
    std::vector<Access> accesses;
    for (Access one; lines >> one.connection >> one.protocol >> one.status >> one.path;) accesses.push_back(one);
    return accesses;
  }

  /// Fetches all tiles; their connections, as nginx numbers them.
  std::set<std::string> fetch_all(bool tls, const HttpOptions& with, const std::string& protocol) {
    Replies replies(with);
    std::vector<std::uint64_t> ids;
    for (int i = 0; i < kTiles; ++i) ids.push_back(replies.get(url(i, tls)));
    for (int i = 0; i < kTiles; ++i) {
      const HttpReply reply = replies.wait(ids[i]);
      EXPECT_EQ(reply.outcome, HttpOutcome::content) << reply.why;
      EXPECT_EQ(std::string(reinterpret_cast<const char*>(reply.body.data()), reply.body.size()), content(i));
    }
    EXPECT_EQ(replies.fetcher().counts().requests, static_cast<std::size_t>(kTiles));
    std::set<std::string> connections;
    for (const Access& access : accesses()) {
      connections.insert(access.connection);
      EXPECT_EQ(access.protocol, protocol);
    }
    return connections;
  }

 private:
  ScratchFolder folder_;
  std::unique_ptr<ServerProcess> nginx_;
};

TEST_F(Nginx, KeepsItsFewConnectionsForFiveHundredRequests) {
  EXPECT_LE(fetch_all(false, options(), "HTTP/1.1").size(), 6U);
}

TEST_F(Nginx, Http2MultiplexesOverOneConnection) { EXPECT_EQ(fetch_all(true, options(), "HTTP/2.0").size(), 1U); }

TEST_F(Nginx, Http2MayBeSwitchedOff) {
  HttpOptions without = options();
  without.http2 = false;
  EXPECT_LE(fetch_all(true, without, "HTTP/1.1").size(), 6U);
}

TEST_F(Nginx, Http2CancelsOneStreamAlone) {
  Replies replies(options());
  EXPECT_EQ(replies.fetch(url(0, true)).outcome, HttpOutcome::content);
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < kTiles; ++i) ids.push_back(replies.get(url(i, true)));
  for (int i = 0; i < kTiles; i += 2) replies.fetcher().cancel(ids[i]);
  for (int i = 1; i < kTiles; i += 2) EXPECT_EQ(replies.wait(ids[i]).outcome, HttpOutcome::content);
  std::set<std::string> connections;
  for (const Access& access : accesses()) connections.insert(access.connection);
  EXPECT_EQ(connections.size(), 1U);
}

TEST_F(Nginx, AnswersConditionalRequestsWith304) {
  Replies replies(options());
  const HttpReply first = replies.fetch(url(3, true));
  ASSERT_EQ(first.outcome, HttpOutcome::content);
  ASSERT_TRUE(first.expires_unix_s.has_value());
  HttpRequest by_tag;
  by_tag.id = 1000;
  by_tag.url = url(3, true);
  by_tag.etag = first.etag;
  HttpRequest by_date = by_tag;
  by_date.id = 1001;
  by_date.etag.clear();
  by_date.last_modified = first.last_modified;
  replies.get(by_tag);
  replies.get(by_date);
  for (const std::uint64_t id : {1000, 1001}) {
    const HttpReply again = replies.wait(id);
    EXPECT_EQ(again.outcome, HttpOutcome::not_modified) << again.why;
    EXPECT_EQ(again.etag, first.etag);
    EXPECT_TRUE(again.expires_unix_s.has_value());
  }
  EXPECT_EQ(replies.fetch(url(kTiles, true)).outcome, HttpOutcome::nothing);
}

#endif

}  // namespace
}  // namespace terrella::test
