#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Learns to balance the rig of configs/rig.yaml, by the cross-entropy method, with only bbsim and numpy.

    python3 examples/learning/cross_entropy.py configs/rig.yaml

Each generation draws policies around a mean and tries all of them on the same random rigs, at once in a
bbsim.VectorEnv. The best policies give the next mean and spread. At the end, the mean policy and the
scenario's own law, by bbsim.sweep, run on the same rigs, none of them from training.
"""
import argparse
import itertools
import time

import numpy as np

import bbsim

# Unknown properties of a rig: uniform within these bounds.
RIGS = {
    "ball.position.0": (0.03, 0.07),
    "ball.position.1": (-0.02, 0.02),
    "ball.radius": (0.015, 0.025),
    "gimbal.servo.natural_frequency": (2 * np.pi * 4, 2 * np.pi * 6),  # rad/s
    "gimbal.servo.damping": (0.7, 0.9),
    "controller.sampling.delay": (0.005, 0.015),
}
PERIOD = 0.02  # of the controller, s
SCENE = {"time.end": 4, "controller.sampling.period": PERIOD}
FALLEN = 0.1  # m: a ball that fell off counts as this far from its reference
COLUMN = {name: i for i, (name, _, _) in enumerate(bbsim.VectorEnv.observation_columns)}
X, V = (slice(COLUMN[name], COLUMN[name] + 2) for name in ("x_reference", "x_reference_rate"))
SERVO, RATE = (slice(COLUMN[name], COLUMN[name] + 2) for name in ("servo_phi", "servo_phi_rate"))
SIGNS = np.array([1.0, -1.0])  # phi moves the ball along x; minus theta moves it along y


class Policy:
    """A command is a weighted sum of quantities of its axis: the error of the ball's position and
    velocity, the sum of errors, and the servo's angle and rate. Both axes have the same weights."""

    START = np.array([0.5, 0.5, 0.1, 0.5, 0.05])  # the first spread of the weights

    def __init__(self, weights, keep=0.6):
        self.weights = np.atleast_2d(weights)[:, :, None]  # of each rig
        self.keep = keep
        self.reset()

    def reset(self):
        self.last = None

    def __call__(self, observations):
        ball = observations[:, :2]
        if self.last is None:
            self.last, self.velocity, self.sum = ball, np.zeros(ball.shape), np.zeros(ball.shape)
        self.velocity = self.keep * self.velocity + (1 - self.keep) * (ball - self.last) / PERIOD
        self.last = ball.copy()
        error = observations[:, X] - ball
        self.sum = self.sum + PERIOD * error
        known = np.stack(
            [error, observations[:, V] - self.velocity, self.sum, SIGNS * observations[:, SERVO],
             SIGNS * observations[:, RATE]], axis=1)  # fmt: skip
        return SIGNS * (self.weights * known).sum(axis=1)


def costs(envs, policy):
    """The mean squared distance from the reference over an episode of each rig, m^2."""
    observations, _ = envs.reset()
    policy.reset()
    total, steps = np.zeros(envs.num_envs), 0
    over, fallen = np.zeros(envs.num_envs, bool), np.zeros(envs.num_envs, bool)
    while not over.all():
        actions = np.clip(policy(observations), envs.action_space.low, envs.action_space.high)
        observations, rewards, terminated, truncated, _ = envs.step(actions)
        fallen |= terminated & ~over
        total += np.where(fallen, FALLEN**2, np.where(over, 0, -rewards))
        over |= terminated | truncated
        steps += 1
    return total / steps


class Rigs:
    """For VectorEnv's randomize: the rigs of a list, repeated."""

    def __init__(self):
        self.randomize = {key: lambda _, key=key: next(self.values[key]) for key in RIGS}

    def draw(self, random, count):
        drawn = {key: random.uniform(*bounds, count) for key, bounds in RIGS.items()}
        self.values = {key: itertools.cycle(values) for key, values in drawn.items()}
        return drawn


def learn(scenario, *, policies=64, rigs=8, best=8, generations=30, seed=1, said=print):
    """Returns the final weights of the cross-entropy method."""
    random, given = np.random.default_rng(seed), Rigs()
    envs = bbsim.VectorEnv(scenario, policies * rigs, given.randomize, seed, set=SCENE)
    mean, spread = np.zeros(Policy.START.size), Policy.START
    for generation in range(generations):
        drawn = mean + spread * random.standard_normal((policies, mean.size))
        given.draw(random, rigs)  # the same for each policy
        cost = costs(envs, Policy(np.repeat(drawn, rigs, axis=0))).reshape(policies, rigs).mean(axis=1)
        elite = drawn[np.argsort(cost)[:best]]
        mean, spread = elite.mean(axis=0), elite.std(axis=0) + 0.05 * Policy.START * 0.9**generation
        if generation % 5 == 4:
            said(f"generation {generation + 1}: {1e6 * np.median(cost):.1f} mm^2 in the median")
    return mean


def compared(scenario, weights, *, rigs=256, seed=1000):
    """The mean squared tracking error (mm^2) of the policy and of the scenario's own law on the same rigs."""
    random, given = np.random.default_rng(seed), Rigs()
    drawn = given.draw(random, rigs)
    columns = ["x", "y", "x_reference", "y_reference"]
    its = {**SCENE, "output.columns": columns}
    envs = bbsim.VectorEnv(scenario, rigs, given.randomize, seed, set=its, record=True)
    costs(envs, Policy(weights))
    learned = []
    for result in map(envs.result, range(rigs)):
        x, y, x_reference, y_reference = map(result.__getitem__, columns)
        error = (x - x_reference) ** 2 + (y - y_reference) ** 2
        learned.append(error.mean() if result.status == "done" else FALLEN**2)
    drawn["controller.sensor.seed"] = random.integers(2**31, size=rigs)
    table = bbsim.sweep(scenario, drawn, "rms_tracking_error", set=its, combine="zip")
    built_in = np.where(table["status"] == "done", table["rms_tracking_error"], FALLEN) ** 2
    return 1e6 * np.mean(learned), 1e6 * np.mean(built_in)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", help="a rig with a controller that takes samples, such as configs/rig.yaml")
    parser.add_argument("--generations", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    began = time.perf_counter()
    weights = learn(given.scenario, generations=given.generations, seed=given.seed)
    print(f"learned in {time.perf_counter() - began:.1f} s:", np.array2string(weights, precision=3))
    learned, built_in = compared(given.scenario, weights)
    print(f"mean squared error on 256 other rigs: {learned:.2f} mm^2; by the scenario's law: {built_in:.2f} mm^2")


if __name__ == "__main__":
    main()
