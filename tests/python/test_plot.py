# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: bbsim.plot and `bbsim plot`. Needs BBSIM (the program) and BBSIM_SOURCE in the environment."""

import os
import pickle
import re
import signal
import subprocess
import time
import unittest
import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

import cases
import numpy as np
from cases import CONFIGS, PROGRAM
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend
from matplotlib.text import Text

import bbsim
from bbsim import _plot_axes as axes
from bbsim._plot_sheet import clean

BUILD = Path(PROGRAM).parent.parent


def drawn_texts(figure):
    """The texts that drawing the figure draws, with their boxes in pixels."""
    canvas, texts, draw = FigureCanvasAgg(figure), [], Text.draw

    def record(self, renderer, *rest, **more):
        if self.get_visible() and self.get_text().strip():
            texts.append((self.get_text(), self.get_window_extent(renderer)))
        draw(self, renderer, *rest, **more)

    with mock.patch.object(Text, "draw", record):
        canvas.draw()
    return texts


def overlap(one, other):
    """How deep two boxes lie in each other, in pixels."""
    return min(one.x1, other.x1) - max(one.x0, other.x0), min(one.y1, other.y1) - max(one.y0, other.y0)


def words_of(figure):
    return " ".join(text for text, _ in drawn_texts(figure))


class Case(cases.Case):
    def refused(self, *words, message):
        """In this process, which is faster than a process for each."""
        self.assertIn(message, self.command("plot", *words, code=2)[1])

    def program_refuses(self, *words, message):
        made = self.bbsim("plot", *words, code=2)
        self.assertIn(message, made.stderr)
        self.assertEqual(made.stdout, "")

    def run_to(self, name, scenario, *words):
        subprocess.run([PROGRAM, "run", CONFIGS / scenario, "-o", self.folder / name, "-q", *words], capture_output=True)
        return self.folder / name

    def sweep_to(self, name, *words):
        self.bbsim("sweep", CONFIGS / "fig2b.yaml", "-o", name, "-q", *words)
        return self.folder / name

    def require_clear(self, figure):
        """No text collides with another or leaves the sheet; no legend covers data."""
        texts = drawn_texts(figure)
        self.assertGreater(len(texts), 3)
        for i, (text, box) in enumerate(texts):
            inside = box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1
            self.assertTrue(inside, f"{text!r} leaves the sheet: {box}")
            for other, its in texts[i + 1 :]:
                self.assertLess(min(overlap(box, its)), 1.5, f"{text!r} collides with {other!r}")
        for legend in figure.findobj(Legend):
            for panel in figure.axes:
                self.assertLess(min(overlap(legend.get_window_extent(), panel.bbox)), 1.5, "a legend covers data")


