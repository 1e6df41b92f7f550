#include <utility>

#include "streaming/preload/tile_origin.h"

namespace terrella {
namespace {

class NetworkOrigin : public TileOrigin {
 public:
  NetworkOrigin(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& answers)
      : set_(set), fetcher_(options, answers) {}

  void ask(TileQuestion question) override {
    HttpRequest request;
    request.id = question.number;
    request.url = tile_url(set_, question.id);
    request.headers = set_.headers;
    request.etag = std::move(question.etag);
    request.last_modified = std::move(question.last_modified);
    fetcher_.submit(std::move(request));
  }
  void withdraw(std::uint64_t number) override { fetcher_.cancel(number); }
  [[nodiscard]] HttpCounts counts() const override { return fetcher_.counts(); }

 private:
  RemoteTileSet set_;
  HttpFetcher fetcher_;
};

}  // namespace

std::unique_ptr<TileOrigin> network_origin(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& answers) {
  return std::make_unique<NetworkOrigin>(set, options, answers);
}

}  // namespace terrella
