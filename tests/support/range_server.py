"""Serves one file by byte ranges, with a fault, and notes what was asked for."""

import contextlib
import http.server
import re
import threading
import time


class RangeServer(http.server.BaseHTTPRequestHandler):
    """`fault`: see do_GET(); "later FAULT" begins after the first request. `asked`: first and last byte of each request.
    `spoil`: what is sent, of the number of the request from 1, the first byte and the right body."""

    protocol_version = "HTTP/1.1"
    data, fault, count, asked, latency_s, tag = b"", "", 0, [], 0.0, '"one"'
    spoil = staticmethod(lambda nth, first, body: body)

    def log_message(self, *_):
        pass

    def do_GET(self):
        cls = type(self)
        cls.count += 1
        time.sleep(self.latency_s)
        first, last = map(int, re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers["Range"]).groups())
        cls.asked.append((first, last))
        size = len(self.data)
        fault = self.fault.removeprefix("later ") if cls.count > 1 or not self.fault.startswith("later ") else ""
        if fault == "whole":
            return self.answer(200, self.data)
        if fault == "endless":
            return self.answer(200, self.data, {"Content-Length": 1 << 40})
        if self.fault == "gone after two" and cls.count > 2:
            return self.answer(404, b"")
        tag = self.tag if self.fault != "changes" or cls.count == 1 else '"two"'
        if self.headers["If-Match"] not in (None, tag) and self.fault != "changes":
            return self.answer(412, b"")
        if self.fault == "412" and cls.count > 1:
            return self.answer(412 if self.headers["If-Match"] == '"one"' else 206, b"")
        if first >= size:
            return self.answer(416, b"", {"Content-Range": f"bytes */{size}"})
        body = self.data[first:last + 1]
        told = {"shifted": f"bytes {first + 1}-{first + len(body)}/{size}", "shorter": f"bytes {first}-{first + 9}/{size}",
                "nonsense": "bytes a-b/c", "none": ""}.get(fault, f"bytes {first}-{first + len(body) - 1}/{size}")
        self.answer(206, self.spoil(cls.count, first, body), {"ETag": tag, **({"Content-Range": told} if told else {})})

    def answer(self, status, body, headers=()):
        self.send_response(status)
        fields = {"Content-Length": len(body), **dict(headers)}
        for name, value in fields.items():
            self.send_header(name, str(value))
        self.end_headers()
        with contextlib.suppress(OSError):
            self.wfile.write(body)


class QuietServer(http.server.ThreadingHTTPServer):
    def handle_error(self, *_):
        """A client that does not want the rest hangs up."""


@contextlib.contextmanager
def range_server(data, fault="", name="a.pmtiles", latency_s=0.0, spoil=RangeServer.spoil):
    handler = type("Handler", (RangeServer,), {"data": data, "fault": fault, "count": 0, "asked": [], "latency_s": latency_s,
                                               "spoil": staticmethod(spoil)})
    server = QuietServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/{name}", handler
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
