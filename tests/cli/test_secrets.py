"""User names, passwords, keys in addresses and headers only reach their own server: not the screen, a file or another
server."""

import base64
import contextlib
import json
import os
import socketserver
import threading

import servers
from program import DONE, DONE_IN_PART, FAILED, NATURAL_EARTH, WRONG_USAGE, ProgramTest

LEVELS = 3
VIEW = ("--unlit", "--camera", "30,20,6000000", "--size", "256x256")
USER, PASSWORD, TOKEN, HEADER = "qUsEr", "qPaSsWoRd", "qToKeN", "qHeAdEr"
BASIC = base64.b64encode(f"{USER}:{PASSWORD}".encode()).decode()
SECRETS = (USER, PASSWORD, TOKEN, HEADER, BASIC)
HEADERS = ("--header", f"X-Key: {HEADER}")
NOBODY = "http://127.0.0.1:9"


def secret_address(address):
    """With user, password and a key."""
    scheme, rest = address.split("://")
    joint = "&" if "?" in rest else "?"
    return f"{scheme}://{USER}:{PASSWORD}@{rest}{joint}token={TOKEN}"


@contextlib.contextmanager
def garbage_server(answer):
    """Answers anything with some bytes and ends the connection."""
    class Handler(socketserver.BaseRequestHandler):
        def handle(self):
            self.request.recv(65536)
            self.request.sendall(answer)

    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), Handler) as server:
        server.daemon_threads = True
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}"
        finally:
            server.shutdown()


class SecretsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.outside = self.folder / "outside"  # files of the servers and the user, secrets included
        self.outside.mkdir()
        self.pyramid = self.outside / "tiles"
        servers.write_pyramid(self.pyramid, LEVELS)

    def describe(self, name="source.json", **fields):
        path = self.outside / name
        path.write_text(json.dumps(fields))
        return path

    def keeps(self, code, *arguments, says=(), **options):
        """The program ends with `code` and tells no secret, on the screen or in the name or bytes of any file."""
        done = self.run_program(*arguments, **options)
        told = done.stdout + done.stderr
        for text in says:
            self.assertIn(text, told, arguments)
        self.assertEqual(done.returncode, code, f"{arguments}\n{told}")
        self.assert_no_secret(told, arguments)
        for path in self.folder.rglob("*"):
            if self.outside in (path, *path.parents):
                continue
            self.assert_no_secret(str(path.relative_to(self.folder)), arguments)
            if path.is_file():
                self.assert_no_secret(path.read_bytes().decode(errors="replace"), f"{path} of {arguments}")
        return done

    def assert_no_secret(self, text, where):
        for secret in SECRETS:
            self.assertNotIn(secret.lower(), text.lower(), where)


