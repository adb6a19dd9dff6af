#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the environment of examples/controllers/bbsim_env.py. BBSIM names the program."""
import csv
import os
import pathlib
import sys
import tempfile
import unittest

source = pathlib.Path(__file__).resolve().parents[2]
examples = source / "examples" / "controllers"
sys.path.insert(0, str(examples))
from bbsim_env import BallOnPlate  # noqa: E402

bbsim = os.environ["BBSIM"]
scene = examples / "python.yaml"


class Pd:
    """Maps an observation to commands."""

    def __init__(self):
        self.last = None

    def __call__(self, observation):
        ball, wanted = observation[:2], observation[2:4]
        rate = [0, 0] if self.last is None else [(b - l) / 0.02 for b, l in zip(ball, self.last)]
        self.last = ball
        phi, theta = (0.7 * (w - b) - 0.4 * r for b, w, r in zip(ball, wanted, rate))
        return [phi, -theta]


def episode(env, policy, **reset):
    observation, info = env.reset(**reset)
    steps, total, ended = 0, 0.0, False
    while not ended:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        total += reward
        steps += 1
        ended = terminated or truncated
    return steps, total, terminated, observation, info


class Environment(unittest.TestCase):
    def test_an_episode_ends_with_the_run_and_has_its_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            output = os.path.join(folder, "run.csv")
            with BallOnPlate(scene, ["time.end=8"], bbsim, output) as env:
                steps, total, terminated, observation, _ = episode(env, Pd())
                first = pathlib.Path(output).read_bytes()
                episode(env, Pd())
                self.assertEqual(pathlib.Path(output).read_bytes(), first)
            # Samples at 0, 20 ms, ..., 8 s; the episode ends with the command of the last one.
            self.assertEqual((steps, terminated), (401, False))
            self.assertLess(total, 0)
            with open(output, newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(len(rows), 401)
            self.assertAlmostEqual(float(rows[-1]["x"]), observation[0], delta=3e-3)
            # 17.5 mm from its target, because the law has no integral: docs/how-to/real-effects.md.
            self.assertLess(abs(observation[0] - 0.0475), 2e-3)

    def test_an_event_terminates_an_episode(self):
        with BallOnPlate(scene, [], bbsim) as env:
            steps, _, terminated, _, info = episode(env, lambda _: [0.2, 0.0])
            self.assertTrue(terminated)
            self.assertLess(steps, 100)
            self.assertIn("left the plate", info["messages"])
            with self.assertRaises(RuntimeError):
                env.step([0, 0])

    def test_options_are_keys_and_a_seed_is_the_sensors(self):
        noisy = ["time.end=0.1", "controller.sensor.noise=0.001"]
        with BallOnPlate(scene, noisy, bbsim) as env:
            one, _ = env.reset(seed=1, options={"ball.position": [0.05, 0.0]})
            again, _ = env.reset(seed=1, options={"ball.position": [0.05, 0.0]})
            other, _ = env.reset(seed=2, options={"ball.position": [0.05, 0.0]})
        self.assertEqual(one, again)
        self.assertNotEqual(one, other)
        self.assertAlmostEqual(one[0], 0.05, delta=0.01)
        self.assertEqual(len(one), BallOnPlate.observation_size)

    def test_a_reward_may_be_ones_own(self):
        with BallOnPlate(scene, ["time.end=0.1"], bbsim, reward=lambda sample, action: action[0]) as env:
            env.reset()
            self.assertEqual(env.step([0.25, 0])[1], 0.25)

    def test_what_bbsim_refuses_is_told(self):
        with BallOnPlate(scene, ["ball.raduis=1"], bbsim) as env:
            with self.assertRaisesRegex(RuntimeError, "did you mean ball.radius"):
                env.reset()

    def test_an_episode_may_be_left(self):
        env = BallOnPlate(scene, [], bbsim)
        env.reset()
        env.step([0, 0])
        env.close()
        env.close()


if __name__ == "__main__":
    unittest.main()
