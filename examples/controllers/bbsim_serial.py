# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Takes the place of pyserial in a program that reads a camera and writes to a sketch, which bbsim runs
(controller.library.serial). Import it before any module that reads a clock:

    import bbsim_serial as serial            # was: import serial

    board = serial.Serial("/dev/ttyACM0", 115200, timeout=1)
    while True:
        ball = serial.ball()                 # was: a frame of the camera, and where the ball is in it
        if ball is not None:                 # x and y in meters; None: not seen
            board.write(f"{ball[0]:.4f},{ball[1]:.4f}\\n".encode())

Time is simulated. It passes in ball(), in time.sleep(), and while the program waits for bytes; reading a clock takes
20 us. At the end of the run each of these raises SystemExit. What the program prints goes to standard error.
"""
import json
import sys
import time

_stdin, _stdout, sys.stdout = sys.stdin, sys.stdout, sys.stderr
_clock_cost = 20e-6  # s
_most_bytes = 16384  # in an answer

_now = 0.0  # s
_to_send, _received = bytearray(), bytearray()
_answer = {}  # beside the bytes
_fresh = False  # ball() has not yet returned the sample
sample = None  # the newest, as in docs/reference/controllers.md


def _say(message):
    _stdout.write(json.dumps(message) + "\n")
    _stdout.flush()


def _hear():
    line = _stdin.readline()
    if not line:
        raise SystemExit(0)
    return json.loads(line)


hello = _hear()
parameters = hello["parameters"]
_say({"protocol": 1, "fields": ["t", "ball", "reference"]})


def _next_sample():
    """Sends what was written, and lets time pass until the next sample."""
    global sample, _now, _fresh
    if sample is not None:
        _say({"serial": bytes(_to_send[:_most_bytes]).decode("latin-1"), **_answer})
        _answer.clear()
        del _to_send[:_most_bytes]
    sample = _hear()
    _received.extend(sample["serial"].encode("latin-1"))
    _now = max(_now, sample["t"])
    _fresh = True


def _pass_time(seconds):
    global _now
    until = _now + seconds
    while sample is None or until >= sample["t"] + hello["period"]:
        _next_sample()
    _now = max(_now, until)


def _wait(ready, timeout):
    """Lets time pass until ready() holds, or for `timeout` (s); None: without limit."""
    _pass_time(_clock_cost)
    until = None if timeout is None else _now + timeout
    while not ready() and (until is None or sample["t"] + hello["period"] <= until):
        _next_sample()
    if not ready():
        _pass_time(max(until - _now, 0))


def ball():
    """The ball's place (x, y) in the next sample, m; None if the sensor missed it."""
    global _fresh
    if not _fresh:
        _next_sample()
    _fresh = False
    return None if sample["ball"] is None else tuple(sample["ball"])


def reference():
    """Where the ball should be in the newest sample, (x, y), m."""
    if sample is None:
        _next_sample()
    return tuple(sample["reference"])


def _time():
    _pass_time(_clock_cost)
    return _now


time.time = time.monotonic = time.perf_counter = _time
time.time_ns = time.monotonic_ns = time.perf_counter_ns = lambda: round(_time() * 1e9)
time.sleep = _pass_time


class SerialException(IOError):
    pass


class Serial:
    """The line to the sketch, with the methods of pyserial's Serial."""

    def __init__(self, port=None, baudrate=9600, bytesize=8, parity="N", stopbits=1, timeout=None, **_):
        self.port = self.name = port
        self.timeout = timeout
        self.is_open = False
        self.baudrate = baudrate
        if port is not None:
            self.open()

    def open(self):
        self.is_open = True
        _answer["baud"] = self.baudrate

    def close(self):
        self.is_open = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def isOpen(self):
        return self.is_open

    def _require_open(self):
        if not self.is_open:
            raise SerialException("Attempting to use a port that is not open")

    def write(self, data):
        self._require_open()
        if isinstance(data, str):
            raise TypeError("a str has no bytes: encode it, as in write(text.encode())")
        data = bytes(data)
        _to_send.extend(data)
        return len(data)

    def flush(self):
        """Bytes are sent when time passes."""

    @property
    def in_waiting(self):
        self._require_open()
        if not _received:
            _pass_time(_clock_cost)
        return len(_received)

    @property
    def out_waiting(self):
        return len(_to_send)

    def inWaiting(self):
        return self.in_waiting

    def read(self, size=1):
        self._require_open()
        _wait(lambda: len(_received) >= size, self.timeout)
        return self._take(size)

    def read_until(self, expected=b"\n", size=None):
        self._require_open()
        _wait(lambda: expected in _received or (size is not None and len(_received) >= size), self.timeout)
        at = _received.find(expected)
        length = len(_received) if at < 0 else at + len(expected)
        return self._take(length if size is None else min(length, size))

    def readline(self, size=None):
        return self.read_until(b"\n", size)

    def read_all(self):
        return self._take(self.in_waiting)

    def __iter__(self):
        return iter(self.readline, b"")

    def reset_input_buffer(self):
        _received.clear()

    def reset_output_buffer(self):
        _to_send.clear()

    flushInput, flushOutput = reset_input_buffer, reset_output_buffer

    @staticmethod
    def _take(size):
        data = bytes(_received[:size])
        del _received[:size]
        return data
