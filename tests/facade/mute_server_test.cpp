// A server that accepts connections and never answers, and a source whose last owner is an answer.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <future>
#include <thread>

#include "streaming/remote/remote_source.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/support/scratch_folder.h"

namespace terrella::test {
namespace {

constexpr Viewport kMuteView{64, 64};
const TileGrid kMuteGrid{.tile_px = 16, .max_level = 1};

/// Listens on the loopback. The system accepts connections for it; nobody reads what they bring.
class MuteServer {
 public:
  MuteServer() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_, 64), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~MuteServer() { ::close(socket_); }
  MuteServer(const MuteServer&) = delete;
  MuteServer& operator=(const MuteServer&) = delete;
  [[nodiscard]] std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/{z}/{x}/{y}"; }
  /// True once a client is connected.
  [[nodiscard]] bool wait_for_a_client() const {
    pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
    return ::poll(&wait, 1, 30'000) == 1;
  }

 private:
  int socket_;
  int port_ = 0;
};

/// Longer than any test: a call that waits for the server fails by the limit of the test.
HttpOptions patient() {
  HttpOptions options;
  options.connect_timeout = options.stall_timeout = options.total_timeout = std::chrono::hours(1);
  return options;
}

std::shared_ptr<TileSource> remote(const std::string& url, const TileSetInfo& info) {
  RemoteTileSet set;
  set.info = info;
  set.url = url;
  return make_remote_source(std::move(set), nullptr, patient());
}

class MuteServers : public GlTest {
 protected:
  static TileSetInfo land_info() {
    TileSetInfo info;
    info.grid = kMuteGrid;
    return info;
  }
  static std::shared_ptr<TileSource> hills() {
    return painted_heights(kMuteGrid, [](double lat, double) { return 1000.0 * lat; });
  }
};

TEST_F(MuteServers, HoldUpNoCallThatEndsALayerHeightsOrAGlobe) {
  for (const std::string_view what : {"the globe", "the layer", "the elevation", "the elevation by another"}) {
    SCOPED_TRACE(what);
    const MuteServer server;
    const bool heights = what.starts_with("the elevation");
    std::optional<ElevationSource> elevation;
    if (heights) elevation = *ElevationSource::open(remote(server.url(), hills()->info()), "heights");
    auto land = one_colour(kMuteGrid, {10, 200, 30});
    auto globe =
        Globe::create(unlit_options(), heights ? land : remote(server.url(), land_info()), std::move(elevation));
    ASSERT_TRUE(globe) << globe.error().message;
    elevation.reset();
    draw(**globe, kMuteView);
    ASSERT_TRUE(server.wait_for_a_client());
    draw(**globe, kMuteView);
    const auto start = std::chrono::steady_clock::now();
    const auto took = [&] {
      const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
      RecordProperty("ms_" + std::to_string(what.size()), std::to_string(ms.count()));
    };
    if (what == "the elevation") {
      EXPECT_TRUE((*globe)->set_elevation({}));
    } else if (heights) {
      EXPECT_TRUE((*globe)->set_elevation(*ElevationSource::open(hills(), "hills")));
    } else if (what == "the layer") {
      EXPECT_TRUE((*globe)->remove((*globe)->imagery().front()));
    } else {
      globe->reset();
      took();
      continue;
    }
    took();
    EXPECT_EQ(settle(**globe, kMuteView).tiles_pending, 0);
    EXPECT_TRUE((*globe)->add_imagery(remote(server.url(), land_info()))) << "a further source of that server";
  }
}

// An answer runs on a thread of the source. If the answer has the source's last owner, the source ends there.
TEST(RemoteSourceOfAnAnswer, EndsOnItsOwnThread) {
  ScratchFolder folder;
  std::ofstream(folder.path() / "0-0-0") << "no picture";
  TileSetInfo info;
  info.grid = kMuteGrid;
  RemoteTileSet set;
  set.info = info;
  set.url = "file://" + (folder.path() / "{z}-{x}-{y}").string();
  std::shared_ptr<TileSource> source = make_remote_source(std::move(set), nullptr, {});
  std::promise<std::thread::id> answered;
  std::promise<void> let_go;
  RemoteTiles* tiles = source->remote();
  tiles->fetch({0, 0, 0}, 1.0, [owner = source, &answered, gone = let_go.get_future().share()](const auto&) mutable {
    gone.wait();  // until nobody else has the source
    EXPECT_EQ(owner.use_count(), 1);
    owner.reset();
    answered.set_value(std::this_thread::get_id());
  });
  source.reset();
  let_go.set_value();
  EXPECT_NE(answered.get_future().get(), std::this_thread::get_id());
}

}  // namespace
}  // namespace terrella::test
