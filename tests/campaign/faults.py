# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws small faults in C++ sources, for scripts/mutate.

The rules read one formatted line at a time: operators have spaces around them, brackets of templates do not.
"""
import itertools
import random
import re

OTHERS = {"<": ["<=", ">"], "<=": ["<", ">="], ">": [">=", "<"], ">=": [">", "<="], "==": ["!="], "!=": ["=="]}


def closing(code, start):
    """Where the bracket that opens at start closes, and where the commas between its parts are."""
    depth, commas = 0, []
    for place in range(start, len(code)):
        depth += (code[place] in "([{") - (code[place] in ")]}")
        if depth == 0:
            return place, commas
        if depth == 1 and code[place] == ",":
            commas.append(place)
    return None, commas


def faults_of(line):
    """Yields the faults that one line of formatted C++ can have: kind, first and last place, text."""
    blank = lambda found: ("_" if found[0][0] in "\"'" else " ") * len(found[0])
    code = re.sub(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|//.*', blank, line).rstrip()
    for found in re.finditer(r"(?<=[\w)\]] )([+-])(=?)(?= |$)", code):
        yield "sign", *found.span(1), "-" if found[1] == "+" else "+"
        term = re.match(r" (?:[^-+,;?:()\[\]{}<>=!&|]|->|::|\((?:[^()]|\([^()]*\))*\)|\[[^\[\]]*\])+"
                        r"(?=[,;?:)\]}]| (?:[-+<>?:]|[<>=!]=|&&|\|\|)(?: |$))", code[found.end():])
        if term and not found[2]:
            yield "term", found.start() - 1, found.end() + len(term[0].rstrip()), ""
    for found in re.finditer(r"(?<=[=(,?:\[{] )-(?=[\w(])|(?<=[(\[{])-(?=[\w(])|(?<=return )-(?=[\w(])", code):
        yield "sign", *found.span(), ""
    found = re.match(r"\s*[\w.\[\]>()-]+ [-+*]= [^;]*;$", code)
    if found:
        yield "term", len(code) - len(code.lstrip()), len(code), ";"
    for found in re.finditer(r"(?<= )([<>]=?|[=!]=)(?= |$)", code):
        for other in OTHERS[found[1]]:
            yield "comparison", *found.span(1), other
    declares = re.match(r"\s*(?!return)[\w:<>,& ]+ \w+\[", code)
    for found in re.finditer(r"(?<=[\w)\]])\[([^\[\]&=_]+)\]", code):
        if not declares:
            for other in ([" + 1"] if found[1] == "0" else [" + 1", " - 1"]):
                yield "index", found.end(1), found.end(1), other
    for found in re.finditer(r"for \([\w:]+ \w+ = (0);", code):
        yield "index", *found.span(1), "1"
    for found in re.finditer(r"(\w+)\(", code):
        end, commas = closing(code, found.end() - 1)
        if end is None or found[1] in ("min", "max", "hypot", "abs", "for", "if", "while"):
            continue
        edges = [found.end() - 1, *commas, end]
        for a, b, c in zip(edges, edges[1:], edges[2:]):
            first, second = line[a + 1:b].strip(), line[b + 1:c].strip()
            if first != second and not re.search(r"\w[>&*]* \w", first + ", " + second):
                yield "arguments", a + 1, c, (" " if line[a + 1] == " " else "") + f"{second}, {first}"
    for found in re.finditer(r"\bif \(", code):
        end, _ = closing(code, found.end() - 1)
        if end and not re.search(r";|[^=!<>]=[^=]", code[found.end():end]):
            yield "condition", found.end(), end, "true"


def draw(root, executed, seed):
    """All faults on the executed lines of files below root, in random order, the kinds in turn."""
    kinds = {}
    for file in sorted(executed):
        lines = (root / file).read_text(encoding="utf-8").split("\n")
        for number in executed[file]:
            line = lines[number - 1]
            for kind, start, end, text in faults_of(line):
                kinds.setdefault(kind, []).append((kind, file, number, line, line[:start] + text + line[end:]))
    generator = random.Random(seed)
    for kind in sorted(kinds):
        generator.shuffle(kinds[kind])
    print("faults to choose from:", ", ".join(f"{len(kinds[kind])} {kind}" for kind in sorted(kinds)))
    turns = itertools.zip_longest(*(kinds[kind] for kind in sorted(kinds)))
    return [fault for turn in turns for fault in turn if fault]
