"""The targets of the project as CMake configured them: include roots, links, compiler options."""
import json
import os
import pathlib
import re
import shlex
import subprocess

SOURCE = pathlib.Path(os.environ['TERRELLA_SOURCE'])
BUILD = pathlib.Path(os.environ['TERRELLA_BUILD'])
FOLDERS = ('engine', 'streaming', 'apps', 'shaders')


def installed(header):
    """A header's name under include/terrella."""
    return 'globe.h' if header == 'globe/globe.h' else header


def _names(links):
    """The project's targets among links, those that are linked but not included from left out."""
    links = re.sub(r'\$<LINK_ONLY:[^>]*>', '', links)
    return set(re.findall(r'\bterrella(?:_\w+)?\b', links))


class Targets:
    def __init__(self):
        self.roots, self._links, self._passed_on = {}, {}, {}
        for line in (BUILD / 'tests/structure/targets.txt').read_text().splitlines():
            name, roots, links, passed_on = line.split('|')
            self._links[name], self._passed_on[name] = _names(links), _names(passed_on)
            if name != 'terrella':
                self.roots[name] = dict(root.split('=') for root in roots.split(';') if '=' in root)
        self._flags = self._read_flags()

    def names(self):
        return sorted(self.roots)

    def may_include(self, name):
        """The targets whose headers the sources of a target may include, itself left out."""
        found, following = set(), set(self._links[name])
        while following:
            one = following.pop()
            if one not in found:
                found.add(one)
                following |= self._passed_on[one]
        return found - {'terrella', name}

    def owner(self, include):
        """The target with the longest root that fits an include; none if it is not the project's."""
        fits = [(len(prefix), name) for name, roots in self.roots.items() for prefix in roots
                if include == prefix or include.startswith(prefix + '/')]
        return max(fits)[1] if fits else None

    def headers(self, name):
        """The headers of a target, as sources include them."""
        for prefix, folder in self.roots[name].items():
            folder = pathlib.Path(folder)
            files = [folder] if folder.is_file() else sorted(folder.rglob('*.h'))
            for path in files:
                include = prefix if path == folder else f'{prefix}/{path.relative_to(folder)}'
                if self.owner(include) == name:
                    yield include, path

    def compile(self, name, text, *options):
        """Compiles text as if it were a source of a target; what the compiler says, and whether that is an error."""
        command = [*self._flags[name], *options, '-x', 'c++', '-']
        done = subprocess.run(command, input=text, capture_output=True, text=True, cwd=BUILD)
        return done.returncode == 0, done.stderr

    @staticmethod
    def _read_flags():
        flags = {}
        for entry in json.loads((BUILD / 'compile_commands.json').read_text()):
            words = shlex.split(entry['command'])
            name = re.search(r'CMakeFiles/(\w+)\.dir/', entry['command'])
            if name and name[1] not in flags:
                compiler = next(word for word in words if 'ccache' not in word)
                kept = [word for word in words if re.match(r'-(I|D|std|f)', word)]
                for i, word in enumerate(words):
                    if word == '-isystem':
                        kept += words[i:i + 2]
                flags[name[1]] = [compiler, *kept]
        return flags


def project_includes(path):
    return re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)
