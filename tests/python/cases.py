# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests of the package share. Needs BBSIM (the program) and BBSIM_SOURCE in the environment."""

import contextlib
import io
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import bbsim
from bbsim._command import main

PROGRAM, SOURCE = os.environ["BBSIM"], Path(os.environ["BBSIM_SOURCE"])
CONFIGS = SOURCE / "configs"


class Case(unittest.TestCase):
    """Runs in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        self.folder = Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return str(self.folder / name)

    def read(self, name):
        return (self.folder / name).read_text()

    def bbsim(self, *words, code=0, **options):
        """The program in a process."""
        made = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, errors="replace", **options)
        self.assertEqual(made.returncode, code, f"{words}: {made.stderr}")
        return made

    def command(self, *words, code=0):
        """A command of the package in this process: what it prints and says."""
        out, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
            self.assertEqual(main(words[0], list(map(str, words[1:]))), code, (words, said.getvalue()))
        return out.getvalue(), said.getvalue()

    def refuses(self, message, call, *words, key=None, **options):
        """`key`: what the first problem names."""
        with self.assertRaises(bbsim.InputError) as caught:
            call(*words, **options)
        self.assertIn(message, str(caught.exception))
        if key is not None:
            self.assertEqual(caught.exception.key, key)
        return caught.exception
