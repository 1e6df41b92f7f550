"""The layers in engine/DESIGN.md are those of the targets, and an include that they forbid does not compile."""
import collections
import concurrent.futures
import json
import re
import subprocess
import unittest

import targets
from targets import BUILD, SOURCE

# A folder with more source files is searched, not read.
MOST_FILES = 36
ENDINGS = {'.h', '.cpp', '.inl', '.glsl', '.vert', '.frag'}


def short(name):
    return name.removeprefix('terrella_')


def section():
    return (SOURCE / 'engine/DESIGN.md').read_text().split('\n## Layers\n')[1].split('\n## ')[0]


class Documents(unittest.TestCase):
    def setUp(self):
        self.targets = targets.Targets()
        self.names = {short(name) for name in self.targets.names()}

    def reach(self, name):
        return {short(one) for one in self.targets.may_include('terrella_' + name)}

    def test_table_says_what_each_library_may_include(self):
        rows = re.findall(r'^\| `(\w+)` \|[^|]*\|([^|]*)\|$', section(), re.MULTILINE)
        table = {name: set(re.findall(r'\w+', may)) - {'nothing'} for name, may in rows}
        self.assertEqual(table, {name: self.reach(name) for name in self.names})

    def test_drawing_has_each_library_above_all_that_it_may_include(self):
        drawing = re.search(r'```text\n(.*?)```', section(), re.DOTALL)[1]
        rows = [re.findall(r'\w+', line) for line in drawing.splitlines()]
        place = {name: i for i, row in enumerate(rows) for name in row}
        self.assertEqual(sorted(name for row in rows for name in row), sorted(self.names))
        wrong = [(name, other) for name in self.names for other in self.reach(name) if place[other] <= place[name]]
        self.assertEqual(wrong, [])

    def test_where_to_find_it_names_functions_and_files_that_are_there(self):
        table = (SOURCE / 'engine/DESIGN.md').read_text().split('\n## Where to find it\n')[1].split('\n## ')[0]
        rows = re.findall(r'^\| [^|]*\?[^|]* \| (.*) \|$', table, re.MULTILINE)
        self.assertGreater(len(rows), 10)
        for row in rows:
            names = re.findall(r'`([^`]+)`', row)
            files = [SOURCE / name for name in names if '/' in name]
            self.assertTrue(files, row)
            files += [files[0].parent / name for name in names if '/' not in name and '()' not in name]
            text = ''.join(path.read_text() for path in files)
            for function in (name for name in names if name.endswith('()')):
                self.assertTrue(re.search(rf'\b{re.escape(function[:-2].split("::")[-1])}\(', text), row)


class Includes(unittest.TestCase):
    def setUp(self):
        self.targets = targets.Targets()
        self.pool = concurrent.futures.ThreadPoolExecutor(2)
        self.addCleanup(self.pool.shutdown)

    def sample(self, name):
        """The smallest header of a target."""
        return min(self.targets.headers(name), key=lambda header: header[1].stat().st_size)[0]

    def test_forbidden_include_does_not_compile(self):
        libraries = [name for name in self.targets.names() if self.targets.roots[name]]
        tries = {}
        for name in self.targets.names():
            for other in libraries:
                if other != name and other not in self.targets.may_include(name):
                    header = self.sample(other)
                    tries[name, header] = self.pool.submit(self.targets.compile, name, f'#include "{header}"\n',
                                                           '-fsyntax-only')
        self.assertGreater(len(tries), 100)
        for (name, header), result in tries.items():
            good, message = result.result()
            self.assertFalse(good, f'a source of {name} can include {header}')
            self.assertRegex(message, f'fatal error: .*{re.escape(header)}', name)

    def test_allowed_include_compiles(self):
        tries = {}
        for name in self.targets.names():
            allowed = [other for other in self.targets.may_include(name) | {name} if self.targets.roots[other]]
            text = ''.join(f'#include "{self.sample(other)}"\n' for other in sorted(allowed))
            tries[name] = self.pool.submit(self.targets.compile, name, text, '-E', '-o', '/dev/null')
        for name, result in tries.items():
            good, message = result.result()
            self.assertTrue(good, f'{name}: {message}')

    def test_no_header_of_a_forbidden_library_is_found(self):
        for name in self.targets.names():
            allowed = self.targets.may_include(name) | {name}
            text = ''
            for other in self.targets.names():
                for header, _ in self.targets.headers(other):
                    wrong = '!' if other in allowed else ''
                    text += f'#if {wrong}__has_include("{header}")\n#error "{header}"\n#endif\n'
            good, message = self.targets.compile(name, text, '-fsyntax-only')
            self.assertTrue(good, f'{name}: {message}')

    def test_each_include_is_written_from_the_root_of_a_library_that_may_be_included(self):
        for name in self.targets.names():
            allowed = self.targets.may_include(name) | {name}
            for header, path in self.targets.headers(name):
                for source in {path, path.with_suffix('.cpp')}:
                    for include in targets.project_includes(source) if source.exists() else []:
                        self.assertIn(self.targets.owner(include), allowed, f'{source} includes "{include}"')

    def test_engine_includes_no_streaming(self):
        for path in (SOURCE / 'engine').rglob('*'):
            if path.suffix in ENDINGS:
                for include in targets.project_includes(path):
                    self.assertFalse(include.startswith('streaming/'), path)


class Folders(unittest.TestCase):
    def test_folders_of_apps_include_those_that_the_design_says(self):
        rows = re.findall(r'^\| `apps/(\w+)` \|([^|]*)\|$', section(), re.MULTILINE)
        table = {folder: set(re.findall(r'\w+', may)) - {'nothing'} for folder, may in rows}
        self.assertEqual(set(table), {'commands', 'film', 'flight', 'open_scene', 'preload', 'process', 'serve'})
        for folder, may in table.items():
            # A subcommand (cmd_*.cpp) is a source of a library above.
            sources = [path for path in (SOURCE / 'apps' / folder).rglob('*.*') if not path.name.startswith('cmd_')]
            found = {include.split('/')[1] for path in sources for include in targets.project_includes(path)
                     if include.startswith('apps/')}
            self.assertEqual(found - {folder}, may, folder)

    def test_no_folder_holds_too_many_files(self):
        count = collections.Counter(path.parent for folder in (*targets.FOLDERS, 'tests')
                                    for path in (SOURCE / folder).rglob('*') if path.suffix in ENDINGS)
        self.assertEqual({str(folder): n for folder, n in count.items() if n > MOST_FILES}, {})

    def test_names_of_tests_are_short_and_the_same_in_every_run(self):
        """A parameter that nothing prints is shown by its bytes, which are addresses in part."""
        def told(*command):
            return subprocess.run(command, cwd=BUILD, capture_output=True, text=True, check=True).stdout

        commands = [test['command'] for test in json.loads(told('ctest', '--show-only=json-v1'))['tests']]
        programs = {command[0] for command in commands if '--gtest_filter' in ' '.join(command)}
        names = [line for program in sorted(programs) for line in told(program, '--gtest_list_tests').splitlines()]
        self.assertGreater(len(names), 1000)
        self.assertEqual([name for name in names if len(name) > 160 or '...>' in name or re.search('[0-9]{2}-byte', name)], [])


if __name__ == '__main__':
    unittest.main()
