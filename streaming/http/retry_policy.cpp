#include "streaming/http/retry_policy.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace terrella::http {
namespace {

using Next = Verdict::Next;

constexpr Verdict refused(std::string_view why) { return {Next::reply, HttpOutcome::refused, why}; }
constexpr Verdict again(std::string_view why) { return {Next::again, HttpOutcome::failed, why}; }
constexpr Verdict wait(std::string_view why) { return {Next::wait, HttpOutcome::failed, why}; }
constexpr Verdict nothing(std::string_view why) { return {Next::reply, HttpOutcome::nothing, why}; }

constexpr std::string_view kNotHttp = "the server's answer is not HTTP; check the scheme and the port of the address";

Verdict judge_client_error(int status) {
  switch (status) {
    case 401:
      return refused("needs a login or a key");
    case 403:
      return refused("access is not allowed");
    case 404:
      return nothing("does not exist");
    case 408:
      return again("the server waited too long for the request");
    case 410:
      return nothing("does not exist any more");
    case 425:
      return again("asked too early");
    case 429:
      return wait("too many requests");
    default:
      return refused("the server does not accept the request");
  }
}

constexpr Verdict kGoodContent{Next::reply, HttpOutcome::content, {}};

/// Statuses that mean something else for a request of a range; none for other statuses.
std::optional<Verdict> judge_ranged(const Answer& answer) {
  switch (answer.status) {
    case 200:
    case 203:
      return refused(
          "the server ignores byte ranges and sends the whole file; download the file and open it from disk");
    case 206:
      if (answer.range_fits) return kGoodContent;
      return refused("the server sent other bytes than were requested (Content-Range)");
    case 412:
      return refused("the file has changed on the server since it was opened; open it again");
    case 416:
      return refused("the file on the server ends before the requested bytes; it is truncated or has changed");
    default:
      return std::nullopt;
  }
}

Verdict judge_status(const Answer& answer) {
  if (answer.ranged) {
    if (const auto verdict = judge_ranged(answer)) return *verdict;
  }
  const int status = answer.status;
  switch (status) {
    case 200:
    case 203:
      return kGoodContent;
    case 204:
    case 205:
      return nothing("the server says that there is nothing");
    case 301:
    case 302:
    case 303:
    case 307:
    case 308:
      return {Next::redirect, HttpOutcome::refused, "redirected to nowhere"};
    case 304:
      if (answer.conditional) return {Next::reply, HttpOutcome::not_modified, {}};
      return refused("answered \"not modified\" (304) to a request that was not conditional");
    case 503:
      return wait("the service is not available");
    default:
      break;
  }
  if (status >= 500) return again("the server failed");
  if (status >= 400) return judge_client_error(status);
  return refused("answered with a status that no tile has");
}

Verdict judge_failure(CURLcode code) {
  switch (code) {
    // Only http and https reach curl. "Unsupported" therefore means an answer without an HTTP status line.
    case CURLE_UNSUPPORTED_PROTOCOL:
      return refused(kNotHttp);
    case CURLE_WEIRD_SERVER_REPLY:
      return again(kNotHttp);
    case CURLE_URL_MALFORMAT:
      return refused("the address cannot be read");
    case CURLE_FILESIZE_EXCEEDED:
      return refused("the body is over the limit of bytes");
    case CURLE_PEER_FAILED_VERIFICATION:
      return refused("the server's certificate is not good");
    case CURLE_SSL_CACERT_BADFILE:
      return refused("the certificates to trust cannot be read");
    case CURLE_SSL_CERTPROBLEM:
      return refused("the own certificate is not good");
    case CURLE_BAD_CONTENT_ENCODING:
      return again("the body cannot be decompressed");
    case CURLE_PARTIAL_FILE:
      return again("the body ends too early");
    default:
      return again({});
  }
}

Verdict judge_cut(const Answer& answer) {
  switch (answer.cut) {
    case Cut::body_too_large:
      return refused("the body is over the limit of bytes");
    case Cut::headers_too_long:
      return refused("the header of the answer is too long");
    case Cut::no_memory:
      return {Next::reply, HttpOutcome::failed, "no memory for the body"};
    case Cut::error_body:
    case Cut::none:
      break;
  }
  return judge_status(answer);
}

/// True if the status alone decides, whatever happened to the body.
bool is_told_by_status(const Answer& answer) {
  const bool whole = answer.status == 200 || answer.status == 203;
  const bool has_body_to_lose = answer.status == 0 || (answer.ranged ? answer.status == 206 : whole);
  return answer.code == CURLE_OK || (!has_body_to_lose && answer.status >= 200);
}

}  // namespace

Verdict judge(const Answer& answer) {
  if (answer.cut != Cut::none) return judge_cut(answer);
  if (is_told_by_status(answer)) return judge_status(answer);
  Verdict verdict = judge_failure(answer.code);
  if (verdict.why.empty()) verdict.why = curl_easy_strerror(answer.code);
  return verdict;
}

std::chrono::milliseconds backoff(const HttpOptions& options, int attempt, double random) {
  const double doubled_ms = static_cast<double>(options.first_backoff.count()) * std::exp2(attempt - 1);
  const double bounded_ms = std::min(doubled_ms, static_cast<double>(options.longest_backoff.count()));
  return std::chrono::milliseconds(static_cast<std::int64_t>(bounded_ms * (0.75 + 0.5 * random)));
}

}  // namespace terrella::http
