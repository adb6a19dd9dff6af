#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""examples/recorder/record.py on pseudo terminals that play a designed motion; BBSIM names the program."""
import csv
import json
import math
import os
import pathlib
import pty
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tty
import unittest

source = pathlib.Path(__file__).resolve().parents[2]
recorder = source / "examples" / "recorder"
sys.path.insert(0, str(recorder))
import sketch_log  # noqa: E402

bbsim = os.environ["BBSIM"]
HEADER = "t_ms,phi_deg,theta_deg,x_mm,y_mm"
TRUTH = {"ball.inertia_factor": 0.5, "gimbal.motion.phi.table.scale": 1.06}
RIG = """
ball: {radius: 2 cm, position: [-4 cm, -5 cm]}
plate: {size: [32 cm, 32 cm]}
gimbal: {motion: {phi: 0, theta: 0}}
time: {end: 4, step: 20 ms}
"""


def run(folder, *words):
    done = subprocess.run([bbsim, *words], cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise RuntimeError(f"bbsim {' '.join(words)}: {done.stderr}")
    return done


class Recording:
    """record.py on a pseudo terminal that the test feeds."""

    def __init__(self, folder, *options):
        self.folder = pathlib.Path(folder)
        self.board, self.line = pty.openpty()
        tty.setraw(self.line)
        self.process = subprocess.Popen(
            [sys.executable, "-B", str(recorder / "record.py"), "serial", os.ttyname(self.line), "-o", "log.csv",
             "--silence", "0.5", *options], cwd=folder, stderr=subprocess.PIPE, text=True)

    def feed(self, data):
        while data:
            data = data[os.write(self.board, data[:512]):]

    def wait_for(self, words):
        """Reads messages until one contains `words`."""
        read = ""
        while words not in read:
            line = self.process.stderr.readline()
            if not line:
                raise RuntimeError(f"no '{words}' in: {read}")
            read += line

    def unplug(self):
        os.close(self.line)
        os.close(self.board)
        self.board = self.line = None

    def end(self):
        _, self.messages = self.process.communicate(timeout=60)
        if self.board is not None:
            self.unplug()
        return self.process.returncode

    def log(self):
        return (self.folder / "log.csv").read_text().splitlines()

    def files(self):
        return sorted(f.name for f in self.folder.iterdir() if "log.csv" in f.name)


def text(lines):
    return "".join(line + "\r\n" for line in lines).encode()


class Serial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """A designed motion, and its sketch's output on a rig whose numbers differ from the scenario's."""
        cls.temporary = tempfile.TemporaryDirectory()
        cls.designed = pathlib.Path(cls.temporary.name)
        (cls.designed / "rig.yaml").write_text(RIG)
        run(cls.designed, "design", "rig.yaml", "--free", "ball.inertia_factor", "--free", "gimbal.motion.phi.table.scale",
            "-o", "designed.yaml", "--sketch", "play.ino", "-q")
        truth = [word for key, value in TRUTH.items() for word in ("--set", f"{key}={value}")]
        run(cls.designed, "run", "designed.yaml", *truth, "--set", "output.columns=[t, x, y]", "-o", "truth.csv", "-q")
        with open(cls.designed / "truth.csv") as file, open(cls.designed / "designed-motion.csv") as motion:
            noise = random.Random(1)
            cls.rows = [
                f"{1000 * float(ball['t']):.1f},{math.degrees(float(told['phi'])):.3f},"
                f"{math.degrees(float(told['theta'])):.3f},{1000 * float(ball['x']) + noise.gauss(0, 0.5):.2f},"
                f"{1000 * float(ball['y']) + noise.gauss(0, 0.5):.2f}"
                for ball, told in zip(csv.DictReader(file), csv.DictReader(motion))]
        assert len(cls.rows) == 201

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fit(self, recording):
        """Fits a recorded log with the scenario that reads it, and requires the true values."""
        shutil.copy(self.designed / "designed.yaml", self.folder / "rig.yaml")
        scenario = (self.folder / "rig.yaml").read_text()
        scenario = scenario.replace("file: 'designed-motion.csv'", "file: log.csv").replace(", unit: rad", "")
        (self.folder / "rig.yaml").write_text(scenario)
        run(self.folder, "fit", "rig.yaml", "log.csv", *(w for key in TRUTH for w in ("--free", key)), "--json", "fit.json", "-q")
        fit = json.loads((self.folder / "fit.json").read_text())
        for one in fit["parameters"]:
            # Twice the 95 % interval is four deviations, because another compiler may design another motion.
            low, high = (2 * end - one["estimate"] for end in one["interval"])
            self.assertTrue(low < TRUTH[one["key"]] < high, one)
            self.assertLess(one["sd"], 0.1 * TRUTH[one["key"]])
        for column, rms in fit["residual_rms"].items():
            self.assertAlmostEqual(rms, 0.5e-3, delta=0.1e-3, msg=column)  # four deviations of 400 numbers' rms

    def test_a_log_is_whole_and_a_fit_of_it_finds_the_truth(self):
        recording = Recording(self.folder)
        recording.feed(b"\xff\x00 boot\r\n" + text([HEADER, *self.rows]))
        self.assertEqual(recording.end(), 0, recording.messages)
        self.assertEqual(recording.log(), [HEADER, *self.rows])
        self.assertIn("the sketch is done; log.csv: 201 rows, 0.00 to 4.00 s\n", recording.messages)
        self.assertEqual(recording.files(), ["log.csv"])
        self.fit(recording)

    def test_damaged_lines_are_left_out_and_counted(self):
        lines = list(self.rows)
        for i in range(10, 100, 10):  # each with another fault
            line = lines[i]
            lines[i] = [line[:-1], line[4:], line.replace(",", ";", 1), line + "0", "\x01" + line[1:], "9" + line,
                        line.rsplit(",", 1)[0], line.replace(".", "", 1), line + "," + line][i // 10 - 1]
        merged = lines[120][:9] + lines[121][5:]  # the bytes between the two were lost
        lines[120:122] = [merged]
        recording = Recording(self.folder)
        recording.feed(text([HEADER, *lines]))
        self.assertEqual(recording.end(), 0, recording.messages)
        damaged = {*range(10, 100, 10), 120, 121}
        self.assertEqual(recording.log(), [HEADER] + [row for i, row in enumerate(self.rows) if i not in damaged])
        self.assertIn(f"{201 - len(damaged)} rows", recording.messages)
        self.assertIn("10 damaged lines left out; 11 rows missing by the clock", recording.messages)
        self.fit(recording)

    def test_what_came_before_it_was_unplugged_is_kept(self):
        recording = Recording(self.folder)
        recording.feed(text([HEADER, *self.rows[:150]]) + self.rows[150][:-1].encode())  # cut off
        recording.wait_for("the motion begins")
        time.sleep(0.2)
        recording.unplug()
        self.assertEqual(recording.end(), 1)
        self.assertIn("was unplugged; log.csv: 150 rows", recording.messages)
        self.assertEqual(recording.log(), [HEADER, *self.rows[:150]])

    def test_ctrl_c_keeps_the_rows_so_far(self):
        recording = Recording(self.folder, "--silence", "50")
        recording.feed(text([HEADER, *self.rows[:20]]))
        recording.wait_for("the motion begins")
        time.sleep(0.2)
        recording.process.send_signal(signal.SIGINT)
        self.assertEqual(recording.end(), 130)
        self.assertEqual(recording.log(), [HEADER, *self.rows[:20]])

    def test_ctrl_c_before_the_first_row_leaves_no_file(self):
        recording = Recording(self.folder)
        recording.wait_for("waiting")
        recording.process.send_signal(signal.SIGINT)
        self.assertEqual(recording.end(), 130)
        self.assertEqual(recording.files(), [])

    def test_a_sketch_that_stops_in_the_middle_is_told(self):
        recording = Recording(self.folder)
        recording.feed(text([HEADER, *self.rows[:50]]))
        self.assertEqual(recording.end(), 1)
        self.assertIn("fell silent 0.98 s into its motion, before the plate was level again", recording.messages)
        self.assertEqual(len(recording.log()), 51)

    def test_a_board_that_restarts_begins_the_log_again(self):
        recording = Recording(self.folder)
        recording.feed(text([HEADER, *self.rows[:50]]) + b"12" + text(["", HEADER, *self.rows]))
        self.assertEqual(recording.end(), 0)
        self.assertIn("the motion begins again: the board has restarted", recording.messages)
        self.assertEqual(recording.log(), [HEADER, *self.rows])

    def test_rows_without_a_header_are_no_log(self):
        recording = Recording(self.folder)
        recording.wait_for("waiting")
        for row in self.rows[100:160]:
            if recording.process.poll() is None:
                recording.feed(text([row]))
                time.sleep(0.03)
        self.assertEqual(recording.end(), 1)
        self.assertIn("found rows without a header", recording.messages)
        self.assertEqual(recording.files(), [])

    def test_silence_is_no_log(self):
        recording = Recording(self.folder, "--wait", "0.3")
        self.assertEqual(recording.end(), 1)
        self.assertIn("found no log on", recording.messages)
        self.assertEqual(recording.files(), [])

    def test_a_log_is_replaced_only_if_asked(self):
        (self.folder / "log.csv").write_text("precious")
        refused = Recording(self.folder)
        self.assertEqual(refused.end(), 2)
        self.assertIn("-o: found log.csv, which exists; allowed: another name, or --force", refused.messages)
        self.assertEqual(refused.log(), ["precious"])
        forced = Recording(self.folder, "--force")
        forced.feed(text([HEADER, *self.rows]))
        self.assertEqual(forced.end(), 0)
        self.assertEqual(len(forced.log()), 202)

    def test_a_line_that_is_none_is_told(self):
        for device, words in (("/dev/null", "no serial line"), ("/dev/none", "No such file or directory; serial lines here: ")):
            done = subprocess.run([sys.executable, "-B", str(recorder / "record.py"), "serial", device], cwd=self.folder,
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, words in done.stderr), (2, True), done.stderr)

    def test_a_file_is_whole_or_not_there(self):
        def rows():
            yield ["1", "2"]
            raise OSError(28, "No space left on device")

        with self.assertRaises(sketch_log.Problem) as told:
            sketch_log.write_whole(str(self.folder / "log.csv"), ["a", "b"], rows())
        self.assertEqual(told.exception.code, 3)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_wrong_times_go_and_right_ones_stay(self):
        def times(*milliseconds):
            lines = [sketch_log.Line(0, HEADER)] + [sketch_log.Line(0, f"{t:.1f},0.000,0.000,1.00,2.00") for t in milliseconds]
            log = sketch_log.Log(lines, HEADER.split(","))
            return [round(1000 * row.t) for row in log.rows], log.damaged, log.missing

        self.assertEqual(times(0, 20, 40, 60), ([0, 20, 40, 60], 0, 0))
        self.assertEqual(times(0, 20, 840, 60, 80), ([0, 20, 60, 80], 1, 1))
        self.assertEqual(times(0, 20, 40, 6, 80), ([0, 20, 40, 80], 1, 1))
        self.assertEqual(times(0, 20, 40, 60, 860), ([0, 20, 40, 60], 1, 0))
        self.assertEqual(times(40, 60, 80), ([40, 60, 80], 0, 2))

    @unittest.skipUnless(shutil.which("c++"), "no compiler for the sketch")
    def test_the_simulated_board_is_recorded(self):
        run(self.designed, "sketch", "play.ino", "-o", "play.so")
        for name in ("wiring.yaml", "board.yaml"):
            shutil.copy(source / "tests/examples" / name, self.designed)
        said = run(self.designed, "run", "board.yaml", "--set", "ball.position=[-4 cm, -5 cm]", "--set", "time.end=9.2", "-o",
                   "board.csv", "--force").stderr  # fmt: skip
        mark = "controller: "
        lines = [line[len(mark):] for line in said.splitlines() if line.startswith(mark)]
        self.assertEqual(len(lines), 202)
        recording = Recording(self.folder)
        recording.feed(text(lines))
        self.assertEqual(recording.end(), 0, recording.messages)
        self.assertEqual(recording.log(), lines)


if __name__ == "__main__":
    unittest.main()
