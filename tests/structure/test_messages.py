"""Messages of the libraries name settings as ‹field›; the program's table turns each into an option (engine/README.md)."""
import re
import unittest

from targets import SOURCE

TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*"')
# A command of GDAL, whose options are its own.
OTHERS = {'gdal_advice.cpp'}


def texts():
    for folder in ('engine', 'streaming'):
        for path in sorted((SOURCE / folder).rglob('*')):
            if path.suffix in ('.cpp', '.h', '.inl') and path.name not in OTHERS:
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    for text in TEXT.findall(line.split('//')[0] if line.lstrip().startswith('//') else line):
                        yield f'{path.relative_to(SOURCE)}:{number}', text


class Messages(unittest.TestCase):
    def test_libraries_name_no_option_and_no_command_of_the_program(self):
        named = re.compile(r'--[a-z]|\bterrella (?:bench|convert|cut|info|merge|preload|render|serve|view)\b')
        self.assertEqual([(place, text) for place, text in texts() if named.search(text)], [])

    def test_each_setting_that_a_message_names_has_an_option(self):
        table = set(re.findall(r'Row\{"(\w+)", "(?:--|terrella )[a-z -]+"\}', (SOURCE / 'apps/process/option_names.cpp').read_text()))
        named = {(place, field) for place, text in texts() for field in re.findall('‹(.*?)›', text)}
        self.assertGreater(len(named), 30)
        self.assertEqual({(place, field) for place, field in named if field not in table}, set())
        self.assertEqual(table - {field for _, field in named}, set(), 'no message names these')


if __name__ == '__main__':
    unittest.main()
