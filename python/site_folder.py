# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the folder below a prefix where this Python looks for packages: site_folder.py PREFIX."""

import os
import sys
import sysconfig

prefix = sys.argv[1]
for folder in sys.path:
    below = os.path.relpath(folder, prefix)
    if below.startswith("lib") and os.path.basename(below) in ("dist-packages", "site-packages"):
        print(below)
        break
else:
    variables = {"base": prefix, "platbase": prefix}
    print(os.path.relpath(sysconfig.get_path("platlib", "posix_prefix", variables), prefix))
