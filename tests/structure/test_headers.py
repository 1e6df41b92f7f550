"""An application gets the public headers and no others, and each says which thread may use what."""
import re
import unittest

import targets
from targets import BUILD, SOURCE

# A program of the tree that links Terrella::terrella as an application outside does.
APPLICATION = 'example_ten_lines'


def public_headers():
    return (BUILD / 'tests/structure/public_headers.txt').read_text().split(';')


def declarations(text):
    """The declarations of a header, each with its comment: what stands between empty lines outside of braces."""
    lines = text.split('namespace terrella {\n', 1)[-1].splitlines()
    depth, block = 0, []
    for line in lines:
        code = line.split('//')[0]
        depth += code.count('{') - code.count('}')
        if line.strip() or depth > 0:
            block.append(line)
        elif block:
            yield '\n'.join(block)
            block = []
    yield '\n'.join(block)


def has_functions(declaration):
    for line in declaration.splitlines():
        code = re.sub(r'operator==\(.*= default;', '', line.split('//')[0]).split(' = ')[0]
        if re.search(r'(?<![<\w])[\w=+*-]+\(', code):
            return True
    return False


class Headers(unittest.TestCase):
    def test_application_finds_public_headers_only(self):
        known = targets.Targets()
        public = {str(SOURCE / header) for header in public_headers()}
        text = ''
        for name in known.names():
            for header, path in known.headers(name):
                installed = targets.installed(header)
                for spelt in (f'<terrella/{installed}>', f'"{header}"', f'"{installed}"'):
                    if str(path) not in public:
                        text += f'#if __has_include({spelt})\n#error {spelt}\n#endif\n'
                if str(path) in public:
                    text += f'#if !__has_include(<terrella/{installed}>)\n#error {installed}\n#endif\n'
        self.assertGreater(text.count('#error'), 300)
        good, message = known.compile(APPLICATION, text, '-fsyntax-only')
        self.assertTrue(good, message)

    def test_public_headers_do_not_name_settings_of_experiments(self):
        text = (SOURCE / 'engine/globe/experiments.h').read_text()
        settings = set(re.findall(r'^  (?:double|bool|CubeMapping|std::\S+) (\w+)(?: =|\{)', text, re.MULTILINE))
        self.assertGreaterEqual(settings, {'paper_a', 'paper_band', 'naive_translucency', 'patch_shuffle', 'mapping'})
        naming = [f'{header}: {name}' for header in public_headers() for name in settings
                  if re.search(rf'\b(?:set_)?{name}\b', re.sub('//.*', '', (SOURCE / header).read_text()))]
        self.assertEqual(naming, [])

    def test_page_of_the_library_names_headers_that_are_installed(self):
        table = (SOURCE / 'engine/README.md').read_text().split('| header `<terrella/…>` |')[1].split('\n\n')[0]
        named = set(re.findall(r'`([\w/]+\.h)`', table))
        self.assertGreater(len(named), 10)
        self.assertEqual(named - {targets.installed(header.removeprefix('engine/')) for header in public_headers()}, set())

    def test_public_headers_name_what_is_installed(self):
        """Headers that a comment names are public too. Documents are installed if they are there (tests/package)."""
        public = {targets.installed(header.removeprefix('engine/')) for header in public_headers()}
        wrong = []
        for header in public_headers():
            for line in (SOURCE / header).read_text().splitlines():
                for named in re.findall(r'[\w/]+\.(?:h|cpp|glsl|md)\b', '' if line.startswith('#include') else line):
                    there = named in public or (named.endswith('.md') and (SOURCE / named).exists())
                    wrong += [] if there else [f'{header}: {named}']
        self.assertEqual(wrong, [])

    def test_each_stated_range_has_a_row_in_the_contract_of_ranges(self):
        """A value of the Globe API with a range in its comment is tried at its ends and beyond (ranges_test.cpp)."""
        tests = (SOURCE / 'tests/facade' / name for name in
                 ('ranges.h', 'ranges_test.cpp', 'object_ranges_test.cpp', 'streaming_ranges_test.cpp'))
        rows = set(re.findall(r'\{"(?:\w+ )?(\w+)",', ''.join(path.read_text() for path in tests)))
        engine = ['geo/camera.h', 'geo/coordinates.h', 'geo/objects.h', 'geo/object_edits.h', 'globe/globe_options.h',
                  'surface/layers.h', 'tiles/tile_grid.h', 'view/render_modes.h']
        headers = [f'engine/{header}' for header in engine] + ['streaming/cut.h', 'streaming/cache/tile_cache.h']
        texts = [(SOURCE / header).read_text() for header in headers]
        enums = '|'.join(set(re.findall(r'^enum class (\w+) {', ''.join(texts), re.MULTILINE)))
        stated = set()
        for text in texts:
            stated |= set(re.findall(rf'^  (?:std::optional<)?(?:{enums})>? (\w+)(?: = .*|{{.*)?;', text, re.MULTILINE))
            lines = text.splitlines()
            for k, line in enumerate(lines):
                if not re.search(r'//.*([\[(]-?[\w.]+°?, [\w.]+°?( \w+)?[\])]|[Pp]ositive|not negative|> 0|less than)', line):
                    continue
                code = next(line for line in lines[k:] if line.split('//')[0].strip())
                member = re.match(r'  [\w:<>, ]+?[ &](\w+)(?: = .*|\{.*)?(?:;|,)', code)
                if member and not member[1].startswith('k'):
                    stated.add(member[1])
        self.assertGreaterEqual(stated, {'polar_columns', 'workers', 'fov_y', 'lat', 'opacity', 'tile_px', 'scale', 'indices', 'quality', 'blend'})
        self.assertEqual(stated - rows, set())

    def test_each_declaration_says_which_thread_may_use_it(self):
        silent = []
        for header in public_headers():
            text = (SOURCE / header).read_text()
            if re.search(r'^// thread: any, for all of this header$', text, re.MULTILINE):
                continue
            for declaration in declarations(text):
                is_value = re.search(r'^struct ', declaration, re.MULTILINE)  # belongs to who has it
                if has_functions(declaration) and not is_value and 'thread:' not in declaration:
                    silent.append(f'{header}: {declaration.splitlines()[0]}')
        self.assertEqual(silent, [])


if __name__ == '__main__':
    unittest.main()
