"""Limits of the system: disk space, file sizes, memory. The program ends with a message and exit code 1, not by a signal."""

import json
import os
import resource
import signal
import subprocess
import unittest
import zlib

import servers
from pictures import png, png_of
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, NATURAL_EARTH, PROGRAM, TIME_LIMIT_S, ProgramTest

SMALL_FILES_BYTES = 64 * 1024
NO_MESA_CACHE = {"MESA_SHADER_CACHE_DISABLE": "true"}


class FileSizes(ProgramTest):
    def assert_limited(self, *arguments, limit=SMALL_FILES_BYTES, says=()):
        self.assert_fails(FAILED, *arguments, says=[*says, f"a limit of {limit} bytes", "ulimit -f"],
                          file_size_limit=limit, environment=NO_MESA_CACHE)
        self.assert_nothing_but()

    def test_cut(self):
        self.assert_limited("cut", BLUE_MARBLE, "-o", "earth.gpkg", says=["earth.gpkg"])
        self.assert_limited("cut", BLUE_MARBLE, "-o", "tiles", limit=1000, says=["tiles"])

    def test_render(self):
        self.assert_limited("render", NATURAL_EARTH, "--size", "1024x1024", "-o", "shot.png", says=["shot.png"])
        self.assert_limited("render", BLUE_MARBLE, "-o", "shot.png", says=[str(self.folder / "cache")])

    def test_preload(self):
        with servers.nginx(NATURAL_EARTH) as server:
            self.assert_fails(FAILED, "preload", server.template, "--levels", "0-2", "-o", "small.gpkg",
                              says=["small.gpkg", "ulimit -f"], file_size_limit=SMALL_FILES_BYTES)


class GpuMemory(ProgramTest):
    def test_more_than_the_driver_gives_is_told(self):
        shot = ("render", NATURAL_EARTH, "--size", "64x64", "-o", "shot.png")
        done = self.assert_done(*shot, "--memory", "65536")
        self.assertRegex(done.stderr, r"--memory 65536: the driver gives \d+ MB for tiles, as many as its array textures hold")
        self.assertNotIn("--memory", self.assert_done(*shot, "--memory", "300").stderr)

    def test_lines_and_areas_without_room_are_told(self):
        world = {"type": "Polygon", "coordinates": [[[-180, -90], [180, -90], [180, 90], [-180, 90], [-180, -90]]]}
        ways = [[[-80, -5], [80, 5]], [[-80, 5], [80, -5]]]  # crossing lines: some squares have all kinds of pictures
        (self.folder / "world.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": world},
            *({"type": "Feature", "properties": {"stroke": color, "stroke-width": 4, "casing": "#000000"},
               "geometry": {"type": "LineString", "coordinates": way}} for color, way in zip(("#ff0000", "#0000ff"), ways))]}))
        shot = ("render", NATURAL_EARTH, "--objects", "world.geojson", "--camera", "0,0,1e8", "--size", "256x256", "-o", "shot.png")
        self.assert_fails(DONE_IN_PART, *shot, "--memory", "64",
                          says=["--memory 64: no room for lines and areas on ", " squares of the ground"])
        self.assertNotIn("--memory", self.assert_done(*shot).stderr)


