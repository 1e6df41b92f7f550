"""Compiles every block of C++ in a document: readme_code.py DOCUMENT COMPILER [OPTION…]"""

import pathlib
import re
import subprocess
import sys

document, *compiler = sys.argv[1:]
blocks = re.findall(r"^```cpp\n(.*?)^```$", pathlib.Path(document).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
if not blocks:
    sys.exit(f"{document}: no block of C++ in it")
for block in blocks:
    subprocess.run([*compiler, "-fsyntax-only", "-x", "c++", "-"], input=block, text=True, check=True)
