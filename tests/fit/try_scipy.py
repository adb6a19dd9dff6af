# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the optimum of `bbsim fit` with that of SciPy's least_squares, which only sees runs.

Four logs of 2 s are four windows. SciPy has the keys and the windows' starts as unknowns, side by
side; bbsim eliminates the starts. BBSIM is the program; needs the Python package, numpy and SciPy.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy.optimize import least_squares
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

import bbsim

KEYS = ["ball.inertia_factor", "gimbal.motion.phi.table.scale", "gimbal.motion.phi.table.offset"]
LOGS, ROWS, STEP = 4, 41, 0.05

# Run errors should be far below 1e-6 of a standard deviation, which is about 1e-3 here.
SOLVER = {"rtol": 1e-12, "atol": 1e-14}


def scenario(log, values, start):
    """The assumed rig, which plays a log."""
    table = {"file": str(log), "time": "t"}
    return {
        "ball": {"radius": 0.01, "inertia_factor": float(values[0]),
                 "position": [float(v) for v in start[:2]], "velocity": [float(v) for v in start[2:]]},
        "gimbal": {"motion": {
            "phi": {"table": {**table, "value": "phi", "scale": float(values[1]), "offset": float(values[2])}},
            "theta": {"table": {**table, "value": "theta"}}}},
        "solver": SOLVER,
        "time": {"end": (ROWS - 1) * STEP, "step": STEP},
        "output": {"columns": ["t", "x", "y"]},
    }


def write_logs(folder):
    """Noisy logs of a rig with other values; each ball starts elsewhere."""
    random = np.random.default_rng(1)
    t = STEP * np.arange(ROWS)
    files, measured = [], []
    for i in range(LOGS):
        phi = np.radians(3 * np.cos(5.3 * t + i) + 2 * np.cos(2.9 * t))
        theta = np.radians(3 * np.cos(4.1 * t - i) + 2 * np.cos(7.7 * t))
        file = folder / f"log{i}.csv"
        np.savetxt(file, np.column_stack([t, phi, theta]), "%.17g", ",", header="t,phi,theta", comments="")
        start = [0.02, -0.01 * i, 0.01 * i, 0.03]
        run = bbsim.run(scenario(file, [0.43, 1.1, 0.01], start))
        x, y = (np.array(run[name]) + random.normal(0, sd, ROWS) for name, sd in (("x", 5e-4), ("y", 8e-4)))
        np.savetxt(file, np.column_stack([t, phi, theta, x, y]), "%.17g", ",", header="t,phi,theta,x,y", comments="")
        files.append(file)
        measured.append(np.concatenate([x, y]))
    return files, measured


def fitted(folder, files):
    """Estimates and standard deviations from bbsim."""
    table = "{{table: {{file: log0.csv, time: t, value: {0}}}}}"
    (folder / "rig.yaml").write_text(
        "ball: {radius: 0.01}\n"
        f"gimbal: {{motion: {{phi: {table.format('phi')}, theta: {table.format('theta')}}}}}\n"
        f"solver: {json.dumps(SOLVER)}\n"
        f"time: {{end: {(ROWS - 1) * STEP}, step: {STEP}}}\n")
    words = [os.environ["BBSIM"], "fit", str(folder / "rig.yaml"), *map(str, files), "--json", "-", "-q"]
    for key in KEYS:
        words += ["--free", key]
    made = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    parameters = {one["key"]: one for one in made["parameters"]}
    return tuple(np.array([parameters[key][word] for key in KEYS]) for word in ("estimate", "sd"))


def optimum(files, measured):
    """Estimates and standard deviations from SciPy, with weights updated from the residuals."""
    size = len(KEYS)

    def differences(unknown):
        rows = []
        for i, file in enumerate(files):
            run = bbsim.run(scenario(file, unknown[:size], unknown[size + 4 * i:size + 4 * i + 4]))
            rows.append(np.concatenate([np.array(run["x"]), np.array(run["y"])]) - measured[i])
        return np.concatenate(rows)

    is_x = np.tile(np.repeat([True, False], ROWS), LOGS)
    unknown = np.concatenate([[0.4, 1, 0]] + [[m[0], m[ROWS], 0, 0] for m in measured])
    noise = np.ones(is_x.size)
    for _ in range(6):
        found = least_squares(lambda u: differences(u) / noise, unknown, jac="3-point", method="trf",
                              x_scale="jac", xtol=1e-13, ftol=1e-15, gtol=1e-15)
        unknown = found.x
        residuals = differences(unknown)
        for mask in (is_x, ~is_x):
            noise[mask] = np.sqrt(np.mean(residuals[mask] ** 2) * is_x.size / (is_x.size - unknown.size))
    jacobian = found.jac
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    return unknown[:size], np.sqrt(np.diag(covariance))[:size]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files, measured = write_logs(folder)
        ours, deviations = fitted(folder, files)
        theirs, others = optimum(files, measured)
    far = np.abs(ours - theirs) / others
    for key, *numbers in zip(KEYS, ours, theirs, far, deviations / others):
        print(f"{key}: bbsim {numbers[0]:.12g}, SciPy {numbers[1]:.12g}, apart {numbers[2]:.2g} sd; "
              f"sd of bbsim over SciPy's {numbers[3]:.6g}")
    assert np.all(far < 1e-6), far
    assert np.all(np.abs(deviations / others - 1) < 1e-3), deviations / others


if __name__ == "__main__":
    main()
