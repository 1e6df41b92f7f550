"""Labels in twelve scripts, beside the same text by pango-view. Letters that no font has are named."""

import json
import math
import os
import subprocess
import unittest

import png as pngs
from pictures import png
from program import ProgramTest

TEXT_PX = 15  # size of labels
WIDTH_PX, HEIGHT_PX = 400, 48
INK = 40  # least strength, of 255, of a pixel that counts as ink
SHIFTS_PX = range(-2, 3)

# The same glyphs at the same places correlate by 0.985 to 1: Pango rounds places of marks a little differently. The
# same letters in another order or in other forms correlate by at most 0.53.
LEAST_CORRELATION, MOST_OF_ANOTHER = 0.95, 0.6

# Words of scripts that DejaVu Sans lacks have no spaces: Pango takes a space from the font of the word.
TEXTS = {
    "Latin": "AVATAR Zürich",
    "Greek": "Αθήνα Θεσσαλονίκη",
    "Cyrillic": "Москва Київ",
    "Armenian": "Երևան Գյումրի",
    "Georgian": "თბილისი",
    "Arabic": "السلام القاهرة 12",
    "Hebrew": "ירושלים 34 (תל אביב)",
    "Devanagari": "हिन्दीक्षत्रिय",
    "Thai": "กรุงเทพที่น้ำ",
    "Chinese": "北京中文字",
    "Japanese": "とうきょうトウキョウ",
    "Korean": "서울한국어",
}

FAMILIES = ("DejaVu Sans", "Lohit Devanagari", "Garuda", "WenQuanYi Micro Hei")
# The machine's settings, and no fonts but some families.
FONTS_CONF = """<?xml version="1.0"?>
<fontconfig>
  <include>fonts.conf</include>
  <selectfont><rejectfont><pattern/></rejectfont><acceptfont>{}</acceptfont></selectfont>
</fontconfig>
"""
FAMILY = '<pattern><patelt name="family"><string>{}</string></patelt></pattern>'


def ink_of(path):
    """Rows of the strength of white on black, 0 to 255, cut to the box of ink."""
    width, _, rows = pngs.read(path)
    rows = [[row[3 * x + 1] for x in range(width)] for row in rows]
    inked = [y for y, row in enumerate(rows) if max(row) > INK]
    columns = [x for x in range(width) if max(row[x] for row in rows) > INK]
    return [row[columns[0]:columns[-1] + 1] for row in rows[inked[0]:inked[-1] + 1]] if inked else []


def correlation(one, other):
    """The best correlation of two pictures of ink over the shifts; around them is black."""
    edge = max(SHIFTS_PX)
    width, height = max(len(one[0]), len(other[0])) + 2 * edge, max(len(one), len(other)) + 2 * edge

    def framed(ink, right, down):
        values = [0] * (width * height)
        for y, row in enumerate(ink):
            at = (y + edge + down) * width + edge + right
            values[at:at + len(row)] = row
        mean = sum(values) / len(values)
        length = math.sqrt(sum((value - mean) ** 2 for value in values))
        return [(value - mean) / length for value in values]

    fixed = framed(one, 0, 0)
    shifted = (framed(other, right, down) for right in SHIFTS_PX for down in SHIFTS_PX)
    return max(sum(a * b for a, b in zip(fixed, moved)) for moved in shifted)


class Scripts(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("black.png", png(64, 32, (0, 0, 0)))
        self.use_fonts(*FAMILIES)

    def use_fonts(self, *families):
        patterns = "".join(FAMILY.format(family) for family in families)
        path = self.write("families.conf", FONTS_CONF.format(patterns).encode())
        self.fonts = {"FONTCONFIG_FILE": str(path)}

    def render(self, title):
        """Standard error, and the ink of a white label over a black planet. The marker is black too."""
        point = {"type": "Feature", "properties": {"title": title, "marker-color": "#000000"},
                 "geometry": {"type": "Point", "coordinates": [0, 0]}}
        self.write("label.geojson", json.dumps(point).encode())
        done = self.assert_done("render", "black.png", "--objects", "label.geojson", "-o", "label.png", "--sky", "off",
                                "--camera", "0,0,3000000", "--size", f"{WIDTH_PX}x{HEIGHT_PX}", environment=self.fonts)
        return done.stderr, ink_of(self.folder / "label.png")

    def pango(self, text):
        path = self.folder / "pango.png"
        subprocess.run(["pango-view", "--no-display", "--pixels", f"--font=DejaVu Sans {TEXT_PX}px", "--hinting=full",
                        "--antialias=gray", "--background=black", "--foreground=white", f"--text={text}", "-o", path],
                       check=True, timeout=60, env={**os.environ, "LC_ALL": "C.UTF-8", **self.fonts})
        return ink_of(path)

    def test_labels_look_as_pango_draws_them(self):
        found = {}
        for script, text in TEXTS.items():
            told, ink = self.render(text)
            self.assertNotIn("font", told, script)
            found[script] = round(correlation(ink, self.pango(text)), 3)
        self.assertGreater(min(found.values()), LEAST_CORRELATION, found)

    def test_another_order_and_other_forms_of_letters_are_seen(self):
        for script in ("Latin", "Arabic", "Hebrew", "Devanagari"):
            _, ink = self.render(TEXTS[script])
            backwards = TEXTS[script][::-1]
            self.assertLess(correlation(ink, self.pango(backwards)), MOST_OF_ANOTHER, script)
        for script in ("Arabic", "Devanagari"):
            _, ink = self.render(TEXTS[script])
            letter_by_letter = "\u200c".join(TEXTS[script])
            self.assertLess(correlation(ink, self.pango(letter_by_letter)), MOST_OF_ANOTHER, script)

    def test_a_letter_that_no_font_has_is_named_with_a_cure(self):
        told, ink = self.render("A\U0010fffdB")
        self.assertGreater(len(ink[0]), len(self.render("AB")[1][0]) + 5, "a mark stands for the letter")
        for text in ("U+10FFFD", "font", "install"):
            self.assertIn(text, told)
        self.assertNotIn("U+0041", told)
        self.use_fonts("DejaVu Sans")
        told, _ = self.render("北京")
        self.assertIn("U+5317", told)
        self.assertIn("U+4EAC", told)


if __name__ == "__main__":
    unittest.main()
