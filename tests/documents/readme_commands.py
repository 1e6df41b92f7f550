"""Checks that the program has every option in the documents' command lines: readme_commands.py PROGRAM DOCUMENT…"""

import functools
import pathlib
import re
import subprocess
import sys

program, *documents = sys.argv[1:]


@functools.cache
def options(subcommand):
    done = subprocess.run([program, *subcommand, "--help"], capture_output=True, text=True, check=True)
    return set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", done.stdout))


def command_lines(text):
    """The subcommand and the rest of each line `terrella SUBCOMMAND …` of a block that is indented."""
    for line in re.findall(r"^    (?:.* )?(?:build/)?terrella ((?:view|render|cut|preload|info|merge|convert|serve|bench)\b.*)$", text, re.MULTILINE):
        subcommand, *words = line.replace("'", " ").split()
        yield ((subcommand, words[0]) if subcommand == "bench" and words and words[0].isalpha() else (subcommand,)), words


count, wrong = 0, []
for document in documents:
    for subcommand, words in command_lines(pathlib.Path(document).read_text(encoding="utf-8")):
        count += 1
        for word in words:
            name = word.split("=")[0]
            if re.fullmatch(r"--?[A-Za-z][\w-]*", name) and name not in options(subcommand):
                wrong.append(f"{document}: terrella {' '.join(subcommand)} has no {name}")
if wrong or not count:
    sys.exit("\n".join(wrong) or "no command lines in the documents")
print(f"{count} command lines")