class ProgramKeepsSecretsTest(SecretsTest):
    def told(self, *command):
        done = self.run_program(*command)
        with self.subTest(command=command):
            self.assert_no_secret(done.stdout + done.stderr, command)

    def test_each_form_of_an_address_is_redacted(self):
        for address in (f"ftp://{USER}:{PASSWORD}@h/x.tif?token={TOKEN}", f"ftp://{USER}:1/{PASSWORD}@h/x.tif?token={TOKEN}",
                        f"http://{USER}:{PASSWORD}@h/x y.tif?token={TOKEN}", f"{USER}:{PASSWORD}@h:80/x",
                        f"{USER}:a/{PASSWORD}@h:80/x?token={TOKEN}", f"http://{USER}:a/{PASSWORD}@127.0.0.1:9/x.tif",
                        f"http://{USER}:12/{PASSWORD}@127.0.0.1:9/{{z}}/{{x}}/{{y}}.png?token={TOKEN}",
                        f"HTTP:/{USER}:{PASSWORD}@127.0.0.1:9/x.json", f"s3://{USER}:{PASSWORD}@b/k.tif?X-Sig={TOKEN}"):
            for command in (("cut", address, "-o", "a.gpkg"), ("info", address, "--json"),
                            ("render", address, "-o", "c.png", "--json", "--timeout", "1", *VIEW)):
                self.told(*command)

    def test_each_option_that_repeats_what_was_given_redacts_addresses(self):
        render = ("-o", "c.png", "--cache", "off", *VIEW)
        preload = ("preload", f"{NOBODY}/{{z}}/{{x}}/{{y}}.jpg", "--retries", "0", "--max-level", "0", "-o")
        for address in (f"ftp://{USER}:1/{PASSWORD}@h/x.tif?token={TOKEN}", f"{USER}:{PASSWORD}@h:80/x?token={TOKEN}"):
            for command in (("cut", NATURAL_EARTH / "0/0/0.jpg", "-o", address), ("merge", address, "-o", "b.gpkg"),
                            ("merge", address, "-o", "b.gpkg", "--json"), ("info", address), ("view", address), (address,),
                            *(("render", NATURAL_EARTH, option, address, *render)
                              for option in ("--objects", "--elevation", "--overlay", "--clouds", "--places", "--colormap",
                                             "--crs", "--layer-time", "--time", "--body", "--camera", "--stretch")),
                            ("render", NATURAL_EARTH, "--night", address, "--time", "2026-06-21T12:00Z", *render),
                            ("render", NATURAL_EARTH, "--cache", address, "-o", "c.png", *VIEW),
                            ("render", NATURAL_EARTH, "-o", address), ("preload", address, "-o", "d.gpkg", "--json"),
                            (*preload, address), *((*preload, "d.gpkg", option, address)
                              for option in ("--polygon", "--flight", "--ca-file", "--missing", "--stored", "--bbox"))):
                self.told(*command)

    def test_when_all_is_well(self):
        with servers.misbehaving(self.pyramid, {}) as server:
            source = secret_address(server.template)
            levels = ("--levels", f"0-{LEVELS - 1}")
            self.keeps(DONE, "preload", source, *levels, "-o", "a.gpkg", *HEADERS)
            self.keeps(DONE, "preload", source, *levels, "-o", "b.gpkg", "--json", "--stored", "stored.txt", *HEADERS)
            self.keeps(DONE, "preload", source, *levels, "-o", "c.gpkg", "--dry-run", *HEADERS)
            self.keeps(DONE, "render", source, "--max-level", "2", "-o", "a.png", *VIEW, *HEADERS)
            self.keeps(DONE, "render", source, "--max-level", "2", "-o", "b.png", "--json", "--offline", *VIEW)
            # The overlay has more levels by what is said of it, so that some of its tiles are missing.
            self.keeps(DONE_IN_PART, "render", source, "--max-level", "2", "--overlay", f"{source}:0.5", "--cache", "off", "-o",
                       "c.png", *VIEW)
            place = {"XDG_CACHE_HOME": str(self.folder / "cache2")}  # cache of another grid, which the source does not state
            self.keeps(DONE, "info", source, says=["token=***"], environment=place)
            self.keeps(DONE, "info", source, "--json", says=["token=***"], environment=place)
            self.keeps(DONE, "info", "a.gpkg", "--verify")
            self.keeps(DONE, "info", "a.gpkg", "--json")
            # The secrets were sent; without that the checks above would show nothing.
            asked = [entry for entry in server.log() if entry["headers"].get("X-Key") == HEADER]
            self.assertTrue(asked)
            self.assertTrue(all(f"token={TOKEN}" in entry["path"] for entry in asked))
            self.assertEqual({entry["headers"]["Authorization"] for entry in asked}, {f"Basic {BASIC}"})

    def test_when_the_server_has_nothing(self):
        empty = self.outside / "empty"
        empty.mkdir()
        with servers.nginx(empty) as server:
            source = secret_address(server.template)
            self.keeps(DONE_IN_PART, "preload", source, "--levels", "0-2", "-o", "a.gpkg", *HEADERS, says=["is http"])
            self.keeps(DONE_IN_PART, "preload", source, "--levels", "0-2", "-o", "b.gpkg", "--json", "--missing", "m.txt")
            self.keeps(FAILED, "render", secret_address(server.template.replace("{z}/{x}/{y}.jpg", "source.json")), "-o",
                       "b.png", *VIEW, says=["source.json"])

    def test_when_nobody_answers(self):
        source = secret_address(NOBODY + "/{z}/{x}/{y}.jpg")
        self.keeps(DONE_IN_PART, "preload", source, "--levels", "0-5", "--retries", "0", "-o", "a.gpkg", "--missing",
                   "missing.txt", *HEADERS, says=["does not answer any more"])
        self.keeps(DONE, "preload", source, "--levels", "0-5", "-o", "b.gpkg", "--dry-run")
        self.keeps(FAILED, "render", secret_address(NOBODY + "/WMTSCapabilities.xml"), "-o", "b.png", *VIEW)
        self.keeps(FAILED, "info", secret_address(NOBODY + "/source.json"))
        self.keeps(FAILED, "render", source, "--offline", "-o", "b.png", *VIEW, says=["--offline"])
        self.keeps(FAILED, "render", source, "--offline", "--cache", "off", "-o", "b.png", *VIEW)

    def test_when_tiles_are_refused_broken_or_elsewhere(self):
        faults = {"2/3/0.jpg": "403", "2/3/1.jpg": "truncated_jpeg", "2/4/0.jpg": "loop", "2/4/1.jpg": "html200",
                  "2/5/0.jpg": f"redirect?to=http://{USER}:{PASSWORD}@127.0.0.1:9/?token={TOKEN}",
                  "2/5/1.jpg": f"redirect?to=ftp://{USER}:{PASSWORD}@127.0.0.1/?token={TOKEN}"}
        with servers.misbehaving(self.pyramid, faults) as server:
            source = secret_address(server.template)
            self.keeps(DONE_IN_PART, "preload", source, "--levels", "0-2", "--retries", "0", "-o", "a.gpkg", "--missing",
                       "missing.txt", *HEADERS, says=["refused"])
            self.keeps(DONE_IN_PART, "render", source, "--max-level", "2", "--cache", "off", "-o", "b.png", *VIEW)
            self.keeps(DONE_IN_PART, "render", source, "--max-level", "2", "--cache", "off", "-o", "b.png", "--json", *VIEW)

    def test_when_a_description_is_wrong(self):
        base = {"url": secret_address(NOBODY + "/{z}/{x}/{y}.jpg"), "max_level": 2, "headers": [f"X-Key: {HEADER}"]}
        for more in ({"max_level": None}, {"bounds": [1, 2, 3]}, {"url": base["url"].replace("{z}", "{tile}")},
                     {"headers": [f"Host: {HEADER}"]}, {"tile_px": 3}, {"unknown": HEADER}, {"url": None},
                     {"url": base["url"].replace("http:", "ftp:")}, {"projection": "mercator"}):
            self.keeps(FAILED, "render", self.describe(**{**base, **more}), "-o", "a.png", *VIEW, says=["source.json"])
        wmts = self.describe(wmts=secret_address(NOBODY + "/c.xml"), headers=[f"X-Key: {HEADER}"])
        self.keeps(FAILED, "info", wmts, says=["c.xml"])
        self.keeps(FAILED, "preload", self.describe(**base), "--max-level", "2", "--levels", "3-5", "-o", "a.gpkg",
                   says=["levels 0 to 2"])

    def test_when_the_command_is_wrong(self):
        source = secret_address(NOBODY + "/{z}/{x}/{y}.jpg")
        self.keeps(WRONG_USAGE, "render", source, source, "-o", "a.png")
        self.keeps(WRONG_USAGE, "render", source, "-o", "a.png", "--heder", f"X-Key: {HEADER}", says=["--heder"])
        self.keeps(WRONG_USAGE, "render", source, "-o", "a.png", f"--heder=X-Key: {HEADER}", says=["--heder"])
        self.keeps(WRONG_USAGE, "render", "-o", "a.png", "--overlay", f"{source}:7", says=["opacity"])
        self.keeps(FAILED, source)
        self.keeps(WRONG_USAGE, "render", source, "-o", "a.png", "--header", f"X Key: {HEADER}", says=["Name: value"])
        self.keeps(FAILED, "render", source.replace("{z}", ""), "-o", "a.png", says=["{z}"])
        self.keeps(FAILED, "render", source.replace(PASSWORD, f"a/{PASSWORD}?{PASSWORD}"), "-o", "a.png")
        # Options that take files only.
        self.keeps(FAILED, "cut", source, "-o", "b.gpkg")
        self.keeps(FAILED, "merge", source, "-o", "b.gpkg")
        self.keeps(FAILED, "render", "--objects", source, "-o", "a.png", *VIEW)
        self.keeps(FAILED, "render", source.replace("//", "/"), "-o", "a.png", *VIEW)

    def test_when_a_cache_is_another_sources(self):
        with servers.misbehaving(self.pyramid, {}) as one, servers.misbehaving(self.pyramid, {}) as other:
            self.keeps(DONE, "preload", secret_address(one.template), "--levels", "0-1", "-o", "a.gpkg")
            self.keeps(FAILED, "preload", secret_address(other.template), "--levels", "0-1", "-o", "a.gpkg")
            self.keeps(DONE, "preload", secret_address(other.template), "--levels", "0-1", "-o", "b.gpkg")
            self.keeps(FAILED, "merge", "a.gpkg", "b.gpkg", "-o", "c.gpkg", says=["b.gpkg"])

    def test_a_new_key_finds_the_cache_of_the_old(self):
        with servers.misbehaving(self.pyramid, {}) as server:
            source = secret_address(server.template)
            self.keeps(DONE, "render", source, "--max-level", "2", "-o", "a.png", *VIEW)
        newer = source.replace(TOKEN, "another").replace(PASSWORD, "other")
        self.keeps(DONE, "render", newer, "--max-level", "2", "--offline", "-o", "b.png", *VIEW)


