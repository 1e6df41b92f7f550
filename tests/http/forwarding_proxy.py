"""A forwarding proxy on loopback: GET of whole addresses, and CONNECT for https. Runs until standard input ends. Prints
one line of JSON: its port and its log. The log has one line per request, with the method and the target."""

import http.server
import json
import shutil
import socket
import sys
import tempfile
import threading
import urllib.error
import urllib.request

DIRECT = urllib.request.build_opener(urllib.request.ProxyHandler({}))


class Proxy(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def note(self):
        with open(self.server.log, "a", encoding="utf-8") as log:
            log.write(f"{self.command} {self.path}\n")

    def do_GET(self):
        self.note()
        try:
            with DIRECT.open(self.path) as answer:
                status, headers, body = answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as refused:
            status, headers, body = refused.code, refused.headers, refused.read()
        self.send_response(status)
        for name in ("Content-Type", "ETag", "Last-Modified"):
            if headers[name]:
                self.send_header(name, headers[name])
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_CONNECT(self):
        self.note()
        host, port = self.path.rsplit(":", 1)
        with socket.create_connection((host, int(port))) as there:
            self.send_response(200)
            self.end_headers()
            back = threading.Thread(target=pump, args=(there, self.connection))
            back.start()
            pump(self.connection, there)
            back.join()
        self.close_connection = True


def pump(source, sink):
    try:
        while data := source.recv(65536):
            sink.sendall(data)
        sink.shutdown(socket.SHUT_WR)
    except OSError:
        pass  # one side went away, and so does the tunnel


def main():
    folder = tempfile.mkdtemp(prefix="terrella-proxy-")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Proxy)
    server.daemon_threads = True
    server.log = f"{folder}/log"
    open(server.log, "w", encoding="utf-8").close()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(json.dumps({"port": server.server_address[1], "log": server.log}), flush=True)
    sys.stdin.read()
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
