// Fetches a list of addresses and tells requests a second and processor time a request, to be compared with
// `curl --parallel`.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <vector>

#include "streaming/http/reply_queue.h"

namespace {

using namespace terrella;

struct Tally {
  std::size_t ended = 0;
  std::uint64_t bytes = 0;
  std::map<HttpOutcome, std::size_t> outcomes;
  std::string first_fault;

  void add(const HttpReply& reply) {
    ++ended;
    bytes += reply.body.size();
    ++outcomes[reply.outcome];
    if (first_fault.empty()) first_fault = reply.why;
  }
};

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

void run(const std::vector<std::string>& urls, const HttpOptions& options) {
  using Seconds = std::chrono::duration<double>;
  Tally tally;
  const double cpu_before_s = cpu_s();
  const auto begin = std::chrono::steady_clock::now();
  {
    ReplyQueue replies;
    HttpFetcher fetcher(options, replies);
    for (std::size_t i = 0; i < urls.size(); ++i) {
      HttpRequest request;
      request.id = i;
      request.url = urls[i];
      fetcher.submit(std::move(request));
    }
    while (tally.ended < urls.size()) tally.add(*replies.take());
  }
  const double wall_s = Seconds(std::chrono::steady_clock::now() - begin).count();
  const auto count = static_cast<double>(urls.size());
  fmt::print("{} requests in {:.3f} s: {:.0f} a second, {:.1f} us of processor each, {:.1f} MB\n", urls.size(), wall_s,
             count / wall_s, (cpu_s() - cpu_before_s) / count * 1e6, static_cast<double>(tally.bytes) * 1e-6);
  fmt::print("content {}, nothing {}, refused {}, failed {}{}{}\n", tally.outcomes[HttpOutcome::content],
             tally.outcomes[HttpOutcome::nothing], tally.outcomes[HttpOutcome::refused],
             tally.outcomes[HttpOutcome::failed], tally.first_fault.empty() ? "" : "; first: ", tally.first_fault);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Requests a second, and processor time a request"};
  std::string list;
  HttpOptions options;
  app.add_option("list", list, "File with an address a line")->required()->check(CLI::ExistingFile);
  app.add_option("--connections", options.connections_per_host, "To a host")->check(CLI::Range(1, 64));
  app.add_option("--in-flight", options.in_flight_per_host, "Requests, of HTTP/2")->check(CLI::Range(1, 1024));
  app.add_option("--ca-file", options.ca_file, "Certificates to trust");
  app.add_flag("!--http1", options.http2, "No HTTP/2");
  CLI11_PARSE(app, argc, argv);
  run(lines_of(list), options);
  return 0;
}
