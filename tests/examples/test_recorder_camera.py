#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""examples/recorder/camera.py on rendered pictures of a run; BBSIM names the program. Needs numpy;
what reads videos and markers is tested where OpenCV is installed.

How exact positions can be, with 1.5 pixels for a mm and a ball of 30 pixels' radius: noise of 3 in a contrast
of 165 shifts a disc's centroid by 3 / 165 / (2 sqrt(pi)) = 0.005 pixels; 16 points for each of the 190 pixels
at its edge leave 0.01 pixels; rounding and the cut of weak weights less. Five deviations of
all that are 0.06 pixels, 0.04 mm. With corners read off to a pixel, 0.5 sqrt(2) pixels, 0.47 mm, come on top:
within the plate, a homography's error is a mean of its corners'."""
import contextlib
import csv
import io
import json
import math
import os
import pathlib
import pty
import subprocess
import sys
import tempfile
import threading
import time
import tty
import types
import unittest

import numpy as np

here = pathlib.Path(__file__).resolve()
sys.path[:0] = [str(here.parent), str(here.parents[2] / "examples" / "recorder")]
import camera  # noqa: E402
import record  # noqa: E402
import rendered  # noqa: E402
from sketch_log import Line, Log, Problem, Row  # noqa: E402

try:
    import cv2
except ImportError:
    cv2 = None

bbsim = os.environ["BBSIM"]
PLATE, RADIUS, HEIGHT = (300.0, 300.0), 20.0, 30.0
HALF = 150.0
CORNERS = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)]
EXACT, READ_OFF = 0.04, 0.04 + 0.47  # mm
NAMES = ["t_ms", "phi_deg", "theta_deg"]
TRUTH = 0.5
RIG = """
ball: {radius: 2 cm, position: [-4 cm, -5 cm]}
plate: {size: [30 cm, 30 cm]}
gimbal: {mounting: {height: 3 cm}, motion: {phi: 0, theta: 0}}
time: {end: 3, step: 20 ms}
"""


def a_camera():
    return rendered.Camera((40.0, -60.0, 700.0 + HEIGHT), (3.0, 2.0, HEIGHT))


def level_corners(view):
    return [view.pixel((x, y, HEIGHT)) for x, y in CORNERS]


def options(view, **others):
    """Arguments as from the command line."""
    values = dict(plate=PLATE, radius=RADIUS, ball="dark", corners=level_corners(view), markers=None, dictionary="4X4_50",
                  camera_at=[40.0, -60.0, 700.0], height=HEIGHT, lag=0.0)
    return types.SimpleNamespace(**{**values, **others})


def a_log(rows):
    """Rotation for (s, phi, theta) in radians."""
    texts = [f"{1000 * t:.1f},{math.degrees(a):.3f},{math.degrees(b):.3f}" for t, a, b in rows]
    return Log([Line(t[0], text) for t, text in zip([(0,), *rows], [",".join(NAMES), *texts])], NAMES)


def positions(rows):
    return {float(row[0]) / 1000: (float(row[3]), float(row[4])) for row in rows if row[3]}


class Geometry(unittest.TestCase):
    def test_a_ball_on_a_tilted_plate_is_where_it_was_put(self):
        eye = a_camera()
        view = camera.View(camera.homography(CORNERS, level_corners(eye)), RADIUS, (40, -60, 700), HEIGHT)
        for phi, theta, x, y in ((0, 0, 0, 0), (0, 0, 120, -110), (0.15, -0.1, -120, 110), (-0.2, 0.2, 100, 90)):
            turn = rendered.turned(phi, theta)
            np.testing.assert_allclose(camera.rotation(phi, theta), turn, atol=1e-15)
            # The outline by the cone of rays that touch the sphere; an ellipse's center is the mean of its points at
            # opposite ends of two conjugate diameters, and the middle of its extremes along u and v.
            center = turn @ [x, y, HEIGHT + RADIUS]
            away = center - eye.place
            distance = np.linalg.norm(away)
            across = np.cross(away / distance, [1, 0, 0])
            across /= np.linalg.norm(across)
            other = np.cross(away / distance, across)
            back, wide = RADIUS**2 / distance, RADIUS * math.sqrt(1 - (RADIUS / distance)**2)
            outline = [eye.pixel(center - back * away / distance + wide * (math.cos(s) * across + math.sin(s) * other))
                       for s in np.linspace(0, 2 * math.pi, 3601)]
            middle = (np.max(outline, axis=0) + np.min(outline, axis=0)) / 2
            np.testing.assert_allclose(view.position(middle, turn), (x, y), atol=2e-4)
            # The tilt, from the pictures of markers at the corners.
            tilted = camera.homography(CORNERS, [eye.pixel(turn @ [a, b, HEIGHT]) for a, b in CORNERS])
            np.testing.assert_allclose(view.tilt_of(tilted), turn, atol=1e-9)

    def test_without_the_cameras_place_positions_are_on_the_level_plate(self):
        eye = a_camera()
        view = camera.View(camera.homography(CORNERS, level_corners(eye)), RADIUS)
        np.testing.assert_allclose(view.position(eye.pixel((70, -20, HEIGHT))), (70, -20), atol=1e-9)

    def test_corners_in_one_line_are_refused(self):
        with self.assertRaisesRegex(Problem, "--corners"):
            camera.homography(CORNERS, [(0, 0), (1, 1), (2, 2), (3, 3)])


class Ball(unittest.TestCase):
    def test_balls_are_found_by_their_look(self):
        eye, noise = a_camera(), np.random.default_rng(1)
        level = camera.homography(CORNERS, level_corners(eye))
        view = camera.View(level, RADIUS, (40, -60, 700), HEIGHT)
        orange, white = (30, 120, 240), (235, 235, 235)
        for look, ball, plate in (("dark", (30, 30, 30), (200, 200, 200)), ("light", white, (60, 60, 60)),
                                  ("240,120,30", orange, (60, 60, 60)), ("240,120,30", orange, (200, 200, 200))):
            looks = {"table": (10, 10, 10) if look == "dark" else (250, 250, 250), "plate": plate, "ball": ball}
            for place in ((0.3, -0.4), (110.0, -105.0)):
                seen = rendered.picture(eye, (0, 0), place, PLATE, RADIUS, HEIGHT, noise, looks=looks)
                pixel = camera.Finder(look, PLATE, RADIUS).find(seen, level)
                self.assertIsNotNone(pixel, look)
                self.assertLess(math.dist(view.position(pixel), place), EXACT, look)

    def test_gray_pictures_have_balls_too(self):
        eye = a_camera()
        level = camera.homography(CORNERS, level_corners(eye))
        seen = rendered.picture(eye, (0, 0), (50, 60), PLATE, RADIUS, HEIGHT)
        finder = camera.Finder("dark", PLATE, RADIUS)
        np.testing.assert_allclose(finder.find(seen[:, :, 0], level), finder.find(seen, level), atol=1e-6)

    def test_no_ball_and_another_size_are_not_found(self):
        eye, noise = a_camera(), np.random.default_rng(2)
        level = camera.homography(CORNERS, level_corners(eye))
        empty = rendered.picture(eye, (0, 0), (1000, 1000), PLATE, RADIUS, HEIGHT, noise)
        self.assertIsNone(camera.Finder("dark", PLATE, RADIUS).find(empty, level))
        small = rendered.picture(eye, (0, 0), (10, 10), PLATE, 10.0, HEIGHT, noise)
        self.assertIsNone(camera.Finder("dark", PLATE, RADIUS).find(small, level))

    def test_what_is_no_look_and_no_plate_are_refused(self):
        with self.assertRaisesRegex(Problem, "--ball: found purple; allowed: dark, light"):
            camera.Finder("purple", PLATE, RADIUS)
        aside = camera.homography(CORNERS, [(u + 5000, v) for u, v in level_corners(a_camera())])
        with self.assertRaisesRegex(Problem, "the plate is not in the picture"):
            camera.Finder("dark", PLATE, RADIUS).find(np.zeros((480, 640, 3), np.uint8), aside)


class Clocks(unittest.TestCase):
    def test_the_boards_clock_is_found_under_late_lines(self):
        """With T the true line, d = found - T is linear. Found is no later than any line, so where the least late
        lines of the first and last quarter are, e1 and e2 late, d is at most e1 and e2. It is the highest of such
        lines at the mean time m, and T is such a line: d(m) >= 0. So d(m) <= E = max(e1, e2), its slope is at most
        E / (a quarter of the length), and |d| <= E + 2 E all over."""
        for seed, rate in ((1, 1.0), (2, 1.004), (3, 0.996)):
            draw = np.random.default_rng(seed)
            late = draw.uniform(0, 0.016, 301)  # a USB adapter's timer
            late[draw.random(301) < 0.05] += 0.3  # a busy computer
            rows = []
            for i, delay in enumerate(late):
                fields = [f"{20 * i:.1f}", "0.000", "0.000", "1.00", "2.00"]
                wire = 10 * (len(",".join(fields)) + 2) / 115200
                rows.append(Row(0.02 * i, 1000 + rate * 0.02 * i + wire + delay, fields))
            bound = 3 * max(late[:75].min(), late[-75:].min())
            self.assertLess(bound, 0.003)
            clock = camera.Clock(rows, 115200)
            for t in np.linspace(0, 6, 25):
                self.assertLessEqual(abs(clock.start + clock.rate * t - (1000 + rate * t)), bound + 1e-9)
                self.assertAlmostEqual(clock.board(1000 + rate * t), t, delta=1.01 * bound + 1e-9)

    def test_few_lines_have_the_hosts_rate(self):
        rows = [Row(0.02 * i, 5 + 0.02 * i + late, ["0.0"]) for i, late in enumerate((0.0, 0.016))]
        clock = camera.Clock(rows, 115200)
        self.assertEqual(clock.rate, 1)
        self.assertAlmostEqual(clock.board(5.01), 0.01 + 10 * 5 / 115200, places=9)


class Recording(unittest.TestCase):
    """Pictures of a designed motion, 25 a second, on a clock of their own."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = cls.folder = pathlib.Path(cls.temporary.name)
        (folder / "rig.yaml").write_text(RIG)

        def run(*words):
            done = subprocess.run([bbsim, *words], cwd=folder, capture_output=True, text=True, timeout=300)
            assert done.returncode == 0, done.stderr

        cls.run_bbsim = staticmethod(run)
        run("design", "rig.yaml", "--max-tilt", "6 deg", "--free", "ball.inertia_factor", "-o", "designed.yaml", "-q")
        run("run", "designed.yaml", "--set", f"ball.inertia_factor={TRUTH}", "--set", "time.step=10 ms",
            "--set", "output.columns=[t, x, y, phi, theta]", "-o", "truth.csv", "-q")
        with open(folder / "truth.csv") as file:
            truth = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        cls.told = [(row["t"], row["phi"], row["theta"]) for row in truth[::2]]
        cls.eye = a_camera()
        noise = np.random.default_rng(4)
        cls.truth, cls.frames = {}, []  # by the sketch's clock
        for row in truth[3::4]:
            place = 1000 * row["x"], 1000 * row["y"]
            cls.truth[row["t"]] = place
            cls.frames.append((row["t"], rendered.picture(cls.eye, (row["phi"], row["theta"]), place, PLATE, RADIUS, HEIGHT, noise)))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def worst(self, frames, log, **others):
        watcher = camera.Watcher(options(self.eye, **others))
        watcher.watch(frames, lambda: False)
        found, rows = watcher.merge(log, watcher.times)
        places = positions(rows)
        self.assertEqual((found, len(places)), (len(self.truth), len(self.truth)))
        return max(math.dist(places[round(t, 4)], place) for t, place in self.truth.items())

    def test_positions_on_the_tilting_plate(self):
        log = a_log(self.told)
        self.assertLess(self.worst(self.frames, log), EXACT)
        read_off = [np.round(corner) for corner in level_corners(self.eye)]
        self.assertLess(self.worst(self.frames, log, corners=read_off), READ_OFF)

    def test_a_plate_that_lags_behind_the_sketch(self):
        early = [(t - 0.06, phi, theta) for t, phi, theta in self.told] + [(2.96, 0, 0), (2.98, 0, 0), (3.0, 0, 0)]
        log = a_log(early)
        self.assertLess(self.worst(self.frames, log, lag=60.0), EXACT)
        self.assertGreater(self.worst(self.frames, log), 5 * EXACT)

    def test_both_are_merged_and_a_fit_finds_the_truth(self):
        """The computer's clock is another, lines come late, pictures by 10 ms, and the camera runs for longer."""
        draw = np.random.default_rng(5)
        rows = [",".join(row.fields) for row in a_log(self.told).rows]
        start, rate, late = 77.0, 1.003, draw.exponential(0.004, len(rows))
        quarter = len(rows) // 4
        clock_bound = 3 * max(late[:quarter].min(), late[-quarter:].min())  # as for the clock alone
        lines = [Line(start - 1, ",".join(NAMES))] + [
            Line(start + rate * t + 10 * (len(text) + 2) / 115200 + delay, text)
            for (t, _, _), text, delay in zip(self.told, rows, late)]
        frames = [(start + rate * t + 0.010, picture) for t, picture in
                  [(-0.5, self.frames[0][1]), *self.frames, (3.5, self.frames[-1][1])]]
        log = Log(lines, NAMES)
        watcher = camera.Watcher(options(self.eye))
        watcher.watch(frames, lambda: False)
        clock = camera.Clock(log.rows, 115200)
        moments = [clock.board(t - 0.010) for t in watcher.times]
        self.assertLess(max(abs(a - b) for a, b in zip(moments[1:-1], self.truth)), clock_bound)
        found, merged = watcher.merge(log, moments)
        self.assertEqual(found, len(self.frames))
        self.assertEqual([",".join(row[:3]) for row in merged if row[1]], rows)
        record.write_whole(str(self.folder / "log.csv"), ["t_ms", "phi_deg", "theta_deg", "x_mm", "y_mm"], merged)
        places = np.array(list(self.truth.values()))
        speed = np.linalg.norm(np.diff(places, axis=0), axis=1).max() / 0.04  # mm/s
        # A time that is late by d moves the ball by speed d, and the tilt at most as much as that at the same time.
        # A ball's acceleration is proportional to g / (1 + k): in it are lengths, and the clock's rate twice, whose error
        # is a third of the clock's bound over a quarter of 3 s.
        size = np.ptp(places, axis=0).min() / 2
        self.fit(EXACT + 2 * speed * clock_bound, (1 + TRUTH) * (EXACT / size + 2 * clock_bound / 3 / 0.75))

    def fit(self, millimeters, systematic):
        scenario = (self.folder / "designed.yaml").read_text()
        (self.folder / "fit.yaml").write_text(scenario.replace("file: 'designed-motion.csv'", "file: log.csv").replace(", unit: rad", ""))
        self.run_bbsim("fit", "fit.yaml", "log.csv", "--free", "ball.inertia_factor", "--json", "fit.json", "-q")
        fit = json.loads((self.folder / "fit.json").read_text())
        one = fit["parameters"][0]
        low, high = one["interval"]
        self.assertLess(systematic, 0.002)
        self.assertTrue(low - systematic < TRUTH < high + systematic, one)
        for column, rms in fit["residual_rms"].items():
            self.assertLess(rms, 1e-3 * millimeters, column)

    def test_both_run_at_once(self):
        """From words to a file: a line and pictures of a ball at rest, by this computer's clock."""
        rows = [f"{20 * i:.1f},0.000,0.000" for i in range(40)]
        board, line = pty.openpty()
        tty.setraw(line)

        def play():
            os.write(board, (",".join(NAMES) + "\r\n").encode())
            for i, row in enumerate(rows):
                time.sleep(max(0, began + 0.02 * i - time.monotonic()))
                os.write(board, (row + "\r\n").encode())

        def watch():
            for i in range(10000):
                time.sleep(0.025)
                yield time.monotonic(), picture

        place = (30.0, -40.0)
        picture = rendered.picture(self.eye, (0, 0), place, PLATE, RADIUS, HEIGHT)
        log = self.folder / "both.csv"
        words = ["camera", "0", "--serial", os.ttyname(line), "--silence", "0.4", "--plate", "300x300", "--radius", "20",
                 "--height", "30", "--camera-at", "40,-60,700", "-o", str(log),
                 "--corners", *(f"{u:.2f},{v:.2f}" for u, v in level_corners(self.eye))]
        said = io.StringIO()
        began = time.monotonic() + 0.1
        player = threading.Thread(target=play)
        player.start()
        with contextlib.redirect_stderr(said):
            code = record.main(words, watch())
        player.join()
        os.close(board)
        os.close(line)
        self.assertEqual(code, 0, said.getvalue())
        self.assertRegex(said.getvalue(), r"the sketch is done; .*both.csv: 40 rows, 0.00 to 0.78 s; the ball in (\d+) of \1 pictures")
        with open(log) as file:
            written = list(csv.reader(file))
        self.assertEqual(written[0], ["t_ms", "phi_deg", "theta_deg", "x_mm", "y_mm"])
        self.assertEqual([",".join(row[:3]) for row in written[1:] if row[1]], rows)
        seen = positions(written[1:])
        self.assertGreater(len(seen), 3)  # of 30 on a computer with nothing else to do
        for where in seen.values():
            self.assertLess(math.dist(where, place), EXACT)

    def test_what_the_camera_needs_is_told(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as end:
            record.main(["camera", "0", "--radius", "20"])
        self.assertEqual(end.exception.code, 2)
        self.assertIn("camera needs --plate, --corners or --markers, --serial or --log", said.getvalue())

    @unittest.skipIf(cv2, "OpenCV is there")
    def test_without_opencv_the_recorder_says_how_to_install_it(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertEqual(record.main(["camera", "0", "--picture", "x.png"]), 2)
        self.assertIn("apt install python3-opencv", said.getvalue())

    @unittest.skipUnless(cv2, "no OpenCV")
    def test_a_video_and_a_log_of_its_time(self):
        folder = self.folder
        record.write_whole(str(folder / "sketch.csv"), NAMES, [row.fields for row in a_log(self.told).rows])
        writer = cv2.VideoWriter(str(folder / "film.avi"), cv2.VideoWriter_fourcc(*"MJPG"), 25, (640, 480))
        for _, picture in self.frames:
            writer.write(picture)
        writer.release()
        corners = [f"{u:.2f},{v:.2f}" for u, v in level_corners(self.eye)]
        words = ["camera", str(folder / "film.avi"), "--log", str(folder / "sketch.csv"), "--first-frame", "30", "--plate",
                 "300x300", "--radius", "20", "--height", "30", "--camera-at", "40,-60,700", "--corners", *corners,
                 "-o", str(folder / "film.csv")]
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertEqual(record.main(words), 0)
        self.assertIn(f"the ball in {len(self.frames)} of {len(self.frames)} pictures", said.getvalue())
        with open(folder / "film.csv") as file:
            places = positions(list(csv.reader(file))[1:])
        # JPEG's rounding is like more noise; pixels stay where they are.
        for t, place in self.truth.items():
            self.assertLess(math.dist(places[round(t, 4)], place), 2 * EXACT)
        picture = ["camera", str(folder / "film.avi"), "--picture", str(folder / "film.png"), "-q"]
        self.assertEqual(record.main(picture), 0)
        self.assertEqual(cv2.imread(str(folder / "film.png")).shape, (480, 640, 3))

    @unittest.skipUnless(cv2 and hasattr(cv2, "aruco"), "no OpenCV with markers")
    def test_markers_show_the_tilt(self):
        aruco = cv2.aruco
        words = aruco.getPredefinedDictionary(aruco.DICT_4X4_50)
        draw = getattr(aruco, "generateImageMarker", None) or aruco.drawMarker
        per_mm, side, off = 4, 160, 120.0  # markers of 40 mm, centered 120 mm from the middle along x and y
        texture = np.full((1200, 1200), 205.0)
        for i, (x, y) in enumerate(((-off, -off), (off, -off), (off, off), (-off, off))):
            column, row = (round((a + HALF) * per_mm) - side // 2 for a in (x, y))
            texture[row:row + side, column:column + side] = draw(words, i, side)[:, ::-1]  # y is up in the picture
        frames = [(-1.0, (0, 0), (0, 0)), (0.5, (0.1, -0.12), (40, 30)), (1.0, (-0.12, 0.05), (-50, 60))]
        seen = [(t, rendered.picture(self.eye, angles, place, PLATE, RADIUS, HEIGHT, texture=texture))
                for t, angles, place in frames]
        watcher = camera.Watcher(options(self.eye, plate=(240.0, 240.0), corners=None, markers=[0, 1, 2, 3]))
        watcher.watch(seen, lambda: False)
        found, rows = watcher.merge(a_log([(0.02 * i, 0, 0) for i in range(101)]), watcher.times)
        self.assertEqual(found, 2)
        for t, _, place in frames[1:]:
            # A marker's center to 0.2 pixels, whose corners are found to 0.4: 0.13 mm of the place. A tilt moves the
            # center's picture by 120 mm / 700 mm of how much it raises it: 0.13 mm tell it to 6.5 mrad, which
            # moves the center of a ball by 20 mm times that, 0.13 mm.
            self.assertLess(math.dist(positions(rows)[t], place), 0.26 + EXACT)


if __name__ == "__main__":
    unittest.main()
