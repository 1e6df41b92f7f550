"""--supersample and --motion-blur: averages in linear light of larger pictures, and of moments of a frame."""

import itertools
import json
import unittest

import png
from program import FAILED, NATURAL_EARTH, WRONG_USAGE, ProgramTest

WIDTH, HEIGHT = 160, 120
SIZE = f"{WIDTH}x{HEIGHT}"
VIEW = "--camera", "20,10,9000000,20,-70"
STARS = "--camera", "0,0,30000000,0,20"
# IEC 61966-2-1.
LIGHT = [k / 255 / 12.92 if k <= 10 else ((k / 255 + 0.055) / 1.055) ** 2.4 for k in range(256)]


def coded(light):
    return 255 * (12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055)


def mean_of(pictures):
    """The coded mean of rows of bytes, pixel by pixel."""
    return [[coded(sum(LIGHT[v] for v in values) / len(values)) for values in zip(*rows)] for rows in zip(*pictures)]


def parts_of(picture, n):
    """The n · n pictures that have one pixel each of every box of n × n."""
    return [[bytes(itertools.chain.from_iterable(row[i:i + 3] for i in range(3 * x, len(row), 3 * n)))
             for row in picture[y::n]] for y in range(n) for x in range(n)]


class Averages(ProgramTest):
    def rows(self, name):
        return png.read(self.folder / name)[2]

    def picture(self, name, *options, size=SIZE):
        self.assert_done("render", NATURAL_EARTH, *options, "--size", size, "-o", name, "--cache", "off")
        return self.rows(name)

    def assert_near(self, picture, expected, most=1.0):
        """A level of 8 bits lies half a level off a mean, and pictures of one view may differ by another half."""
        worst = max(abs(a - b) for row, other in zip(picture, expected) for a, b in zip(row, other))
        self.assertLessEqual(worst, most)


class Supersample(Averages):
    def test_is_the_mean_of_the_picture_of_larger_size(self):
        bare = "--sky", "off", *VIEW
        for n in (2, 3):
            large = self.picture("large.png", *bare, size=f"{n * WIDTH}x{n * HEIGHT}")
            small = self.picture("small.png", *bare, "--supersample", str(n))
            self.assertEqual((len(small), len(small[0])), (HEIGHT, 3 * WIDTH))
            self.assert_near(small, mean_of(parts_of(large, n)))
        self.assertNotEqual(small, self.picture("plain.png", *bare))

    def objects(self, name, **properties):
        way = [[-30, 0], [40, 45]] if properties.pop("ground", False) else [[-30, 0, 3e5], [40, 45, 3e5]]
        shape = {"type": "LineString", "coordinates": way} if "stroke" in properties else {"type": "Point", "coordinates": [0, 30, 2e5]}
        self.write(name, json.dumps({"type": "Feature", "properties": properties, "geometry": shape}).encode())
        return "--objects", name

    def test_lines_are_those_of_twice_the_size(self):
        bare = "--sky", "off", "--camera", "15,-5,2000000,20,-80"
        line = {"stroke": "#ff0000", "stroke-width": 3, "stroke-dasharray": [12, 8]}
        wide = {"stroke": "#ff0000", "stroke-width": 6, "stroke-dasharray": [24, 16]}
        large = self.picture("large.png", *bare, *self.objects("wide.json", **wide), size=f"{2 * WIDTH}x{2 * HEIGHT}")
        small = self.picture("small.png", *bare, *self.objects("line.json", **line), "--supersample", "2")
        without = self.picture("without.png", *bare, "--supersample", "2")
        self.assertGreater(sum(a != b for a, b in zip(small, without)), HEIGHT / 4, "the line is seen")
        self.assert_near(small, mean_of(parts_of(large, 2)))

    def test_sizes_in_pixels_stay(self):
        """Each part of the picture adds about as much light, in place and amount, as it adds without."""
        bare = "--sky", "off", *VIEW
        for part, options, without in [
                ("stars", STARS, (*STARS, "--sky", "off")),
                ("ground", (*bare, *self.objects("ground.json", ground=True, stroke="#ffffff", **{"stroke-width": 4})), bare),
                ("dashes", (*bare, *self.objects("dashes.json", ground=True, stroke="#ffffff", **{
                    "stroke-width": 4, "stroke-dasharray": [9, 9]})), bare),
                ("arrow heads", (*bare, *self.objects("arrow.json", stroke="#ffffff", **{
                    "stroke-width": 4, "stroke-arrows": "both"})), bare),
                ("marker", (*bare, *self.objects("marker.json", **{"marker-color": "#ffffff", "marker-size": 16})), bare),
                ("smallest sphere", (*bare, *self.objects("sphere.json", **{"marker-color": "#ffffff", "radius_m": 10})), bare),
                ("label", (*bare, *self.objects("label.json", title="mmmmmm", **{"marker-size": 4})), bare),
                ("graticule", (*bare, "--graticule"), bare),
                ("map", (*bare, "--map", "on"), bare),
                ("scale bar", (*bare, "--scale-bar"), bare)]:
            with self.subTest(part):
                added = []
                for more in (), ("--supersample", "3"):
                    one, other = self.picture("with.png", *options, *more), self.picture("without.png", *without, *more)
                    added.append(sum(abs(LIGHT[a] - LIGHT[b]) for row, rest in zip(one, other) for a, b in zip(row, rest)))
                self.assertGreater(added[0], 1)
                # A disc of two pixels meets the middles of one to four.
                self.assertAlmostEqual(added[1] / added[0], 1, delta=0.5 if part == "smallest sphere" else 0.15)

    def test_wrong_usage(self):
        for options, says in [(("--supersample", "0"), "it takes 1 to 4"), (("--supersample", "5"), "it takes 1 to 4"),
                              (("--supersample", "1.5"), "--supersample"),
                              (("--supersample", "2", "--stereo", "interlaced"), "leave out one of them"),
                              (("--supersample", "4", "--size", "4097x10"), "smaller --supersample or --size")]:
            self.assert_fails(WRONG_USAGE, "render", *options, "-o", "a.png", says=["--supersample", says])
        self.assert_nothing_but()


