#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>

#include "streaming/http/network.h"

namespace terrella::http {
namespace {

using std::chrono::milliseconds;

std::int64_t unix_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string status_text(int status) { return status >= 400 ? fmt::format(" (status {})", status) : std::string(); }

}  // namespace

// Answers come back -----------------------------------------------------------------------------------------------

bool Network::collect() {
  bool any = false;
  int left = 0;
  while (const CURLMsg* message = curl_multi_info_read(multi_.get(), &left)) {
    if (message->msg != CURLMSG_DONE) continue;
    any = true;
    const CURLcode code = message->data.result;
    Job* job = nullptr;
    curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &job);
    finish(*job, code);
  }
  return any;
}

void Network::finish(Job& job, CURLcode code) {
  std::unique_ptr<Transfer> transfer = detach(job);
  const Answer answer = transfer->answer(code);
  Verdict verdict = judge(answer);
  HostGate& gate = job.host->gate;
  gate.answered(verdict.next == Verdict::Next::reply || verdict.next == Verdict::Next::redirect);
  if (answer.status != 0) gate.learn(transfer->multiplexed());
  if (job.state == Job::State::abandoned) {
    leave_host(job);
    std::erase_if(abandoned_, [&](const auto& abandoned) { return abandoned.get() == &job; });
  } else if (verdict.next == Verdict::Next::reply) {
    reply_answer(job, verdict, answer.status, *transfer);
  } else if (verdict.next == Verdict::Next::redirect) {
    redirect(job, verdict, answer.status, transfer->redirect_url());
  } else {
    try_again(job, verdict, answer.status, *transfer);
  }
  recycle(std::move(transfer));
}

void Network::redirect(Job& job, const Verdict& verdict, int status, Url url) {
  const std::string from = shown(job.address);
  if (url.empty()) return reply(job, HttpOutcome::refused, status, from + ": " + std::string(verdict.why));
  if (++job.redirects > options_.max_redirects) {
    return reply(job, HttpOutcome::refused, status,
                 fmt::format("{}: redirected more than {} times", from, options_.max_redirects));
  }
  Result<Address> address = parse_http_address(url);
  if (!address) return reply(job, HttpOutcome::refused, status, from + " redirects: " + address.error().message);
  if (address->scheme == Address::Scheme::file) {
    return reply(job, HttpOutcome::refused, status, from + ": redirects to a file of this machine");
  }
  if (address->origin != job.address.origin) job.may_send_headers = false;
  job.redirected_url = std::move(url);
  job.address = std::move(*address);
  job.is_hop = true;
  leave_host(job);
  put_back(job);
  enqueue(job);
}

// Updates the two counts in this order so that their sum is never 0 while a request is in progress.
void Network::put_back(Job& job) {
  job.state = Job::State::ready;
  ++tally_->waiting;
  --tally_->in_flight;
}

void Network::try_again(Job& job, const Verdict& verdict, int status, const Transfer& transfer) {
  Host& host = *job.host;
  const milliseconds own_wait = backoff(options_, job.attempts, std::uniform_real_distribution<double>()(random_));
  const bool host_waits = verdict.next == Verdict::Next::wait && pause(host, status, transfer.fields(), own_wait);
  if (host.gate.is_given_up(now_)) return reply_given_up(job);
  if (job.attempts >= options_.attempts) {
    return reply(
        job, HttpOutcome::failed, status,
        fmt::format("{}: {}{}, after {} attempts", shown(job.address), verdict.why, status_text(status), job.attempts));
  }
  put_back(job);
  if (host_waits) return enqueue(job);
  job.state = Job::State::delayed;
  job.due = std::chrono::steady_clock::now() + own_wait;
  delayed_.insert(&job);
}

// A 503 without Retry-After may concern one tile only. A 429 concerns all requests to the host.
bool Network::pause(Host& host, int status, const ReplyFields& fields, milliseconds own_wait) {
  const std::int64_t now_unix_s = unix_now_s();
  const auto asked = retry_after(fields, now_unix_s);
  if (!asked && status != 429) return false;
  const Time now = std::chrono::steady_clock::now();
  if (asked && *asked > options_.longest_wait) {
    host.gate.give_up(now + *asked);
    host.given_up_why = fmt::format("asks to be left alone until {:%Y-%m-%d %H:%M:%S} UTC (status {})",
                                    fmt::gmtime(static_cast<std::time_t>(now_unix_s + asked->count())), status);
    fail_waiting(host);
    return true;
  }
  host.gate.pause(now + (asked ? Time::duration(*asked) : Time::duration(own_wait)), now);
  return true;
}

void Network::fail_waiting(Host& host) {
  std::vector<Job*> waiting(host.ready.begin(), host.ready.end());
  std::copy_if(delayed_.begin(), delayed_.end(), std::back_inserter(waiting),
               [&](const Job* job) { return job->host == &host; });
  for (Job* job : waiting) reply_given_up(*job);
}

void Network::reply_given_up(Job& job) {
  reply(job, HttpOutcome::failed, 0, job.address.origin + " " + job.host->given_up_why);
}

HttpReply Network::begin_reply(const Job& job, HttpOutcome outcome, int status) {
  HttpReply reply;
  reply.id = job.request.id;
  reply.outcome = outcome;
  reply.status = status;
  reply.attempts = job.attempts;
  return reply;
}

void Network::reply(Job& job, HttpOutcome outcome, int status, std::string why) {
  HttpReply ended = begin_reply(job, outcome, status);
  ended.why = std::move(why);
  hand_over(job, std::move(ended));
}

void Network::reply_answer(Job& job, const Verdict& verdict, int status, Transfer& transfer) {
  const ReplyFields& fields = transfer.fields();
  HttpReply reply = begin_reply(job, verdict.outcome, status);
  if (verdict.outcome == HttpOutcome::content) reply.body = transfer.take_body();
  reply.content_type = fields.content_type;
  reply.etag = fields.etag;
  reply.last_modified = fields.last_modified;
  reply.expires_unix_s = expiry_unix_s(fields, unix_now_s());
  reply.no_store = fields.no_store;
  if (fields.content_range) reply.file_bytes = fields.content_range->file_bytes;
  if (!verdict.why.empty()) {
    reply.why = fmt::format("{}: {}{}", shown(job.address), verdict.why, status_text(status));
    if (!transfer.certificate_fault().empty()) reply.why += fmt::format(": {}", transfer.certificate_fault());
  }
  hand_over(job, std::move(reply));
}

// Whoever is told may ask again under the same identity, so the job ends before.
void Network::hand_over(Job& job, HttpReply&& reply, ReplyQueue::Finish finish) {
  std::atomic<std::size_t>& count = job.state == Job::State::in_flight ? tally_->in_flight : tally_->waiting;
  tally_->body_bytes += reply.body.size();
  const std::unique_ptr<Job> ended = remove(job);
  leave_host(*ended);
  replies_.push(std::move(reply), std::move(finish));
  --count;
}

}  // namespace terrella::http
