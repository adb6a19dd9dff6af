#!/usr/bin/env python3
"""A controller for bbsim, with a PID for each axis. It moves the ball of the example "step" to its reference:

    bbsim examples step
    bbsim run step.yaml --set controller.pid=null --set "controller.program.command=[python3, controller.py]"

`bbsim check`, with the same --set, says where its commands drive the ball. docs/reference/controllers.md says what
bbsim sends and which answers it expects.
"""
import json
import sys

KP, KI, KD = 0.7, 0.35, 0.6  # rad/m, rad/(m s), rad s/m
FILTER = 0.04  # s, of the velocity
LIMIT = 0.2  # rad


class Axis:
    def __init__(self):
        self.last = None
        self.velocity = self.integral = 0.0

    def command(self, position, reference, dt):
        """The tilt, in rad, that drives the ball from its position to the reference, in m."""
        if self.last is not None:
            self.velocity += dt / (FILTER + dt) * ((position - self.last) / dt - self.velocity)
        self.last = position
        error = reference - position
        tilt = KP * error + self.integral - KD * self.velocity
        if abs(tilt) < LIMIT:  # else the integral would wind up
            self.integral += KI * error * dt
        return max(-LIMIT, min(LIMIT, tilt))


for line in sys.stdin:
    message = json.loads(line)
    if "protocol" in message:  # a run begins
        period = message["period"]  # s
        x, y = Axis(), Axis()
        command = [0.0, 0.0]
        answer = {"protocol": 1, "reset": True}
    else:  # a sample
        if message["ball"] is not None:  # else the sensor missed it: hold the command
            (ball_x, ball_y), (reference_x, reference_y) = message["ball"], message["reference"]
            # Positive phi drives the ball towards +x, positive theta towards -y.
            command = [x.command(ball_x, reference_x, period), -y.command(ball_y, reference_y, period)]
        answer = {"command": command}
    print(json.dumps(answer), flush=True)  # bbsim waits for each line
