# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""A headless Chromium, controlled through WebDriver with Python's standard library only."""

import base64
import json
import shutil
import socket
import subprocess
import struct
import tempfile
import time
import urllib.error
import urllib.request
import zlib

# Software rendering for WebGL, without network access of its own.
FLAGS = [
    "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--disable-extensions", "--hide-scrollbars", "--force-device-scale-factor=1",
    "--disable-dev-shm-usage", "--mute-audio",
    # No network request is answered.
    "--proxy-server=http://127.0.0.1:9", "--proxy-bypass-list=<-loopback>",
]
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Failure(Exception):
    pass


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Browser:
    """`with Browser(width, height) as browser:` ends the browser and removes its profile."""

    def __init__(self, width=1280, height=800, dark=False, still=True, phone=False, flags=()):
        self.size = (width, height)
        self.flags = FLAGS + [f"--window-size={width},{height}", *flags]
        self.dark, self.still, self.phone = dark, still, phone

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="bbsim-browser-")
        self.port = free_port()
        self.driver = subprocess.Popen(
            ["chromedriver", f"--port={self.port}", "--log-level=SEVERE"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(100):
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{self.port}/status", timeout=1).read()
                break
            except OSError:
                time.sleep(0.1)
        options = {
            "args": self.flags + [f"--user-data-dir={self.profile}"],
            "perfLoggingPrefs": {"enableNetwork": True},
            "prefs": {"download.default_directory": self.profile, "download.prompt_for_download": False},
        }
        binary = shutil.which("chromium")
        if binary:
            options["binary"] = binary
        capabilities = {
            "browserName": "chrome",
            "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        }
        self.session = None
        try:
            answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
        except Failure:
            self.__exit__(None, None, None)
            raise
        self.session = answer["sessionId"]
        width, height = self.size
        # The size of the page, without the window's own frame.
        self.devtools("Emulation.setDeviceMetricsOverride",
                      {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": self.phone})
        self.devtools("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": "dark" if self.dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if self.still else "no-preference"}]})
        # Offline, so that the page has only what its file contains.
        self.devtools("Network.enable", {})
        self.devtools("Network.emulateNetworkConditions",
                      {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
        self.call("POST", "/timeouts", {"script": 120000, "pageLoad": 120000})
        return self

    def __exit__(self, *_):
        if self.session:
            try:
                self.call("DELETE", "")
            except Failure:
                pass
        self.driver.terminate()
        self.driver.wait(20)
        shutil.rmtree(self.profile, ignore_errors=True)

    def call(self, method, path, body=None):
        prefix = f"/session/{self.session}" if self.session else ""
        request = urllib.request.Request(
            f"http://127.0.0.1:{self.port}{prefix}{path}", method=method,
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise Failure(json.load(error)["value"]["message"]) from None

    def devtools(self, command, parameters):
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, url):
        self.call("POST", "/url", {"url": url})
        self.ready()

    def ready(self):
        self.call("POST", "/execute/async", {
            "script": "const done = arguments[0]; bbsim.ready.then(() => requestAnimationFrame(() => done(true)));",
            "args": []})

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def frame(self):
        """Waits until the page has drawn its pending changes."""
        self.call("POST", "/execute/async", {
            "script": "const done = arguments[0];"
                      "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 0)));",
            "args": []})

    def find(self, selector):
        return self.call("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        self.call("POST", f"/element/{self.find(selector)}/click", {})

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0]).textContent", selector)

    def keys(self, *keys):
        actions = []
        for key in keys:
            actions += [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def drag(self, start, *stops):
        move = lambda point, ms: {"type": "pointerMove", "duration": ms, "x": round(point[0]), "y": round(point[1])}
        actions = [move(start, 0), {"type": "pointerDown", "button": 0}]
        actions += [move(stop, 60) for stop in stops]
        actions += [{"type": "pointerUp", "button": 0}]
        self.call("POST", "/actions", {"actions": [
            {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}]})

    def click_at(self, x, y):
        self.drag((x, y))

    def hover(self, x, y):
        self.call("POST", "/actions", {"actions": [
            {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
             "actions": [{"type": "pointerMove", "duration": 50, "x": round(x), "y": round(y)}]}]})

    def picture(self, whole=False, clip=None):
        """PNG bytes of the window, of the whole page, or of (x, y, width, height)."""
        parameters = {"format": "png"}
        if clip:
            x, y, width, height = clip
            parameters["clip"] = {"x": x, "y": y, "width": width, "height": height, "scale": 1}
        if whole:
            size = self.run("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
            parameters.update(captureBeyondViewport=True,
                              clip={"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": 1})
        return base64.b64decode(self.devtools("Page.captureScreenshot", parameters)["data"])

    def console(self):
        """New console messages since the last call: level and message."""
        return [(entry["level"], entry["message"]) for entry in self.call("POST", "/se/log", {"type": "browser"})]

    def requests(self):
        """Addresses requested since the last call."""
        asked = []
        for entry in self.call("POST", "/se/log", {"type": "performance"}):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                asked.append(message["params"]["request"]["url"])
        return asked


def pixels(png):
    """Width, height and rows of (r, g, b) bytes of an 8-bit PNG without interlacing."""
    position, packed, width, height, channels = 8, b"", 0, 0, 3
    while position < len(png):
        length, kind = struct.unpack(">I4s", png[position:position + 8])
        data = png[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", data[:10])
            channels = {2: 3, 6: 4}[colour]
        elif kind == b"IDAT":
            packed += data
        position += 12 + length
    raw, rows, previous = zlib.decompress(packed), [], bytes(width * channels)
    stride = width * channels
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = line[i - channels] if i >= channels else 0
            up, corner = previous[i], previous[i - channels] if i >= channels else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                a, b, c = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
                line[i] = (line[i] + (left if a <= b and a <= c else up if b <= c else corner)) & 255
        previous = bytes(line)
        rows.append([tuple(line[i:i + 3]) for i in range(0, stride, channels)])
    return width, height, rows


def small_png(png):
    """The same picture in fewer bytes: six bits per color, which looks the same, and no transparency."""
    width, height, rows = pixels(png)
    raw, previous = bytearray(), bytes(3 * width)
    for row in rows:
        line = bytes(value & 0xFC | value >> 6 for pixel in row for value in pixel)
        up = bytes((a - b) & 255 for a, b in zip(line, previous))
        left = line[:3] + bytes((a - b) & 255 for a, b in zip(line[3:], line))
        # The filter among three with the smallest residual.
        kind, best = min(((0, line), (1, left), (2, up)), key=lambda way: sum(min(b, 256 - b) for b in way[1]))
        raw.append(kind)
        raw += best
        previous = line

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b"")
