"""An application gets the public headers and no others, and each says which thread may use what."""
import re
import unittest

import targets
from targets import BUILD, SOURCE

# A program of the tree that links Terrella::terrella as an application outside does.
APPLICATION = 'example_ten_lines'


def public_headers():
    return (BUILD / 'tests/structure/public_headers.txt').read_text().split(';')


class Headers(unittest.TestCase):
    def test_application_finds_public_headers_only(self):
        known = targets.Targets()
        public = {str(SOURCE / header) for header in public_headers()}
        text = ''
        for name in known.names():
            for header, path in known.headers(name):
                installed = header.removeprefix('globe/')
                for spelt in (f'<terrella/{installed}>', f'"{header}"', f'"{installed}"'):
                    if str(path) not in public:
                        text += f'#if __has_include({spelt})\n#error {spelt}\n#endif\n'
                if str(path) in public:
                    text += f'#if !__has_include(<terrella/{installed}>)\n#error {installed}\n#endif\n'
        self.assertGreater(text.count('#error'), 300)
        good, message = known.compile(APPLICATION, text, '-fsyntax-only')
        self.assertTrue(good, message)


if __name__ == '__main__':
    unittest.main()
