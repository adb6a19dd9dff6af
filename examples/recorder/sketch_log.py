# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the log that a sketch of `bbsim design --sketch` prints from a serial line, and writes its rows to a file.
Needs only Python's standard library, on Linux or macOS."""
import bisect
import collections
import glob
import os
import re
import select
import statistics
import threading
import time

CLOCK, ANGLES, BALL = "t_ms", ("phi_deg", "theta_deg"), ("x_mm", "y_mm")
NUMBER = re.compile(r"-?\d+(\.\d+)?")
Line = collections.namedtuple("Line", "arrival text")  # arrival: s of time.monotonic()
Row = collections.namedtuple("Row", "t arrival fields")  # t: s of the sketch's clock


class Problem(Exception):
    """A problem that the user can fix, with the exit code: 1 the recording failed, 2 the arguments, 3 the output."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


class SerialLine:
    """A serial line, 8 bits, no parity, as bytes."""

    def __init__(self, device, baud):
        import fcntl
        import termios
        import tty

        speed = getattr(termios, f"B{baud}", None)
        if speed is None:
            raise Problem(2, f"--baud: found {baud}; allowed: a usual speed, such as the sketch's 115200")
        try:
            self.file = os.open(device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        except OSError as e:
            there = sorted(p for pattern in ("ttyACM*", "ttyUSB*", "cu.usb*", "cu.wch*") for p in glob.glob("/dev/" + pattern))
            hint = "your user may not open it; on Linux, join its group (dialout)" if isinstance(e, PermissionError) else \
                "serial lines here: " + (", ".join(there) or "none; is the board plugged in?")
            raise Problem(2, f"found {device}: {e.strerror}; {hint}") from None
        try:
            tty.setraw(self.file, termios.TCSANOW)  # no flush: what has arrived may be the log
            mode = termios.tcgetattr(self.file)
            mode[2] |= termios.CLOCAL | termios.CREAD
            mode[4] = mode[5] = speed
            termios.tcsetattr(self.file, termios.TCSANOW, mode)
            fcntl.ioctl(self.file, termios.TIOCEXCL)  # else a serial monitor could take lines away
        except termios.error:
            os.close(self.file)
            raise Problem(2, f"found {device}, which is no serial line; allowed: one such as /dev/ttyACM0") from None

    def read(self, seconds):
        """What arrives within `seconds`; None if nothing does; b"" once the line is gone."""
        if not select.select([self.file], [], [], seconds)[0]:
            return None
        try:
            return os.read(self.file, 4096)
        except BlockingIOError:
            return None
        except OSError:  # unplugged
            return b""

    def close(self):
        os.close(self.file)


class Listener:
    """Collects the lines of a sketch from its first to its last."""

    def __init__(self, line, wait, silence, needs, say):
        self.line, self.wait, self.silence, self.needs, self.say = line, wait, silence, needs, say
        self.lines = []
        self.end = None  # "done", "unplugged", "silent" (nothing came), "headless" (rows without a header)
        self.stop = threading.Event()

    def run(self):
        unread, began, headed, rows = b"", time.monotonic(), False, 0
        last = began
        while not self.stop.is_set() and self.end is None:
            read = self.line.read(0.05)
            now = time.monotonic()
            if read == b"":
                self.end = "unplugged"
            elif read is None:
                if headed and rows > 0 and now - last > self.silence:
                    self.end = "done"
                elif not (headed and rows > 0) and now - began > self.wait:
                    self.end = "silent"
            else:
                last = now
                *whole, unread = (unread + read).split(b"\n")
                for text in whole:
                    line = Line(now, text.decode("ascii", "replace").rstrip("\r"))
                    self.lines.append(line)
                    if is_header(line.text, self.needs):
                        self.say("the motion begins again: the board has restarted" if headed else "the motion begins")
                        headed, rows = True, 0
                    elif numbers_of(line.text):
                        rows += 1
                # Earlier rows may be of a motion that opening the line has just reset.
                if not headed and rows >= 5 and now - began > 1:
                    self.end = "headless"


def is_header(text, needs):
    names = text.split(",")
    return names[0] == CLOCK and len(set(names)) == len(names) and all(n.isidentifier() for n in names) \
        and set(needs) <= set(names)


def numbers_of(text):
    """The fields of a row; None if one is not a number."""
    fields = text.split(",")
    return fields if len(fields) >= 3 and all(NUMBER.fullmatch(f) for f in fields) else None


def increasing(numbers):
    """The places of the longest series that increases."""
    ends, places, before = [], [], []  # for each length: the least last number, and its place
    for i, number in enumerate(numbers):
        length = bisect.bisect_left(ends, number)
        before.append(places[length - 1] if length else None)
        ends[length:length + 1], places[length:length + 1] = [number], [i]
    kept, i = [], places[-1] if places else None
    while i is not None:
        kept.append(i)
        i = before[i]
    return kept[::-1]


class Log:
    """The rows below the last header. A line is damaged if it is not a row of numbers, if its numbers have
    other decimals than most rows, or if its time does not fit between its neighbors'."""

    def __init__(self, lines, needs):
        headers = [i for i, line in enumerate(lines) if is_header(line.text, needs)]
        self.names, self.rows, self.damaged, self.missing = [], [], 0, 0
        if not headers:
            return
        self.names = lines[headers[-1]].text.split(",")
        below = lines[headers[-1] + 1:]
        rows = [(line, fields) for line in below
                if (fields := numbers_of(line.text)) and len(fields) == len(self.names)]

        def decimals(fields):
            return tuple(len(f.partition(".")[2]) for f in fields)

        usual = [collections.Counter(column).most_common(1)[0][0] for column in zip(*(decimals(f) for _, f in rows))]
        rows = [Row(float(fields[0]) / 1000, line.arrival, fields) for line, fields in rows
                if decimals(fields) == tuple(usual)]
        self.rows = [rows[i] for i in increasing([row.t for row in rows])]
        self.damaged = -len(self.rows) + len(below)
        steps = [b.t - a.t for a, b in zip(self.rows, self.rows[1:])]
        if not steps:
            return
        period = statistics.median(steps)
        # No row follows the last one, so only the lines before it can show whether its time is right.
        if steps[-1] > (self.damaged + 10) * period:
            self.rows.pop()
            steps.pop()
            self.damaged += 1
        self.missing = sum(max(0, round(step / period) - 1) for step in steps) + max(0, round(self.rows[0].t / period))

    def angles(self, row):
        return [float(row.fields[self.names.index(name)]) for name in ANGLES]

    def ends_level(self):
        """A designed motion begins and ends with the plate level; the 0.1 deg allow for a lost first row."""
        return bool(self.rows) and all(abs(first - last) < 0.1 for first, last in
                                       zip(self.angles(self.rows[0]), self.angles(self.rows[-1])))


def check_output(path, force):
    """Refuses a file before the recording, not after it."""
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder) or not os.access(folder, os.W_OK):
        raise Problem(3, f"-o: found {path}, whose folder is missing or not writable")
    if os.path.isdir(path):
        raise Problem(2, f"-o: found {path}, which is a folder; allowed: a file")
    if os.path.exists(path) and not force:
        raise Problem(2, f"-o: found {path}, which exists; allowed: another name, or --force to replace it")


def write_whole(path, names, rows):
    """Writes a complete CSV file, or nothing."""
    part = f"{path}.{os.getpid()}.part"
    try:
        with open(part, "x", encoding="ascii", newline="\n") as file:
            file.writelines(",".join(fields) + "\n" for fields in [names, *rows])
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except BaseException as e:
        try:
            os.unlink(part)
        except FileNotFoundError:
            pass
        if isinstance(e, OSError):
            raise Problem(3, f"{path}: could not be written: {e.strerror}") from None
        raise
