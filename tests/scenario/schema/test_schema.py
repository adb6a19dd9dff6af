# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that bbsim and its JSON Schema agree: test_schema.py BBSIM CONFIGS REFUSED [CASES]

Both accept every scenario of the folder CONFIGS, and both refuse every scenario of the file REFUSED;
those under `program_alone` are the exceptions, which the schema accepts. The file CASES gets all of
them as JSON, for other readers of the schema (ajv.mjs).
"""
import copy
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import jsonschema
import yaml


class Core(yaml.SafeLoader):
    """Reads scalars as YAML 1.2 does: 1e-3 is a number, yes is a string."""


Core.yaml_implicit_resolvers = {}
for tag, pattern, first in (
    ("bool", r"true|false", "tf"),
    ("int", r"[-+]?[0-9]+", "-+0123456789"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789"),
    ("null", r"~|null|", ["~", "n", ""]),
):
    Core.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first))
Core.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))
Core.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def with_changes(scenario, changes):
    """The scenario with keys set, or removed if the value is null."""
    scenario = copy.deepcopy(scenario)
    for path, value in changes.items():
        *names, last = path.split(".")
        at = scenario
        for name in names:
            at = at.setdefault(name, {})
        if value is None:
            at.pop(last, None)
        else:
            at[last] = value
    return scenario


def main(program, configs, refused, cases_file=None):
    schema = json.loads(subprocess.run([program, "--schema"], capture_output=True, check=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    wrong = []
    cases = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for table in pathlib.Path(configs).glob("*.csv"):
            shutil.copy(table, folder)

        def program_refuses(scenario):
            # JSON is valid YAML.
            (folder / "scenario.yaml").write_text(json.dumps(scenario))
            checked = subprocess.run([program, "check", str(folder / "scenario.yaml")], capture_output=True)
            if checked.returncode not in (0, 1, 2):
                wrong.append(f"{scenario}: bbsim check ends with {checked.returncode}")
            return checked.returncode == 2

        shipped = {}
        for path in sorted(pathlib.Path(configs).rglob("*.yaml")):
            scenario = yaml.load(path.read_text(), Core)
            shipped[path.stem] = scenario
            cases.append({"name": str(path), "kind": "shipped", "scenario": scenario})
            for error in validator.iter_errors(scenario):
                wrong.append(f"the schema refuses {path}: {error.json_path}: {error.message[:300]}")
        lists = yaml.load(pathlib.Path(refused).read_text(), Core)
        for kind, schema_too in (("both", True), ("program_alone", False)):
            for base, changes, *_ in lists[kind]:
                scenario = with_changes(shipped[base], changes)
                cases.append({"name": f"{base} with {changes}", "kind": kind, "scenario": scenario})
                if not program_refuses(scenario):
                    wrong.append(f"bbsim accepts {base} with {changes}")
                if validator.is_valid(scenario) == schema_too:
                    wrong.append(f"the schema {'accepts' if schema_too else 'refuses'} {base} with {changes}")
    if cases_file:
        pathlib.Path(cases_file).write_text(json.dumps(cases))
    print("\n".join(wrong))
    counts = f"{len(shipped)} accepted, {len(lists['both'])} refused by both, "
    print(counts + f"{len(lists['program_alone'])} by the program alone")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
