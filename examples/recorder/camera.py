# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the ball in a camera's pictures, in the plate's frame and on the sketch's clock. Needs numpy, and
OpenCV for cameras, videos and markers only. Lengths are in mm, as in the log."""
import csv
import math
import time

import numpy as np

from sketch_log import Log, Line, Problem


def opencv():
    try:
        import cv2
    except ImportError:
        raise Problem(2, "camera: found no OpenCV; apt install python3-opencv, or pip install opencv-python") from None
    return cv2


def frames(source):
    """Opens a camera or video; yields (s, picture), with s of time.monotonic() or since the video's start."""
    cv2 = opencv()
    video = not source.isdecimal() and not source.startswith("/dev/")
    capture = cv2.VideoCapture(int(source) if source.isdecimal() else source)
    if not capture.isOpened():
        raise Problem(2, f"found {source}, which OpenCV cannot open; allowed: a camera's number or device, or a video")

    def read():
        try:
            while capture.grab():
                now = capture.get(cv2.CAP_PROP_POS_MSEC) / 1000 if video else time.monotonic()
                whole, picture = capture.retrieve()
                if whole:
                    yield now, picture
        finally:
            capture.release()
    return read()


def save_picture(pictures, path):
    last = None
    for i, (_, last) in enumerate(pictures):
        if i == 10:  # a camera needs some to set its exposure
            break
    if last is None or not opencv().imwrite(path, last):
        raise Problem(3, f"--picture: {path} could not be written")


def read_log(path, needs):
    try:
        with open(path, encoding="ascii", newline="") as file:
            log = Log([Line(0.0, ",".join(fields)) for fields in csv.reader(file)], needs)
    except (OSError, UnicodeError) as e:
        raise Problem(2, f"--log: found {path}: {e}") from None
    if not log.rows:
        raise Problem(2, f"--log: found {path}, which has no rows under {', '.join(needs)}")
    return log


class Clock:
    """The host's time as a function of the sketch's: host = start + rate board. No line arrives before it is
    sent, so this straight line is below all arrivals. Of all such lines, it is the highest at the mean
    time: an edge of the lower convex hull of the arrivals. Late arrivals do not move it."""

    def __init__(self, rows, baud):
        board = np.array([row.t for row in rows])
        # A line's own time on the wire: 8 bits with start and stop, and an end of two characters.
        host = np.array([row.arrival - 10 * (len(",".join(row.fields)) + 2) / baud for row in rows])
        self.rate = self._slope(board, host - host[0])
        if abs(self.rate - 1) > 0.02:  # no resonator is that far off: there are too few lines
            self.rate = 1.0
        late = host - self.rate * board
        self.start = late.min()
        self.spread = np.median(late) - self.start

    @staticmethod
    def _slope(board, host):
        hull = []
        for p in zip(board, host):
            while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (p[0] - hull[-2][0]) >= \
                    (p[1] - hull[-2][1]) * (hull[-1][0] - hull[-2][0]):
                hull.pop()
            hull.append(p)
        mean = board.mean()
        for a, b in zip(hull, hull[1:]):
            if b[0] >= mean:
                return (b[1] - a[1]) / (b[0] - a[0])
        return 1.0

    def board(self, host):
        return (host - self.start) / self.rate

    def text(self):
        return f"the board's clock runs {100 * (1 / self.rate - 1):+.2f} % against this computer's; the median line arrives {1000 * self.spread:.1f} ms " \
            "later than the earliest one"


def homography(plate, pixels):
    """The matrix that maps (x, y, 1) of four places to their pixels."""
    rows, right = [], []
    for (x, y), (u, v) in zip(plate, pixels):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        right += [u, v]
    try:
        return np.append(np.linalg.solve(rows, right), 1).reshape(3, 3)
    except np.linalg.LinAlgError:
        raise Problem(2, "--corners: found three of the four on one line; allowed: the corners of the plate") from None


def rotation(phi, theta):
    """From the plate's frame to the room's: R_y(phi) R_x(theta), as in bbsim."""
    a, b, c, d = math.cos(phi), math.sin(phi), math.cos(theta), math.sin(theta)
    return np.array([[a, b * d, b * c], [0, c, -d], [-b, a * d, a * c]])


