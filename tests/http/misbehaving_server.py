"""A server on loopback that misbehaves on demand, for tests of its clients. README.md lists the faults."""

import argparse
import email.utils
import functools
import gzip
import http.server
import json
import os
import pathlib
import socket
import ssl
import struct
import sys
import threading
import time
import urllib.parse

JPEG = bytes.fromhex(  # one grey pixel
    "ffd8ffe000104a46494600010100000100010000ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d"
    "283a333d3c3933383740485c4e404457453738506d51575f626768673e4d71797064785c656763ffc0000b08000100010101"
    "1100ffc40014000100000000000000000000000000000001ffc40014100100000000000000000000000000000000ffda0008"
    "010100003f001fffd9")
CHUNK = 64 * 1024


class Log:
    """Every request with its time, so that rates can be judged."""

    def __init__(self):
        self.lock = threading.Lock()
        self.entries = []
        self.counts = {}

    def add(self, path, headers):
        with self.lock:
            self.entries.append({"time_s": time.monotonic(), "path": path, "headers": headers})
            self.counts[path] = self.counts.get(path, 0) + 1
            return self.counts[path]

    def lines(self):
        with self.lock:
            return "".join(json.dumps(entry) + "\n" for entry in self.entries).encode()


@functools.lru_cache(maxsize=4)
def bomb(megabytes):
    """A gzip stream of zeros: some kilobytes that become `megabytes`."""
    return gzip.compress(bytes(megabytes << 20), 9)


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    wbufsize = -1

    def log_message(self, *_):
        pass

    def do_GET(self):
        server = self.server
        path, _, query = self.path.partition("?")
        if path == "/log":
            return self.answer(200, server.log.lines(), "application/x-ndjson")
        nth = server.log.add(self.path, dict(self.headers.items()))
        time.sleep(server.latency_s)
        name = path.strip("/").split("/")[0]
        if server.root is not None:
            fault = server.faults.get(path.strip("/"), "file")
            name, _, query = fault.partition("?")
        self.options = dict(urllib.parse.parse_qsl(query))
        if nth > int(self.options.get("times", sys.maxsize)):
            name = "file" if server.root is not None else "ok"
        act = getattr(self, "fault_" + name, None)
        if act is not None:
            return act()
        if name.isdigit():
            return self.status(int(name))
        return self.status(404)

    # Answers
    # -----------------------------------------------------------------------------------------------------------

    def answer(self, status, body=b"", kind="image/jpeg", fields=(), length=None):
        self.send_response(status)
        if status not in (204, 304):
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body) if length is None else length))
        for name, value in fields:
            self.send_header(name, value)
        self.end_headers()
        self.send(body)

    def send(self, body):
        try:
            self.wfile.write(body)
            self.wfile.flush()
        except OSError:
            self.close_connection = True
            return False
        return True

    def status(self, status):
        fields = []
        if "retry_after" in self.options:
            seconds = int(self.options["retry_after"])
            as_date = self.options.get("as") == "date"
            wait = email.utils.formatdate(time.time() + seconds, usegmt=True) if as_date else str(seconds)
            fields.append(("Retry-After", wait))
        self.answer(status, b"no\n", "text/plain", fields)

    # Faults ----------------------------------------------------------------------------------------------------------

    def fault_ok(self):
        etag = '"v1"'
        if self.headers.get("If-None-Match") == etag:
            return self.answer(304, fields=[("ETag", etag)])
        self.answer(200, JPEG, fields=[("ETag", etag), ("Cache-Control", "max-age=60")])

    def fault_file(self, spoil=lambda data: data):
        root = self.server.root.resolve()
        path = (root / self.path.partition("?")[0].lstrip("/")).resolve()
        if root not in path.parents or not path.is_file():
            return self.status(404)
        kind = "image/png" if path.suffix == ".png" else "image/jpeg"
        self.answer(200, spoil(path.read_bytes()), kind, [("ETag", f'"{path.stat().st_mtime_ns:x}"')])

    def fault_zeroed(self):
        self.fault_file(lambda data: bytes(len(data)))

    def fault_shifted(self):
        self.fault_file(lambda data: bytes(7) + data[:-7])

    def fault_scrambled(self):
        """Begins and ends as it should."""
        self.fault_file(lambda data: data[:700] + bytes(b ^ 0x55 for b in data[700:-300]) + data[-300:])

    def fault_empty(self):
        self.answer(200, b"")

    def fault_echo(self):
        self.answer(200, json.dumps(dict(self.headers.items())).encode(), "application/json")

    def fault_timeout(self):
        time.sleep(float(self.options.get("seconds", 60)))
        self.close_connection = True

    def fault_slow(self):
        time.sleep(float(self.options.get("seconds", 0.5)))
        if self.server.root is not None:
            return self.fault_file()
        self.fault_ok()

    def fault_reset(self):
        self.answer(200, JPEG[:40], length=len(JPEG))
        self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        os.close(self.connection.detach())  # an orderly shutdown would come before a close()
        self.close_connection = True

    def fault_close(self):
        self.close_connection = True

    def fault_truncated(self):
        self.answer(200, JPEG[:40], length=len(JPEG))
        self.close_connection = True

    def fault_truncated_jpeg(self):
        self.answer(200, JPEG[:40])

    def fault_html200(self):
        self.answer(200, b"<!DOCTYPE html><title>Sorry</title>Maintenance", "text/html")

    def fault_wrongtype(self):
        self.answer(200, b"PK\x05\x06" + bytes(18), "application/zip")

    def fault_huge(self):
        size = int(self.options.get("megabytes", 100)) << 20
        said = None if "chunked" in self.options else size
        self.send_response(200)
        self.send_header("Content-Type", "image/jpeg")
        if said is None:
            self.send_header("Connection", "close")
            self.close_connection = True
        else:
            self.send_header("Content-Length", str(said))
        self.end_headers()
        for _ in range(size // CHUNK):
            if not self.send(bytes(CHUNK)):
                return

    def fault_huge404(self):
        self.answer(404, bytes(8 << 20), "text/html")

    def fault_headers(self):
        self.send_response(200)
        for i in range(int(self.options.get("kilobytes", 1024))):
            self.send_header(f"X-{i}", "x" * 1000)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def fault_loop(self):
        self.answer(302, fields=[("Location", self.path)])

    def fault_redirect(self):
        fields = [("Location", self.options["to"])] if "to" in self.options else []
        self.answer(302, fields=fields)

    def fault_drip(self):
        self.answer(200, length=100)
        for _ in range(100):
            time.sleep(float(self.options.get("seconds", 0.2)))
            if not self.send(b"x"):
                return

    def fault_bomb(self):
        self.answer(200, bomb(int(self.options.get("megabytes", 64))), fields=[("Content-Encoding", "gzip")])


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128

    def handle_error(self, request, client_address):
        pass  # whoever asked went away, or spoke no TLS


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, help="serve this folder; other paths are 404")
    parser.add_argument("--faults", type=pathlib.Path, help="JSON object: path under --root to fault, such as 503?times=2")
    parser.add_argument("--latency-ms", type=float, default=0.0, help="before each answer")
    parser.add_argument("--tls", nargs=2, metavar=("CERTIFICATE", "KEY"), help="PEM files: serve https")
    parser.add_argument("--until-stdin-ends", action="store_true", help="end with whoever holds the other end")
    return parser.parse_args()


def end_with_stdin():
    sys.stdin.read()
    os._exit(0)


def main():
    options = arguments()
    server = Server(("127.0.0.1", 0), Handler)
    server.log = Log()
    server.root = options.root
    server.faults = json.loads(options.faults.read_text()) if options.faults else {}
    server.latency_s = options.latency_ms / 1000
    if options.tls:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(*options.tls)
        server.socket = context.wrap_socket(server.socket, server_side=True, do_handshake_on_connect=False)
    print(json.dumps({"port": server.server_address[1]}), flush=True)
    if options.until_stdin_ends:
        threading.Thread(target=end_with_stdin, daemon=True).start()
    server.serve_forever()


if __name__ == "__main__":
    main()
