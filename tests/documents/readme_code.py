"""Compiles the C++ blocks of each document as one program: readme_code.py DOCUMENT… -- COMPILER [OPTION…]"""

import pathlib
import re
import subprocess
import sys

border = sys.argv.index("--")
documents, compiler = sys.argv[1:border], sys.argv[border + 1 :]
for document in documents:
    blocks = re.findall(r"^```cpp\n(.*?)^```$", pathlib.Path(document).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    if not blocks:
        sys.exit(f"{document}: no block of C++ in it")
    subprocess.run([*compiler, "-fsyntax-only", "-x", "c++", "-"], input="\n".join(blocks), text=True, check=True)
