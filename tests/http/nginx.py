"""Runs nginx on loopback with its own configuration in a temporary folder, until standard input ends or SIGTERM arrives.
Prints one line of JSON: the ports of http and https (the latter with HTTP/2), the certificate to trust for https, and the
access log. The log has one line per request: number of the connection, protocol, status and path."""

import argparse
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

CONFIGURATION = """
daemon off; master_process off; pid {work}/pid; error_log {work}/error.log;
events {{ worker_connections 512; }}
http {{
  types {{ image/jpeg jpg; image/png png; }}
  log_format lines '$connection $server_protocol $status $request_uri';
  access_log {log};
  keepalive_requests 1000000; sendfile on; tcp_nodelay on;
  client_body_temp_path {work}/a; proxy_temp_path {work}/b; fastcgi_temp_path {work}/c;
  uwsgi_temp_path {work}/d; scgi_temp_path {work}/e;
  server {{
    listen 127.0.0.1:{port}; listen 127.0.0.1:{tls_port} ssl http2;
    ssl_certificate {work}/server.pem; ssl_certificate_key {work}/key.pem;
    root "{root}";
    {expires}
    {passing}
  }}
}}
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def certificate(work):
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                    "-keyout", work / "key.pem", "-out", work / "server.pem", "-days", "2", "-subj", "/CN=localhost",
                    "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"], check=True, stderr=subprocess.DEVNULL)


def start(work, root, log, expires, passing):
    """A free port may be taken by another program before nginx has it; then another is tried."""
    for _ in range(10):
        port, tls_port = free_port(), free_port()
        text = CONFIGURATION.format(work=work, port=port, tls_port=tls_port, root=root.resolve(), log=log,
                                    expires=expires, passing=passing)
        (work / "nginx.conf").write_text(text)
        process = subprocess.Popen(["nginx", "-p", f"{work}/", "-c", work / "nginx.conf", "-e", f"{work}/error.log"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while process.poll() is None:
            try:
                socket.create_connection(("127.0.0.1", port), 1).close()
                return process, port, tls_port
            except OSError:
                time.sleep(0.02)
    sys.exit((work / "error.log").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="folder to serve")
    parser.add_argument("--no-log", action="store_true", help="keep no access log")
    parser.add_argument("--no-expiry", action="store_true", help="do not say how long a file may be kept: else 1 h")
    parser.add_argument("--pass", dest="passed_to", type=int, metavar="PORT",
                        help="answer with what another server on loopback answers")
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="terrella-nginx-"))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    process = None
    try:
        certificate(work)
        log = "off" if options.no_log else f"{work}/access.log lines"
        passing = (f"location / {{ proxy_set_header Host $http_host; proxy_pass http://127.0.0.1:{options.passed_to}; }}"
                   if options.passed_to else "")
        process, port, tls_port = start(work, options.root, log, "" if options.no_expiry else "expires 1h;", passing)
        print(json.dumps({"port": port, "tls_port": tls_port, "ca_file": str(work / "server.pem"),
                          "access_log": str(work / "access.log")}), flush=True)
        sys.stdin.read()
    finally:
        if process is not None:
            process.terminate()
            process.wait()
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    main()
