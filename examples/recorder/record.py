#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Records the motion of a sketch of `bbsim design --sketch`, for `bbsim fit`.

    record.py serial /dev/ttyACM0 -o log.csv
    record.py camera 0 --serial /dev/ttyACM0 --plate 300x300 --radius 20 \\
        --corners 102,415 548,409 541,58 110,63 --camera-at=0,0,700 -o log.csv

`serial` takes the ball from the sketch, which reads a touch screen. `camera` finds the ball in
pictures, and puts them on the sketch's clock; it needs OpenCV. docs/how-to/design.md has more.
Exit codes: 0 done, 1 ended early, 2 wrong arguments, 3 the output cannot be written, 130 Ctrl-C.
After 1 and 130, the log has the rows so far.
"""
import argparse
import sys
import threading

import sketch_log
from sketch_log import ANGLES, BALL, CLOCK, Listener, Log, Problem, SerialLine, check_output, write_whole

quiet = False


def say(text):
    if not quiet:
        print("record: " + text, file=sys.stderr, flush=True)


def count(number, thing):
    return f"{number} {thing}" + ("" if number == 1 else "s")


def verdict(end, log, device):
    """The exit code, and what to say about the end; raises if there is no row."""
    if not log.rows:
        texts = {
            "silent": f"found no log on {device}; is the sketch on the board, with --baud of its Serial.begin?",
            "headless": f"found rows without a header that has {CLOCK} and the sketch's columns: reset the board while "
                        "the recorder waits",
            "unplugged": f"{device} was unplugged before the first row",
            "interrupted": "interrupted before the first row",
        }
        raise Problem(130 if end == "interrupted" else 1, texts.get(end, "found no valid row") + "; nothing is written")
    if end == "interrupted":
        return 130, "interrupted"
    if end == "unplugged":
        return 1, f"{device} was unplugged"
    if not log.ends_level():
        return 1, f"the sketch fell silent {log.rows[-1].t:.2f} s into its motion, before the plate was level again"
    return 0, "the sketch is done"


def describe(log):
    text = f"{count(len(log.rows), 'row')}, {log.rows[0].t:.2f} to {log.rows[-1].t:.2f} s"
    if log.damaged:
        text += f"; {count(log.damaged, 'damaged line')} left out"
    if log.missing:
        text += f"; {count(log.missing, 'row')} missing by the clock"
    return text


def record_serial(arguments):
    needs = (CLOCK, *ANGLES, *BALL)
    line = SerialLine(arguments.device, arguments.baud)
    listener = Listener(line, arguments.wait, arguments.silence, needs, say)
    say(f"waiting for the sketch on {arguments.device}; Ctrl-C ends, and keeps the rows so far")
    try:
        listener.run()
    except KeyboardInterrupt:
        listener.end = "interrupted"
    finally:
        line.close()
    log = Log(listener.lines, needs)
    code, why = verdict(listener.end, log, arguments.device)
    write_whole(arguments.output, log.names, [row.fields for row in log.rows])
    say(f"{why}; {arguments.output}: {describe(log)}")
    return code


def record_camera(arguments, frames=None):
    """`frames` gives (s, picture) in place of the camera or video."""
    try:
        import camera
    except ImportError:
        raise Problem(2, "camera: found no numpy; install OpenCV, which brings it: apt install python3-opencv, or "
                      "pip install opencv-python") from None
    frames = frames or camera.frames(arguments.source)
    if arguments.picture:
        camera.save_picture(frames, arguments.picture)
        say(f"{arguments.picture}: a picture; read the corners' pixels from it")
        return 0
    watcher = camera.Watcher(arguments)
    needs = (CLOCK, *ANGLES)
    if arguments.log:
        log, code, why = camera.read_log(arguments.log, needs), 0, "the video is over"
        try:
            watcher.watch(frames, lambda: False)
        except KeyboardInterrupt:
            code, why = 130, "interrupted"
        moments = [arguments.first_frame / 1000 + t for t in watcher.times]
    else:
        line = SerialLine(arguments.serial, arguments.baud)
        listener = Listener(line, arguments.wait, arguments.silence, needs, say)
        thread = threading.Thread(target=listener.run, daemon=True)
        say(f"waiting for the sketch on {arguments.serial}; Ctrl-C ends, and keeps what there is")
        interrupted = False
        try:
            thread.start()
            watcher.watch(frames, lambda: not thread.is_alive())
        except KeyboardInterrupt:
            interrupted = True
        finally:
            listener.stop.set()
            thread.join()
            line.close()
        log = Log(listener.lines, needs)
        end = "interrupted" if interrupted else listener.end or "unplugged"
        code, why = verdict(end, log, arguments.serial if listener.end else "the camera")
        clock = camera.Clock(log.rows, arguments.baud)
        moments = [clock.board(t - arguments.latency / 1000) for t in watcher.times]
        say(clock.text())
    found, rows = watcher.merge(log, moments)
    if found == 0:
        raise Problem(1, f"found the ball in none of {count(len(moments), 'picture')}; nothing is written: --ball, --radius and "
                      "--corners have to be those of the rig")
    write_whole(arguments.output, (CLOCK, *ANGLES, *BALL), rows)
    say(f"{why}; {arguments.output}: {describe(log)}; the ball in {found} of "
        f"{count(watcher.within(log, moments), 'picture')}")
    if watcher.slow:
        say(f"{count(watcher.slow, 'picture')} took longer to process than the time between pictures: their times may be late; "
            "choose a smaller picture or fewer frames per second")
    return code


def numbers(how_many, separator=","):
    def convert(text):
        parts = [float(part) for part in text.split(separator)]
        if len(parts) != how_many:
            raise ValueError
        return parts
    convert.__name__ = f"{how_many} numbers with '{separator}' between them"
    return convert


def positive(text):
    number = float(text)
    if not 0 < number < float("inf"):
        raise ValueError
    return number


def parser():
    top = argparse.ArgumentParser(prog="record.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = top.add_subparsers(dest="command", required=True)
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("-o", "--output", default="log.csv", metavar="FILE", help="the log (default: %(default)s)")
    common.add_argument("--force", action="store_true", help="replace FILE if it exists")
    common.add_argument("--baud", type=int, default=115200, help="bits per second (default: %(default)s, the sketch's)")
    common.add_argument("--wait", type=positive, default=60, metavar="S", help="how long to wait for the first row (default: %(default)s)")
    common.add_argument("--silence", type=positive, default=2, metavar="S",
                        help="how long a silence ends the recording (default: %(default)s)")
    common.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    serial = commands.add_parser("serial", parents=[common], help="the ball as the sketch reads it")
    serial.add_argument("device", metavar="DEVICE", help="such as /dev/ttyACM0")
    view = commands.add_parser("camera", parents=[common], help="the ball as a camera sees it; lengths in mm")
    view.add_argument("source", metavar="SOURCE", help="a camera's number or device, or a video")
    line = view.add_mutually_exclusive_group()
    line.add_argument("--serial", metavar="DEVICE", help="the sketch's line, while the camera runs")
    line.add_argument("--log", metavar="FILE", help="for a video: the log that `record.py serial` wrote meanwhile")
    view.add_argument("--first-frame", type=float, metavar="MS",
                      help="for a video: the sketch's t_ms at its first frame; negative if the video began before")
    view.add_argument("--plate", type=numbers(2, "x"), metavar="XxY", help="the plate's sides, or the distances of the markers")
    view.add_argument("--radius", type=positive, metavar="MM", help="the ball's radius")
    view.add_argument("--ball", default="dark", metavar="LOOK", help="the ball: dark (default), light, or a color as R,G,B")
    where = view.add_mutually_exclusive_group()
    where.add_argument("--corners", nargs=4, type=numbers(2), metavar="U,V",
                       help="pixels of the level plate's corners: (-x, -y), (+x, -y), (+x, +y), (-x, +y)")
    where.add_argument("--markers", type=numbers(4), metavar="ID,ID,ID,ID",
                       help="ArUco markers with their centers at these corners; they also show the tilt")
    view.add_argument("--dictionary", default="4X4_50", help="the markers' dictionary (default: %(default)s)")
    view.add_argument("--camera-at", type=numbers(3), metavar="X,Y,Z",
                      help="the camera's place, from the center of the level plate's surface, along its axes and up, "
                           "after a = sign; without it, the ball's height and the tilt are ignored")
    view.add_argument("--height", type=float, default=0, metavar="MM",
                      help="height of the plate's surface above the gimbal's center (default: 0)")
    view.add_argument("--lag", type=float, default=0, metavar="MS", help="time from the sketch's angles to the plate's (default: 0)")
    view.add_argument("--latency", type=float, default=0, metavar="MS", help="time from exposure to arrival of a picture (default: 0)")
    view.add_argument("--picture", metavar="FILE.png", help="write one picture, to read the corners from, and stop")
    return top


def main(words=None, frames=None):
    global quiet
    options = parser()
    arguments = options.parse_args(words)
    quiet = arguments.quiet
    if arguments.command == "camera" and not arguments.picture:
        missing = [name for name, value in (("--plate", arguments.plate), ("--radius", arguments.radius),
                                            ("--corners or --markers", arguments.corners or arguments.markers),
                                            ("--serial or --log", arguments.serial or arguments.log)) if value is None]
        if missing:
            options.error("camera needs " + ", ".join(missing))
        if arguments.log and arguments.first_frame is None:
            options.error("--log needs --first-frame, the sketch's t_ms at the video's first frame")
    try:
        if arguments.command == "serial":
            check_output(arguments.output, arguments.force)
            return record_serial(arguments)
        if not arguments.picture:
            check_output(arguments.output, arguments.force)
        return record_camera(arguments, frames)
    except Problem as problem:
        print("record: " + str(problem), file=sys.stderr)
        return problem.code
    except KeyboardInterrupt:
        print("record: interrupted; nothing is written", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
