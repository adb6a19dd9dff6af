#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Samples per second of processor time of bbsim.VectorEnv on configs/rig.yaml, in SIMD lanes and as single runs.

    PYTHONPATH=build/release/python python3 bench/environments.py configs/rig.yaml
"""
import argparse
import time

import numpy as np

import bbsim

FALLING = {"ball.position.0": (0.03, 0.07), "gimbal.servo.natural_frequency": (25, 38)}  # m, rad/s
# Runs with this many samples are single runs, not in lanes; their start is the same.
SINGLE = {"time.end": 1e4}


def pd(observations, memory):
    """Approximately the law of the scenario, clipped to the space of actions."""
    ball = observations[:, :2]
    last, velocity = memory or (ball, np.zeros(ball.shape))
    velocity = 0.6 * velocity + 0.4 * (ball - last) / 0.02
    memory[:] = ball.copy(), velocity
    wanted = (10 * (observations[:, 3:5] - ball) + 8 * (observations[:, 5:7] - velocity)) / 7
    return np.clip(wanted * (1, -1), -0.2, 0.2)


def rate(scenario, n, steps, settings, falls):
    """Samples per second, and the share of samples that ended an episode."""
    envs = bbsim.VectorEnv(scenario, n, FALLING if falls else None, set=settings)
    observations, _ = envs.reset(seed=1)
    tilts = np.random.default_rng(1).uniform(-0.1, 0.1, (n, 2))
    memory, spent, ends = [], 0.0, 0
    for _ in range(steps):
        actions = tilts if falls else pd(observations, memory)
        began = time.process_time()
        observations, _, terminated, truncated, _ = envs.step(actions)
        spent += time.process_time() - began
        ends += (terminated | truncated).sum()
    return n * steps / spent, ends / (n * steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    parser.add_argument("-n", type=int, default=1024)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    for name, falls in (("balancing", False), ("falling", True)):
        rounds = []
        for _ in range(given.rounds):  # take turns, so that other load affects both alike
            lanes, ends = rate(given.scenario, given.n, given.steps, None, falls)
            single, _ = rate(given.scenario, given.n, given.steps, SINGLE, falls)
            rounds.append((lanes, single, lanes / single))
        lanes, single, factor = np.median(rounds, axis=0)
        said = f", an episode has {1 / ends:.0f} samples" if ends else ""
        print(f"{name}: {lanes:,.0f} samples/s in lanes, {single:,.0f} singly, x{factor:.1f}{said}")


if __name__ == "__main__":
    main()
