"""Films: frames are the same whole, after a kill and in shards; what is refused; MP4 through ffmpeg."""

import json
import os
import signal
import sqlite3
import struct
import subprocess
import time
import unittest
import zipfile
import zlib

from pictures import png_of
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, NATURAL_EARTH, PROGRAM, WRONG_USAGE, ProgramTest

SIZE = "--size", "96x64", "--cache", "off"
FRAMES = 16
FLIGHT = {"type": "Feature",
          "properties": {"duration_s": 2, "pitches": [-40, -25, -90], "headings": [30, 80, 10],
                         "times": ["2026-06-21T08:00Z", "2026-06-21T12:00Z", "2026-06-21T16:00Z"]},
          "geometry": {"type": "LineString", "coordinates": [[5, 62, 900000], [10, 47, 300000], [12, 78, 9000000]]}}
# Writes its arguments, and its input when that ends.
FFMPEG = """#!/bin/sh
printf '%s\\n' "$@" > ffmpeg.arguments
for last; do :; done
cat > "${last#file:}"
exit ${FFMPEG_CODE:-0}
"""


def hills(width, height):
    rows = b"".join(b"\0" + b"".join(struct.pack(">H", 32768 + 4000 * ((x // 5 + y // 3) % 2)) for x in range(width))
                    for y in range(height))
    return png_of(width, height, zlib.compress(rows), bits=16, colour=0)


class Film(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("f.geojson", json.dumps(FLIGHT).encode())

    def arguments(self, *options, output="frames/%03d.png"):
        return ["render", NATURAL_EARTH, "--flight", "f.geojson", "--fps", "8", *SIZE, "-o", output, *options]

    def film(self, *options, output="frames/%03d.png", code=DONE):
        done = self.run_program(*self.arguments("--json", *options, output=output))
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return json.loads(done.stdout), done.stderr

    def frames(self, folder):
        return {path.name: path.read_bytes() for path in (self.folder / folder).glob("*.png")}

    def test_tour_of_a_kmz_file(self):
        """A tour of Google Earth is a film, as the same views in GeoJSON are; its sound is left out by name."""
        def view(lon):
            return f"""<Camera><longitude>{lon}</longitude><latitude>47</latitude><altitude>900000</altitude>
                       <tilt>30</tilt><altitudeMode>absolute</altitudeMode></Camera>"""
        steps = "".join(f"<gx:FlyTo><gx:duration>1</gx:duration>{view(lon)}</gx:FlyTo>" for lon in (5, 9))
        kml = f"""<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>
                  <gx:Tour><gx:Playlist>{steps}<gx:SoundCue/></gx:Playlist></gx:Tour></Document></kml>"""
        with zipfile.ZipFile(self.folder / "tour.kmz", "w") as out:
            out.writestr("doc.kml", kml)
        same = {"type": "Feature", "properties": {"duration_s": 1, "pitch": -60},
                "geometry": {"type": "LineString", "coordinates": [[5, 47, 900000], [9, 47, 900000]]}}
        self.write("f.geojson", json.dumps(same).encode())
        self.film(output="lines/%d.png")
        done = self.assert_done("render", NATURAL_EARTH, "--flight", "tour.kmz", "--fps", "8", *SIZE, "-o", "tour/%d.png")
        self.assertIn("SoundCue", done.stderr)
        self.assertEqual(len(self.frames("tour")), 8)
        self.assertEqual(self.frames("tour"), self.frames("lines"))
        self.write("places.kml", kml.replace("gx:Tour>", "Folder>").encode())
        self.assert_fails(FAILED, "render", "--flight", "places.kml", "-o", "no/%d.png", says=("places.kml", "gx:Tour"))

    def test_a_flight_has_no_look_of_the_one_before(self):
        """Each frame is the same in a film of all flights, of some, and in shards."""
        def flight(lon, **properties):
            return {"type": "Feature", "properties": {"duration_s": 0.5, **properties},
                    "geometry": {"type": "LineString", "coordinates": [[lon, 47, 900000], [lon + 2, 47, 900000]]}}
        looks = {"opacities": [0.9, 0.3], "times": ["2026-06-21T18:00Z", "2026-06-21T20:00Z"]}
        both = {"type": "FeatureCollection", "features": [flight(5, **looks), flight(20)]}
        self.write("f.geojson", json.dumps(both).encode())
        self.film("--time", "2026-06-21T12:00Z")
        self.write("f.geojson", json.dumps(flight(20)).encode())
        self.film("--time", "2026-06-21T12:00Z", output="alone/%03d.png")
        whole, alone = self.frames("frames"), self.frames("alone")
        self.assertEqual([whole[f"{k + 4:03}.png"] for k in range(4)], [alone[f"{k:03}.png"] for k in range(4)])

    def test_whole_killed_and_in_shards(self):
        self.write("hills.png", hills(512, 256))
        self.assert_done("cut", "hills.png", "--elevation", "--offset", "-32768", "-o", "hills.gpkg", "--tile-size", "64")
        relief = "--elevation", "hills.gpkg", "--exaggeration", "8"
        report, _ = self.film(*relief, output="whole/%03d.png")
        self.assertEqual((report["frames"], report["written"], report["kept"]), (FRAMES, FRAMES, 0))
        whole = self.frames("whole")
        self.assertEqual(sorted(whole), [f"{k:03}.png" for k in range(FRAMES)])
        self.assertGreater(len(set(whole.values())), FRAMES - 1)
        killed = subprocess.Popen([PROGRAM, *map(str, self.arguments(*relief))], cwd=self.folder,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "frames/004.png").exists():
            self.assertIsNone(killed.poll())
            time.sleep(0.005)
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        (self.folder / f"frames/009.png.{killed.pid}.part").write_bytes(b"half")
        report, _ = self.film(*relief)
        self.assertGreaterEqual(report["kept"], 5)
        self.assertEqual(report["kept"] + report["written"], FRAMES)
        self.assertEqual(self.frames("frames"), whole)
        self.assertEqual(len(list((self.folder / "frames").iterdir())), FRAMES + 1)  # and film.json
        for shard in "2/2", "1/2":
            report, _ = self.film(*relief, "--shard", shard, output="parts/%03d.png")
            self.assertEqual(report["written"], FRAMES / 2)
            self.assertEqual(len(self.frames("parts")), FRAMES if shard == "1/2" else FRAMES / 2)
        self.assertEqual(self.frames("parts"), whole)

    def test_frames_of_another_film_are_not_kept(self):
        self.film("--shard", "1/8")
        said = self.assert_fails(FAILED, *self.arguments("--unlit"), says=["film.json", "--unlit", "--force"]).stderr
        self.assertNotIn("flight", said)
        self.write("f.geojson", json.dumps({**FLIGHT, "properties": {"duration_s": 2}}).encode())
        self.assert_fails(FAILED, *self.arguments(), says=["film.json", "flight differ", "--force"])
        report, _ = self.film("--force", "--shard", "2/8")
        self.assertEqual((report["written"], report["kept"]), (2, 0))
        self.assertEqual(sorted(self.frames("frames")), ["001.png", "009.png"])
        (self.folder / "frames/film.json").unlink()
        self.assert_fails(FAILED, *self.arguments(), says=["no film.json", "--force"])

    def test_missing_tiles(self):
        self.assert_done("cut", BLUE_MARBLE, "-o", "earth.gpkg",
                         "--tile-size", "128")
        with sqlite3.connect(self.folder / "earth.gpkg") as base:
            table, = base.execute("SELECT table_name FROM gpkg_contents").fetchone()
            base.execute(f'UPDATE "{table}" SET tile_data = ? WHERE zoom_level > 2', (b"no picture",))
        base.close()
        arguments = ["render", "earth.gpkg", "--flight", "f.geojson", "--fps", "1", *SIZE, "-o", "%d.png"]
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertRegex(done.stderr, r"frame \d lacks tiles")
        self.assertRegex(done.stdout, r"2 frames: 2 written, 0 kept; [1-9]\d* tiles missing; \d+\.\d s")
        marks = len(list(self.folder.glob("*.incomplete")))
        self.assertGreater(marks, 0)
        again = self.run_program(*arguments)  # frames that lack tiles are drawn again
        self.assertIn(f"{marks} written, {2 - marks} kept", again.stdout)

    def test_wrong_usage(self):
        for options, says in [(("--camera", "1,2,3"), "leave out --camera"), (("--fps", "0"), "--fps"),
                              (("--fps", "241"), "--fps"), (("--shard", "3/2"), "--shard")]:
            self.assert_fails(WRONG_USAGE, *self.arguments(*options), says=[says])
        for output in "a.png", "%s.png", "%d%d.png", "%d.mp4":
            self.assert_fails(WRONG_USAGE, *self.arguments(output=output), says=["frames/%05d.png"])
        self.assert_fails(WRONG_USAGE, *self.arguments("--shard", "1/2", output="a.mp4"), says=["frames/%05d.png"])
        self.assert_fails(WRONG_USAGE, "render", "--fps", "30", "-o", "a.png", says=["--flight"])
        self.write("f.geojson", json.dumps({**FLIGHT, "properties": {"duration_s": 1e6}}).encode())
        self.assert_fails(FAILED, *self.arguments(), says=["8000000 frames", "duration_s", "--fps"])
        self.assert_nothing_but("f.geojson")

    def test_mp4_through_ffmpeg(self):
        (self.folder / "bin").mkdir()
        nothing = {"PATH": str(self.folder / "bin")}
        self.assert_fails(FAILED, *self.arguments(output="a.mp4"), environment=nothing,
                          says=["ffmpeg", "install the package ffmpeg", "frames/%05d.png"])
        program = self.write("bin/ffmpeg", FFMPEG.encode())
        program.chmod(0o755)
        there = {"PATH": f"{self.folder}/bin:{os.environ['PATH']}"}
        self.assert_done(*self.arguments(output="a.mp4"), environment=there)
        self.assertEqual((self.folder / "a.mp4").stat().st_size, FRAMES * 96 * 64 * 4)
        said = (self.folder / "ffmpeg.arguments").read_text().split("\n")
        for name, value in ("-video_size", "96x64"), ("-framerate", "8"), ("-pixel_format", "rgba"), ("-i", "pipe:0"):
            self.assertEqual(said[said.index(name) + 1], value)
        self.assert_fails(FAILED, *self.arguments(output="a.mp4"), environment=there, says=["is there already", "--force"])
        self.assert_fails(FAILED, *self.arguments("--force", output="a.mp4"), says=["ended with code 7"],
                          environment={**there, "FFMPEG_CODE": "7"})
        self.assertEqual((self.folder / "a.mp4").stat().st_size, FRAMES * 96 * 64 * 4)
        self.assert_nothing_but("a.mp4", "bin", "f.geojson", "ffmpeg.arguments")


if __name__ == "__main__":
    unittest.main()
