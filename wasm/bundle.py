# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: bundle.py ENGINE.js ENGINE.wasm OUTPUT.html

Writes the part of a live page that has the engine: the script that loads it, and the module, compressed, in base64.
src/replay/page/engine.js reads both by their ids.
"""

import base64
import gzip
import sys

loader, module, output = sys.argv[1:]
with open(loader, encoding="utf-8") as file:
    script = file.read()
if "</script" in script or "<!--" in script:
    sys.exit(f"{loader}: would end its element of the page")
with open(module, "rb") as file:
    packed = base64.b64encode(gzip.compress(file.read(), 9, mtime=0)).decode()
with open(output, "w", encoding="utf-8") as file:
    file.write(f'<script type="text/plain" id="bbsim-engine-loader">{script}</script>\n'
               f'<script type="text/plain" id="bbsim-engine">{packed}</script>\n')
