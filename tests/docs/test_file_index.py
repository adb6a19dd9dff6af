#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the list of files in docs/architecture.md with the first comments of the sources.

  test_file_index.py            exits 1 if the list differs, or if a source has no such comment
  test_file_index.py --write    writes the list
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "architecture.md"
BEGIN, END = "<!-- files: tests/docs/test_file_index.py --write -->\n", "<!-- end of files -->\n"
ENDINGS = [".hpp", ".h", ".cpp", ".js", ".py"]  # the first of a name's files that has a comment counts
FOLDERS = ["include", "src", "python", "apps"]
ROOMS = ["base", "simd", "file", "yaml", "scenario", "model", "sketch", "controller", "solve", "record", "study",
         "sweep", "fit", "tune", "design", "results", "plot", "replay", "api", "library"]


def comment_of(path):
    """The comment that stands before a file's first line of code, as one line; empty if there is none."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        found = re.search(r'^"""(.*?)"""', text, re.M | re.S)
        return " ".join(found.group(1).split("\n\n")[0].split()) if found else ""
    text = re.sub(r"(// SPDX.*\n|/\* SPDX.*\n|/\* SPDX.*\*/\n| \* SPDX.*\n)", "", text).lstrip()
    text = re.sub(r"^'use strict';\s*", "", text)
    if text.startswith("/*"):
        lines = re.split(r"\n\s*\*?", text[2:text.index("*/")])
    else:
        lines = []
        for line in text.split("\n"):
            if not line.startswith("//"):
                break
            lines.append(line[2:])
        # A comment on a declaration is none on the file.
        rest = text.split("\n")[len(lines):]
        if path.suffix != ".js" and rest and rest[0] and not rest[0].startswith("#"):
            return ""
    words = []
    for line in lines:
        if not line.strip() and words:
            break  # the first paragraph
        words += line.split()
    return " ".join(words)


def first_sentence(text):
    return re.split(r"(?<=[^ .])\.(?= [^a-z]|$)", text, maxsplit=1)[0].rstrip(":") + "."


def sources():
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in ENDINGS and "__pycache__" not in path.parts and not path.name.startswith("make_"):
                yield path


def place_of(path):
    parts = path.relative_to(ROOT).parts
    return "/".join(parts[1:-1] if parts[0] == "src" else parts[:-1]) + "/"


def order_of(place):
    room = place.split("/")[0]
    if room in ROOMS:
        return (ROOMS.index(room), place)
    return (len(ROOMS) + ["include", "python", "apps"].index(room), place)


def index():
    places, bare = {}, []
    for path in sources():
        places.setdefault(place_of(path), {}).setdefault(path.stem, []).append(path)
    text = ""
    for place in sorted(places, key=order_of):
        text += f"\n### {place}\n\n"
        for stem, paths in sorted(places[place].items()):
            paths.sort(key=lambda path: ENDINGS.index(path.suffix))
            comment = next(filter(None, map(comment_of, paths)), "")
            if not comment:
                bare.append(str(paths[0].relative_to(ROOT)))
            link = "../" + paths[0].relative_to(ROOT).as_posix()
            text += f"* [{stem}]({link}): {first_sentence(comment)}\n"
    return text, bare


def main():
    text, bare = index()
    if bare:
        sys.exit("without a comment that says what the file holds: " + ", ".join(bare))
    page = PAGE.read_text(encoding="utf-8")
    begin, end = page.index(BEGIN) + len(BEGIN), page.index(END)
    wanted = page[:begin] + text + "\n" + page[end:]
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(wanted, encoding="utf-8")
    elif wanted != page:
        sys.exit("docs/architecture.md: the list of files is old; run tests/docs/test_file_index.py --write")


main()
