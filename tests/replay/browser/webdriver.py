# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""A headless Chromium, controlled through WebDriver with Python's standard library only."""

import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

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
        self.emulate()
        # Offline, so that the page has only what its file contains.
        self.devtools("Network.enable", {})
        self.devtools("Network.emulateNetworkConditions",
                      {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
        self.call("POST", "/timeouts", {"script": 120000, "pageLoad": 120000})
        return self

    def emulate(self):
        """The theme and the wish for stillness of its user, on a screen."""
        self.devtools("Emulation.setEmulatedMedia", {"media": "", "features": [
            {"name": "prefers-color-scheme", "value": "dark" if self.dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if self.still else "no-preference"}]})

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
        self.ask("await bbsim.ready; await new Promise(requestAnimationFrame)")

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def ask(self, script, *arguments):
        """The value of an async function's body about `args`; a rejection becomes {fault: its message}."""
        return self.call("POST", "/execute/async", {
            "script": "const done = arguments[arguments.length - 1], args = [...arguments];"
                      f"(async () => {{ {script} }})().then(done, (error) => done({{fault: error.message}}));",
            "args": list(arguments)})

    def frame(self):
        """Waits until the page has drawn its pending changes."""
        self.ask("for (const _ of [1, 2]) await new Promise(requestAnimationFrame);"
                 "await new Promise((resolve) => setTimeout(resolve, 0))")

    def find(self, selector):
        return self.call("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        self.call("POST", f"/element/{self.find(selector)}/click", {})

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0]).textContent", selector)

    def act(self, kind, actions, **options):
        self.call("POST", "/actions", {"actions": [{"type": kind, "id": kind, "actions": actions, **options}]})

    def keys(self, *keys, held=()):
        """Presses keys, one after the other, while others are held."""
        press = lambda kind, its: [{"type": kind, "value": key} for key in its]
        pressed = [action for key in keys for action in press("keyDown", key) + press("keyUp", key)]
        self.act("key", press("keyDown", held) + pressed + press("keyUp", held))

    def mouse(self, *actions):
        move = lambda point: {"type": "pointerMove", "duration": 50, "x": round(point[0]), "y": round(point[1])}
        self.act("pointer", [{"type": one, "button": 0} if isinstance(one, str) else move(one) for one in actions],
                 parameters={"pointerType": "mouse"})

    def drag(self, start, *stops):
        self.mouse(start, "pointerDown", *stops, "pointerUp")

    def click_at(self, x, y):
        self.drag((x, y))

    def picture(self):
        """PNG bytes of the window."""
        return base64.b64decode(self.devtools("Page.captureScreenshot", {"format": "png"})["data"])

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


def small_png(browser, png):
    """The same picture in fewer bytes: six bits per color, which looks the same. The browser packs it again."""
    url = browser.ask("""const picture = new Image(); picture.src = 'data:image/png;base64,' + args[0]; await picture.decode();
        const canvas = Object.assign(document.createElement('canvas'), {width: picture.width, height: picture.height});
        const ink = canvas.getContext('2d'); ink.drawImage(picture, 0, 0);
        const all = ink.getImageData(0, 0, canvas.width, canvas.height);
        all.data.forEach((value, i) => { all.data[i] = value & 0xFC | value >> 6; });
        ink.putImageData(all, 0, 0);
        return canvas.toDataURL('image/png')""", base64.b64encode(png).decode())
    return base64.b64decode(url.split(",")[1])
