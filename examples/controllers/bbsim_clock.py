# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Simulated time for a controller in Python that reads a clock. Import it before any module that reads one:

    import bbsim_clock               # time.time, monotonic, perf_counter and sleep now use simulated time
    ...
    bbsim_clock.now = message["t"]   # at each sample
"""
import time

now = 0.0  # s


def sleep(seconds):
    """Takes no real time, and does not delay the next sample."""
    global now
    now += seconds


time.time = time.monotonic = time.perf_counter = lambda: now
time.time_ns = time.monotonic_ns = time.perf_counter_ns = lambda: round(now * 1e9)
time.sleep = sleep
