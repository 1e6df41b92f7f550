"""Comments name the thing first, and state requirements themselves (CONTRIBUTING.md, "Rules")."""
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ['TERRELLA_SOURCE'])
FOLDERS = ('apps', 'data', 'engine', 'shaders', 'streaming', 'tests')
SLASHES = ('.h', '.cpp', '.frag', '.glsl', '.vert')
HASHES = ('.py', '.cmake', 'CMakeLists.txt')
# No name follows these words, so a reader of the opening cannot know the thing.
OPENING = re.compile(r'(of|whether|where|what|whom|who|how|that|which|nor|such|so|it|they|why|whose)\b', re.IGNORECASE)


def comments(path):
    """Each line of comment in a file: its number, its text, and true if it opens a comment."""
    first, other = ('//', '//') if path.name.endswith(SLASHES) else ('#', '"""')
    follows = False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if first not in line and other not in line:
            follows = False
            continue
        code, mark, text = line.partition(first if first in line else other)
        stands_alone = not code.strip()
        if stands_alone or code.endswith(' '):
            yield number, text.lstrip('/< '), not (follows and stands_alone)
        follows = stands_alone and mark == first


def files():
    for folder in FOLDERS:
        for path in sorted((SOURCE / folder).rglob('*')):
            if path.name.endswith(SLASHES + HASHES):
                yield path


class Comments(unittest.TestCase):
    def test_wording(self):
        wrong, lines = [], 0
        for path in files():
            for number, text, opens in comments(path):
                lines += 1
                place = f'{path.relative_to(SOURCE)}:{number}'
                if opens and OPENING.match(text):
                    wrong.append(f'{place}: name the thing first, then say what it does: {text}')
                if re.search(r'\bissues?\b', text, re.IGNORECASE):
                    wrong.append(f'{place}: state the requirement itself: {text}')
        self.assertGreater(lines, 5000)
        if wrong:
            self.fail('\n' + '\n'.join(wrong))


if __name__ == '__main__':
    unittest.main()
