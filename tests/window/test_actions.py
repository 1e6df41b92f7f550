"""Walks the table of actions in the user's page: each by keyboard and by mouse, each twice in a row."""

import json
import os
import re
import time
import unittest
from pathlib import Path

import pictures
from real_window import SIZE, WindowTest, differing, wait_until

PAGE = Path(os.environ["TERRELLA_SOURCE"]) / "apps/README.md"
ROWS = 380  # pixels from the top; messages and the status line are under them
SHOWN = 400  # pixels: the least that an action changes in the picture
MIDDLE = (SIZE[0] // 2, SIZE[1] // 2)
MENU_AT = (450, 330)  # beside all panels
PLACE_ITEM, FIRST_ACTION, ACTION_STEP = 34, 162, 19  # pixels under the menu's upper edge
COLUMNS = (262, 470)  # pixels from the left, in the actions of the menu
ICONS = ["menu", "search", "layers", "clock", "compass", "plus", "minus", "tilted", "flat", "home", "back", "forward"]
LAST_ICON, ICON_STEP, ICON_X = 407, 26, 612
OBJECT = {"type": "Feature", "properties": {"note": "here"}, "geometry": {"type": "Point", "coordinates": [10, 20]}}
RESET = "reset the view: settings as at the start, whole globe"
DRAW_BUTTONS, DRAW_ROW = (30, 85), 65  # pixels from the left and from the top of the panel
ROW_BUTTONS = 26  # pixels over the lower edge of the row of a measurement: over the texts of its buttons


def table():
    """Action, way by keyboard, way by mouse."""
    text = PAGE.read_text(encoding="utf-8")
    rows = text[text.index("| action | keyboard | mouse |") :].split("\n\n")[0].split("\n")[2:]
    return [tuple(cell.strip() for cell in row.strip("|").split("|")) for row in rows]


class Walk(WindowTest):
    """Names of methods follow the table: an action without a way here fails."""

    def setUp(self):
        super().setUp()
        (self.folder / "object.json").write_text(json.dumps(OBJECT), encoding="ascii")
        (self.folder / "part.png").write_bytes(pictures.png(64, 64))
        (self.folder / "part.pgw").write_text("0.3125\n0\n0\n-0.3125\n0.15\n29.85\n", encoding="ascii")
        self.viewer = self.start("--camera", "20,10,12000000", "--objects", "object.json", "--overlay", "part.png")
        self.menu_rows = [what for what, _, mouse in table()
                          if mouse.startswith("menu") and what != "save the view as a bookmark"]

    # Hands

    def key(self, *names):
        for name in names:
            self.viewer.key(name)
            time.sleep(0.15)

    def icon(self, name):
        self.viewer.click(ICON_X, LAST_ICON - ICON_STEP * (len(ICONS) - 1 - ICONS.index(name)))
        time.sleep(0.15)

    def menu_top(self):
        """The menu is as low as the window lets it be."""
        rows = (len(self.menu_rows) + 1) // 2
        return SIZE[1] - 12 - (FIRST_ACTION + ACTION_STEP * rows - 2)

    def open_menu(self):
        self.viewer.open_menu(*MENU_AT)

    def menu(self, what):
        """Chooses an action in the menu."""
        index, half = self.menu_rows.index(what), (len(self.menu_rows) + 1) // 2
        self.open_menu()
        self.viewer.click(COLUMNS[index // half], self.menu_top() + FIRST_ACTION + ACTION_STEP * (index % half))
        time.sleep(0.15)

    def place_item(self, index):
        self.open_menu()
        self.viewer.click(COLUMNS[0], self.menu_top() + PLACE_ITEM + 20 * index)
        time.sleep(0.15)

    # Changes of the view

    def moved(self, act):
        before = self.viewer.camera
        act()
        after = self.viewer.next_camera()
        self.assertNotEqual(str(vars(before)), str(vars(after)))

    def shown(self, act):
        before = self.viewer.settled(ROWS)
        act()
        wait_until("a change in the picture", lambda: differing(before, self.viewer.grab(), ROWS) > SHOWN)

    def said(self, act):
        before = self.viewer.grab()[ROWS:]
        act()
        wait_until("another text", lambda: differing(before, self.viewer.grab()[ROWS:]) > 100)

    def silent(self):
        wait_until("no message", lambda: "message" not in self.viewer.layout.panels)

    def filed(self, pattern, act):
        before = set(self.folder.glob(pattern))
        act()
        wait_until(f"a new {pattern}", lambda: set(self.folder.glob(pattern)) - before)

    def copied(self, act):
        self.viewer.set_clipboard("nothing")
        act()
        wait_until("the clipboard", lambda: "Length" in self.viewer.clipboard())

    def stored(self, act):
        file = self.kept / "terrella" / "bookmarks.json"
        before = file.read_text() if file.exists() else ""
        act()
        wait_until("the file", lambda: file.exists() and file.read_text() != before)

    def resized(self, act):
        before = self.viewer.geometry()[2:]
        act()
        wait_until("another size", lambda: self.viewer.geometry()[2:] != before)

    def measured(self):
        """Ends a measurement that there may be, and starts one with two places."""
        self.key("m")
        self.viewer.click(200, 200)
        self.viewer.click(300, 250)
        self.viewer.move(330, 120)  # away from the last place, so that the row tells the way to the cursor
        time.sleep(0.15)
        self.viewer.settled()

    def measure_button(self, index):
        """Clicks a button of the row, found by its blue."""
        left, _, right, bottom = map(int, self.viewer.layout.panels["measure"])  # beside it the sea is blue too
        row = self.viewer.grab()[bottom - ROW_BUTTONS]
        blue = [(pixel & 255) - (pixel >> 16 & 255) > 50 for pixel in row]
        starts = [x for x in range(left + 1, right) if blue[x] and not blue[x - 1] and all(blue[x : x + 20])]
        self.viewer.click(starts[index] + 12, bottom - ROW_BUTTONS + 7)
        time.sleep(0.15)

    def drawn(self):
        """A mark of two places, and the panel of the marks."""
        self.measured()
        self.key("ctrl+d")
        self.viewer.settled()

    def undone(self):
        self.drawn()
        self.key("ctrl+z")
        self.viewer.settled()

    def draw_button(self, index):
        """Clicks a button under those that begin a mark."""
        left, top, _, _ = self.viewer.layout.panels["Draw"]
        self.viewer.click(round(left) + DRAW_BUTTONS[index], round(top) + DRAW_ROW)
        time.sleep(0.15)

    def after_measuring(self):
        self.key("m")

    def away(self):
        self.key("shift+Left", "shift+Left", "shift+Left")
        self.viewer.next_camera()
        time.sleep(0.4)  # a view is kept after a rest

    def reset(self):
        """The look of the start, over the whole globe in daylight."""
        self.key("r", "r")  # changed settings ask once
        time.sleep(1.0)
        self.viewer.settled(ROWS)

    def turned(self):
        self.key("shift+Left")
        self.viewer.next_camera()

    def at_the_object(self):
        self.away()
        self.key("1")
        self.viewer.next_camera()
        time.sleep(0.5)  # no double click

    def tilted(self):
        self.key("shift+Up", "shift+Up", "shift+Up")
        self.viewer.next_camera()

    def back(self):
        self.away()
        self.key("alt+Left")
        self.viewer.next_camera()
        time.sleep(0.4)

    def panel_open(self):
        self.shown(lambda: self.key("p"))

    def close(self):
        self.shown(lambda: self.key("Escape"))

    def bookmark_click(self):
        self.shown(lambda: self.key("k"))
        self.viewer.click(100, 115)
        time.sleep(0.2)
        self.key("Escape")

    # Each action: how it is seen, by keyboard, by mouse, what is done before and after it

    def actions(self):
        key, icon, menu, drag = self.key, self.icon, self.menu, self.viewer.drag
        none = lambda: None  # noqa: E731
        row_button = self.measure_button
        simple = {
            "graticule": "g", "map: coastlines, borders and names": "c", "view settings": "p",
            "layers: show, opacity, order, remove": "l",
            "bookmarks: fly, name, sort, delete": "k", "flight: bookmarks and tours, film": "y", "translucent surface": "u",
            "swipe: compare layers at a line": "v", "body: Earth, Moon, planets": "w",
            "measure: start, end": "m", "draw: place marks, lines, areas": "d",
        }
        ways = {what: (self.shown, lambda k=k: key(k), lambda w=what: menu(w), none, none) for what, k in simple.items()}
        ways |= {
            "move the ground": (self.moved, lambda: key("Up"), lambda: drag((300, 200), (330, 260)), none, none),
            "zoom in": (self.moved, lambda: key("plus"), lambda: icon("plus"), none, none),
            "zoom out": (self.moved, lambda: key("minus"), lambda: icon("minus"), none, none),
            "turn": (self.moved, lambda: key("shift+Left"), lambda: drag((300, 200), (360, 200), button=3), none, none),
            "tilt towards the horizon": (self.moved, lambda: key("shift+Up"), lambda: icon("tilted"), none, none),
            "tilt towards straight down": (self.moved, lambda: key("shift+Down"), lambda: icon("flat"), self.tilted, none),
            "north up; again: look straight down": (self.moved, lambda: key("n"), lambda: icon("compass"), self.turned,
                                                    none),
            "the whole globe": (self.moved, lambda: key("Home"), lambda: icon("home"), self.away, none),
            "back to the view before": (self.moved, lambda: key("alt+Left"), lambda: icon("back"), self.away, none),
            "forward to the next view": (self.moved, lambda: key("alt+Right"), lambda: icon("forward"), self.back, none),
            "menu of the place: copy, measure, centre, fly there": (
                self.shown, lambda: key("Menu"), self.open_menu, none, self.close),
            "object in the middle of the view: show its fields": (
                self.shown, lambda: key("o"), lambda: self.viewer.click(*MIDDLE), self.at_the_object, self.close),
            "fly to a place": (self.moved, lambda: key("Menu", *["Down"] * 5, "Return"),
                               lambda: self.viewer.double_click(300, 200), none, none),
            RESET: (self.moved, lambda: key("r"), lambda: menu(RESET), self.away, none),
            "stereo: anaglyph, side by side, interlaced, off": (
                self.shown, lambda: key("s"), lambda: menu("stereo: anaglyph, side by side, interlaced, off"), self.reset,
                none),
            "save a picture of any size": (self.shown, lambda: key("i"), lambda: menu("save a picture of any size"), none,
                                           self.close),
            "project: save, restore at the next start, new": (
                self.shown, lambda: key("j"), lambda: menu("project: save, restore at the next start, new"), none,
                self.close),
            "shortcuts": (self.shown, lambda: key("F1"), lambda: menu("shortcuts"), none,
                          lambda: self.shown(lambda: self.viewer.click(*MENU_AT))),
            "search for a place": (self.shown, lambda: key("slash"), lambda: icon("search"), none,
                                   self.close),
            "add data: public pictures by body and theme": (
                self.shown, lambda: key("e"), lambda: menu("add data: public pictures by body and theme"), none,
                self.close),
            "measure, draw: add the middle of the view": (self.shown, lambda: key("Return"),
                                                    lambda: self.viewer.click(260, 320), self.measured,
                                                    self.after_measuring),
            "measure, draw: remove the last place": (self.shown, lambda: key("BackSpace"), lambda: row_button(0),
                                                     self.measured, self.after_measuring),
            "measure: copy the result": (self.copied, lambda: key("ctrl+c"), lambda: row_button(1), self.measured,
                                         self.after_measuring),
            "measure: keep the result as a drawing": (self.shown, lambda: key("ctrl+d"), lambda: row_button(3),
                                                      self.measured, self.close),
            "measure: profile of heights and numbers": (self.shown, lambda: key("ctrl+p"), lambda: row_button(5),
                                                        self.measured, lambda: key("ctrl+p", "m")),
            "measure, draw: save as GeoJSON or KML": (
                lambda act: self.filed("terrella-*.geojson", act), lambda: key("ctrl+s"), lambda: row_button(2),
                self.measured, self.after_measuring),
            "undo: drawing while it is open, else layers": (self.shown, lambda: key("ctrl+z"), lambda: self.draw_button(0), self.drawn, self.close),
            "redo: drawing while it is open, else layers": (self.shown, lambda: key("ctrl+y"), lambda: self.draw_button(1), self.undone, self.close),
            "fly to a bookmark": (self.moved, lambda: key("1"), self.bookmark_click, self.away, none),
            "save the view as a bookmark": (self.stored, lambda: key("ctrl+2"), lambda: self.place_item(2), self.away,
                                            none),
            "open a file, folder or address": (self.shown, lambda: key("ctrl+o"),
                                               lambda: menu("open a file, folder or address"), none, self.close),
            "play or pause the time": (self.said, lambda: key("t"), lambda: icon("clock"), none,
                                       lambda: key("t")),  # nothing stands still while it plays
            "dates of layers: play, step": (self.said, lambda: key("a"), lambda: menu("dates of layers: play, step"),
                                            self.silent, none),  # a message says that no layer has dates
            "frame time, tiles, memory": (self.said, lambda: key("F3"), lambda: menu("frame time, tiles, memory"), none,
                                          none),
            "go under the ground, and back": (self.moved, lambda: key("x"),
                                              lambda: menu("go under the ground, and back"), none, none),
            "sky on or off": (self.shown, lambda: key("b"), lambda: menu("sky on or off"), none, none),
            "full screen": (self.resized, lambda: key("f"), lambda: menu("full screen"), none,
                            lambda: self.resized(lambda: key("f"))),
            "save a screenshot": (lambda act: self.filed("terrella-*.png", act), lambda: key("F12"),
                                  lambda: menu("save a screenshot"), none, none),
            "switch the keyboard between panel and globe": (
                self.moved, lambda: key("F6", "Up"), lambda: (self.viewer.click(500, 200), key("Up")), self.panel_open,
                self.close),
            "close a panel, cancel; twice: quit": (self.shown, lambda: key("Escape"),
                                                   lambda: self.viewer.click(348, 63), self.panel_open, none),
        }
        return ways

    def test_each_action_by_keyboard_and_by_mouse(self):
        ways = self.actions()
        self.key("ctrl+1")
        for what, keys, mouse in table():
            if what == "quit":
                continue
            with self.subTest(what):
                seen, by_keyboard, by_mouse, before, after = ways[what]
                self.assertTrue(keys and mouse)
                # Once by each: twice in a row.
                for by, way in (("keyboard", by_keyboard), ("mouse", by_mouse)):
                    with self.subTest(f"{what}: {by}"):
                        before()
                        seen(way)
                        after()
                self.assertIsNone(self.viewer.program.poll())
        self.quits(lambda: self.key("ctrl+q"))
        self.viewer = self.start("--camera", "20,10,12000000")
        self.quits(lambda: self.menu("quit"))

    def quits(self, act):
        act()
        self.assertEqual(self.viewer.program.wait(timeout=30), 0)


if __name__ == "__main__":
    unittest.main()