class LostOutput(ProgramTest):
    def run_into(self, arguments, stdout="/dev/full", redirect=""):
        with open(stdout, "w") as out:
            return subprocess.run(["bash", "-c", f'"$@" {redirect}', "bash", PROGRAM, *map(str, arguments)],
                                  cwd=self.folder, stdout=out, stderr=subprocess.PIPE, text=True, timeout=TIME_LIMIT_S,
                                  env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})

    def assert_told(self, *arguments):
        for how in {}, {"stdout": "/dev/null", "redirect": ">&-"}:
            with self.subTest(arguments=arguments, **how):
                done = self.run_into(arguments, **how)
                self.assertEqual(done.returncode, FAILED, done.stderr)
                self.assertIn("standard output cannot be written", done.stderr)

    def test_each_subcommand(self):
        self.write("planet.png", png(128, 64))
        self.assert_done("cut", "planet.png", "-o", "planet.gpkg")
        shot = ("render", "planet.gpkg", "-o", "shot.png", "--size", "64x64")
        cut = ("cut", "planet.png", "-o", "again.gpkg")
        for arguments in (("--help",), ("--version",), ("preload", "--help"), ("info", "planet.gpkg"),
                          ("info", "planet.gpkg", "--json"), ("info", "planet.gpkg", "--verify"), shot,
                          (*shot, "--json"), cut, (*cut, "--json")):
            self.assert_told(*arguments)

    def test_preload_and_merge(self):
        with servers.nginx(NATURAL_EARTH) as server:
            preload = ("preload", server.template, "--levels", "0-1", "-o", "cache.gpkg")
            self.assert_told(*preload)
            self.assert_told(*preload, "--json")
            self.assert_told(*preload, "--dry-run")
        merge = ("merge", "cache.gpkg", "-o", "merged.gpkg")
        done = self.run_into(merge)
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("standard output", done.stderr)

    def tiles(self):
        servers.write_pyramid(self.folder / "tiles", 2)
        return self.folder / "tiles"

    def test_lists_of_tiles(self):
        with servers.misbehaving(self.tiles(), {"1/0/0.jpg": "403"}) as server:
            for option in "--stored", "--missing":
                with self.subTest(option):
                    self.assert_fails(FAILED, "preload", server.template, "--levels", "0-1", "-o", f"{option}.gpkg",
                                      f"{option}=/dev/full", says=["/dev/full", "No space left"])

    def test_lost_messages_do_not_abort(self):
        self.write("planet.png", png(128, 64))
        for redirect in "2>/dev/full", "2>&-":
            with self.subTest(redirect):
                failed = self.run_into(("cut", "nothing.png", "-o", "x.gpkg"), stdout="/dev/null", redirect=redirect)
                self.assertEqual(failed.returncode, FAILED)
        done = self.run_into(("cut", "planet.png", "-o", "x.gpkg"), stdout="/dev/null", redirect="2>&-")
        self.assertEqual(done.returncode, DONE)


class Memory(ProgramTest):
    def run_within(self, megabytes, *arguments):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", timeout=TIME_LIMIT_S, preexec_fn=limit,
                              env={**os.environ, **NO_MESA_CACHE, "XDG_CACHE_HOME": str(self.folder / "cache")})

    def starts_within(self, megabytes):
        return self.run_within(megabytes, "--version").returncode == DONE

    def assert_ends_well(self, limits, *arguments, codes=(DONE, FAILED)):
        """Done or a message at every limit that lets the program start at all, and not the same at all of them."""
        ended = {}
        for megabytes in filter(self.starts_within, limits):
            done = self.run_within(megabytes, *arguments)
            ended[megabytes] = done.returncode
            with self.subTest(arguments=arguments, megabytes=megabytes):
                self.assertIn(done.returncode, codes, done.stdout + done.stderr)
                self.assertNotIn("terminate called", done.stderr)
                if done.returncode == FAILED:
                    self.assertRegex(done.stderr, "memory|threads")
        self.assertIn(FAILED, ended.values(), ended)

    def test_cut_of_a_wide_picture(self):
        width, height = 200_000, 64
        self.write("wide.png", png(width, height))
        side_deg = 180 / width * height
        self.assert_ends_well((200, 300, 400, 600, 800, 1200, 2400), "cut", "wide.png", "-o", "wide.gpkg",
                              f"--bounds=-180,0,0,{side_deg}")

    def test_cut_of_a_picture_that_is_decoded_whole(self):
        # Interlaced: the rows of the picture are not known before its last pass.
        side = 8000
        row = zlib.compressobj()
        header = b"\0" + bytes(3 * side)
        data = b"".join(row.compress(header) for _ in range(side * 2)) + row.flush()
        raw = bytearray(png_of(2 * side, side, data))
        raw[28] = 1
        raw[29:33] = zlib.crc32(raw[12:29]).to_bytes(4, "big")
        self.write("whole.png", bytes(raw))
        for megabytes in filter(self.starts_within, (200, 300, 400, 600)):
            done = self.run_within(megabytes, "cut", "whole.png", "-o", "whole.gpkg")
            self.assertIn(done.returncode, (DONE, FAILED), done.stderr)

    def test_info_verify(self):
        self.assert_done("cut", BLUE_MARBLE, "-o", "tiles", "--tile-size", "1024")
        for megabytes in filter(self.starts_within, (160, 180, 200, 240, 300, 400)):
            with self.subTest(megabytes):
                done = self.run_within(megabytes, "info", "tiles", "--verify")
                self.assertIn(done.returncode, (DONE, FAILED), done.stdout + done.stderr)

    def test_render(self):
        for megabytes in filter(self.starts_within, (250, 400, 700, 1200)):
            with self.subTest(megabytes):
                done = self.run_within(megabytes, "render", NATURAL_EARTH, "-o", "shot.png", "--size", "2048x2048")
                self.assertIn(done.returncode, (DONE, FAILED, DONE_IN_PART), done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
