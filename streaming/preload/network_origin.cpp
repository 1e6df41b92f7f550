#include <utility>

#include "streaming/preload/tile_origin.h"
#include "streaming/remote/tile_fetcher.h"

namespace terrella {
namespace {

class NetworkOrigin : public TileOrigin {
 public:
  NetworkOrigin(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& answers)
      : fetcher_(set, options, answers) {}

  void ask(TileQuestion question) override {
    HttpRequest request;
    request.id = question.number;
    request.etag = std::move(question.etag);
    request.last_modified = std::move(question.last_modified);
    fetcher_.fetch(question.id, std::move(request));
  }
  void withdraw(std::uint64_t number) override { fetcher_.cancel(number); }
  [[nodiscard]] HttpCounts counts() const override { return fetcher_.counts(); }

 private:
  TileFetcher fetcher_;
};

}  // namespace

std::unique_ptr<TileOrigin> network_origin(const RemoteTileSet& set, const HttpOptions& options, ReplyQueue& answers) {
  return std::make_unique<NetworkOrigin>(set, options, answers);
}

}  // namespace terrella