class Layout(Case):
    def test_every_run(self):
        for scenario in sorted(CONFIGS.glob("*.yaml")):
            with self.subTest(scenario.stem):
                file = self.run_to("run.h5", scenario)
                self.require_clear(bbsim.plot(file))
                self.require_clear(bbsim.plot(file, width="88 mm"))

    def test_sweeps(self):
        kv, kp = "controller.pd.kv.0.0=linear:-1:1:9", "controller.pd.kp.0.0=log:0.001:1:7"
        draws = "ball.position.0=normal:5 cm:2 mm"
        for vary in (
            ["--vary", kv],
            ["--vary", kv, "--vary", kp],
            ["--vary", kv, "--vary", "controller.pd.kp.0.0=list:0.1,0.2,0.5"],
            ["--vary", draws, "--samples", "40"],
            ["--vary", kv, "--vary", draws, "--samples", "5"],
            ["--vary", "solver.method=list:radau,bdf,adams"],
            ["--vary", kv, "--vary", "ball.radius=linear:5 mm:15 mm:3", "--vary", kp],
        ):
            for width in (None, "88 mm"):
                with self.subTest(vary=vary, width=width):
                    self.require_clear(bbsim.plot(self.sweep_to("sweep.h5", *vary), width=width))

    def test_two_drawn_keys_are_points(self):
        draws = ["ball.position.0=normal:5 cm:2 mm", "ball.radius=uniform:5 mm:15 mm"]
        words = [word for one in draws for word in ("--vary", one)]
        file = self.sweep_to("drawn.h5", *words, "--samples", "40", "--measure", "max_tilt")
        figure = bbsim.plot(file, over="ball.radius,ball.position.0")
        self.require_clear(figure)
        panel = next(axes for axes in figure.axes if axes.get_xlabel())
        self.assertEqual(len(panel.collections[0].get_offsets()), 40)

    def test_cells_without_a_value_are_explained(self):
        kv = ["--vary", "controller.pd.kv.0.0=linear:-1:1:9", "--vary", "controller.pd.kp.0.0=log:0.001:1:7"]
        figure = bbsim.plot(self.sweep_to("none.h5", *kv, "--measure", "phi_gain_margin"))
        self.assertIn("no value", words_of(figure))

    def test_comparisons_and_chosen_columns(self):
        files = []
        for k in ("0.5", "2"):
            files.append(self.run_to(f"hold-{k}.csv", "hold.yaml", "--set", f"controller.pd.kp=[[{k}, 0], [0, -{k}]]"))
        figure = bbsim.plot(files)
        self.require_clear(figure)
        self.assertIn("hold-0.5.csv hold-2.csv", words_of(figure))
        one = bbsim.plot(files[0], columns=["path", ["x", "x_reference"], "torque_phi"])
        self.require_clear(one)
        self.assertEqual(len(one.axes), 3)
        self.assertIn("torque φ (mN m)", words_of(one))

    def test_accuracy(self):
        figure = bbsim.plot(CONFIGS / "beam.yaml", accuracy=True, csv=self.folder / "points.csv")
        self.require_clear(figure)
        self.assertIn("processor time of a run (µs)", words_of(figure))
        self.assertEqual({line.get_color() for line in figure.axes[0].lines}, {"#0072b2", "#d55e00", "#009e73"})
        self.assertTrue((self.folder / "points.csv").read_text().startswith("method,rtol,atol,error_m,time_us"))

    def test_loops(self):
        kp, kv = "controller.gravity_compensation.kp", "controller.pd.kv.0.0"
        for scene, key in (("rig.yaml", kp), ("beam.yaml", None), ("fig2b.yaml", kv)):
            locus = [{"root_locus": f"{key}=0.3:2"}] if key else []
            for asked in ({"bode": True}, {"nyquist": True}, {"poles": True}, {"step": True}, *locus):
                with self.subTest(scene=scene, **asked), warnings.catch_warnings():
                    warnings.simplefilter("error")
                    figure = bbsim.plot(CONFIGS / scene, csv=self.folder / "loop.csv", **asked)
                    self.require_clear(figure)
                    self.assertIn("</svg>", figure._repr_svg_())
                    for width in ("88 mm", "60 mm"):
                        self.require_clear(bbsim.plot(CONFIGS / scene, width=width, **asked))
                    numbers = np.genfromtxt(self.folder / "loop.csv", delimiter=",", names=True)
                    self.assertGreater(len(numbers), 3)
                    finite = all(np.isfinite(numbers[name]).all() for name in numbers.dtype.names)
                    self.assertTrue(finite or scene == "beam.yaml")  # which has no loop of theta
        self.assertEqual(self.read("loop.csv").splitlines()[0], "value,real,imag")

    def test_a_step_has_all_its_samples(self):
        """Regression: for some periods a response lacked its last sample."""
        bbsim.plot(CONFIGS / "falls.yaml", step=True, csv=self.folder / "step.csv")
        self.assertTrue(np.isfinite(np.genfromtxt(self.folder / "step.csv", delimiter=",", names=True)["x"]).all())

    def test_the_margins_of_a_bode_plot_are_those_of_check(self):
        for scene in ("rig.yaml", "fig2b.yaml", "beam.yaml"):
            words = words_of(bbsim.plot(CONFIGS / scene, bode=True))
            for its in bbsim.linearize(CONFIGS / scene).margins.values():
                self.assertIn(f"{20 * np.log10(its['gain']):+.3g} dB", words)
                self.assertIn(f"{np.degrees(its['phase']):.3g}°", words)

    def test_values_close_together_and_of_every_size(self):
        for low, high in ((0.1, 0.1 + 1e-9), (1e-12, 3e-12), (-2e7, 1e9), (1e-300, 1e-299), (-1e300, 1e300), (5.0, 5.0)):
            (self.folder / "log.csv").write_text(f"t,level\n0,{low!r}\n1,{high!r}\n2,{low!r}\n")
            with self.subTest(low=low, high=high):
                self.require_clear(bbsim.plot(self.folder / "log.csv"))

    def test_long_names(self):
        name = "a_very_long_name_of_a_column_that_some_rig_has_in_its_log"
        (self.folder / "log.csv").write_text(f"t,{name},{name}_too\n0,1,2\n1,3,4\n")
        for asked in ((), [f"{name},{name}_too"]):
            self.require_clear(bbsim.plot(self.folder / "log.csv", columns=asked, width="60 mm"))


