# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Watches the ball and sends two angles of servos, "x,y" in degrees, to servos.ino: a PD law on the PC."""
import pathlib
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import bbsim_serial as serial

board = serial.Serial("/dev/ttyACM0", 115200, timeout=0.1)
kp = serial.parameters.get("kp", 30)  # degrees per m
kd = serial.parameters.get("kd", 25)  # degrees per m/s

last = None  # time, x, y
while True:
    ball = serial.ball()
    if ball is None:
        continue
    now, (x, y) = time.time(), ball
    vx, vy = ((x - last[1]) / (now - last[0]), (y - last[2]) / (now - last[0])) if last else (0, 0)
    last = now, x, y
    board.write(f"{90 - kp * x - kd * vx:.1f},{90 + kp * y + kd * vy:.1f}\n".encode())
