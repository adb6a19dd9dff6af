# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: bundle.py ENGINE.js ENGINE.wasm OUTPUT.html

Writes the part of a live page that has the engine: the script that loads it, and the module, compressed, in base 85,
which is shorter than base64, without the characters of markup. src/replay/page/engine.js reads both by their ids.
"""

import base64
import gzip
import shutil
import subprocess
import sys

SAFE = str.maketrans("<>&", ",./")
loader, module, output = sys.argv[1:]
with open(loader, encoding="utf-8") as file:
    script = file.read()
if "</script" in script or "<!--" in script:
    sys.exit(f"{loader}: would end its element of the page")
if shutil.which("zopfli"):  # a twentieth smaller
    compressed = subprocess.run(["zopfli", "-c", "--i5", module], stdout=subprocess.PIPE, check=True).stdout
else:
    with open(module, "rb") as file:
        compressed = gzip.compress(file.read(), 9, mtime=0)
packed = base64.b85encode(compressed).decode().translate(SAFE)
with open(output, "w", encoding="utf-8") as file:
    file.write(f'<script type="text/plain" id="bbsim-engine-loader">{script}</script>\n'
               f'<script type="text/plain" id="bbsim-engine">{packed}</script>\n')
