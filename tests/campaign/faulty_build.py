# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Builds and tests a copy of the commit with one fault at a time, for scripts/mutate."""
import collections
import concurrent.futures
import hashlib
import html
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time

FOLDERS = ("src/model/", "src/solve/", "src/record/", "src/sweep/")
ROOMS = ["model", "solve", "record", "sweep", "study", "scenario", "results"]
SLOWEST = 0.1  # the part of the cases that runs only if the others find nothing
ENDLESS = 30  # seconds of processor time, of a case or a golden run that is ended
WAITS = 600  # seconds on the clock
PATIENCE = 120  # seconds on the clock, in which a program whose cases end it is started again


class Failure(Exception):
    """What the user must repair."""


def command(*words, **options):
    return subprocess.run(words, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def processor_seconds(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def run_once(program, names, folder):
    """Runs test cases until one ends the program: of each that began, whether it passed, and its seconds."""
    escaped = [re.sub(r"([\\,\[\]])", r"\\\1", name) for name in names]  # as Catch2 wants them
    (folder / "names").write_text("\n".join(escaped) + "\n", encoding="utf-8")
    report, begun, since, used = folder / "report.xml", 0, time.monotonic(), 0
    with open(report, "wb") as out:
        process = subprocess.Popen([program, "-r", "xml", "-d", "yes", "-f", "names"], cwd=folder, stdout=out,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
    while process.poll() is None:
        time.sleep(0.1)
        count = report.read_bytes().count(b"<TestCase ")
        if count != begun:
            begun, since, used = count, time.monotonic(), processor_seconds(process)
        elif processor_seconds(process) - used > ENDLESS or time.monotonic() - since > WAITS:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    results = {}
    for part in report.read_text(encoding="utf-8", errors="replace").split("<TestCase ")[1:]:
        name = html.unescape(re.match(r'name="([^"]*)"', part)[1])
        end = re.search(r'<OverallResult success="(\w+)" durationInSeconds="([^"]*)"', part)
        results[name] = (end[1] == "true", float(end[2])) if end else (False, ENDLESS)
    return results


class Copy:
    """A copy of the commit, in build/mutate, with a build that counts lines and one that tests."""

    def __init__(self, root, jobs):
        self.jobs = jobs
        self.work = root / "build/mutate"
        self.tree, self.coverage, self.tests = self.work / "tree", self.work / "coverage", self.work / "tests"
        self.bbsim = self.tests / "bin/bbsim"
        self.programs = {room: self.tests / "tests" / f"test_{room}" for room in ROOMS}
        self.sound, self.rounds = None, None
        self.commit = command("git", "-C", root, "rev-parse", "--short=9", "HEAD").strip()
        if not self.tree.exists():
            command("git", "-C", root, "worktree", "prune")
            command("git", "-C", root, "worktree", "add", "--detach", self.tree, self.commit)
            if (root / ".deps").exists():
                (self.tree / ".deps").symlink_to(root / ".deps")
        # Files that are right stay as they are, so they are not compiled again.
        command("git", "-C", self.tree, "checkout", "--quiet", "--force", "--detach", self.commit)

    def build(self, folder, targets, *options):
        """Configures a build of the copy, if it is new, and builds the targets. Returns whether this succeeds."""
        if not (folder / "build.ninja").exists():
            if shutil.which("ccache"):
                options += ("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache",)
            command("cmake", "-G", "Ninja", "-S", self.tree, "-B", folder, "-DBBSIM_BASELINE_ONLY=ON",
                    "-DBBSIM_PYTHON_PACKAGE=OFF", *options)
        with open(f"{folder}.log", "w", encoding="utf-8") as log:  # without git, no program holds the commit
            return subprocess.run(["ninja", "-C", folder, f"-j{self.jobs}", *targets], stdout=log, stderr=log,
                                  env={**os.environ, "GIT_DIR": "/nowhere"}).returncode == 0

    def build_tests(self):
        return self.build(self.tests, ["bbsim", *(f"test_{room}" for room in ROOMS)],
                          "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG")

    def executed_lines(self):
        """The lines of each file that runs of configs/ and a small sweep execute; kept until these or src change."""
        kept = self.work / "executed.json"
        state = command("git", "-C", self.tree, "rev-parse", "HEAD:src", "HEAD:configs")
        if kept.exists() and json.loads(kept.read_text())["state"] == state:
            return json.loads(kept.read_text())["lines"]
        print("making a build that counts lines", flush=True)
        if not self.build(self.coverage, ["bbsim"], "-DBBSIM_TESTS=OFF", "-DCMAKE_BUILD_TYPE=Debug",
                          "-DCMAKE_CXX_FLAGS_DEBUG=--coverage -O0 -g0"):
            raise Failure(f"the build that counts lines fails: {self.coverage}.log")
        for counts in self.coverage.rglob("*.gcda"):
            counts.unlink()
        runs = [["run", path, "--summary", "summary.json"] for path in sorted((self.tree / "configs").glob("*.yaml"))]
        runs.append(["sweep", self.tree / "configs/fig2b.yaml", "--vary", "controller.pd.kv.0.0=linear:0.5:1.5:9"])
        with tempfile.TemporaryDirectory() as folder:
            for run in runs:  # some end early, as they should
                subprocess.run([self.coverage / "bin/bbsim", *run, "-q", "-o", "out.csv", "--set", "time.end=3"],
                               cwd=folder, stderr=subprocess.DEVNULL)
        lines = {}
        for counts in self.coverage.rglob("*.gcda"):
            for report in command("gcov", "--json-format", "--stdout", counts, cwd=self.coverage).splitlines():
                for source in json.loads(report)["files"]:
                    file = os.path.relpath(os.path.realpath(self.coverage / source["file"]), self.tree)
                    if file.startswith(FOLDERS):
                        executed = {line["line_number"] for line in source["lines"] if line["count"]}
                        lines.setdefault(file, set()).update(executed)
        lines = {file: sorted(numbers) for file, numbers in sorted(lines.items())}
        kept.write_text(json.dumps({"state": state, "lines": lines}))
        return lines

    def run_cases(self, room, names):
        """Runs test cases of a room, or golden tests: of each, whether it passed, and its seconds."""
        results = {}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for name in names if room == "golden" else []:
                words = ["prlimit", f"--cpu={ENDLESS}", "timeout", f"{WAITS}", "cmake", f"-DBBSIM={self.bbsim}",
                         f"-DSCENARIO={self.tree}/configs/{name}.yaml", f"-DGOLDEN={self.tree}/tests/golden/{name}.csv",
                         "-P", self.tree / "tests/golden/compare.cmake"]
                results[name] = (subprocess.run(words, cwd=folder, capture_output=True).returncode == 0, 0)
            began, left = time.monotonic(), [name for name in names if name not in results]
            while left and time.monotonic() - began < PATIENCE:
                now = run_once(self.programs[room], left, folder)
                results.update(now)
                left = [name for name in left if name not in now] if now else []
        if any(name not in results for name in names):
            results["(program)"] = (False, 0)  # the cases that were not reached have no result
        return results

    def hashes(self):
        programs = {**self.programs, "golden": self.bbsim}
        return {room: hashlib.sha256(path.read_bytes()).hexdigest() for room, path in programs.items()}

    def know_cases(self):
        """Builds the copy without a fault, and finds the test cases that pass, and their seconds."""
        if not self.build_tests():
            raise Failure(f"the build fails without a fault: {self.tests}.log")
        kept, self.sound = self.work / "cases.json", self.hashes()
        if not kept.exists() or json.loads(kept.read_text())["programs"] != self.sound:
            print("running the tests without a fault", flush=True)
            cases = {"golden": [path.stem for path in sorted((self.tree / "tests/golden").glob("*.csv"))]}
            for room, program in self.programs.items():
                words = [program, "--list-test-names-only", "~[slow]~[.]"]  # the exit code is their number
                cases[room] = subprocess.run(words, text=True, capture_output=True).stdout.splitlines()
            for room, names in cases.items():
                results = self.run_cases(room, names)
                for name in results:
                    if not results[name][0]:
                        print(f"left out, since it fails without a fault: {room}: {name}", flush=True)
                cases[room] = {name: results[name][1] for name in names if name in results and results[name][0]}
            kept.write_text(json.dumps({"programs": self.sound, "cases": cases}))
        cases = json.loads(kept.read_text())["cases"]
        seconds = sorted(seconds for names in cases.values() for seconds in names.values())
        longest = seconds[int((1 - SLOWEST) * len(seconds))]
        self.rounds = [{room: [name for name in names if (names[name] > longest) == is_slow]
                        for room, names in cases.items()} for is_slow in (False, True)]

    def objects(self):
        """How many object files each source goes into."""
        counts = collections.Counter()
        for line in command("ninja", "-C", self.tests, "-t", "deps").splitlines():
            if line.startswith("    "):
                counts[os.path.relpath(os.path.realpath(self.tests / line.strip()), self.tree)] += 1
        return counts

    def judge(self):
        """Builds the copy, and runs the tests: the outcome, and the names of the test cases that fail."""
        if not self.build_tests():
            return "not compiled", []
        changed = [room for room, content in self.hashes().items() if content != self.sound[room]]
        if not changed:
            return "same code", []
        for cases in self.rounds:
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                results = pool.map(lambda room: (room, self.run_cases(room, cases[room])), changed)
            by = [f"{room}: {name}" for room, tried in results for name, (passed, _) in tried.items() if not passed]
            if by:
                return "found", by
        return "survived", []

    def try_fault(self, file, number, before, after):
        """Puts the fault in, judges it, and takes it out."""
        path = self.tree / file
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        lines[number - 1] = after
        try:
            path.write_text("\n".join(lines), encoding="utf-8")
            return self.judge()
        finally:
            path.write_text(text, encoding="utf-8")
