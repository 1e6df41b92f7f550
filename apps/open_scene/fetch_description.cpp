#include "apps/open_scene/fetch_description.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/process/stop_signals.h"
#include "streaming/http/reply_queue.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote/remote_pmtiles.h"

namespace terrella {

Result<RemoteTileSet> fetch_description(const Url& source, const RemoteOptions& remote, const HttpOptions& http) {
  if (is_pmtiles_address(source)) {
    RangeReader reader(source, remote.headers, http, may_wait);
    return describe_remote_pmtiles(source, remote, reader);
  }
  return describe_remote(source, remote, [&](const Url& url, const std::vector<std::string>& headers) {
    return fetch_document(http, url, headers);
  });
}

HttpOptions within_limits(HttpOptions http, const RemoteTileSet& set) {
  if (set.timeout) http.total_timeout = std::min<std::chrono::milliseconds>(http.total_timeout, *set.timeout);
  if (set.connections > 0) http.connections_per_host = std::min(http.connections_per_host, set.connections);
  return http;
}

Result<std::vector<std::byte>> fetch_document(const HttpOptions& http, const Url& url,
                                              const std::vector<std::string>& headers) {
  ReplyQueue replies;
  HttpFetcher fetcher(http, replies);
  HttpRequest request;
  request.url = url;
  request.headers = headers;
  fetcher.submit(std::move(request));
  constexpr std::chrono::milliseconds kBetweenLooks{100};
  std::vector<HttpReply> answer;
  while (answer.empty()) {
    if (!may_wait()) return Error{"stopped before it answered"};
    answer = replies.take_all(kBetweenLooks);
  }
  HttpReply& reply = answer.front();
  if (reply.outcome != HttpOutcome::content) return Error{reply.why};
  return std::move(reply.body);
}

}  // namespace terrella