class MotionBlur(Averages):
    FLIGHT = {"type": "Feature",
              "properties": {"duration_s": 1, "pitches": [-40, -25], "opacities": [1, 0.4],
                             "times": ["2026-06-21T08:00Z", "2026-06-21T16:00Z"]},
              "geometry": {"type": "LineString", "coordinates": [[5, 62, 900000], [10, 47, 300000]]}}

    def setUp(self):
        super().setUp()
        self.write("f.geojson", json.dumps(self.FLIGHT).encode())

    def arguments(self, folder, *options, fps=2):
        return ["render", NATURAL_EARTH, "--flight", "f.geojson", "--fps", str(fps), "--size", "96x64", "--cache", "off",
                "-o", f"{folder}/%d.png", *options]

    def film(self, folder, *options, fps=2):
        self.assert_done(*self.arguments(folder, *options, fps=fps))
        return {path.name: path.read_bytes() for path in (self.folder / folder).glob("*.png")}

    def test_a_frame_is_the_mean_of_its_moments(self):
        """A film of eight times as many frames has the four moments of each frame."""
        self.film("fine", fps=16)
        for options in (), ("--supersample", "2"):
            self.film("fine", *options, "--force", fps=16)
            blurred = self.film(f"blurred{len(options)}", "--motion-blur", "1", "--blur-moments", "4", *options)
            self.assertEqual(len(blurred), 2)
            moments = [self.rows(f"fine/{8 + off}.png") for off in (-3, -1, 1, 3)]
            self.assertNotEqual(moments[0], moments[3])
            self.assert_near(self.rows(f"blurred{len(options)}/1.png"), mean_of(moments))

    def test_what_is_drawn_over_the_globe_stays_sharp(self):
        """The graticule's own light in a blurred frame is that of the frame's own view, not of many views."""
        def lines(*blur):
            pictures = []
            for options in (), ("--graticule",):
                self.film("over", "--force", *blur, *options)
                pictures.append(self.rows("over/1.png"))
            return [[a != b for a, b in zip(*rows)] for rows in zip(*pictures)]
        sharp, blurred = lines(), lines("--motion-blur", "1", "--blur-moments", "4")
        differ = sum(a != b for rows in zip(sharp, blurred) for a, b in zip(*rows))
        self.assertGreater(sum(map(sum, sharp)), 200)
        # A faint pixel of a line may have the level of the ground under it.
        self.assertLess(differ, 0.1 * sum(map(sum, sharp)))

    def test_runs_and_shards_are_the_same_and_go_on(self):
        blur = "--motion-blur", "0.5", "--blur-moments", "3"
        whole = self.film("whole", *blur)
        self.assertNotEqual(whole, self.film("plain"))
        for shard in "2/2", "1/2":
            self.film("parts", *blur, "--shard", shard)
        (self.folder / "parts/1.png").unlink()
        self.assertEqual(self.film("parts", *blur), whole)
        for other in ("--motion-blur", "0.6", *blur[2:]), (*blur[:3], "4"), (*blur, "--supersample", "2"), ():
            self.assert_fails(FAILED, *self.arguments("parts", *other), says=["film.json", "--force"])

    def test_a_still_camera_has_the_frame_without_blur(self):
        still = {**self.FLIGHT, "geometry": {"type": "LineString", "coordinates": [[5, 62, 900000]] * 2},
                 "properties": {"times_s": [0, 1], "pitch": -40}}
        self.write("f.geojson", json.dumps(still).encode())
        self.assertEqual(self.film("blurred", "--motion-blur", "1"), self.film("plain"))

    def test_features_are_those_of_the_frame(self):
        """A feature that ends between two moments is whole or not there."""
        self.write("area.json", json.dumps({"type": "Feature",
            "properties": {"fill": "#ff0000", "fill-opacity": 1, "time-end": "2026-06-21T12:10Z"},
            "geometry": {"type": "Polygon", "coordinates": [[[-60, 0], [80, 0], [80, 85], [-60, 85], [-60, 0]]]}}).encode())
        still = {**self.FLIGHT, "geometry": {"type": "LineString", "coordinates": [[5, 50, 900000]] * 2},
                 "properties": {"times_s": [0, 2], "times": self.FLIGHT["properties"]["times"]}}
        self.write("f.geojson", json.dumps(still).encode())
        self.film("blurred", "--motion-blur", "1", "--objects", "area.json", "--unlit")
        self.assertEqual([png.pixel(png.read(self.folder / f"blurred/{k}.png"), 48, 32)[:2] == (255, 0) for k in range(4)],
                         [True, True, True, False])

    def test_wrong_usage(self):
        for options, says in [(("--motion-blur", "1.1"), "--motion-blur"), (("--motion-blur", "-0.1"), "--motion-blur"),
                              (("--motion-blur", "nan"), "--motion-blur"),
                              (("--motion-blur", "0.5", "--blur-moments", "1"), "it takes 2 to 64"),
                              (("--motion-blur", "0.5", "--blur-moments", "65"), "it takes 2 to 64"),
                              (("--blur-moments", "4"), "--motion-blur")]:
            self.assert_fails(WRONG_USAGE, *self.arguments("no", *options), says=[says])
        self.assert_fails(WRONG_USAGE, "render", "--motion-blur", "0.5", "-o", "a.png", says=["--flight"])
        self.assert_nothing_but("f.geojson")


if __name__ == "__main__":
    unittest.main()