class View:
    """A fixed camera, known from its picture of the level plate; completely, if its place is given."""

    def __init__(self, level, radius, place=None, height=0.0):
        self.level, self.radius, self.height = np.asarray(level), radius, height
        self.inverse = np.linalg.inv(self.level)
        self.camera = None
        if place is not None:
            self.camera = np.array([place[0], place[1], place[2] + height])
            # Its matrix M maps p - camera to a pixel; two columns are the plate's, the third one follows.
            third = -(self.level @ [place[0], place[1], 1]) / place[2]
            self.matrix = np.column_stack([self.level[:, 0], self.level[:, 1], third])
            self.axis = self.matrix[2] / np.linalg.norm(self.matrix[2])

    def tilt_of(self, tilted):
        """The plate's rotation from its homography when it is tilted."""
        across = np.linalg.solve(self.matrix, tilted)[:, :2]
        across /= np.sqrt(np.linalg.norm(across[:, 0]) * np.linalg.norm(across[:, 1]))
        left, _, right = np.linalg.svd(np.column_stack([across, np.cross(across[:, 0], across[:, 1])]))
        return left @ right

    def position(self, pixel, turn=np.eye(3)):
        """The ball's contact point, from the center of its outline."""
        seen = np.array([*pixel, 1.0])
        if self.camera is None:
            x, y, w = self.inverse @ seen
            return x / w, y / w
        ray, camera, axis = turn.T @ np.linalg.solve(self.matrix, seen), turn.T @ self.camera, turn.T @ self.axis
        # A sphere's outline is an ellipse. Its center shows a point that is nearer than the sphere's
        # center, by radius^2 / depth along the optical axis.
        nearer = np.zeros(3)
        for _ in range(3):
            center = camera + ray * ((self.height + self.radius - nearer[2] - camera[2]) / ray[2]) + nearer
            nearer = axis * self.radius**2 / (axis @ (center - camera))
        return center[0], center[1]


class Finder:
    """Finds the ball in a picture: the most ball-like square of its size, then the centroid around it."""

    least_contrast = 20  # of 255

    def __init__(self, look, plate, radius):
        self.plate, self.radius = plate, radius
        self.color = None
        if look not in ("dark", "light"):
            try:
                red, green, blue = (float(part) for part in look.split(","))
            except ValueError:
                raise Problem(2, f"--ball: found {look}; allowed: dark, light, or a color as R,G,B") from None
            self.color = np.array([blue, green, red], dtype=np.float32)  # OpenCV's order
        self.sign = -1 if look == "light" else 1
        self.known, self.region = None, None

    def _unlike(self, picture):
        if self.color is None:
            return self.sign * (picture if picture.ndim == 2 else picture.mean(axis=2, dtype=np.float32)).astype(np.float32)
        return np.sqrt(((picture.astype(np.float32) - self.color)**2).sum(axis=2))

    def _look_at(self, level, shape):
        """The plate's pixels, and the pixels per mm at each."""
        if self.known is not None and self.known[1] == shape and np.array_equal(self.known[0], level):
            return self.region
        half = np.array(self.plate) / 2
        corners = np.array([[-half[0], -half[1], 1], [half[0], -half[1], 1], [half[0], half[1], 1], [-half[0], half[1], 1]])
        seen = corners @ level.T
        seen = seen[:, :2] / seen[:, 2:]
        low = np.maximum(np.floor(seen.min(axis=0)).astype(int), 0)
        high = np.minimum(np.ceil(seen.max(axis=0)).astype(int) + 1, [shape[1], shape[0]])
        if (high - low).min() < 3:
            raise Problem(2, "the plate is not in the picture; --corners are pixels U,V of the picture, from its upper left")
        u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        x, y, w = (np.linalg.inv(level) @ np.stack([u.ravel(), v.ravel(), np.ones(u.size)])).reshape(3, *u.shape)
        on_plate = (abs(x / w) <= half[0]) & (abs(y / w) <= half[1])
        # Pixels per mm: the root of the determinant of the homography's derivative.
        scale = np.sqrt(abs(np.linalg.det(level)) * abs(w)**3)
        self.known, self.region = (level, shape), (low, high, u, v, on_plate, scale)
        return self.region

    def find(self, picture, level, outlines=()):
        """The pixel of the ball's center, None if there is no ball; `outlines` are the markers'."""
        low, high, u, v, on_plate, scale = self._look_at(level, picture.shape)
        for outline in outlines:
            on_plate = on_plate & ~inside(outline, u, v)
        unlike = self._unlike(picture[low[1]:high[1], low[0]:high[0]])
        like = np.where(on_plate, np.median(unlike[on_plate]) - unlike, 0)
        size = max(1, int(1.2 * self.radius * np.median(scale[on_plate])))  # of a square within the ball
        sums = np.zeros((like.shape[0] + 1, like.shape[1] + 1))
        sums[1:, 1:] = like.cumsum(axis=0, dtype=np.float64).cumsum(axis=1)
        squares = (sums[size:, size:] - sums[:-size, size:] - sums[size:, :-size] + sums[:-size, :-size]) / size**2
        if squares.size == 0 or squares.max() < self.least_contrast:
            return None
        contrast = squares.max()
        row, column = np.unravel_index(squares.argmax(), squares.shape)
        center = np.array([u[0, column] + (size - 1) / 2, v[row, 0] + (size - 1) / 2])
        radius = self.radius * scale[row + size // 2, column + size // 2]
        window = tuple(slice(max(0, int(at + size / 2 - 3 * radius)), int(at + size / 2 + 3 * radius) + 1)
                       for at in (row, column))
        u, v, weight = u[window], v[window], np.clip(like[window] / contrast, 0, 1)
        weight[weight < 0.2] = 0  # the background's noise
        for _ in range(20):
            near = weight * ((u - center[0])**2 + (v - center[1])**2 < (1.5 * radius)**2)
            area = near.sum()
            if area == 0:
                return None
            before, center = center, np.array([(near * u).sum(), (near * v).sum()]) / area
            if abs(center - before).max() < 1e-3:
                break
        return center if 0.5 < area / (math.pi * radius**2) < 2 else None


class Markers:
    """Four ArUco markers on the plate."""

    def __init__(self, ids, dictionary):
        cv2 = opencv()
        aruco, name = getattr(cv2, "aruco", None), "DICT_" + dictionary
        if aruco is None or not hasattr(aruco, name):
            raise Problem(2, f"--dictionary: found {dictionary}; allowed: a name of OpenCV's, such as 4X4_50")
        self.ids, words = [int(i) for i in ids], aruco.getPredefinedDictionary(getattr(aruco, name))
        modern = hasattr(aruco, "ArucoDetector")  # since OpenCV 4.7
        parameters = aruco.DetectorParameters() if modern else aruco.DetectorParameters_create()
        parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
        if modern:
            self.detect = aruco.ArucoDetector(words, parameters).detectMarkers
        else:
            self.detect = lambda picture: aruco.detectMarkers(picture, words, parameters=parameters)

    def find(self, picture):
        """The centers, and all markers' outlines; None if one of the four is not seen."""
        corners, ids, _ = self.detect(picture)
        outlines = [c.reshape(4, 2).astype(float) for c in corners]
        found = {} if ids is None else dict(zip(ids.ravel().tolist(), outlines))
        if not set(self.ids) <= set(found):
            return None, outlines
        return np.array([crossing(found[i]) for i in self.ids]), outlines


def inside(outline, u, v):
    """Which pixels are in a marker or close to it."""
    middle = outline.mean(axis=0)
    points = middle + 1.15 * (outline - middle)
    sides = [(b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]) for a, b in zip(points, np.roll(points, -1, axis=0))]
    return (np.min(sides, axis=0) >= 0) | (np.max(sides, axis=0) <= 0)


