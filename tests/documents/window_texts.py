"""Prints every text of the window, so that all can be read in one go, and checks their plain standard:
window_texts.py FOLDER

The texts are the string literals of the window's sources, without names of files, formats and settings.
"""

import pathlib
import re
import sys

MOST_WORDS = 25  # in a sentence
BANNED = r"\b(lack\w*|whilst|utili[sz]e\w*|please|sorry|oops|invalid|leave off|successfully|in order to)\b"
NO_TEXT = re.compile(
    r"^(##.*|[a-z]+_[a-z_]+|[\W\d]*|\.?[\w./-]*\.(json|png|ttf|h|frag|vert)|/usr/.*|XDG_\w+|\.\w+(/\w+)?|%[.\w* ]*\w*|"
    r"\\\"\w*|#version.*|\w+://.*|wbe?)$"
)


def literals(source):
    """The string literals of a source, those that follow each other joined, without includes and comments."""
    source = re.sub(r"//[^\n]*|^#include.*$", "", source, flags=re.MULTILINE)
    for joined in re.findall(r'(?<![\w\'])((?:u8|U|L)?"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*)', source):
        if not joined.startswith("U"):
            yield "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', joined))


def faults(text):
    if re.search(BANNED, text, re.IGNORECASE):
        yield "a word of no plain English"
    if "  " in text.strip() and "   " not in text and not re.match(r"^\S+(  \S+)+", text):
        yield "two blanks"
    if re.search(r"!|\.\.\.$|;$|,$", text) and text != "...":
        yield "its end"
    if any(len(sentence.split()) > MOST_WORDS for sentence in re.split(r"[.:;]\s|\\n", text)):
        yield f"a sentence of more than {MOST_WORDS} words"
    if re.search(r"\b1 tiles\b|Sun, Moon and stars at a time|by itself", text):
        yield "an old word"


def main(folder):
    wrong, count = [], 0
    for file in sorted(pathlib.Path(folder).rglob("*.cpp")):
        texts = [t for t in dict.fromkeys(literals(file.read_text(encoding="utf-8"))) if not NO_TEXT.match(t)]
        if texts:
            print(f"\n{file.relative_to(folder)}")
        for text in texts:
            count += 1
            print(f"  {text}")
            wrong += [f"{file.name}: {fault}: {text}" for fault in faults(text)]
    print(f"\n{count} texts")
    if wrong or count < 150:
        sys.exit("\n".join(wrong) or "too few texts: the sources have moved")


main(sys.argv[1])
