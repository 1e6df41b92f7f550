"""Flights in the window: Y plays bookmarks and the tours of KML files, saves them and has films rendered."""

import json
import os
import shlex
import signal
import subprocess
import time
import unittest
from pathlib import Path

from real_window import PROGRAM, WindowTest, wait_until

BUTTONS, SAVE = 90, 223  # pixels under the panel's upper edge
SAVE_RUNNING = 245  # the same, of "Cancel film"
PLAY, START, SAVE_FILM, SAVE_FLIGHT = 30, 80, 40, 120  # pixels from its left edge
FIRST, LAST = (10.0, 20.0, 3.0e6), (16.0, 24.0, 2.0e6)  # latitude, longitude, height of the tour's views
SECONDS = 1.5
FRAMES = 45


def tour():
    def step(view, duration, mode):
        lat, lon, height = view
        return f"""<gx:FlyTo><gx:duration>{duration}</gx:duration><gx:flyToMode>{mode}</gx:flyToMode><Camera>
          <longitude>{lon}</longitude><latitude>{lat}</latitude><altitude>{height}</altitude><tilt>0</tilt>
          <altitudeMode>absolute</altitudeMode></Camera></gx:FlyTo>"""
    return f"""<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>
      <gx:Tour><name>T</name><gx:Playlist>{step(FIRST, 0, 'bounce')}{step(LAST, SECONDS, 'smooth')}</gx:Playlist></gx:Tour>
      <Placemark><name>here</name><Point><coordinates>22,12</coordinates></Point></Placemark></Document></kml>"""


class Flights(WindowTest):
    def click_in(self, x, y):
        self.viewer.settled()
        left, top, *_ = self.viewer.panel("Flight")
        self.viewer.click(left + x, top + y)

    def is_at(self, place, within=1e-6):
        seen = self.viewer.camera
        return all(abs(a - b) <= within * max(1.0, abs(b)) for a, b in zip((seen.lat, seen.lon, seen.height_m), place))

    def fly(self, place):
        """Plays from the first view to the end; the camera is told where it comes to rest alone."""
        self.click_in(START, BUTTONS)
        self.viewer.next_camera()
        self.assertTrue(self.is_at(FIRST), str(vars(self.viewer.camera)))
        self.click_in(PLAY, BUTTONS)
        self.viewer.next_camera()
        self.assertTrue(self.is_at(place), str(vars(self.viewer.camera)))

    def test_a_way_through_bookmarks_is_played_twice_and_a_drag_pauses_it(self):
        self.viewer = self.start("--camera", "10,20,3000000", "--unlit")
        self.viewer.key("y")
        self.viewer.panel("Flight")  # without two bookmarks it says how to make them
        self.viewer.key("ctrl+1")
        self.viewer.settled()
        self.viewer.wheel(560, 300, 2)
        self.viewer.next_camera()
        self.viewer.key("ctrl+2")
        self.viewer.settled()
        second = (self.viewer.camera.lat, self.viewer.camera.lon, self.viewer.camera.height_m)
        wait_until("the flight", lambda: self.viewer.panel("Flight")[3] > 200)
        for _ in range(2):
            self.fly(second)
        self.viewer.save_grab(self.folder / "panel.png")
        self.click_in(START, BUTTONS)
        self.viewer.next_camera()
        self.click_in(PLAY, BUTTONS)
        time.sleep(0.3)
        self.viewer.drag((540, 300), (570, 300))
        self.viewer.next_camera()
        self.assertFalse(self.is_at(second, 1e-3) or self.is_at(FIRST, 1e-9))
        self.assertTrue(self.viewer.camera_stays(2.0), "a flight goes on after a drag")

    def test_a_tour_is_played_saved_and_rendered(self):
        (self.folder / "tour.kml").write_text(tour(), encoding="utf-8")
        self.viewer = self.start("--camera", "0,0,5000000", "--unlit")
        self.viewer.settled()
        self.viewer.drop(self.folder / "tour.kml")
        self.viewer.next_camera()  # flies to the layer
        self.viewer.settled()
        self.viewer.key("y")
        for _ in range(2):
            self.fly(LAST)
        self.click_in(SAVE_FLIGHT, SAVE)
        saved = wait_until("the flight", lambda: list(self.folder.glob("terrella-*.geojson")))[0]
        flight = json.loads(saved.read_text(encoding="utf-8"))["features"][0]
        self.assertEqual([round(x, 6) for x in flight["geometry"]["coordinates"][-1]], [LAST[1], LAST[0], LAST[2]])
        self.assertEqual(flight["properties"]["times_s"], [0, SECONDS])
        self.click_in(SAVE_FILM, SAVE)
        folder = wait_until("the film's folder", lambda: list(self.folder.glob("terrella-*-film")))[0]
        wait_until("the film", lambda: len(list(folder.glob("*.png"))) == FRAMES)
        wait_until("its end", lambda: not self.film_runs())
        # A frame is the picture of its view.
        lat, lon, height = FIRST
        subprocess.run([PROGRAM, "render", folder / "scene.terrella", "--camera", f"{lat},{lon},{height}", "--size",
                        "{}x{}".format(*self.viewer.size), "--credits", "-o", self.folder / "first.png"], check=True, timeout=60,
                       env=self.viewer.environment, stdout=subprocess.DEVNULL)
        self.assertEqual((folder / "00000.png").read_bytes(), (self.folder / "first.png").read_bytes())

    def test_a_film_is_cancelled_and_its_command_goes_on(self):
        self.folder /= "100 %"  # a name with the sign of frames' numbers
        self.folder.mkdir()
        (self.folder / "tour.kml").write_text(tour(), encoding="utf-8")
        self.viewer = self.start("--camera", "0,0,5000000", "--unlit", "--flight", "tour.kml", "--cache", "off")
        self.viewer.panel("Flight")
        self.click_in(SAVE_FILM, SAVE)
        folder = wait_until("the film's folder", lambda: list(self.folder.glob("terrella-*-film")))[0]
        wait_until("a frame", lambda: list(folder.glob("*.png")))
        film = int(self.film_runs()[0])
        os.kill(film, signal.SIGSTOP)  # the film does not end meanwhile
        self.viewer.key("ctrl+q")
        self.viewer.settled()
        self.assertIsNone(self.viewer.program.poll(), "a film is lost without a question")
        self.viewer.key("Escape")  # closes the panel
        self.viewer.settled()
        self.assertTrue(self.film_runs(), "Esc has no effect on a film")
        self.viewer.key("y")
        self.viewer.panel("Flight")
        self.click_in(SAVE_FILM, SAVE_RUNNING)  # Cancel film
        self.viewer.settled()
        os.kill(film, signal.SIGCONT)
        wait_until("the end", lambda: not self.film_runs())
        there = len(list(folder.glob("*.png")))
        self.assertLess(there, FRAMES)
        command = (folder / "film.log").read_text(encoding="utf-8").splitlines()[0]
        self.assertIn("--cache off", command)
        done = subprocess.run([PROGRAM, *shlex.split(command)[1:]], cwd=self.folder, env=self.viewer.environment, timeout=120,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{there} kept", done.stdout)
        self.assertEqual(len(list(folder.glob("*.png"))), FRAMES)

    def film_runs(self):
        children = Path(f"/proc/{self.viewer.program.pid}/task/{self.viewer.program.pid}/children")
        return children.read_text().split()


if __name__ == "__main__":
    unittest.main()
