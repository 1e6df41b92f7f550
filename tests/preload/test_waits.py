"""Servers that are silent or send a byte now and then: --timeout ends the wait for what comes before the tiles."""

import concurrent.futures
import contextlib
import socket
import threading
import time
import unittest

from preload_test import PreloadTest

from program import FAILED

LIMIT_S = 1
PATIENCE_S = 45  # less than the attempts of one request take; long for a busy machine
VIEW = ("-o", "x.png", "--unlit", "--sky", "off", "--size", "64x64", "--cache", "off")


def answer(connection, drips, stop):
    with contextlib.suppress(OSError), connection:
        asked = connection.recv(65536)
        if drips:
            ranged = b"Range:" in asked
            connection.sendall(b"HTTP/1.1 206 Partial\r\nContent-Range: bytes 0-32767/99999\r\nETag: \"a\"\r\n" if ranged else
                               b"HTTP/1.1 200 OK\r\n")
            connection.sendall(b"Content-Length: 32768\r\n\r\n")
        while not stop.wait(0.2):
            if drips:
                connection.sendall(b"x")


@contextlib.contextmanager
def slow_server(drips):
    listener, stop = socket.create_server(("127.0.0.1", 0)), threading.Event()

    def accept():
        with contextlib.suppress(OSError):
            while True:
                threading.Thread(target=answer, args=(listener.accept()[0], drips, stop), daemon=True).start()
    threading.Thread(target=accept, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        stop.set()
        listener.close()


class Waits(PreloadTest):
    PATHS = ("WMTSCapabilities.xml", "a.tif", "a.pmtiles", "{z}/{x}/{y}.jpg", "a.json", "what")

    def run_one(self, command):
        begun = time.monotonic()
        done = self.run_program(*command, "--timeout", LIMIT_S, time_limit_s=200)
        return command, done, time.monotonic() - begun

    def test_the_limit_holds_before_the_first_tile(self):
        for drips in False, True:
            with slow_server(drips) as server, concurrent.futures.ThreadPoolExecutor(8) as pool:
                commands = [("render", f"{server}/{path}", *VIEW) for path in self.PATHS]
                commands += [("info", f"{server}/{path}") for path in ("a.tif", "what")]
                commands += [("preload", f"{server}/{path}", "-o", f"{number}.gpkg")
                             for number, path in enumerate(("WMTSCapabilities.xml", "a.tif", "a.pmtiles", "a.json"))]
                commands.append(("render", "--elevation", f"{server}/heights.tif", *VIEW))
                for command, done, took_s in pool.map(self.run_one, commands):
                    with self.subTest(command, drips=drips):
                        self.assertEqual(done.returncode, FAILED, done.stdout + done.stderr)
                        self.assertIn("--timeout", done.stderr)
                        self.assertLess(took_s, PATIENCE_S, done.stderr)


if __name__ == "__main__":
    unittest.main()
