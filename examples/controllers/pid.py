#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The built-in PID of bbsim, as a program: python.yaml runs it.

    bbsim run examples/controllers/python.yaml

gives the results of configs/step.yaml bit for bit. Needs only Python's standard library.
"""
import json
import sys


class Axis:
    """One coordinate of the ball: velocity from filtered differences, and the integral part of the command."""

    def __init__(self, hello):
        gains = hello["parameters"]
        self.kp, self.kv, self.ki = gains["kp"], gains["kv"], gains["ki"]
        self.filter = hello["derivative_filter"]
        self.limit = hello["limit"] or float("inf")  # null: none
        self.position = None  # not measured yet
        self.velocity = self.integral = 0.0

    def command(self, seen, reference, reference_rate, elapsed):
        keep = self.filter / (self.filter + elapsed)
        difference = 0.0 if self.position is None else (seen - self.position) / elapsed
        self.velocity = keep * self.velocity + (1 - keep) * difference
        self.position = seen
        error = reference - seen
        before = self.law(error, reference_rate)
        # The integral waits while the command is at its limit and the error drives it outward.
        if not (abs(before) >= self.limit and self.ki * error * before > 0):
            self.integral += elapsed * (self.ki * error)
        return self.law(error, reference_rate)

    def law(self, error, reference_rate):
        return self.kp * error + self.kv * (reference_rate - self.velocity) + self.integral


def main():
    for line in sys.stdin:
        message = json.loads(line)
        if "protocol" in message:  # a run begins
            period = message["period"]
            x, y = Axis(message), Axis(message)
            periods = 1  # since the last measured position
            command = [0.0, 0.0]
            answer = {
                "protocol": 1,
                "reset": True,
                "columns": {"x_integral": "rad", "y_integral": "rad"},
                "fields": ["ball", "reference", "reference_rate"],
            }
        else:
            if message["ball"] is None:  # the sensor missed the ball: hold the command
                if x.position is not None:
                    periods += 1
            else:
                (ball_x, ball_y), (x_d, y_d) = message["ball"], message["reference"]
                x_rate, y_rate = message["reference_rate"]
                elapsed = periods * period
                # Positive phi drives the ball towards +x, positive theta towards -y.
                command = [x.command(ball_x, x_d, x_rate, elapsed), 0 - y.command(ball_y, y_d, y_rate, elapsed)]
                periods = 1
            answer = {"command": command, "x_integral": x.integral, "y_integral": y.integral}
        print(json.dumps(answer), flush=True)


main()
