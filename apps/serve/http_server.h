#pragma once

#include <functional>
#include <memory>
#include <string>

#include "apps/serve/web_request.h"
#include "base/result.h"

namespace terrella {

struct HttpServerOptions {
  std::string host = "127.0.0.1";  ///< a name or address of this machine
  int port = 0;                    ///< 0: any free one
  int connections = 1024;          ///< open at once, with a file each; others wait
};

/// An HTTP/1.1 server of libmicrohttpd. It answers from a few threads, and makes answers that take long
/// (WebAnswer::later) in others. thread: main
class HttpServer {
 public:
  /// Gives an answer to a request. thread: any, several at once
  using Answerer = std::function<WebAnswer(const WebRequest& request)>;

  /// Begins to listen. The error names the address, the reason and a cure.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> start(const HttpServerOptions& options, Answerer answerer);
  /// Ends all connections, finished or not.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// "http://127.0.0.1:8080"
  [[nodiscard]] const std::string& address() const;
  [[nodiscard]] int port() const;
  /// True if only this machine reaches the server.
  [[nodiscard]] bool is_loopback() const;

 private:
  class Work;
  explicit HttpServer(std::unique_ptr<Work> work);
  const std::unique_ptr<Work> work_;
};

}  // namespace terrella