class WindowKeepsSecretsTest(SecretsTest):
    def test_a_window_says_nothing(self):
        from real_window import Display
        display = Display()
        self.addCleanup(display.close)
        environment = {"DISPLAY": display.environment["DISPLAY"], "LIBGL_ALWAYS_SOFTWARE": "1",
                       "XDG_CONFIG_HOME": str(self.folder / "config")}
        with servers.misbehaving(self.pyramid, {}) as server:
            broken = secret_address(server.template.replace("{z}/{x}/{y}.jpg", "WMTSCapabilities.xml"))
            self.keeps(FAILED, "view", broken, environment=environment, says=["WMTSCapabilities.xml"])
            self.look(secret_address(server.template), environment, server)
            self.keeps(DONE, "info", NATURAL_EARTH)  # looks at every file that the window left

    def look(self, source, environment, server):
        import subprocess
        from program import PROGRAM
        from real_window import wait_until
        env = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache"), **environment}
        program = subprocess.Popen([PROGRAM, "view", source, "--max-level", "2", "--size", "320x240", "--print-camera",
                                    *HEADERS], cwd=self.folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        try:
            find = ["xdotool", "search", "--onlyvisible", "--name", "."]
            window = wait_until("a window", lambda: subprocess.run(find, env=env, capture_output=True,
                                                                   text=True).stdout.split())[0]
            wait_until("tiles", lambda: len(server.log()) > 8)
            title = subprocess.run(["xdotool", "getwindowname", window], env=env, capture_output=True, text=True).stdout
            subprocess.run(["xdotool", "key", "--window", window, "Escape", "Escape"], env=env, check=True)
            told = "".join(program.communicate(timeout=30))
        finally:
            program.kill()
        self.assert_no_secret(told + title, "view")


class OtherServersTest(SecretsTest):
    """Two servers of one host: what is for the first does not come to the second."""

    def assert_got_nothing(self, log):
        for entry in log:
            self.assertNotIn("X-Key", entry["headers"])
            self.assertNotIn("Authorization", entry["headers"])
            self.assert_no_secret(json.dumps(entry), entry)

    def test_a_document_that_points_to_another_port(self):
        from test_remote import CAPABILITIES, MATRIX
        matrices = "".join(MATRIX.format(z=z, scale=279541132.0143589 / 2**z, width=2 << z, height=1 << z)
                           for z in range(2)).replace("512", "256")
        with servers.misbehaving(self.outside, {}) as one, servers.misbehaving(self.pyramid, {}) as other:
            (self.outside / "caps.xml").write_text(CAPABILITIES.format(address=other.address, matrices=matrices))
            (self.outside / "own.xml").write_text(CAPABILITIES.format(address=one.address, matrices=matrices))
            caps = secret_address(one.address + "/caps.xml")
            for command in ("render", caps, "-o", "a.png", *VIEW), ("preload", caps, "-o", "a.gpkg"):
                self.keeps(FAILED, *command, *HEADERS, says=[other.address, "port"])
            pointer = secret_address(one.address + "/pointer.json")
            self.describe("pointer.json", wmts=other.address + "/caps.xml")
            self.keeps(FAILED, "info", self.outside / "pointer.json", says=[other.address])  # 404: its own headers alone
            self.keeps(FAILED, "render", pointer, "-o", "a.png", *VIEW, *HEADERS, says=[other.address, "port"])
            self.describe("template.json", url=other.template, max_level=1)
            self.keeps(FAILED, "render", secret_address(one.address + "/template.json"), "-o", "a.png", *VIEW, *HEADERS,
                       says=[other.address, "port"])
            # Without headers the other is asked for its tiles, and user and password stay where they were given for.
            self.keeps(FAILED, "render", caps, "-o", "a.png", *VIEW)
            self.assertTrue(other.log())
            self.assert_got_nothing(other.log())
            # The same server's tiles are asked for with the headers.
            self.keeps(FAILED, "render", secret_address(one.address + "/own.xml"), "-o", "b.png", *VIEW, *HEADERS)
            tiles = [entry for entry in one.log() if entry["path"].endswith(".png")]
            self.assertTrue(tiles and all(entry["headers"].get("X-Key") == HEADER for entry in tiles))

    def test_a_redirect_to_another_port(self):
        with servers.misbehaving(self.pyramid, {}) as other:
            faults = {f"{z}/{x}/{y}.jpg": f"redirect?to={other.address}/{z}/{x}/{y}.jpg"
                      for z in range(LEVELS) for x in range(2 << z) for y in range(1 << z)}
            faults["0/0/0.jpg"] = f"redirect?to=//{other.address.split('//')[1]}/0/0/0.jpg"
            faults["0/1/0.jpg"] = "redirect?to=../../1/0/0.jpg"
            with servers.misbehaving(self.outside / "tiles", faults) as one:
                self.keeps(DONE, "preload", secret_address(one.template), "--levels", "0-2", "-o", "a.gpkg", *HEADERS)
                self.assertTrue(all(entry["headers"].get("X-Key") == HEADER for entry in one.log()
                                    if entry["path"].startswith("/0/0")))
            self.assertGreater(len(other.log()), 30)
            self.assert_got_nothing(other.log())


class RefusedHeadersTest(SecretsTest):
    def test_a_header_that_is_never_sent_is_wrong_usage(self):
        for header in f"Host: {HEADER}", f"range: {HEADER}", f"User-Agent: {HEADER}", f"a b: {HEADER}", HEADER, f"A: \x01{HEADER}":
            for command in ("render", NOBODY + "/{z}/{x}/{y}.jpg", "-o", "a.png"), ("preload", NOBODY, "-o", "a.gpkg"):
                done = self.keeps(WRONG_USAGE, *command, "--header", header, says=["--header"])
                if header.startswith(("Host", "range", "User")):
                    self.assertIn("set by Terrella itself", done.stderr)
                    self.assertIn(header.split(":")[0], done.stderr)


class NotHttpTest(SecretsTest):
    def test_an_answer_that_is_not_http_is_named(self):
        for answer in b"SSH-2.0-OpenSSH_9.2\r\n", b"\x15\x03\x01\x00\x02\x02\x46", b"garbage " * 20, b"HTTP/9.9 what\r\n\r\n":
            with garbage_server(answer) as address:
                done = self.keeps(FAILED, "render", secret_address(address + "/source.json"), "-o", "a.png", *VIEW,
                                  says=["not HTTP", "port"])
                self.assertNotIn("only http and https", done.stderr)