class Content(Case):
    def test_a_scene_is_shown(self):
        words = words_of(bbsim.plot(self.run_to("slips.h5", "slips.yaml")))
        for text in (
            "A plate that rocks too fast for the friction", "slips.h5, stopped at t = 0.556624 s: lift_off",
            "slip, 2 times", "lift_off (stops)", "coefficient 0.1", "friction demand",
        ):  # fmt: skip
            self.assertIn(text, words)
        # A CSV lacks these data: they come from its summary ...
        csv = self.run_to("falls.csv", "falls.yaml")
        self.assertNotIn("plate's edge", words_of(bbsim.plot(csv)))
        self.run_to("falls.csv", "falls.yaml", "--summary", self.folder / "falls.json")
        words = words_of(bbsim.plot(csv))
        self.assertIn("plate's edge", words)
        self.assertIn("edge (stops)", words)
        # ... or from the scenario.
        (self.folder / "falls.json").unlink()
        words = words_of(bbsim.plot(csv, scenario=CONFIGS / "falls.yaml", set={"events.slip.friction": 0.2}))
        self.assertIn("plate's edge", words)
        self.assertIn("coefficient 0.2", words)

    def test_results_in_memory_are_drawn_as_their_files(self):
        made = bbsim.run(CONFIGS / "rig.yaml")
        stored = words_of(bbsim.plot(self.run_to("rig.h5", "rig.yaml")))
        self.assertEqual(words_of(made.plot()), stored.replace("rig.h5 ", ""))
        self.assertEqual(len(made.plot(["x", "y,y_reference"]).axes), 2)
        table = bbsim.sweep(CONFIGS / "fig2a.yaml", vary={"gravity": [9, 9.5, 10]}, measures=["max_x", "end_y"])
        self.assertEqual(len(bbsim.plot(table).axes), 2)
        self.assertIn("<svg", pickle.loads(pickle.dumps(made.plot()))._repr_svg_())
        self.assertRaises(TypeError, bbsim.plot, 5)

    def test_commands_of_a_sampled_controller_are_steps(self):
        lines = bbsim.run(CONFIGS / "rig.yaml").plot(["phi,phi_command"]).axes[0].lines
        self.assertEqual(sorted(line.get_drawstyle() for line in lines), ["default", "steps-post"])
        columns = {"output.columns": ["t", "phi_command"]}
        smooth = bbsim.run(CONFIGS / "hold.yaml", columns).plot().axes[0].lines
        self.assertEqual({line.get_drawstyle() for line in smooth}, {"default"})

    def test_units_are_the_scenarios(self):
        scene = "ball: {radius: %s, position: [%s, 0]}\ngimbal: {motion: {phi: %s}}\ntime: {end: 1, step: 0.1}\n"
        for values, heading in (
            (("10 mm", "90 mm", "2 deg"), "x, y (mm)"),
            (("1 cm", "9 cm", "2 deg"), "x, y (cm)"),
            ((0.01, 0.09, 0.03), "x, y (cm)"),
        ):
            words = words_of(bbsim.run(scene % values).plot(["x,y", "phi"]))
            self.assertIn(heading, words)
            self.assertIn("φ (°)", words)
        self.assertIn("φ (rad)", words_of(bbsim.run(scene % ("1 cm", 0, '"0.1 rad"')).plot(["phi"])))

    def test_a_log_has_no_units_and_its_gaps_stay_gaps(self):
        (self.folder / "log.csv").write_text("t,x,y,phi\n0,-12,3,2\n0.1,-11,2,2\n0.2,,,\n0.3,-9,1,1\n0.4,,0,1\n")
        figure = bbsim.plot(self.folder / "log.csv")
        words = words_of(figure)
        self.assertIsNone(re.search(r"\((m|cm|s|°)\)", words))
        path = figure.axes[0].lines[0]
        self.assertEqual(list(np.isnan(path.get_ydata())), [False, False, True, False, True])
        self.assertEqual(len(figure.axes[0].lines[1].get_xdata()), 1)  # the lone point

    def test_a_mapped_column_is_drawn_once(self):
        (self.folder / "log.csv").write_text("millis,ball_x,servo\n0,10,1\n20,11,2\n40,13,4\n")
        log = {"map": "x=ball_x:mm"}
        words = words_of(bbsim.plot(self.folder / "log.csv", **log)).split()
        self.assertIn("servo", words)
        self.assertFalse({"ball_x", "millis"} & set(words))
        # Its own name still draws it.
        self.assertIn("ball_x", words_of(bbsim.plot(self.folder / "log.csv", columns="ball_x", **log)))

    def test_a_map_over_decades_has_logarithmic_colors(self):
        table = np.array(
            [(i, 1.0 + i % 6, 1.0 + i // 6, "done", 10.0 ** (i / 8)) for i in range(36)],
            dtype=[("case", int), ("a", float), ("b", float), ("status", "U8"), ("level", float)],
        )
        figure = bbsim.plot(table)
        self.require_clear(figure)
        self.assertEqual(figure.axes[1].get_yscale(), "log")

    def test_cases_without_a_value_or_an_end(self):
        rows = "0,1,9,done,1,1\n1,2,9,done,1,2\n2,,9,done,1,2\n3,3,9.5,failed,0.2,\n4,2,10,done,1,4\n"
        (self.folder / "s.csv").write_text("case,ball.radius,gravity,status,end_time,end_x\n" + rows)
        axes = bbsim.plot(self.folder / "s.csv", columns="end_x", over="ball.radius").axes[0]
        for line, points in zip(axes.lines, ([[1, 1], [2, 2]], [[3, np.nan]], [[2, 4]])):  # by gravity
            np.testing.assert_array_equal(line.get_xydata(), points)
        self.assertEqual(list(axes.lines[-1].get_xdata()), [3])  # at the foot: failed
        self.require_clear(bbsim.plot(self.folder / "s.csv", over="ball.radius,gravity"))
        self.assertRaisesRegex(bbsim.InputError, "files: found none", bbsim.plot, [])

    def test_hostile_titles_are_texts(self):
        title = "a $x$ 'quote' {_sub} ^sup \\\\n <b>&amp; ]]> %d"
        scene = {"title": title, "ball": {"radius": 0.01}, "gimbal": {"motion": {"phi": 0.01}}, "time": {"end": 1, "step": 0.1}}
        figure = bbsim.run(scene).plot()
        self.assertIn(title, words_of(figure))
        self.assertEqual(clean("a\x01\n\u202eb"), "a \ufffdb")
        self.assertIn(title, "".join(ElementTree.fromstring(figure._repr_svg_()).itertext()))

    def test_a_million_rows_keep_their_extremes(self):
        t = np.linspace(0, 40, 10**6)
        level = np.sin(t) + 0.1 * np.random.default_rng(1).standard_normal(len(t))
        level[123456], level[700001] = 5, -4
        np.savetxt(self.folder / "log.csv", np.stack([t, level], 1), "%.6g", ",", header="t,level", comments="")
        drawn = bbsim.plot(self.folder / "log.csv")
        svg = drawn._repr_svg_()
        self.assertLess(len(svg), 400_000)
        line = max(re.findall(' d="([^"]*)"', svg), key=len)
        heights = [float(height) for height in re.findall(r"[ML] \S+ (\S+)", line)]
        ends = drawn.axes[0].transData.transform([(0, 5), (0, -4)])[:, 1] * 72 / drawn.dpi
        expected = drawn.get_figheight() * 72 - ends
        np.testing.assert_allclose([min(heights), max(heights)], expected, atol=1e-4)

    def test_ticks(self):
        self.assertEqual(axes.power_of_ten(-12), "10⁻¹²")
        self.assertEqual(axes.choose_scale(axes.Unit("m"), (0.1, 0.1 + 5e-8)).heading("x"), "x − 0.1 m (nm)")
        self.assertEqual(axes.choose_scale(axes.Unit("N m"), (0, 2e-4)).unit, "µN m")


class Command(Case):
    def test_formats_are_whole_alike_and_marked(self):
        self.run_to("rig.h5", "rig.yaml")
        for ending, first in (("svg", b"<?xml"), ("pdf", b"%PDF-"), ("png", b"\x89PNG")):
            file = self.folder / f"rig.{ending}"
            told = self.bbsim("plot", "rig.h5", "--format", ending).stderr
            self.assertEqual(told, f"rig.{ending}: 2001 rows, 7 panels\n")
            before = file.read_bytes()
            self.assertTrue(before.startswith(first))
            self.assertEqual(self.bbsim("-q", "plot", "rig.h5", "--format", ending).stderr, "")  # replaces its like
            self.assertEqual(file.read_bytes(), before)
        self.assertIn(">friction demand", (self.folder / "rig.svg").read_text())  # texts, not outlines
        self.assertIn(b"/ToUnicode", (self.folder / "rig.pdf").read_bytes())
        self.assertEqual(sorted(os.listdir(self.folder)), ["rig.h5", "rig.pdf", "rig.png", "rig.svg"])
        (self.folder / "rig.svg").write_text("mine")
        self.refused("rig.h5", message="--force")
        self.bbsim("plot", "rig.h5", "--force", "--width", "88 mm", "--font", "DejaVu Serif")
        self.assertIn("DejaVu Serif", (self.folder / "rig.svg").read_text())

    def test_streams(self):
        self.run_to("a.csv", "beam.yaml")
        with open(self.folder / "a.csv") as csv:
            made = self.bbsim("plot", "-", "-o", "-", stdin=csv)
        ElementTree.fromstring(made.stdout)
        self.assertEqual(made.stderr, "")
        both = self.bbsim("plot", "a.csv", "--overlay", "a.csv", "--columns", "x")
        self.assertIn("a-overlay.svg: 602 rows, 1 panel\n", both.stderr)

    def test_accuracy(self):
        self.bbsim("plot", CONFIGS / "beam.yaml", "--accuracy", "--set", "time.end=0.5", "--csv", "points.csv")
        self.assertTrue((self.folder / "beam-accuracy.svg").exists())
        self.assertIn("\nradau,", (self.folder / "points.csv").read_text())

    def test_loops(self):
        self.bbsim("plot", CONFIGS / "rig.yaml", "--bode", "--csv", "bode.csv")
        self.assertTrue((self.folder / "rig-bode.svg").exists())
        self.assertTrue((self.folder / "bode.csv").read_text().startswith("frequency,phi_gain,phi_phase,theta_gain,theta_phase"))
        self.bbsim("plot", CONFIGS / "fig2b.yaml", "--root-locus", "controller.pd.kv.0.0=0.2:2", "-o", "locus.pdf")
        self.refused(CONFIGS / "rig.yaml", "--bode", "--poles", message="found --bode and --poles; allowed: one picture")
        self.refused(CONFIGS / "rig.yaml", "--root-locus", "gravity", message="--root-locus: found gravity; allowed: KEY=FROM:TO")
        self.refused(CONFIGS / "rig.yaml", "--root-locus", "title=1:2", message="title")
        self.refused(CONFIGS / "fig2a.yaml", "--bode", message="the scenario has no controller")

    def test_what_cannot_be_drawn(self):
        files = {
            "run.csv": "t,x,y,phi\n0,1,2,3\n1,2,3,4\n", "beam.csv": "t,x\n0,1\n1,2\n", "empty.csv": "",
            "sweep.csv": "case,ball.radius,status,end_time,end_x\n0,1,done,1,1\n1,2,done,1,2\n",
        }  # fmt: skip
        for name, text in files.items():
            (self.folder / name).write_text(text)
        self.refused("none.csv", message="cannot read none.csv: no such file")
        self.refused("empty.csv", message="empty.csv:1:1: found no header")
        self.refused(CONFIGS / "rig.yaml", message="is a scenario")
        self.refused("run.csv", "-o", "a.gif", message="--output: found a.gif; allowed: a name that ends in .svg")
        self.refused("run.csv", "beam.csv", "-o", "a.svg", message="--overlay")
        self.refused("run.csv", "--columns", "phii", message="--columns: found phii; did you mean phi?")
        self.refused("run.csv", "--columns", "x,phi;t", message="--columns: found t")
        self.refused("beam.csv", "--columns", "path", message="no numbers x and y")
        self.refused("run.csv", "--over", "x", message="--over: run.csv is not a sweep")
        self.refused("sweep.csv", "run.csv", "--overlay", message="a sweep has")
        self.refused("sweep.csv", "--columns", "y", message="measures of sweep.csv: end_x")
        self.refused("sweep.csv", "--over", "gravity", message="what varies: ball.radius")
        self.refused("-", message="--output: missing")
        self.refused("run.csv", "--set", "gravity=9", message="--scenario")
        self.refused("run.csv", "--width", "3 m", message="--width: found 3 m; allowed: a length from 50 mm")
        self.refused("run.csv", "--font", "No Such Font", message="--font: found No Such Font")
        self.refused("run.csv", "--csv", "x.csv", message="--csv: allowed with the pictures of a scenario")
        self.refused("run.csv", "--time-offset", "auto", message="--time-offset")
        # No picture overwrites an input, what describes it, or another picture.
        self.run_to("held.csv", "hold.yaml", "--summary", self.folder / "held.json")
        (self.folder / "held.svg").symlink_to("held.json")
        self.refused("held.csv", message="held.json (the summary of held.csv), which is read here")
        self.refused("run.csv", "--summary", "run.csv", message="run.csv: is not a summary")
        self.refused("run.csv", "-o", "run.csv", "--format", "svg", message="it is the same file as run.csv (what is drawn)")
        self.refused("run.csv", "./run.csv", message="which is written here, too")
        # Other files are still drawn.
        self.refused("none.csv", "beam.csv", message="beam.svg: 2 rows")

    def test_mistakes_on_the_command_line(self):
        self.program_refuses("run.csv", "--colums", "x", message="unknown option --colums of bbsim plot; did you mean --columns?")
        self.program_refuses("run.csv", "--format", "gif", message="gif not in {svg,png,pdf}")
        self.program_refuses(message="FILES is required")
        # The wheel has no program: Python reads the words itself.
        nothing = "found nothing; allowed: a value, or leave the option out"
        for refused in (self.program_refuses, self.refused):
            refused("run.csv", "--font", "", message=nothing)
        self.refused("a.csv", "--colums", "x", message="unknown option --colums of bbsim plot; did you mean --columns?")
        self.refused("a.csv", "--width", message="expected one argument")

    def test_what_cannot_be_written(self):
        (self.folder / "run.csv").write_text("t,x\n0,1\n1,2\n")
        self.bbsim("plot", "run.csv", "-o", "none/a.svg", code=3)
        made = self.bbsim("plot", "run.csv", "-o", "/dev/full", "--format", "svg", code=3)
        self.assertIn("/dev/full", made.stderr)
        self.assertEqual(os.listdir(self.folder), ["run.csv"])

    def test_without_the_package(self):
        alone = self.folder / "bin"
        alone.mkdir()
        os.link(PROGRAM, alone / "bbsim") if os.stat(PROGRAM).st_dev == os.stat(alone).st_dev else (
            (alone / "bbsim").write_bytes(Path(PROGRAM).read_bytes()), (alone / "bbsim").chmod(0o755))  # fmt: skip
        made = subprocess.run([alone / "bbsim", "plot", "run.csv"], capture_output=True, text=True)
        self.assertEqual(made.returncode, 2)
        self.assertEqual(made.stderr.count("\n"), 1)
        self.assertIn("apt install python3-numpy python3-scipy python3-matplotlib; bbsim replay draws without it", made.stderr)
        (self.folder / "matplotlib.py").write_text("raise ImportError('No module named matplotlib')")
        (self.folder / "run.csv").write_text("t,x\n0,1\n1,2\n")
        made = self.bbsim("plot", "run.csv", code=2, env={**os.environ, "PYTHONPATH": str(self.folder)})
        self.assertEqual(made.stderr.count("\n"), 1)
        self.assertIn("apt install python3-numpy python3-scipy python3-matplotlib", made.stderr)

    def test_a_moved_prefix(self):
        for component in ("program", "python"):
            subprocess.run(
                ["cmake", "--install", BUILD, "--prefix", self.folder / "first", "--component", component],
                check=True, capture_output=True,
            )  # fmt: skip
        (self.folder / "first").rename(self.folder / "moved")
        self.run_to("rig.h5", "rig.yaml")
        alone = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "BBSIM"))}
        words = [self.folder / "moved/bin/bbsim", "plot", "rig.h5"]
        made = subprocess.run(words, cwd=self.folder, env=alone, capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stderr), (0, "rig.svg: 2001 rows, 7 panels\n"))

    def test_an_interrupt(self):
        os.mkfifo(self.folder / "slow.csv")
        plot = subprocess.Popen([PROGRAM, "plot", "slow.csv", "-o", "a.svg"], cwd=self.folder, stderr=subprocess.PIPE)
        time.sleep(1.0)
        plot.send_signal(signal.SIGINT)
        _, said = plot.communicate(timeout=60)
        self.assertEqual(plot.returncode, 130, said)
        self.assertEqual(os.listdir(self.folder), ["slow.csv"])


if __name__ == "__main__":
    unittest.main()
