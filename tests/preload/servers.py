"""Runs the servers of tests/http, and makes small tile pyramids for them."""

import collections
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time
import urllib.error
import urllib.request

SOURCE = pathlib.Path(os.environ["TERRELLA_SOURCE"])
HTTP = SOURCE / "tests/http"
TILES = sorted((SOURCE / "tests/fixtures/natural_earth_ii").glob("*/*/*.jpg"))

DIRECT = urllib.request.build_opener(urllib.request.ProxyHandler({}))


def write_pyramid(folder, levels):
    """{z}/{x}/{y}.jpg of the levels 0 to levels-1, two roots; which picture is where depends on the place alone."""
    for z in range(levels):
        for x in range(2 << z):
            column = folder / str(z) / str(x)
            column.mkdir(parents=True)
            for y in range(1 << z):
                shutil.copyfile(tile_file(z, x, y), column / f"{y}.jpg")


def tile_file(z, x, y):
    return TILES[(z * 31 + x * 7 + y) % len(TILES)]


def places(levels):
    return [(z, x, y) for z in range(levels) for x in range(2 << z) for y in range(1 << z)]


def tiles_in(levels):
    return sum(2 << (2 * z) for z in range(levels))


@contextlib.contextmanager
def running(*command):
    process = subprocess.Popen([sys.executable, "-B", *map(str, command)], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    try:
        yield json.loads(process.stdout.readline())
    finally:
        process.stdin.close()
        process.wait()
        process.stdout.close()


@contextlib.contextmanager
def nginx(root, *options):
    with running(HTTP / "nginx.py", root, *options) as told:
        yield Nginx(told)


class Nginx:
    def __init__(self, told):
        self.template = f"http://127.0.0.1:{told['port']}/{{z}}/{{x}}/{{y}}.jpg"
        self.tls_template = f"https://localhost:{told['tls_port']}/{{z}}/{{x}}/{{y}}.jpg"
        self.ca_file = told["ca_file"]
        self.access_log = pathlib.Path(told["access_log"])

    def requests(self):
        """(status, path) of each request so far."""
        lines = self.access_log.read_text().splitlines() if self.access_log.exists() else []
        return [(int(line.split()[2]), line.split()[3]) for line in lines]

    def counts(self):
        return collections.Counter(path for _, path in self.requests())

    def cut(self):
        """A connection that is younger than all before it and older than all after it."""
        name = f"/cut/{time.monotonic_ns()}"
        with contextlib.suppress(urllib.error.HTTPError):
            DIRECT.open(self.template.split("/{z}")[0] + name).close()
        while True:  # the log is written after the answer
            for connection, path in self._connections():
                if path == name:
                    return connection
            time.sleep(0.002)

    def asked_since(self, cut):
        """(z, x, y) of the tiles asked for on connections after a cut."""
        return {tuple(map(int, path.removesuffix(".jpg").split("/")[1:])) for connection, path in self._connections()
                if connection > cut and not path.startswith("/cut/")}

    def paths_since(self, cut):
        """The paths asked for on connections after a cut."""
        return {path for connection, path in self._connections() if connection > cut and not path.startswith("/cut/")}

    def _connections(self):
        lines = self.access_log.read_text().splitlines() if self.access_log.exists() else []
        return [(int(line.split()[0]), line.split()[3]) for line in lines if len(line.split()) == 4]


@contextlib.contextmanager
def wms(*options):
    """The WMS of tests/http/wms_server.py behind nginx."""
    with running(HTTP / "wms_server.py", *options) as told:
        with running(HTTP / "nginx.py", HTTP, "--pass", str(told["port"])) as front:
            yield Wms(front["port"])


class Wms:
    def __init__(self, port):
        self.address = f"http://127.0.0.1:{port}"

    def log(self):
        """The requests so far, path and query."""
        with DIRECT.open(self.address + "/log") as answer:
            return json.load(answer)


@contextlib.contextmanager
def misbehaving(root, faults, *options):
    """`faults`: path under root to what goes wrong with it (tests/http/README.md)."""
    faults_file = root.parent / "faults.json"
    faults_file.write_text(json.dumps(faults))
    with running(HTTP / "misbehaving_server.py", "--until-stdin-ends", "--root", root, "--faults", faults_file,
                 *options) as told:
        yield Misbehaving(told["port"])


class Misbehaving:
    def __init__(self, port):
        self.address = f"http://127.0.0.1:{port}"
        self.template = self.address + "/{z}/{x}/{y}.jpg"

    def log(self):
        with urllib.request.urlopen(self.address + "/log") as answer:
            return [json.loads(line) for line in answer]


class SmallDisk:
    """A small file system in memory, where the system lets us have one."""

    def __init__(self, folder, size):
        self.folder = folder
        folder.mkdir()
        self.mounted = self._mount(f"size={size}")

    def resize(self, size):
        if not self._mount(f"remount,size={size}"):
            raise OSError(f"{self.folder} cannot be resized")

    def unmount(self):
        if self.mounted:
            subprocess.run(["umount", "--lazy", self.folder], check=True)

    def _mount(self, options):
        return subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", self.folder], check=False,
                              stderr=subprocess.DEVNULL).returncode == 0
