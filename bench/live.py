# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""How fast live pages answer: python3 bench/live.py BBSIM

Moves a slider of shipped scenarios in a headless Chromium without 3D and without a graphics card, thirty times after as
many to warm up. Prints medians in ms: from the move to the new columns, from there to the picture, and of the program's
own run (processor time). Then draws 100 rigs, and a map of 40 by 40 cells, and prints the times beside the program's
own for the same sweep on one thread.
"""

import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(SOURCE, "tests", "replay", "browser"))
from webdriver import Browser  # noqa: E402: its folder is not a package

BBSIM = os.path.abspath(sys.argv[1])
KEYS = {"fig2a": "gravity", "fig2b": "controller.reference.circle.radius", "step": "ball.radius",
        "rig": "controller.gravity_compensation.kp", "pushrod": "controller.gravity_compensation.kp",
        "three-servos": "ball.radius"}
MOVES = """
const done = arguments[arguments.length - 1], [key] = arguments;
(async () => {
  const {value} = bbsim.data.scene.live.keys.find((one) => one.key === key), times = [];
  let computed;
  const {replace} = bbsim.data;
  bbsim.data.replace = (...scene) => {
    computed = performance.now();
    replace(...scene);
  };
  for (let i = 0; i < 60; ++i) {
    const begun = performance.now();
    await bbsim.live.set(key, value * (1 + 0.002 * (1 + i % 30)));
    times.push([computed - begun, performance.now() - computed]);
  }
  return times.slice(30);
})().then(done, (error) => done(error.message));
"""

# Many runs, after their worker has started.
MANY = """
const done = arguments[arguments.length - 1];
(async () => {
  const gains = ['controller.pd.kp.0.0', 'controller.pd.kv.0.0'], map = () => bbsim.live.map(...gains, 'max_tracking_error', 40);
  const timed = async (what) => {
    const begun = performance.now(), found = await what();
    return [performance.now() - begun, Object.entries(found.keys).map(([key, values]) => [key, [...values]])];
  };
  await bbsim.live.rigs();
  return [await timed(bbsim.live.rigs), await timed(map)];
})().then(done, (error) => done(error.message));
"""


def native_sweep(folder, keys):
    """The program's time for these cases of fig2b, without their rows, ms."""
    vary = [part for key, values in keys for part in ("--vary", f"{key}=list:{','.join(map(repr, values))}")]
    told = subprocess.run([BBSIM, "sweep", os.path.join(SOURCE, "configs", "fig2b.yaml"), *vary, "--combine", "zip",
                           "--threads", "1", "-o", os.path.join(folder, "sweep.csv")],
                          stderr=subprocess.PIPE, check=True, text=True).stderr
    return 1e3 * float(re.search(r", ([0-9.e-]+) s$", told, re.MULTILINE).group(1))


with tempfile.TemporaryDirectory() as folder, Browser(1280, 900, flags=["--disable-gpu"]) as browser:
    print(f"{'scenario':14}{'columns':>10}{'picture':>10}{'program':>10}")
    for name, key in KEYS.items():
        scenario, page, summary = (os.path.join(*path) for path in [
            (SOURCE, "configs", name + ".yaml"), (folder, name + ".html"), (folder, name + ".json")])
        subprocess.run([BBSIM, "replay", scenario, "--live", "-o", page, "-q"], check=True)
        own = []
        for _ in range(9):
            subprocess.run([BBSIM, "run", scenario, "-o", os.path.join(folder, "rows.csv"), "--summary", summary, "-q"],
                           check=True)
            with open(summary, encoding="utf-8") as file:
                own.append(1e3 * json.load(file)["statistics"]["cpu_seconds"])
        browser.open("file://" + page)
        browser.run("bbsim.screen.setFlat(true)")
        times = browser.call("POST", "/execute/async", {"script": MOVES, "args": [key]})
        if isinstance(times, str):
            sys.exit(f"{name}: {times}")
        columns, picture = (statistics.median(column) for column in zip(*times))
        print(f"{name:14}{columns:10.1f}{picture:10.1f}{statistics.median(own):10.2f}")
        if name == "fig2b":
            many = browser.call("POST", "/execute/async", {"script": MANY, "args": []})
    if isinstance(many, str):
        sys.exit(many)
    for label, (took, keys) in zip(["100 rigs", "40 by 40 map"], many):
        print(f"fig2b, {label:17}{took:10.0f}{native_sweep(folder, keys):10.0f}")
