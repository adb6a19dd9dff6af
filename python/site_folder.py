# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the folder below a prefix where this Python looks for packages: site_folder.py PREFIX."""

import os
import sys
import sysconfig

prefix = sys.argv[1]
for folder in sys.path:
    if folder.startswith(prefix + os.sep) and os.path.basename(folder) in ("dist-packages", "site-packages"):
        print(os.path.relpath(folder, prefix))
        break
else:
    variables = {"base": prefix, "platbase": prefix}
    print(os.path.relpath(sysconfig.get_path("platlib", "posix_prefix", variables), prefix))