def crossing(corners):
    """Where the diagonals cross: a square's center, in any perspective."""
    a, b, c, d = (np.append(corner, 1.0) for corner in corners)
    x, y, w = np.cross(np.cross(a, c), np.cross(b, d))
    return x / w, y / w


class Watcher:
    """What the pictures of one recording show."""

    def __init__(self, arguments):
        self.arguments = arguments
        half = np.array(arguments.plate) / 2
        self.places = [(-half[0], -half[1]), (half[0], -half[1]), (half[0], half[1]), (-half[0], half[1])]
        self.finder = Finder(arguments.ball, arguments.plate, arguments.radius)
        self.markers = Markers(arguments.markers, arguments.dictionary) if arguments.markers else None
        self.level = None if self.markers else homography(self.places, arguments.corners)
        self.times, self.pixels, self.corners = [], [], []
        self.slow = 0

    def watch(self, frames, ended):
        busy = []
        for moment, picture in frames:
            began = time.monotonic()
            corners, outlines = self.markers.find(picture) if self.markers else (None, ())
            level = homography(self.places, corners) if corners is not None else self.level
            self.times.append(moment)
            self.pixels.append(None if level is None else self.finder.find(picture, level, outlines))
            self.corners.append(corners)
            busy.append(time.monotonic() - began)
            if ended():
                break
        if len(busy) > 1:
            self.slow = int((np.array(busy) > np.median(np.diff(self.times))).sum())

    def within(self, log, moments):
        return sum(log.rows[0].t <= t <= log.rows[-1].t for t in moments)

    def merge(self, log, moments):
        """The number of pictures with the ball, and all rows: the sketch's have angles, the camera's have the ball."""
        arguments = self.arguments
        level = self.level
        if self.markers:
            seen = [(t, c) for t, c in zip(moments, self.corners) if c is not None]
            if not seen:
                return 0, []
            still = [c for t, c in seen if t <= log.rows[0].t] or [seen[0][1]]
            level = homography(self.places, np.mean(still, axis=0))
        view = View(level, arguments.radius, arguments.camera_at, arguments.height)
        times = [row.t for row in log.rows]
        angles = np.radians([log.angles(row) for row in log.rows])
        names = [log.names.index(name) for name in ("t_ms", "phi_deg", "theta_deg")]
        rows = {f"{1000 * row.t:.1f}": [*(row.fields[i] for i in names), "", ""] for row in log.rows}
        found = 0
        for t, pixel, corners in zip(moments, self.pixels, self.corners):
            if pixel is None or not times[0] <= t <= times[-1]:
                continue
            if corners is None:
                phi, theta = (np.interp(t - arguments.lag / 1000, times, angles[:, i]) for i in (0, 1))
                x, y = view.position(pixel, rotation(phi, theta))
            elif view.camera is None:
                x, y = View(homography(self.places, corners), arguments.radius).position(pixel)
            else:
                x, y = view.position(pixel, view.tilt_of(homography(self.places, corners)))
            key = f"{1000 * t:.1f}"
            rows.setdefault(key, [key, "", "", "", ""])[3:] = [f"{x:.2f}", f"{y:.2f}"]
            found += 1
        return found, [rows[key] for key in sorted(rows, key=float)]
