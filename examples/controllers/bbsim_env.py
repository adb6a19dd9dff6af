#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""A ball on a plate as a Gymnasium-style environment: reset() and step() of bbsim's runs.

    from bbsim_env import BallOnPlate

    env = BallOnPlate("examples/controllers/python.yaml")
    observation, info = env.reset()
    done = False
    while not done:
        action = [0.0, 0.0]  # commands for phi and theta, rad
        observation, reward, terminated, truncated, info = env.step(action)
        done = terminated or truncated
    env.close()

The scenario can be any whose controller is a program: the environment replaces that program, and
simulated time waits for the next step(). An episode is a run of bbsim. Needs only Python 3.9 on
Linux; Gymnasium's own classes accept it as it is.
"""
import json
import os
import socket
import subprocess
import sys
import tempfile


class BallOnPlate:
    """An observation is a list of eight numbers in SI units: the ball as last measured (x, y), its
    reference (x, y), and the servos' angles and rates (phi, theta, phi_rate, theta_rate)."""

    observation_size, action_size = 8, 2

    def __init__(self, scenario, overrides=(), bbsim="bbsim", output=None, reward=None,
                 columns=("t", "x", "y", "phi", "theta", "phi_command", "theta_command")):
        """`overrides` are "key.path=value", as after --set; `output` is a CSV or HDF5 file that gets
        each episode in turn, with `columns` (the scenario's own may be those of its program, which
        an environment does not give); `reward(sample, action)` replaces minus the squared distance
        from the reference, m^2."""
        self._scenario = os.fspath(scenario)
        self._overrides = ["output.columns=" + json.dumps(list(columns)), *overrides]
        self._bbsim, self._output = os.fspath(bbsim), output
        self._reward = reward or self.squared_distance
        self._process = None

    @staticmethod
    def squared_distance(sample, _action):
        if sample["ball"] is None:
            return 0.0
        return -sum((a - b) ** 2 for a, b in zip(sample["ball"], sample["reference"]))

    def reset(self, *, seed=None, options=None):
        """Begins an episode. `seed` is the sensor's, for a scenario with noise or dropouts; `options`
        are keys of the scenario with their values, such as {"ball.position": [0.05, 0]}. If bbsim
        refuses, raises RuntimeError with its message."""
        self.close()
        keys = dict(options or {})
        if seed is not None:
            keys["controller.sensor.seed"] = seed
        self._folder = tempfile.TemporaryDirectory(prefix="bbsim-env-")
        place = os.path.join(self._folder.name, "socket")
        keys["controller.program.command"] = [sys.executable, os.path.abspath(__file__), place]
        keys["controller.program.timeout"] = 86400  # a learner may be slow
        keys["controller.program.start_timeout"] = 60
        overrides = self._overrides + [f"{key}={json.dumps(value)}" for key, value in keys.items()]
        words = [self._bbsim, "run", self._scenario, "-q", "-o", self._output or "-"]
        for override in overrides:
            words += ["--set", override]
        self._messages = tempfile.TemporaryFile()
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(place)
            listening.listen()
            listening.settimeout(0.05)
            self._process = subprocess.Popen(words, stdin=subprocess.DEVNULL,
                                             stdout=subprocess.DEVNULL, stderr=self._messages)
            self._line = None
            while self._line is None:
                try:
                    self._line = listening.accept()[0]
                except socket.timeout:
                    if self._process.poll() is not None:
                        self._fail()
        self._line.settimeout(None)
        _, (read_end, write_end), _, _ = socket.recv_fds(self._line, 1, 2)
        self._from_bbsim, self._to_bbsim = open(read_end, "r"), open(write_end, "w")
        self.hello = json.loads(self._from_bbsim.readline())
        self._ball = [0.0, 0.0]
        sample = self._ask({"protocol": 1})
        if sample is None:
            self._process.wait()
            self._fail()
        return self._observe(sample), {"sample": sample}

    def step(self, action):
        """Sends the commands for phi and theta (rad, or rad/s^2 if accelerations are driven), and
        returns (observation, reward, terminated, truncated, info) of the next sample: terminated
        if an event or a failure stopped the run, truncated at its end."""
        if self._process is None:
            raise RuntimeError("step() before reset(), or after the episode's end")
        sample = self._ask({"command": [float(command) for command in action]})
        terminated = truncated = False
        if sample is None:  # the run has ended
            sample = self._sample
            truncated = self._end() == 0
            terminated = not truncated
        info = {"sample": sample, "messages": self.messages if terminated else ""}
        return self._observe(sample), self._reward(sample, action), terminated, truncated, info

    def close(self):
        """Ends the episode at any point."""
        if self._process is not None:
            self._process.terminate()
            self._end()

    def _ask(self, answer):
        try:
            self._to_bbsim.write(json.dumps(answer) + "\n")
            self._to_bbsim.flush()
            line = self._from_bbsim.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            return None
        self._sample = json.loads(line)
        return self._sample

    def _observe(self, sample):
        if sample["ball"] is not None:
            self._ball = sample["ball"]
        return [*self._ball, *sample["reference"], *sample["servo"], *sample["servo_rate"]]

    def _end(self):
        """Waits until bbsim ends; returns its exit code."""
        for end in (self._line, self._to_bbsim, self._from_bbsim):
            try:
                end.close()
            except BrokenPipeError:
                pass
        code = self._process.wait()
        self._read_messages()
        self._process = None
        return code

    def _read_messages(self):
        self._messages.seek(0)
        self.messages = self._messages.read().decode(errors="replace")
        self._messages.close()
        self._folder.cleanup()

    def _fail(self):
        self._read_messages()
        self._process = None
        raise RuntimeError("bbsim: " + self.messages.strip())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def hand_over(place):
    """Runs as bbsim's program: passes its pipes to the environment, and waits until that ends."""
    with socket.socket(socket.AF_UNIX) as line:
        line.connect(place)
        socket.send_fds(line, [b"."], [0, 1])
        line.recv(1)


if __name__ == "__main__":
    hand_over(sys.argv[1])
