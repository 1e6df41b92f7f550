// Drops files onto a window as a file manager does: XDND version 5 with text/uri-list. Usage: drop_files WINDOW FILE...
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <poll.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

constexpr int kPatience_ms = 60'000;

struct Drop {
  Display* display;
  Window target, source;
  std::string uris;
  [[nodiscard]] Atom atom(const char* name) const { return XInternAtom(display, name, False); }
};

void send(const Drop& drop, const char* type, const std::array<long, 5>& values) {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = drop.target;
  event.xclient.message_type = drop.atom(type);
  event.xclient.format = 32;
  for (std::size_t i = 0; i < values.size(); ++i) event.xclient.data.l[i] = values[i];
  XSendEvent(drop.display, drop.target, False, NoEventMask, &event);
  XFlush(drop.display);
}

// The target asks for the selection as text; it is put where it said.
void answer(const Drop& drop, const XSelectionRequestEvent& request) {
  XChangeProperty(drop.display, request.requestor, request.property, request.target, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(drop.uris.data()), int(drop.uris.size()));
  XEvent reply{};
  reply.xselection.type = SelectionNotify;
  reply.xselection.requestor = request.requestor;
  reply.xselection.selection = request.selection;
  reply.xselection.target = request.target;
  reply.xselection.property = request.property;
  reply.xselection.time = request.time;
  XSendEvent(drop.display, request.requestor, False, NoEventMask, &reply);
  XFlush(drop.display);
}

// True once the target has finished; it drops when the target has taken the position.
bool serve(const Drop& drop) {
  for (;;) {
    pollfd descriptor{.fd = ConnectionNumber(drop.display), .events = POLLIN, .revents = 0};
    if (XPending(drop.display) == 0 && poll(&descriptor, 1, kPatience_ms) <= 0) return false;
    XEvent event;
    XNextEvent(drop.display, &event);
    if (event.type == SelectionRequest) answer(drop, event.xselectionrequest);
    if (event.type != ClientMessage) continue;
    if (event.xclient.message_type == drop.atom("XdndFinished")) return true;
    if (event.xclient.message_type != drop.atom("XdndStatus")) continue;
    if ((event.xclient.data.l[1] & 1) == 0) return false;
    send(drop, "XdndDrop", {long(drop.source), 0, CurrentTime, 0, 0});
  }
}

}  // namespace

int main(int count, char** words) {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr || count < 3) return 2;
  Drop drop{.display = display,
            .target = std::strtoul(words[1], nullptr, 0),
            .source = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0),
            .uris = {}};
  for (int i = 2; i < count; ++i) drop.uris += "file://" + std::filesystem::absolute(words[i]).string() + "\r\n";
  XSetSelectionOwner(display, drop.atom("XdndSelection"), drop.source, CurrentTime);
  constexpr long kVersion5 = 5L << 24;
  send(drop, "XdndEnter", {long(drop.source), kVersion5, long(drop.atom("text/uri-list")), 0, 0});
  send(drop, "XdndPosition",
       {long(drop.source), 0, (200L << 16) | 200L, CurrentTime, long(drop.atom("XdndActionCopy"))});
  const bool finished = serve(drop);
  XCloseDisplay(display);
  if (!finished) std::fprintf(stderr, "the window did not take the files\n");
  return finished ? 0 : 1;
}
